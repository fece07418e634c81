/** What a click on the plan does, and what may be added. */

import { Button, Menu, Text, Tooltip } from "@mantine/core";
import type { Addition } from "../../model/editing/deed";
import type { Editing, Item } from "../../model/editing/item";
import { Icon } from "../../ui/Icon";
import classes from "./Edit.module.css";
import type { Tool } from "./grip";

interface Props {
  tool: Tool;
  onTool: (tool: Tool) => void;
  /** The route of what is chosen. */
  route: string | undefined;
  chosen: readonly Item[];
  state: Editing;
  names: boolean;
  onNames: (names: boolean) => void;
  /** Whether the 3D scene is beside the plan. */
  scene: boolean;
  onScene: (scene: boolean) => void;
  onEvent: () => void;
  onEnough: () => void;
  onAnew: () => void;
}

const ADDITIONS: readonly { title: string; of: readonly { what: Addition; label: string }[] }[] = [
  { title: "On the road", of: [{ what: "vehicle", label: "Vehicle" }, { what: "friction", label: "Friction patch" }] },
  { title: "People", of: [{ what: "pedestrian", label: "Pedestrian" }, { what: "cyclist", label: "Cyclist" }] },
  {
    title: "Objects",
    of: [
      { what: "cuboid", label: "Cuboid" },
      { what: "cylinder", label: "Cylinder" },
      { what: "cone", label: "Cone" },
      { what: "barrier", label: "Barrier" },
      { what: "wall", label: "Wall" },
      { what: "tree", label: "Tree" },
    ],
  },
  { title: "Radio", of: [{ what: "station", label: "Road-side unit" }, { what: "radio", label: "Region without radio" }] },
];

export function Toolbar({ tool, onTool, route, chosen, state, names, onNames, scene, onScene, onEvent, onEnough, onAnew }: Props) {
  const choose = (next: Tool) => () => onTool(next);
  return (
    <div className={classes.tools} role="toolbar" aria-label="Tools">
      <Press on={tool.is === "select"} label="Select" hint="Click chooses, Shift adds, a drag over empty ground spans a rectangle (Esc)" onClick={choose({ is: "select" })} />
      <AddMenu onTool={onTool} onEvent={onEvent} />
      <Press on={tool.is === "measure"} label="Measure" hint="Click from point to point (M)" onClick={choose({ is: "measure", points: [] })} />
      <Press
        on={tool.is === "route"}
        label="Route"
        hint={route ? `Click along roads: the route ${route} goes on there (R)` : "Choose a vehicle or a route first"}
        disabled={!route}
        onClick={() => route && onTool({ is: "route", route })}
      />
      <Press on={names} label="Names" hint="Names on the plan (N)" onClick={() => onNames(!names)} />
      <Press on={scene} label="3D" hint="The scene beside the plan: choose, drag, turn and place there as well (3)" onClick={() => onScene(!scene)} />
      <Text size="xs" className={classes.hint} role="status" data-testid="tool-hint">
        {hintOf(tool, state)}
      </Text>
      {tool.is === "route" && chosen[0]?.group === "vehicle" ? (
        <Button size="compact-xs" variant="default" onClick={onAnew}>
          A route of its own from here
        </Button>
      ) : null}
      {tool.is === "select" ? null : (
        <Button size="compact-xs" variant="light" onClick={onEnough}>
          Done
        </Button>
      )}
    </div>
  );
}

function Press({ on, label, hint, disabled = false, onClick }: { on: boolean; label: string; hint: string; disabled?: boolean; onClick: () => void }) {
  return (
    <Tooltip label={hint} openDelay={300}>
      <Button size="compact-sm" variant={on ? "light" : "default"} aria-pressed={on} disabled={disabled} onClick={onClick}>
        {label}
      </Button>
    </Tooltip>
  );
}

function AddMenu({ onTool, onEvent }: Pick<Props, "onTool" | "onEvent">) {
  return (
    <Menu position="bottom-start" width={210}>
      <Menu.Target>
        <Button size="compact-sm" variant="default" leftSection={<Icon name="plus" size={13} />}>
          Add
        </Button>
      </Menu.Target>
      <Menu.Dropdown aria-label="Add">
        {ADDITIONS.map(({ title, of }) => (
          <div key={title}>
            <Menu.Label>{title}</Menu.Label>
            {of.map(({ what, label }) => (
              <Menu.Item key={what} onClick={() => onTool({ is: "add", what })}>
                {label}
              </Menu.Item>
            ))}
            {title === "Objects" ? <Menu.Item onClick={() => onTool({ is: "walls", corners: [] })}>Wall from corner to corner</Menu.Item> : null}
          </div>
        ))}
        <Menu.Label>What happens</Menu.Label>
        <Menu.Item onClick={() => onTool({ is: "area", corners: [] })}>Area with a trigger</Menu.Item>
        <Menu.Item
          onClick={() => {
            onTool({ is: "select" });
            onEvent();
          }}
        >
          Event
        </Menu.Item>
      </Menu.Dropdown>
    </Menu>
  );
}

/** What the next click does, in words. */
function hintOf(tool: Tool, state: Editing): string {
  switch (tool.is) {
    case "add":
      return `Click where the ${tool.what} is to be.`;
    case "area":
      return tool.corners.length < 3 ? "Click the corners of the area." : "Click further corners; Enter or a double click closes it.";
    case "walls":
      return tool.corners.length < 2 ? "Click where the wall begins, and its corners." : "Click further corners; Enter or a double click ends it.";
    case "measure":
      return "Click from point to point.";
    case "route": {
      const users = state.items.filter(({ group, route }) => group === "vehicle" && route === tool.route).length;
      const many = users > 1 ? ` ${users} vehicles follow it.` : "";
      return `Click a road: ${tool.route} goes on there. Drag a point onto another road, click it to take it out.${many}`;
    }
    default:
      return "";
  }
}
