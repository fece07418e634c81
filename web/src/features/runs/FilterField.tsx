/** The filter of the runs, as an expression, with what is wrong in it and what it can say. */

import { ActionIcon, Code, Popover, Text, TextInput } from "@mantine/core";
import { useRef } from "react";
import { shortest, type Wrong } from "../../model/filter";
import type { Column } from "../../model/table";
import { Icon } from "../../ui/Icon";
import { useShortcuts } from "../../ui/shortcut";

interface Props {
  text: string;
  wrong: Wrong | undefined;
  columns: readonly Column[];
  onText: (text: string) => void;
}

export function FilterField({ text, wrong, columns, onText }: Props) {
  const field = useRef<HTMLInputElement>(null);
  useShortcuts({ "/": () => field.current?.focus() });
  return (
    <TextInput
      ref={field}
      size="xs"
      w={320}
      placeholder="Filter, e.g. failed or headway < 0.9 (/)"
      aria-label="Filter the runs"
      leftSection={<Icon name="search" size={14} />}
      rightSection={<Examples columns={columns} onText={onText} />}
      value={text}
      error={wrong ? <Mistake text={text} wrong={wrong} /> : undefined}
      onChange={(event) => onText(event.currentTarget.value)}
    />
  );
}

/** What is wrong, and where. */
function Mistake({ text, wrong: { at, problem } }: { text: string; wrong: Wrong }) {
  return (
    <span data-testid="filter-wrong">
      <Code fz={11}>
        {text.slice(0, at)}
        <mark>{text.slice(at) || "…"}</mark>
      </Code>{" "}
      {problem}
    </span>
  );
}

/** What can be said, with the columns of this table. */
function Examples({ columns, onText }: Pick<Props, "columns" | "onText">) {
  const of = (group: Column["group"]) => columns.find((column) => column.group === group && column.numeric);
  const [set, measured] = [of("parameters"), of("metrics")];
  const name = (column: Column | undefined, otherwise: string) => (column ? shortest(column, columns) : otherwise);
  const examples = [
    "failed",
    `${name(set, "seed")} < 1`,
    `${name(measured, "run")} >= 1 and not discarded`,
    "tag = wet or verdict = candidate",
    'name = "a long name"',
  ];
  return (
    <Popover width={360} position="bottom-end" withArrow shadow="md" trapFocus>
      <Popover.Target>
        <ActionIcon variant="subtle" color="gray" size="sm" aria-label="What the filter can say">
          <Icon name="help" size={14} />
        </ActionIcon>
      </Popover.Target>
      <Popover.Dropdown>
        <Text size="sm" mb={6}>
          A word is looked for in all that stands in a row. A column is compared by its name, with &lt; &lt;= &gt; &gt;= = !=, and
          joined by and, or, not and brackets. Metrics of runs that ended early are not compared.
        </Text>
        {examples.map((each) => (
          <Text key={each} size="sm">
            <button type="button" onClick={() => onText(each)} style={{ all: "unset", cursor: "pointer" }}>
              <Code>{each}</Code>
            </button>
          </Text>
        ))}
      </Popover.Dropdown>
    </Popover>
  );
}
