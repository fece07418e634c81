/** Which columns the table of runs has, which stay at the left, and in which order; the browser remembers it. */

import { ActionIcon, Button, Checkbox, Group, Popover, ScrollArea, Text, TextInput } from "@mantine/core";
import { useLocalStorage } from "@mantine/hooks";
import { useState } from "react";
import { type Arrangement, arranged, AS_IT_IS, moved, pinned, pinnedOf, toggled, withoutChannel } from "../../model/arrangement";
import { channelName } from "../../model/column";
import type { Column } from "../../model/table";
import { withUnit } from "../../model/units";
import { Icon } from "../../ui/Icon";

export function useArrangement() {
  const [arrangement, arrange] = useLocalStorage<Arrangement>({
    key: "columns of runs",
    defaultValue: AS_IT_IS,
    getInitialValueInEffect: false,
  });
  return { arrangement, arrange };
}

interface Props {
  columns: readonly Column[];
  arrangement: Arrangement;
  onArrange: (arrangement: Arrangement) => void;
}

interface MenuProps extends Props {
  /** Somebody wants a column that is not there yet. */
  onAdd: () => void;
}

export function ColumnMenu({ columns, arrangement, onArrange, onAdd }: MenuProps) {
  const [isOpen, setOpen] = useState(false);
  const [query, setQuery] = useState("");
  const hidden = arrangement.hidden.filter((id) => columns.some((column) => column.id === id)).length;
  const staying = pinnedOf(columns, arrangement);
  const rest = arranged(columns, arrangement).filter((column) => !staying.includes(column));
  const shown = [...staying, ...rest].filter(
    ({ id, title, name }) => id !== "run" && `${title} ${name}`.toLowerCase().includes(query.toLowerCase()),
  );
  return (
    <Popover opened={isOpen} onChange={setOpen} width={420} position="bottom-end" withArrow shadow="md" trapFocus>
      <Popover.Target>
        <Button size="xs" variant="default" leftSection={<Icon name="columns" size={14} />} onClick={() => setOpen(!isOpen)}>
          Columns{hidden ? ` (${hidden} hidden)` : ""}
        </Button>
      </Popover.Target>
      <Popover.Dropdown>
        <Group gap="xs" wrap="nowrap" mb={6}>
          <TextInput
            size="xs"
            flex={1}
            placeholder="Find a column"
            aria-label="Find a column"
            value={query}
            onChange={(event) => setQuery(event.currentTarget.value)}
          />
          <Button size="compact-xs" variant="subtle" onClick={() => onArrange(AS_IT_IS)}>
            As it was
          </Button>
        </Group>
        <ScrollArea h={320} type="auto" offsetScrollbars>
          {shown.map((column) => (
            <Entry key={column.id} column={column} columns={columns} arrangement={arrangement} onArrange={onArrange} />
          ))}
          {shown.length === 0 ? (
            <Text size="sm" c="dimmed">
              No column is called so.
            </Text>
          ) : null}
        </ScrollArea>
        <Button
          size="compact-xs"
          variant="light"
          mt={6}
          leftSection={<Icon name="plus" size={12} />}
          onClick={() => {
            setOpen(false);
            onAdd();
          }}
        >
          Add a column: a channel's aggregate …
        </Button>
      </Popover.Dropdown>
    </Popover>
  );
}

function Entry({ column, columns, arrangement, onArrange }: Props & { column: Column }) {
  const move = (by: number) => onArrange(moved(arrangement, columns, column.id, by));
  const name = withUnit(column.title, column.unit);
  const isPinned = arrangement.pinned?.includes(column.id) === true;
  const channel = channelName(column.id);
  return (
    <Group gap={4} wrap="nowrap" title={column.name}>
      <Checkbox
        size="xs"
        flex={1}
        miw={0}
        label={name}
        checked={!arrangement.hidden.includes(column.id)}
        onChange={() => onArrange(toggled(arrangement, column.id))}
      />
      <ActionIcon
        variant={isPinned ? "light" : "subtle"}
        size={24}
        aria-label={`Pin ${name}`}
        aria-pressed={isPinned}
        title={isPinned ? "Let it go to its place (p on its head)" : "Keep it at the left (p on its head)"}
        onClick={() => onArrange(pinned(arrangement, column.id))}
      >
        <Icon name="pin" size={12} />
      </ActionIcon>
      <ActionIcon variant="subtle" size={24} aria-label={`${name} first`} title="To the beginning" onClick={() => move(-columns.length)}>
        <Icon name="fit" size={12} />
      </ActionIcon>
      <ActionIcon variant="subtle" size={24} aria-label={`${name} to the left`} onClick={() => move(-1)}>
        <Icon name="up" size={12} />
      </ActionIcon>
      <ActionIcon variant="subtle" size={24} aria-label={`${name} to the right`} onClick={() => move(1)}>
        <Icon name="down" size={12} />
      </ActionIcon>
      {channel === undefined ? null : (
        <ActionIcon variant="subtle" size={24} aria-label={`Remove ${name}`} title="Remove the column" onClick={() => onArrange(withoutChannel(arrangement, channel))}>
          <Icon name="close" size={12} />
        </ActionIcon>
      )}
    </Group>
  );
}
