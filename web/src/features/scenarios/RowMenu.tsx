/** What can be done with a scenario: behind its button, or at the pointer after a click with the right button. */

import { Menu } from "@mantine/core";
import { Link } from "@tanstack/react-router";
import { downloadOf } from "../../api/scenarios";
import type { ScenarioRow } from "../../model/scenario";
import { Icon, type IconName } from "../../ui/Icon";
import classes from "./Scenarios.module.css";

export type Deed = "rename" | "duplicate" | "delete";

/** Of which scenario the menu is open, where, and what gets the focus back. */
export interface OpenMenu {
  row: ScenarioRow;
  x: number;
  y: number;
  from: HTMLElement | null;
}

interface Props {
  open: OpenMenu | undefined;
  onClose: () => void;
  onDeed: (deed: Deed, row: ScenarioRow) => void;
}

export function RowMenu({ open, onClose, onDeed }: Props) {
  if (!open) return null;
  const { row, x, y, from } = open;
  const close = () => {
    onClose();
    from?.focus({ preventScroll: true });
  };
  const icon = (name: IconName) => <Icon name={name} size={14} />;
  const why = row.sealed ? " (may be read only)" : "";
  return (
    <Menu opened onClose={close} position="bottom-start" width={230} returnFocus={false} withinPortal>
      <Menu.Target>
        <div className={classes.pointer} style={{ left: x, top: y }} />
      </Menu.Target>
      <Menu.Dropdown aria-label={`What to do with ${row.title}`}>
        <Menu.Item
          component={Link}
          to="/studio/$scenario"
          params={{ scenario: row.id } as never}
          search={{} as never}
          leftSection={icon("car")}
        >
          Open in the studio
        </Menu.Item>
        <Menu.Item
          component={Link}
          to="/edit/$scenario"
          params={{ scenario: row.id } as never}
          leftSection={icon("map")}
        >
          Edit on the plan
        </Menu.Item>
        <Menu.Item
          component={Link}
          to="/scenarios/$scenario/text"
          params={{ scenario: row.id } as never}
          leftSection={icon("text")}
        >
          Edit as text
        </Menu.Item>
        <Menu.Divider />
        <Menu.Item leftSection={icon("copy")} onClick={() => onDeed("duplicate", row)}>
          Duplicate …
        </Menu.Item>
        <Menu.Item
          leftSection={icon("pen")}
          disabled={row.sealed}
          onClick={() => onDeed("rename", row)}
          rightSection={<kbd className={classes.key}>F2</kbd>}
        >
          Rename …{why}
        </Menu.Item>
        <Menu.Item component="a" href={downloadOf(row.id)} download leftSection={icon("download")}>
          Download the file
        </Menu.Item>
        <Menu.Divider />
        <Menu.Item
          color="red"
          leftSection={icon("trash")}
          disabled={row.sealed}
          onClick={() => onDeed("delete", row)}
          rightSection={<kbd className={classes.key}>Del</kbd>}
        >
          Delete{why}
        </Menu.Item>
      </Menu.Dropdown>
    </Menu>
  );
}
