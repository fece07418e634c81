/** One quantity over time: a uPlot chart with our own compact legend. */

import { useComputedColorScheme } from "@mantine/core";
import { type ReactNode, useEffect, useRef, useState } from "react";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { formatTime, withUnit } from "../model/units";
import classes from "./TimeChart.module.css";

export interface Line {
  key: string;
  label: string;
  color: string;
  dashed?: boolean;
}

export type Columns = [number[], ...(number | null | undefined)[][]];

interface Props {
  title: string;
  unit: string;
  lines: readonly Line[];
  data: Columns;
  /** Changes whenever `data` has grown in place. */
  version?: number;
  /** Charts with the same key share their cursor and zoom. */
  sync?: string;
  /** The time axis reaches at least this far [s]. */
  duration?: number;
  height?: number;
  /** Stands in front of the legend, for instance the choice of the quantity. */
  lead?: ReactNode;
}

const INK = {
  dark: { text: "#a6a7ab", grid: "rgba(255,255,255,0.07)", line: "#5c5f66" },
  light: { text: "#5c6370", grid: "rgba(0,0,0,0.07)", line: "#adb5bd" },
};
const FONT = '11px system-ui, -apple-system, "Segoe UI", sans-serif';
/** Equal left margins keep stacked charts aligned. */
const AXIS_WIDTH = 52;

function series({ label, color, dashed }: Line): uPlot.Series {
  return {
    label,
    stroke: color,
    width: dashed ? 1.5 : 1.75,
    ...(dashed ? { dash: [6, 4] } : {}),
    points: { show: false },
    spanGaps: false,
  };
}

/** In a low chart the unit stands at the ticks, which saves the line of the label. */
const withSecond = (_chart: uPlot, ticks: number[]): string[] => ticks.map((tick) => `${tick} s`);

/** Below this height [px] a chart is low. */
const LOW = 120;

/** What the chart tells and remembers outside of React's rendering. */
interface Memory {
  zoomed: boolean;
  onCursor: (index: number | null) => void;
}

function options(
  { title, unit, lines, duration = 0, sync }: Props,
  dark: boolean,
  memory: Memory,
  low: boolean,
): Omit<uPlot.Options, "width" | "height"> {
  const ink = dark ? INK.dark : INK.light;
  const axis = {
    stroke: ink.text,
    font: FONT,
    grid: { stroke: ink.grid, width: 1 },
    ticks: { show: false },
    labelFont: FONT,
    labelSize: 16,
    labelGap: 0,
  };
  return {
    padding: [8, 12, 0, 0],
    legend: { show: false },
    cursor: {
      ...(sync ? { sync: { key: sync, setSeries: false } } : {}),
      drag: { x: true, y: false },
      points: { size: 6 },
    },
    scales: {
      x: {
        time: false,
        range: (_u, low, high) => (memory.zoomed ? [low, high] : [0, Math.max(duration, high ?? 0, 1)]),
      },
      y: { range: (_u, low, high) => padded(low, high) },
    },
    axes: [
      { ...axis, size: 24, space: 60, ...(low ? { values: withSecond } : { label: "Time [s]" }) },
      { ...axis, size: AXIS_WIDTH - 16, label: withUnit(title, unit), space: 28 },
    ],
    series: [{ label: "Time" }, ...lines.map(series)],
    hooks: {
      setCursor: [(chart) => memory.onCursor(chart.cursor.idx ?? null)],
      setSelect: [
        () => {
          memory.zoomed = true;
        },
      ],
      ready: [
        (chart) =>
          chart.over.addEventListener(
            "dblclick",
            () => {
              memory.zoomed = false;
            },
            { capture: true },
          ),
      ],
    },
  };
}

/** A little air above and below, and never a range without height. */
function padded(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null) return [0, 1];
  const air = Math.max((high - low) * 0.08, Math.abs(high) * 0.02, 0.05);
  return [low >= 0 ? Math.max(-air / 3, low - air) : low - air, high + air];
}

/** The newest sample that any line has. */
function newest(data: Columns): number | null {
  return data[0].length > 0 ? data[0].length - 1 : null;
}

/** How many samples of the other run may lie between two of this one. */
const LOOK_BACK = 64;

/** The value of a column at an index, looking back over places where only the other run has samples. */
function valueAt(column: Columns[number] | undefined, index: number | null): number | null {
  if (!column || index === null) return null;
  for (let i = index; i >= 0 && i > index - LOOK_BACK; i -= 1)
    if (column[i] !== undefined) return column[i] ?? null;
  return null;
}

export function TimeChart(props: Props) {
  const { lines, data, version, title, unit, height = 180, lead } = props;
  const dark = useComputedColorScheme("light") === "dark";
  const host = useRef<HTMLDivElement>(null);
  const chart = useRef<uPlot>(undefined);
  const [cursor, setCursor] = useState<number | null>(null);
  const memory = useRef<Memory>({ zoomed: false, onCursor: setCursor });
  const shape = JSON.stringify([lines, title, unit, props.sync, props.duration, dark]);

  // A chart is rebuilt only when its lines, axes or theme change; samples are set below.
  // `shape` stands for all of them.
  useEffect(() => {
    const element = host.current;
    if (!element) return;
    const size = () => ({
      width: Math.max(element.clientWidth, 50),
      height: Math.max(element.clientHeight, 60),
    });
    const made = new uPlot(
      { ...options(props, dark, memory.current, element.clientHeight < LOW), ...size() },
      data as uPlot.AlignedData,
      element,
    );
    chart.current = made;
    const observer = new ResizeObserver(() => made.setSize(size()));
    observer.observe(element);
    return () => {
      observer.disconnect();
      made.destroy();
    };
  }, [shape]);

  // The columns grow in place, `version` tells when.
  useEffect(() => {
    // New samples must not throw away a zoom made by hand.
    chart.current?.setData(data as uPlot.AlignedData, !memory.current.zoomed);
    if (memory.current.zoomed) chart.current?.redraw(true);
  }, [data, version]);

  const index = cursor ?? newest(data);
  const time = index === null ? undefined : data[0][index];
  return (
    <figure className={classes.figure} aria-label={`${withUnit(title, unit)} over time`}>
      <figcaption className={classes.legend}>
        {lead}
        <span className={classes.time}>{time === undefined ? "" : `t = ${formatTime(time)} s`}</span>
        {byLabel(lines).map(([label, members]) => (
          <span key={label} className={classes.item}>
            {label}
            {members.map(({ line, place }) => (
              <span key={line.key} className={classes.item}>
                <Stroke color={line.color} dashed={line.dashed === true} />
                <b className={classes.value}>{shown(valueAt(data[place + 1], index))}</b>
              </span>
            ))}
          </span>
        ))}
      </figcaption>
      <div ref={host} className={classes.plot} style={{ minHeight: height }} />
    </figure>
  );
}

/** Lines of the same name share one entry of the legend: a solid and a dashed value side by side. */
function byLabel(lines: readonly Line[]): [string, { line: Line; place: number }[]][] {
  const groups = new Map<string, { line: Line; place: number }[]>();
  for (const [place, line] of lines.entries()) {
    groups.set(line.label, [...(groups.get(line.label) ?? []), { line, place }]);
  }
  return [...groups];
}

/** Two decimals at all times, so that the legend does not jump. */
const shown = (value: number | null): string =>
  value === null ? "–" : value.toFixed(2).replace("-", "\u2212");

function Stroke({ color, dashed }: { color: string; dashed: boolean }) {
  return (
    <svg width="16" height="8" aria-hidden="true">
      <line
        x1="0"
        y1="4"
        x2="16"
        y2="4"
        stroke={color}
        strokeWidth="2.5"
        strokeDasharray={dashed ? "5 3" : undefined}
      />
    </svg>
  );
}
