/** Runs in the space of what was set and measured: as lines over parallel axes, or as points over each pair of them. */

import { Group, MultiSelect, SegmentedControl, Text } from "@mantine/core";
import { useMemo } from "react";
import { type Axis, axesOf, axisOf, axisText, firstAxes, type Range } from "../../model/axes";
import { AsTable } from "../../charts/Sheet";
import { type Bound, filterOf, withRange } from "../../model/filter";
import type { ListedRun } from "../../model/run";
import { evenly, partOf } from "../../model/sampled";
import { type Column, textOf } from "../../model/table";
import { formatValue, withUnit } from "../../model/units";
import { Empty } from "../../ui/State";
import { Parallel } from "./Parallel";
import { Ranking } from "./Ranking";
import { Scatter } from "./Scatter";
import classes from "./Space.module.css";

export interface SpaceView {
  /** How it is drawn. */
  draw?: "lines" | "points" | "ranks" | undefined;
  /** Ids of the axes, with commas; the first that tell something without it. */
  axes?: string | undefined;
}

interface Props extends SpaceView {
  runs: readonly ListedRun[];
  /** Those that the filter lets through. */
  shown: ReadonlySet<number>;
  columns: readonly Column[];
  text: string;
  bounds: readonly Bound[];
  onView: (view: SpaceView) => void;
  onFilter: (text: string) => void;
  onHover: (run: number | undefined) => void;
}

/** What both ways of drawing are given. */
export interface Drawn {
  axes: readonly Axis[];
  runs: readonly ListedRun[];
  shown: ReadonlySet<number>;
  bounds: readonly Bound[];
  /** Keep these axes between values; without a range let all through. */
  onRange: (ranges: readonly (readonly [Axis, Range | undefined])[]) => void;
  onHover: (run: number | undefined) => void;
}

/** So many pairs of axes can be told apart. */
const MOST_POINTS = 5;

export function Space({ runs, shown, columns, text, bounds, draw = "lines", axes: chosen, onView, onFilter, onHover }: Props) {
  const all = useMemo(() => axesOf(columns, runs), [columns, runs]);
  const ids = chosen === undefined ? firstAxes(all, runs) : chosen.split(",");
  const axes = useMemo(() => ids.flatMap((id) => axisOf(id, all) ?? []), [all, ids.join()]);
  const onAxes = (next: readonly Axis[]) => onView({ draw, axes: next.length ? next.map(axisText).join(",") : undefined });
  const onRange: Drawn["onRange"] = (ranges) => {
    let next = text;
    for (const [axis, range] of ranges) next = withRange(next, boundsOf(next, columns), axis.column, columns, range);
    onFilter(next);
  };
  if (all.length < 2)
    return (
      <Empty icon="chart" title="Nothing to draw yet">
        Here runs are drawn over what was set and what was measured, as soon as two of them differ in two numbers.
      </Empty>
    );
  // Points stand over plain axes.
  const plain = axes.slice(0, MOST_POINTS).map(({ column, low, high }) => ({ column, low, high }));
  const drawn: Drawn = { axes: draw === "points" ? plain : axes, runs, shown, bounds, onRange, onHover };
  return (
    <section className={classes.space} aria-label="Runs over their parameters and metrics" data-testid="space">
      <Group gap="sm" align="center" px={16}>
        <SegmentedControl
          size="xs"
          aria-label="Drawn as"
          value={draw}
          onChange={(next) => onView({ draw: next as SpaceView["draw"], axes: chosen })}
          data={[
            { value: "lines", label: "Parallel axes" },
            { value: "points", label: "Each pair" },
            { value: "ranks", label: "Sensitivity" },
          ]}
        />
        {draw === "ranks" ? null : <MultiSelect
          size="xs"
          flex={1}
          searchable
          clearable
          aria-label="Axes"
          placeholder={ids.length ? "" : "Choose axes"}
          value={axes.map(({ column }) => column.id)}
          onChange={(next) => onAxes(next.flatMap((id) => axes.find(({ column }) => column.id === id) ?? axisOf(id, all) ?? []))}
          data={all.map(({ column }) => ({ value: column.id, label: withUnit(column.title, column.unit) }))}
          maxDropdownHeight={320}
        />}
        <Text size="xs" c="dimmed" hidden={draw === "ranks"}>
          {draw === "points" && axes.length > MOST_POINTS ? `The first ${MOST_POINTS} of ${axes.length}. ` : ""}
          Drag along an axis to filter; it stands in the filter above.
          {draw === "points" ? "" : " Drag a title, or use the arrow keys on it, to move its axis; F flips it, L makes it logarithmic."}
        </Text>
        {draw === "ranks" ? null : <AsTable sheet={() => sheetOf(drawn)} />}
      </Group>
      {draw === "ranks" ? (
        <Ranking all={all} columns={columns} runs={runs} shown={shown} />
      ) : draw === "points" ? <Scatter {...drawn} /> : <Parallel {...drawn} onAxes={onAxes} />}
    </section>
  );
}

/** What an expression keeps runs between. */
const boundsOf = (text: string, columns: readonly Column[]): readonly Bound[] => filterOf(text, columns, textOf).bounds ?? [];

/** The runs that the filter lets through, with their values on the axes that are drawn. */
function sheetOf({ axes, runs, shown }: Drawn) {
  const through = runs.filter(({ run }) => shown.has(run));
  const some = evenly(through);
  const told = (value: ReturnType<Column["value"]>) => (value === null || value === undefined || typeof value === "number" ? value : formatValue(value));
  return {
    title: "Runs over their axes",
    note: partOf(some.length, through.length, "runs"),
    heads: ["Run", ...axes.map(({ column }) => withUnit(column.title, column.unit))],
    rows: some.map((run) => [`#${run.run}`, ...axes.map(({ column }) => told(column.value(run)))]),
  };
}
