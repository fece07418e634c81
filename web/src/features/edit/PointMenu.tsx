/** What can be done at a place of the plan: behind a click with the right button. */

import { Menu } from "@mantine/core";
import type { Item } from "../../model/editing/item";
import { toggled } from "../../model/editing/item";
import type { Point } from "../../model/view";
import { Icon, type IconName } from "../../ui/Icon";
import classes from "./Edit.module.css";
import type { Editor } from "./EditPage";

/** Where on the screen and on the ground the menu is open, and on what. */
export interface Pointed {
  screen: Point;
  ground: Point;
  item: Item | undefined;
}

interface Props {
  pointed: Pointed | undefined;
  editor: Editor;
  onFocus: () => void;
  onClose: () => void;
}

export function PointMenu({ pointed, editor, onFocus, onClose }: Props) {
  if (!pointed) return null;
  const { item, screen } = pointed;
  const { veil, setVeil } = editor;
  return (
    <Menu opened onClose={onClose} position="bottom-start" width={220} withinPortal returnFocus={false}>
      <Menu.Target>
        <div className={classes.pointer} style={{ left: screen.x, top: screen.y }} />
      </Menu.Target>
      <Menu.Dropdown aria-label={item ? `What to do with ${item.name}` : "What to do here"}>
        {item ? (
          <>
            <Entry icon="copy" label="Duplicate" keys="Ctrl+D" onClick={editor.duplicate} />
            <Entry icon="copy" label="Copy" keys="Ctrl+C" onClick={editor.copy} />
            <Entry icon="fit" label="Focus" keys="F" onClick={onFocus} />
            {editor.routeOf ? (
              <Entry icon="route" label="Edit route" keys="R" onClick={() => editor.setTool({ is: "route", route: editor.routeOf as string })} />
            ) : null}
            <Entry icon="eye" label="Hide" onClick={() => setVeil({ ...veil, hidden: toggled(veil.hidden, item.path) })} />
            <Entry icon="lock" label={veil.locked.includes(item.path) ? "Unlock" : "Lock"} onClick={() => setVeil({ ...veil, locked: toggled(veil.locked, item.path) })} />
            <Menu.Divider />
            <Entry icon="trash" label="Delete" keys="Del" onClick={editor.remove} />
          </>
        ) : (
          <>
            <Entry icon="copy" label="Paste" keys="Ctrl+V" disabled={!editor.canPaste()} onClick={editor.paste} />
            <Entry icon="car" label="Add a vehicle" onClick={() => editor.setTool({ is: "add", what: "vehicle" })} />
            <Entry icon="tape" label="Measure from here" keys="M" onClick={() => editor.setTool({ is: "measure", points: [pointed.ground] })} />
          </>
        )}
      </Menu.Dropdown>
    </Menu>
  );
}

function Entry({ icon, label, keys, disabled = false, onClick }: { icon: IconName; label: string; keys?: string; disabled?: boolean; onClick: () => void }) {
  return (
    <Menu.Item leftSection={<Icon name={icon} size={14} />} disabled={disabled} onClick={onClick} rightSection={keys ? <kbd className={classes.key}>{keys}</kbd> : null}>
      {label}
    </Menu.Item>
  );
}
