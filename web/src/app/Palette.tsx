/** Ctrl+K: every place, scenario, run and map by its name. */

import { Spotlight, type SpotlightActionData, type SpotlightActionGroupData, spotlight } from "@mantine/spotlight";
import "@mantine/spotlight/styles.css";
import { useQuery } from "@tanstack/react-query";
import { useNavigate } from "@tanstack/react-router";
import { type KeyboardEvent, useState } from "react";
import { maps } from "../api/maps";
import { runs, scenarios } from "../api/queries";
import { Icon, type IconName } from "../ui/Icon";

/** So many of what fits are shown. */
const SHOWN = 12;

/** Ctrl+K opens the palette from a field too: no tag is left out. */
const EVERYWHERE: string[] = [];

export const openPalette = spotlight.open;

interface Props {
  onKeys: () => void;
}

export function Palette({ onKeys }: Props) {
  const [opened, setOpened] = useState(false);
  return (
    <Spotlight
      actions={useActions(onKeys, opened)}
      shortcut="mod + K"
      tagsToIgnore={EVERYWHERE}
      limit={SHOWN}
      scrollable
      maxHeight={420}
      highlightQuery
      nothingFound="Nothing is called so. Names of places, scenarios, runs (#3) and maps are known."
      searchProps={{
        placeholder: "Go to a place, scenario, run or map …",
        leftSection: <Icon name="search" size={16} />,
        "aria-label": "Go to",
        onKeyDown: takeFirst,
      }}
      onSpotlightOpen={() => setOpened(true)}
      onSpotlightClose={() => setOpened(false)}
    />
  );
}

/** Enter means the first one, when the list has changed since one was marked. */
function takeFirst({ key, currentTarget }: KeyboardEvent<HTMLInputElement>): void {
  const list = currentTarget.closest("[role=dialog]");
  if (key === "Enter" && !list?.querySelector("[data-action][data-selected]")) list?.querySelector<HTMLElement>("[data-action]")?.click();
}

function useActions(onKeys: () => void, opened: boolean): SpotlightActionGroupData[] {
  const navigate = useNavigate();
  const { data: files = [] } = useQuery(scenarios);
  // Runs and maps are asked for when the palette is open: they may be many, and nobody waits for them before.
  const { data: latest = [] } = useQuery({ ...runs(), enabled: opened });
  const { data: places = [] } = useQuery({ ...maps, enabled: opened });
  const action = (id: string, label: string, icon: IconName, onClick: () => void, description = ""): SpotlightActionData => ({
    id,
    label,
    description,
    keywords: [description],
    leftSection: <Icon name={icon} size={16} />,
    onClick,
  });
  const group = (title: string, actions: SpotlightActionData[]) => ({ group: title, actions });
  return [
    group("Places", [
      action("studio", "Studio", "car", () => navigate({ to: "/" }), "g s"),
      action("scenarios", "Scenarios", "text", () => navigate({ to: "/scenarios", search: {} }), "g f"),
      action("runs", "Runs", "table", () => navigate({ to: "/runs", search: {} }), "g r"),
      action("lineage", "Runs: lineage", "branch", () => navigate({ to: "/runs", search: { as: "lineage" } }), "which descends from which"),
      action("plot", "Runs: plot", "chart", () => navigate({ to: "/runs", search: { as: "space" } }), "parallel axes, each pair"),
      action("board", "Runs: board", "columns", () => navigate({ to: "/runs", search: { as: "board" } }), "candidates, discarded"),
      action("queue", "Queue", "table", () => navigate({ to: "/queue" }), "g q"),
      action("compare", "Compare", "compare", () => navigate({ to: "/compare", search: {} }), "g c"),
      action("maps", "Maps", "map", () => navigate({ to: "/maps" }), "g m"),
      action("validate", "Validation", "check", () => navigate({ to: "/validate" }), "g v"),
      action("kinds", "Kinds", "columns", () => navigate({ to: "/kinds" }), "g k"),
      action("keys", "Keyboard shortcuts", "help", onKeys, "?"),
    ]),
    group(
      "Scenarios",
      files.flatMap(({ id, title }) => [
        action(`scenario ${id}`, title, "car", () => navigate({ to: "/studio/$scenario", params: { scenario: id }, search: {} }), `open ${id} in the studio`),
        action(`edit ${id}`, `Edit ${title}`, "pen", () => navigate({ to: "/edit/$scenario", params: { scenario: id } }), `edit ${id} on the plan`),
      ]),
    ),
    group(
      "Runs",
      latest.map(({ run, name, scenario, status, verdict, reason }) =>
        action(
          `run ${run}`,
          `#${run} ${name || scenario}`,
          "table",
          () => navigate({ to: "/runs/$run", params: { run: String(run) } }),
          [status, verdict === "open" ? "" : `${verdict}: ${reason}`].filter(Boolean).join(", "),
        ),
      ),
    ),
    group(
      "Maps",
      places.map(({ id, title }) => action(`map ${id}`, title || id, "map", () => navigate({ to: "/maps/$map", params: { map: id }, search: {} }))),
    ),
  ];
}
