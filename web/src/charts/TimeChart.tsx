/** One quantity over time: a uPlot chart with our own compact legend. */

import { useComputedColorScheme } from "@mantine/core";
import { type ReactNode, useEffect, useRef, useState, useSyncExternalStore } from "react";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { formatFixed, formatTime, withUnit } from "../model/units";
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
  /** The time of a playback: a line stands there, and a click goes there. */
  head?: Head | undefined;
}

/** A time that moves [s], who wants to hear of it, and how to go to another. */
export interface Head {
  readonly time: number;
  readonly subscribe: (listener: () => void) => () => void;
  readonly seek: (time: number) => void;
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
  /** Puts the line of the playback where it belongs. */
  onDraw: () => void;
}

/** [px] Who moves the pointer farther between down and up has drawn a range, and not clicked. */
const CLICK = 4;

/** [s] Between two values of the legend while a playback goes on. */
const GRAIN = 0.1;

/** A line over the plot at the time of a playback, moved without drawing the chart again; a click goes there. */
function follow(chart: uPlot, head: Head, memory: Memory): () => void {
  const line = document.createElement("div");
  line.className = classes.head ?? "";
  chart.over.append(line);
  const put = () => {
    const left = chart.valToPos(head.time, "x");
    line.hidden = !(left >= 0 && left <= chart.over.clientWidth);
    line.style.transform = `translateX(${left}px)`;
  };
  memory.onDraw = put;
  put();
  let down = 0;
  const press = (event: MouseEvent) => {
    down = event.clientX;
  };
  const click = (event: MouseEvent) => {
    if (Math.abs(event.clientX - down) < CLICK)
      head.seek(chart.posToVal(event.clientX - chart.over.getBoundingClientRect().left, "x"));
  };
  chart.over.addEventListener("mousedown", press);
  chart.over.addEventListener("click", click);
  const unsubscribe = head.subscribe(put);
  return () => {
    unsubscribe();
    memory.onDraw = () => undefined;
    chart.over.removeEventListener("mousedown", press);
    chart.over.removeEventListener("click", click);
    line.remove();
  };
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
      draw: [() => memory.onDraw()],
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

const still = () => () => undefined;

/** The sample that is nearest to a time. */
function nearest(times: readonly number[], time: number): number | null {
  let low = 0;
  let high = times.length - 1;
  if (high < 0) return null;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if ((times[middle] as number) > time) high = middle;
    else low = middle;
  }
  return time - (times[low] as number) < (times[high] as number) - time ? low : high;
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
  const { lines, data, version, title, unit, height = 180, lead, head } = props;
  const dark = useComputedColorScheme("light") === "dark";
  const host = useRef<HTMLDivElement>(null);
  const chart = useRef<uPlot>(undefined);
  const [cursor, setCursor] = useState<number | null>(null);
  const memory = useRef<Memory>({ zoomed: false, onCursor: setCursor, onDraw: () => undefined });
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

  useEffect(
    () => (head && chart.current ? follow(chart.current, head, memory.current) : undefined),
    [head, shape],
  );

  // The columns grow in place, `version` tells when.
  useEffect(() => {
    // New samples must not throw away a zoom made by hand.
    chart.current?.setData(data as uPlot.AlignedData, !memory.current.zoomed);
    if (memory.current.zoomed) chart.current?.redraw(true);
  }, [data, version]);

  const played = useSyncExternalStore(head?.subscribe ?? still, () =>
    head ? Math.round(head.time / GRAIN) * GRAIN : null,
  );
  const index = cursor ?? (played === null ? newest(data) : nearest(data[0], played));
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
  value === null ? "–" : formatFixed(value, 2);

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
