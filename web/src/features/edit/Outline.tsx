/** Everything in the scenario, group by group: searched, chosen, hidden, locked. */

import { ActionIcon, CloseButton, ScrollArea, Text, TextInput, Tooltip, UnstyledButton } from "@mantine/core";
import { useState } from "react";
import { grouped, type Item, toggled, type Turn, type Veil } from "../../model/editing/item";
import { Icon } from "../../ui/Icon";
import classes from "./Edit.module.css";

interface Props {
  items: readonly Item[];
  turns: readonly Turn[];
  chosen: readonly string[];
  veil: Veil;
  onVeil: (veil: Veil) => void;
  onChoose: (paths: string[], add: boolean) => void;
  onFocus: (item: Item) => void;
}

export function Outline({ items, turns, chosen, veil, onVeil, onChoose, onFocus }: Props) {
  const [query, setQuery] = useState("");
  const [closed, setClosed] = useState<readonly string[]>([]);
  const groups = grouped(items, query);
  const never = new Map(turns.filter((turn) => turn.never).map(({ entry, never: why }) => [entry, why]));
  return (
    <nav className={classes.outline} aria-label="Everything in the scenario">
      <TextInput
        size="xs"
        m={8}
        placeholder="Search"
        aria-label="Search in the scenario"
        leftSection={<Icon name="search" size={14} />}
        rightSection={query ? <CloseButton size="xs" aria-label="Clear the search" onClick={() => setQuery("")} /> : null}
        value={query}
        onChange={(event) => setQuery(event.currentTarget.value)}
      />
      <ScrollArea className={classes.scrolled} type="auto">
        {groups.length === 0 ? (
          <Text size="sm" c="dimmed" p="sm">
            Nothing is called “{query}”.
          </Text>
        ) : null}
        {groups.map(({ group, title, items: found }) => (
          <section key={group} aria-label={title}>
            <UnstyledButton className={classes.group} aria-expanded={!closed.includes(group)} onClick={() => setClosed(toggled(closed, group))}>
              <Icon name={closed.includes(group) ? "right" : "down"} size={12} /> {title} <span className={classes.count}>{found.length}</span>
            </UnstyledButton>
            {closed.includes(group)
              ? null
              : found.map((item) => (
                  <Row
                    key={item.path}
                    item={item}
                    never={group === "area" || group === "radio" ? undefined : never.get(item.path.startsWith("script.") ? item.name : "")}
                    chosen={chosen.includes(item.path)}
                    hidden={veil.hidden.includes(item.path)}
                    locked={veil.locked.includes(item.path)}
                    onChoose={(add) => onChoose([item.path], add)}
                    onFocus={() => onFocus(item)}
                    onHide={() => onVeil({ ...veil, hidden: toggled(veil.hidden, item.path) })}
                    onLock={() => onVeil({ ...veil, locked: toggled(veil.locked, item.path) })}
                  />
                ))}
          </section>
        ))}
      </ScrollArea>
    </nav>
  );
}

interface RowProps {
  item: Item;
  never: string | undefined;
  chosen: boolean;
  hidden: boolean;
  locked: boolean;
  onChoose: (add: boolean) => void;
  onFocus: () => void;
  onHide: () => void;
  onLock: () => void;
}

function Row({ item: { name, told, figures }, never, chosen, hidden, locked, onChoose, onFocus, onHide, onLock }: RowProps) {
  return (
    <div className={classes.row} data-chosen={chosen || undefined} data-hidden={hidden || undefined}>
      <UnstyledButton
        className={classes.item}
        aria-pressed={chosen}
        title={never ? `${name} never begins: ${never}` : `${name}: ${told}`}
        onClick={(event) => onChoose(event.shiftKey || event.ctrlKey || event.metaKey)}
        onDoubleClick={onFocus}
      >
        {never ? (
          <span className={classes.never}>
            <Icon name="warning" size={13} />
          </span>
        ) : null}
        <span className={classes.itemName}>{name}</span> <span className={classes.told} aria-hidden="true">
          {told}
        </span>
      </UnstyledButton>
      {figures.length > 0 ? (
        <>
          <Toggle on={hidden} icon="eye" label={`${hidden ? "Show" : "Hide"} ${name}`} onClick={onHide} />
          <Toggle on={locked} icon="lock" label={`${locked ? "Unlock" : "Lock"} ${name}`} onClick={onLock} />
        </>
      ) : null}
    </div>
  );
}

function Toggle({ on, icon, label, onClick }: { on: boolean; icon: "eye" | "lock"; label: string; onClick: () => void }) {
  return (
    <Tooltip label={label} openDelay={400}>
      <ActionIcon className={classes.toggle} size={20} variant={on ? "light" : "subtle"} color="gray" aria-label={label} aria-pressed={on} data-on={on || undefined} onClick={onClick}>
        <Icon name={icon} size={13} />
      </ActionIcon>
    </Tooltip>
  );
}
