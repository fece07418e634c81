/** One quantity over time: a uPlot chart with our own compact legend. */

import { useComputedColorScheme } from "@mantine/core";
import { type ReactNode, useEffect, useMemo, useRef, useState, useSyncExternalStore } from "react";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Beyond } from "../model/beyond";
import { formatFixed, formatNumber, formatTime, unitText, withUnit, words } from "../model/units";
import { type Limits, limitsOf } from "./limits";
import { DataTable } from "./DataTable";
import { Stroke } from "./Stroke";
import classes from "./TimeChart.module.css";
import { touched } from "./touch";
import type { Span, Zoom } from "./zoom";

export interface Line {
  key: string;
  label: string;
  color: string;
  /** [px] Stroke and gap in turn; solid without. */
  dash?: readonly number[];
  /** On the second axis, at the right. */
  right?: boolean;
}

/** Values below `least`, or above `most`, are not wanted. */
export interface Shade {
  metric: string;
  least?: number;
  most?: number;
}

export type Columns = [number[], ...(number | null | undefined)[][]];

interface Props {
  title: string;
  unit: string;
  lines: readonly Line[];
  data: Columns;
  /** Changes whenever `data` has grown in place. */
  version?: number;
  /** Charts with the same key share their cursor. */
  sync?: string;
  /** The stretch of time that is shown, which a drag over the plot chooses. */
  zoom: Zoom;
  /** The time axis reaches at least this far [s]. */
  duration?: number;
  height?: number;
  /** Stands in front of the legend, for instance the choice of the quantity. */
  lead?: ReactNode;
  /** The unit of the second axis. */
  rightUnit?: string | undefined;
  /** Where goals are missed: the ground is red there. */
  shades?: readonly Shade[];
  /** When a vehicle was outside the span that it was validated for. */
  beyond?: Beyond | undefined;
  /** The time of a playback: a line stands there, and a click goes there. */
  head?: Head | undefined;
}

/** A time that moves [s], who wants to hear of it, and how to go to another. */
export interface Head {
  readonly time: number;
  readonly playing: boolean;
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

function series({ label, color, dash, right }: Line): uPlot.Series {
  return {
    label,
    scale: right ? RIGHT : "y",
    stroke: color,
    width: dash ? 1.5 : 1.75,
    ...(dash ? { dash: [...dash] } : {}),
    points: { show: false },
    spanGaps: false,
  };
}

const RIGHT = "right";

/** The ground is red where a goal is missed, and the edge of that is a line. */
function shade(chart: uPlot, shades: readonly Shade[]): void {
  const { ctx, bbox } = chart;
  const edge = (value: number) => Math.min(Math.max(chart.valToPos(value, "y", true), bbox.top), bbox.top + bbox.height);
  ctx.save();
  ctx.fillStyle = MISSED;
  for (const { least, most } of shades) {
    if (least !== undefined) ctx.fillRect(bbox.left, edge(least), bbox.width, bbox.top + bbox.height - edge(least));
    if (most !== undefined) ctx.fillRect(bbox.left, bbox.top, bbox.width, edge(most) - bbox.top);
  }
  ctx.restore();
}

const MISSED = "rgba(224, 49, 49, 0.13)";

/** A band over the times at which a vehicle was outside its span, with a bar above it, so that the colour is not all that tells. */
function band(chart: uPlot, beyond: Beyond | undefined): void {
  const { ctx, bbox } = chart;
  const edge = (time: number) => Math.min(Math.max(chart.valToPos(time, "x", true), bbox.left), bbox.left + bbox.width);
  ctx.save();
  for (const [begin, end] of beyond?.parts ?? []) {
    const [from, to] = [edge(begin), edge(end)];
    if (to <= bbox.left || from >= bbox.left + bbox.width) continue;
    const width = Math.max(to - from, uPlot.pxRatio);
    ctx.fillStyle = BEYOND_GROUND;
    ctx.fillRect(from, bbox.top, width, bbox.height);
    ctx.fillStyle = BEYOND_BAR;
    ctx.fillRect(from, bbox.top, width, 3 * uPlot.pxRatio);
  }
  ctx.restore();
}

const BEYOND_GROUND = "rgba(174, 62, 201, 0.12)";
const BEYOND_BAR = "#ae3ec9";

/** In a low chart the unit stands at the ticks, which saves the line of the label. */
const withSecond = (_chart: uPlot, ticks: number[]): string[] => ticks.map((tick) => `${tick} s`);

/** [px] Of the label's mean letter, and of what is no plot above and below it. */
const LETTER = 6.3;
const AROUND = 32;

/** The label of an axis: with its unit alone where the chart is too low for all of it, for the quantity is named above. */
const fitting = (chart: uPlot, title: string, unit: string): string =>
  LETTER * withUnit(title, unit).length < chart.height - AROUND ? withUnit(title, unit) : `[${unitText(unit) || "1"}]`;

/** Below this height [px] a chart is low. */
const LOW = 120;

/** What the chart tells and remembers outside of React's rendering. */
interface Memory {
  span: Span | undefined;
  limits: Limits | undefined;
  beyond: Beyond | undefined;
  onCursor: (time: number | null) => void;
  onSpan: (span: Span | undefined) => void;
  /** Puts the line of the playback where it belongs. */
  onDraw: () => void;
}

/** [px] Who moves the pointer farther between down and up has drawn a range, and not clicked. */
const CLICK = 4;

/** [s] Between two values of the legend while a playback goes on, and while it stands. */
const GRAIN = { playing: 0.1, standing: 0.001 };

/** The time of a playback for the legend: not every picture is worth a rendering. */
function shownTime({ time, playing }: Head): number {
  const grain = playing ? GRAIN.playing : GRAIN.standing;
  return Math.round(time / grain) * grain;
}

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
  { title, unit, lines, duration = 0, sync, rightUnit, shades = [] }: Props,
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
      drag: { x: true, y: false, setScale: false },
      points: { size: 6 },
      bind: {
        dblclick: () => () => {
          memory.onSpan(undefined);
          return null;
        },
      },
    },
    scales: {
      x: {
        time: false,
        range: (_u, _low, high) => (memory.span ? [...memory.span] : [0, Math.max(duration, high ?? 0, 1)]),
      },
      y: { range: () => padded(memory.limits) },
      ...(rightUnit === undefined ? {} : { [RIGHT]: { range: (_u: uPlot, low: number, high: number) => padded(limitsFrom(low, high)) } }),
    },
    axes: [
      { ...axis, size: 24, space: 60, ...(low ? { values: withSecond } : { label: "Time [s]" }) },
      { ...axis, size: AXIS_WIDTH - 16, label: (chart: uPlot) => fitting(chart, title, unit), space: 28 },
      ...(rightUnit === undefined
        ? []
        : [{ ...axis, scale: RIGHT, side: 1 as const, size: AXIS_WIDTH - 16, label: `[${unitText(rightUnit) || "1"}]`, grid: { show: false } }]),
    ],
    series: [{ label: "Time" }, ...lines.map(series)],
    hooks: {
      drawClear: [(chart) => shade(chart, shades), (chart) => band(chart, memory.beyond)],
      draw: [() => memory.onDraw()],
      setCursor: [(chart) => memory.onCursor(pointedAt(chart))],
      setSelect: [
        (chart) => {
          const { left, width } = chart.select;
          if (width > 0) memory.onSpan([chart.posToVal(left, "x"), chart.posToVal(left + width, "x")]);
          chart.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
        },
      ],
    },
  };
}

/** The time under the pointer, the same in all charts whose cursors go together. */
function pointedAt(chart: uPlot): number | null {
  const { left = -1 } = chart.cursor;
  return left < 0 ? null : chart.posToVal(left, "x");
}

const limitsFrom = (low: number | null, high: number | null): Limits | undefined =>
  low === null || high === null ? undefined : { low, high };

/** A little air above and below, and never a range without height. */
function padded(limits: Limits | undefined): [number, number] {
  if (!limits) return [0, 1];
  const { low, high } = limits;
  const air = Math.max((high - low) * 0.08, Math.abs(high) * 0.02, 0.05);
  return [low >= 0 ? Math.max(-air / 3, low - air) : low - air, high + air];
}

/** The newest sample that any line has. */
function newest(data: Columns): number | null {
  return data[0].length > 0 ? data[0].length - 1 : null;
}

const still = () => () => undefined;

/** [s] Who is farther from the first and the last sample than this is beyond them. */
const BEYOND = 0.1;

/** The sample that is nearest to a time; none of a time beyond all samples. */
function nearest(times: readonly number[], time: number): number | null {
  let low = 0;
  let high = times.length - 1;
  if (high < 0 || time < (times[0] as number) - BEYOND || time > (times[high] as number) + BEYOND) return null;
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

/** The columns of the first axis; the very same when there is no other. */
function leftOf(data: Columns, lines: readonly Line[]): Columns {
  if (!lines.some(({ right }) => right)) return data;
  return [data[0], ...data.slice(1).filter((_, place) => !lines[place]?.right)] as Columns;
}

export function TimeChart(props: Props) {
  const { lines, data, version, title, unit, height = 180, lead, head, zoom, beyond } = props;
  const dark = useComputedColorScheme("light") === "dark";
  const host = useRef<HTMLDivElement>(null);
  const chart = useRef<uPlot>(undefined);
  const [cursor, setCursor] = useState<number | null>(null);
  const [table, setTable] = useState(false);
  const left = useMemo(() => leftOf(data, lines), [data, lines, version]);
  const [limits, outside, toggle] = useLimits(title, left, version, zoom.span);
  const memory = useRef<Memory>({
    span: zoom.span,
    limits,
    beyond,
    onCursor: setCursor,
    onSpan: zoom.choose,
    onDraw: () => undefined,
  });
  Object.assign(memory.current, { span: zoom.span, limits, beyond, onSpan: zoom.choose });
  const shape = JSON.stringify([lines, title, unit, props.sync, props.duration, dark, props.rightUnit, props.shades]);

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
    const whole = () => Math.max(props.duration ?? 0, made.data[0].at(-1) ?? 0, 1);
    const untouched = touched(made, () => memory.current.span, whole, (span) => memory.current.onSpan(span));
    return () => {
      untouched();
      observer.disconnect();
      made.destroy();
    };
  }, [shape]);

  useEffect(
    () => (head && chart.current ? follow(chart.current, head, memory.current) : undefined),
    [head, shape],
  );

  // The columns grow in place, `version` tells when; the scales are asked for their ranges again.
  useEffect(() => chart.current?.setData(data as uPlot.AlignedData), [data, version, zoom.span, limits]);

  useEffect(() => chart.current?.redraw(false), [beyond]);

  const played = useSyncExternalStore(head?.subscribe ?? still, () =>
    head ? shownTime(head) : null,
  );
  const wanted = cursor ?? played;
  const index = wanted === null ? newest(data) : nearest(data[0], wanted);
  const time = wanted ?? (index === null ? undefined : data[0][index]);
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
                <Stroke color={line.color} dash={line.dash} />
                <b className={classes.value}>{shown(valueAt(data[place + 1], index))}</b>
              </span>
            ))}
          </span>
        ))}
        {(props.shades ?? []).map((each) => (
          <span key={each.metric} className={classes.item} title="The ground is red where this goal is missed">
            goal {words(each.metric)} {[each.least === undefined ? "" : `≥ ${formatNumber(each.least)}`, each.most === undefined ? "" : `≤ ${formatNumber(each.most)}`].filter(Boolean).join(", ")}
          </span>
        ))}
        {beyond ? <Legend beyond={beyond} /> : null}
        <Outside limits={outside} whole={limits !== outside} onToggle={toggle} />
        <button type="button" className={classes.action} onClick={() => setTable(true)}>
          As table
        </button>
        {zoom.span ? (
          <button type="button" className={classes.action} onClick={() => zoom.choose(undefined)}>
            Show all of it
          </button>
        ) : null}
      </figcaption>
      {table ? (
        <DataTable title={title} unit={unit} rightUnit={props.rightUnit} lines={lines} data={data} span={zoom.span} onClose={() => setTable(false)} />
      ) : null}
      <div ref={host} className={classes.plot} style={{ minHeight: height }} />
    </figure>
  );
}

/** What the band means, and the worst of it. */
function Legend({ beyond }: { beyond: Beyond }) {
  return (
    <span className={`${classes.item} ${classes.wraps}`} title={beyond.all}>
      <svg width={14} height={10} className={classes.swatch} aria-hidden="true">
        <rect width={14} height={10} fill={BEYOND_GROUND} />
        <rect width={14} height={3} fill={BEYOND_BAR} />
      </svg>
      outside its validated span: {beyond.worst}
    </span>
  );
}

/** The limits that are drawn, those without needles, and how to choose between these and all that there is; of another quantity anew. */
function useLimits(title: string, data: Columns, version: number | undefined, span: Span | undefined) {
  const [wholeOf, setWholeOf] = useState<string>();
  const robust = useMemo(() => limitsOf(data, span), [data, version, span]);
  const whole = useMemo(() => robust && { low: robust.below ?? robust.low, high: robust.above ?? robust.high }, [robust]);
  const isWhole = wholeOf === title;
  return [isWhole ? whole : robust, robust, () => setWholeOf(isWhole ? undefined : title)] as const;
}

/** What lies beyond the axis is told, and seen when it is asked for. */
function Outside({ limits, whole, onToggle }: { limits: Limits | undefined; whole: boolean; onToggle: () => void }) {
  const { below, above } = limits ?? {};
  if (below === undefined && above === undefined) return null;
  const told = [above === undefined ? "" : `▲ up to ${formatNumber(above)}`, below === undefined ? "" : `▼ down to ${formatNumber(below)}`];
  return (
    <button
      type="button"
      className={classes.action}
      aria-pressed={whole}
      title={whole ? "The axis reaches to the outermost values" : "Short peaks lie beyond the axis: show them"}
      onClick={onToggle}
    >
      {told.filter(Boolean).join(", ")} {whole ? "inside" : "outside"}
    </button>
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
