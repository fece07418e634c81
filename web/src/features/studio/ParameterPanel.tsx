/** The parameters of the scenario: search, what is changed, what is wrong, and the form. */

import {
  Alert,
  Badge,
  Button,
  CloseButton,
  Collapse,
  ScrollArea,
  Text,
  TextInput,
  Tooltip,
  UnstyledButton,
} from "@mantine/core";
import { type ReactNode, useMemo, useRef, useState } from "react";
import {
  type Exchange,
  exchangesOf,
  type Field,
  fieldsOf,
  matching,
  placed,
  type Section,
} from "../../model/form";
import type { Json, Problem } from "../../model/run";
import { formatValue } from "../../model/units";
import { Icon } from "../../ui/Icon";
import { Path } from "../../ui/Path";
import { ProblemList } from "../../ui/Problems";
import { SchemaForm } from "../../ui/SchemaForm";
import { useShortcuts } from "../../ui/shortcut";
import classes from "./Studio.module.css";

interface Props {
  sections: Section[];
  problems: readonly Problem[];
  parent: number | null;
  onChange: (field: Field, value: Json) => void;
  onExchange: (exchange: Exchange, name: string) => void;
  onResetAll: () => void;
  onForgetParent: () => void;
  /** Writes the changes into a file. */
  save: ReactNode;
}

export function ParameterPanel({
  save,
  sections,
  problems,
  parent,
  onChange,
  onExchange,
  onResetAll,
  onForgetParent,
}: Props) {
  const [query, setQuery] = useState("");
  const [open, setOpen] = useState<string[]>(["applications"]);
  const search = useRef<HTMLInputElement>(null);
  useShortcuts({ "/": () => search.current?.focus() });

  const shown = useMemo(() => matching(sections, query), [sections, query]);
  const wrong = useMemo(() => byField(problems, sections), [problems, sections]);
  return (
    <>
      <div className={classes.search}>
        <TextInput
          ref={search}
          size="xs"
          placeholder="Search parameters (/)"
          aria-label="Search parameters"
          leftSection={<Icon name="search" size={14} />}
          rightSection={
            query ? (
              <CloseButton size="xs" aria-label="Clear the search" onClick={() => setQuery("")} />
            ) : null
          }
          value={query}
          onChange={(event) => setQuery(event.currentTarget.value)}
        />
      </div>
      <ScrollArea className={classes.form} type="auto" offsetScrollbars="y">
        <General problems={wrong.get("") ?? []} />
        {shown.length === 0 ? (
          <Text size="sm" c="dimmed" p="md">
            No parameter matches “{query}”.
          </Text>
        ) : (
          <SchemaForm
            sections={shown}
            problems={wrong}
            open={query ? shown.map(({ path }) => path) : open}
            expanded={query !== ""}
            onOpen={setOpen}
            onChange={onChange}
            onExchange={onExchange}
          />
        )}
      </ScrollArea>
      <Changed sections={sections} onChange={onChange} onExchange={onExchange} onResetAll={onResetAll} save={save} />
      <Parent parent={parent} onForget={onForgetParent} />
    </>
  );
}

function byField(problems: readonly Problem[], sections: readonly Section[]) {
  const paths = [
    ...fieldsOf(sections).map(({ path }) => path),
    ...exchangesOf(sections).map(({ path }) => path),
  ];
  return placed(problems, paths);
}

/** Problems that belong to no single field. */
function General({ problems }: { problems: readonly Problem[] }) {
  if (problems.length === 0) return null;
  return (
    <Alert
      color="red"
      variant="outline"
      p="xs"
      m="xs"
      icon={<Icon name="warning" />}
      title="This scenario cannot be run"
    >
      <ProblemList problems={problems} />
    </Alert>
  );
}

type ChangedProps = Pick<Props, "sections" | "onChange" | "onExchange" | "onResetAll" | "save">;

/** The list of everything that differs from the scenario's file. */
function Changed({ sections, onChange, onExchange, onResetAll, save }: ChangedProps) {
  const [open, setOpen] = useState(false);
  const fields = fieldsOf(sections).filter(({ changed }) => changed);
  const exchanges = exchangesOf(sections).filter(({ initial, value }) => initial !== value);
  const count = fields.length + exchanges.length;
  if (count === 0) {
    return (
      <Text size="xs" c="dimmed" className={classes.foot}>
        Nothing is changed from the scenario's file.
      </Text>
    );
  }
  return (
    <div className={classes.foot} data-testid="changes">
      <div className={classes.footHead}>
        <UnstyledButton onClick={() => setOpen(!open)} aria-expanded={open} className={classes.footToggle}>
          <Icon name={open ? "down" : "up"} size={14} />
          <Badge size="sm" tt="none" variant="light">
            {count} changed
          </Badge>
        </UnstyledButton>
        {save}
        <Button size="compact-xs" variant="subtle" onClick={onResetAll}>
          Reset all
        </Button>
      </div>
      <Collapse expanded={open}>
        <ul className={classes.changes}>
          {exchanges.map((exchange) => (
            <Change
              key={exchange.path}
              path={exchange.path}
              from={exchange.initial}
              to={exchange.value}
              unit=""
              onReset={() => onExchange(exchange, exchange.initial)}
            />
          ))}
          {fields.map((field) => (
            <Change
              key={field.path}
              path={field.path}
              from={field.initial}
              to={field.value}
              unit={field.unit}
              onReset={() => onChange(field, field.initial)}
            />
          ))}
        </ul>
      </Collapse>
    </div>
  );
}

interface ChangeProps {
  path: string;
  from: Json;
  to: Json;
  unit: string;
  onReset: () => void;
}

function Change({ path, from, to, unit, onReset }: ChangeProps) {
  return (
    <li>
      <span className={classes.changePath}>
        <Path path={path} />
      </span>
      <span className={classes.changeValue}>
        <s>{formatValue(from)}</s> <b>{formatValue(to)}</b> {unit}
      </span>
      <CloseButton size="xs" aria-label={`Reset ${path}`} onClick={onReset} />
    </li>
  );
}

/** The run that the next one descends from. */
function Parent({ parent, onForget }: { parent: number | null; onForget: () => void }) {
  if (parent === null) return null;
  return (
    <div className={classes.parent} data-testid="next-parent">
      <Icon name="branch" size={14} />
      <Text size="xs" span>
        The next run is a child of <b>#{parent}</b>
      </Text>
      <Tooltip label="Start a new line of runs">
        <CloseButton size="xs" aria-label="Start the next run without a parent" onClick={onForget} />
      </Tooltip>
    </div>
  );
}
