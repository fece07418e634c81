/** A recorded zone with the simulations in it: a band for the bounds, lines for the means. Zoom by dragging, linked over all of a kind. */

import { useComputedColorScheme } from "@mantine/core";
import { useEffect, useRef, useState } from "react";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { AsTable } from "../../charts/Sheet";
import { evenly, partOf } from "../../model/sampled";
import { formatNumber, withUnit, words } from "../../model/units";
import { columnsOf, type Course, shareOf } from "../../model/validation";
import classes from "./Validation.module.css";

const HEIGHT = 240;
const INK = {
  light: { text: "#5c6370", grid: "rgba(0,0,0,0.07)", theirs: "#1f5fa8", ours: "#b3261e", averaged: "#9c6500", band: "rgba(31,95,168,0.2)" },
  dark: { text: "#a6a7ab", grid: "rgba(255,255,255,0.07)", theirs: "#74b0f0", ours: "#ff8a80", averaged: "#f0b450", band: "rgba(116,176,240,0.25)" },
};

export function ZoneChart({ course, interval }: { course: Course; interval: string }) {
  const host = useRef<HTMLDivElement>(null);
  const ink = INK[useComputedColorScheme("light")];
  const [at, setAt] = useState<number | null>(null);
  const alone = course.runs.length === 1;
  const title = `${course.maneuver}: ${words(course.signal).toLowerCase()}`;
  useEffect(() => {
    const element = host.current;
    if (!element) return;
    const axis = { stroke: ink.text, grid: { stroke: ink.grid, width: 1 }, ticks: { stroke: ink.grid } };
    const line = (label: string, stroke: string, dash?: number[]): uPlot.Series => ({
      label,
      stroke,
      width: 1.5,
      points: { show: false },
      ...(dash ? { dash } : {}),
    });
    const edge = (label: string): uPlot.Series => ({ label, points: { show: false } });
    const made = new uPlot(
      {
        width: Math.max(element.clientWidth, 50),
        height: HEIGHT,
        legend: { show: false },
        cursor: { sync: { key: `zones over ${course.over}` }, y: false },
        scales: { x: { time: false } },
        axes: [
          { ...axis, label: withUnit(course.over, course.over_unit), size: 34, labelSize: 16 },
          { ...axis, label: withUnit(words(course.signal), course.unit), size: 54 },
        ],
        series: [
          {},
          edge("high"),
          edge("low"),
          line("theirs", ink.theirs),
          line("ours", ink.ours),
          ...(course.averaged ? [line("averaged", ink.averaged, [6, 4])] : []),
        ],
        bands: [{ series: [1, 2], fill: ink.band }],
        hooks: { setCursor: [({ cursor }) => setAt(cursor.idx ?? null)] },
      },
      columnsOf(course) as uPlot.AlignedData,
      element,
    );
    const observer = new ResizeObserver(() => made.setSize({ width: Math.max(element.clientWidth, 50), height: HEIGHT }));
    observer.observe(element);
    return () => {
      observer.disconnect();
      made.destroy();
    };
  }, [course, ink]);
  const value = (values: readonly (number | null)[] | null | undefined) =>
    at === null || !values || values[at] == null ? "" : ` ${formatNumber(values[at] as number)}`;
  return (
    <figure className={classes.figure} aria-label={title}>
      <figcaption>
        <b>{title}</b>
        <span>{alone ? course.runs[0] : `${course.runs.length} recorded runs`}</span>
        {alone ? null : (
          <span title={interval}>
            <i style={{ background: ink.band }} /> {shareOf(interval)} of their mean
          </span>
        )}
        <span>
          <i style={{ background: ink.theirs }} /> recorded{value(course.theirs)}
        </span>
        <span>
          <i style={{ background: ink.ours }} /> simulated{value(course.ours)}
        </span>
        {course.averaged ? (
          <span>
            <i style={{ background: ink.averaged }} /> averaged input{value(course.averaged)}
          </span>
        ) : null}
        {at === null ? null : (
          <span>
            at {formatNumber(course.at[at] ?? 0)} {course.over_unit}
          </span>
        )}
        <AsTable sheet={() => sheetOf(title, course)} />
      </figcaption>
      <div ref={host} />
    </figure>
  );
}

/** The same as a table: of bounds and means. */
function sheetOf(title: string, course: Course) {
  const columns = columnsOf(course);
  const rows = evenly([...course.at.keys()]).map((place) => columns.map((column) => column[place]));
  const names = ["upper bound", "lower bound", "recorded", "simulated", ...(course.averaged ? ["averaged input"] : [])];
  const heads = [withUnit(words(course.over), course.over_unit), ...names.map((name) => withUnit(name, course.unit))];
  return { title, note: partOf(rows.length, course.at.length, "places"), heads, rows };
}
