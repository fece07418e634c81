/** One line a run over parallel axes. Lines are on a canvas, since there may be ten thousand; axes and what is hovered over it. */

import { useElementSize } from "@mantine/hooks";
import { type KeyboardEvent, type PointerEvent, useEffect, useRef, useState } from "react";
import { type Axis, canBeLog, changed, placeOn, type Range, rangeAt, rangeOf, reordered } from "../../model/axes";
import type { ListedRun } from "../../model/run";
import { formatNumber, formatValue, withUnit } from "../../model/units";
import { useDark } from "../../ui/dark";
import { inkOf } from "./ink";
import type { Drawn } from "./Space";
import classes from "./Space.module.css";

const HEIGHT = 250;
const [TOP, BOTTOM, SIDE] = [34, 34, 70];
/** Where a run is that has no value there: below the axis. */
const NONE = HEIGHT - 10;
/** [px] So near to a line one means it, and so near to an axis. */
const NEAR = 8;
const GRIP = 14;

interface Stroke {
  axis: number;
  from: number;
  to: number;
}

interface Props extends Drawn {
  /** The axes stand otherwise. */
  onAxes: (axes: readonly Axis[]) => void;
}

export function Parallel({ axes, runs, shown, bounds, onRange, onHover, onAxes }: Props) {
  const { ref, width } = useElementSize();
  const canvas = useRef<HTMLCanvasElement>(null);
  const dark = useDark();
  const [hovered, setHovered] = useState<ListedRun>();
  const [stroke, setStroke] = useState<Stroke>();
  const x = (index: number) => SIDE + (axes.length < 2 ? 0 : (index * (width - 2 * SIDE)) / (axes.length - 1));
  const titled = width > 0 ? axes : []; // before it is known how wide this is, all titles would lie on one another
  useEffect(() => {
    if (canvas.current && width > 0) drawLines(canvas.current, width, axes, runs, shown, x, dark);
  }, [width, axes, runs, shown, dark]);

  const hover = (run: ListedRun | undefined) => {
    setHovered(run);
    onHover(run?.run);
  };
  const move = (event: PointerEvent<SVGSVGElement>) => {
    const { left, top } = event.currentTarget.getBoundingClientRect();
    const at = { x: event.clientX - left, y: event.clientY - top };
    if (stroke) setStroke({ ...stroke, to: placeAt(at.y) });
    else hover(nearest(at, axes, runs, shown, x));
  };
  const press = (event: PointerEvent<SVGSVGElement>) => {
    const { left, top } = event.currentTarget.getBoundingClientRect();
    const axis = axes.findIndex((_, index) => Math.abs(event.clientX - left - x(index)) < GRIP);
    if (axis < 0 || event.button !== 0) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    const from = placeAt(event.clientY - top);
    setStroke({ axis, from, to: from });
  };
  const release = () => {
    if (!stroke) return;
    const axis = axes[stroke.axis] as Axis;
    const ends = rangeAt(axis, [stroke.from, stroke.to]);
    const isClick = Math.abs(stroke.to - stroke.from) * (HEIGHT - TOP - BOTTOM) < 4;
    onRange([[axis, isClick ? undefined : (ends)]]);
    setStroke(undefined);
  };
  return (
    <div ref={ref} className={classes.parallel} style={{ height: HEIGHT }}>
      <canvas ref={canvas} className={classes.lines} />
      <svg
        width={width}
        height={HEIGHT}
        role="img"
        aria-label={`Parallel axes: ${axes.map(({ column }) => column.title).join(", ")}`}
        onPointerMove={move}
        onPointerDown={press}
        onPointerUp={release}
        onPointerCancel={() => setStroke(undefined)}
        onPointerLeave={() => hover(undefined)}
        onKeyDown={(event) => event.key === "Escape" && setStroke(undefined)}
      >
        {axes.map((axis, index) => (
          <AxisLine
            key={axis.column.id}
            axis={axis}
            x={x(index)}
            range={stroke?.axis === index ? sorted(stroke) : rangeOf(axis, bounds)}
          />
        ))}
        {hovered ? <polyline points={points(hovered, axes, x)} className={classes.hovered} /> : null}
      </svg>
      {titled.map((axis, index) => (
        <AxisTitle
          key={axis.column.id}
          axis={axis}
          x={x(index)}
          room={axes.length < 2 ? width : x(1) - x(0) - 12}
          onMove={(by) => onAxes(reordered(axes, index, index + by))}
          onDrop={(px) => onAxes(reordered(axes, index, axes.length < 2 ? 0 : Math.round((x(index) + px - SIDE) / (x(1) - x(0)))))}
          onChange={(change) => onAxes(changed(axes, index, change))}
        />
      ))}
      {hovered ? <Told run={hovered} axes={axes} /> : null}
    </div>
  );
}

const sorted = ({ from, to }: Stroke): Range => [Math.min(from, to), Math.max(from, to)];
const y = (place: number | undefined) => (place === undefined ? NONE : HEIGHT - BOTTOM - place * (HEIGHT - TOP - BOTTOM));
const placeAt = (at: number) => Math.min(1, Math.max(0, (HEIGHT - BOTTOM - at) / (HEIGHT - TOP - BOTTOM)));

interface AxisProps {
  axis: Axis;
  x: number;
  range: Range | undefined;
}

/** The axis' own ends, the range that is kept, and the place of runs that have no value. */
function AxisLine({ axis, x, range }: AxisProps) {
  const { column, low, high } = axis;
  return (
    <g className={classes.axis} data-axis={column.id}>
      <title>{`${column.name}: drag along the axis to keep a range, click to let all through`}</title>
      <rect x={x - GRIP} y={TOP} width={2 * GRIP} height={HEIGHT - TOP - BOTTOM} className={classes.grip} />
      <line x1={x} x2={x} y1={TOP} y2={HEIGHT - BOTTOM} />
      <text x={x} y={TOP - 6}>
        {formatNumber(axis.isFlipped ? low : high)}
      </text>
      <text x={x} y={HEIGHT - BOTTOM + 13}>
        {formatNumber(axis.isFlipped ? high : low)}
      </text>
      {range ? (
        <rect x={x - 6} width={12} y={y(range[1])} height={Math.max(3, y(range[0]) - y(range[1]))} className={classes.range} />
      ) : null}
    </g>
  );
}

interface TitleProps {
  axis: Axis;
  x: number;
  /** [px] For what is written. */
  room: number;
  /** By so many places. */
  onMove: (by: number) => void;
  /** It was dragged by so many pixels. */
  onDrop: (px: number) => void;
  onChange: (change: Partial<Axis>) => void;
}

/** The title of an axis, by which it is taken: dragged, or by keys. */
function AxisTitle({ axis, x, room, onMove, onDrop, onChange }: TitleProps) {
  const { column, isFlipped = false, isLog = false } = axis;
  const from = useRef<number>(undefined);
  const name = withUnit(column.title, column.unit);
  const how = [isFlipped ? "flipped" : "", isLog ? "logarithmic" : ""].filter(Boolean).join(", ");
  const acts: Record<string, () => void> = {
    ArrowLeft: () => onMove(-1),
    ArrowRight: () => onMove(1),
    f: () => onChange({ isFlipped: !isFlipped }),
    l: () => canBeLog(axis) && onChange({ isLog: !isLog }),
  };
  const press = (event: KeyboardEvent) => {
    const act = event.ctrlKey || event.metaKey || event.altKey ? undefined : acts[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    event.preventDefault();
    event.stopPropagation();
    act();
  };
  return (
    <button
      type="button"
      className={classes.title}
      style={{ left: Math.max(x, SIDE - 8), maxWidth: Math.max(room, 2 * SIDE - 16) }}
      aria-label={`Axis ${name}${how ? `, ${how}` : ""}`}
      aria-keyshortcuts="ArrowLeft ArrowRight F L"
      title={`${name}: drag or arrow keys move it, F flips it${canBeLog(axis) ? ", L makes it logarithmic" : ""}`}
      onKeyDown={press}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        from.current = event.clientX;
      }}
      onPointerUp={(event) => {
        if (from.current !== undefined && Math.abs(event.clientX - from.current) > NEAR) onDrop(event.clientX - from.current);
        from.current = undefined;
      }}
    >
      <span aria-hidden>{`${isFlipped ? "↓ " : ""}${isLog ? "log " : ""}`}</span>
      {name}
    </button>
  );
}

const points = (run: ListedRun, axes: readonly Axis[], x: (index: number) => number) =>
  axes.map((axis, index) => `${x(index)},${y(placeOn(axis, run))}`).join(" ");

/** Which run is meant: that whose value on the nearest axis is nearest, of those that are shown. */
function nearest(at: { x: number; y: number }, axes: readonly Axis[], runs: readonly ListedRun[], shown: ReadonlySet<number>, x: (index: number) => number) {
  let found: ListedRun | undefined;
  let least = NEAR;
  for (const run of runs) {
    if (!shown.has(run.run)) continue;
    for (let index = 0; index + 1 < axes.length; index += 1) {
      const [left, right] = [x(index), x(index + 1)];
      if (at.x < left || at.x > right) continue;
      const [from, to] = [y(placeOn(axes[index] as Axis, run)), y(placeOn(axes[index + 1] as Axis, run))];
      const off = Math.abs(from + ((to - from) * (at.x - left)) / (right - left) - at.y);
      if (off < least) [found, least] = [run, off];
    }
  }
  return found;
}

/** The values of the run under the pointer. */
function Told({ run, axes }: { run: ListedRun; axes: readonly Axis[] }) {
  return (
    <div className={classes.told} role="status">
      <b>#{run.run}</b> {run.name}{" "}
      {axes.map(({ column }) => `${column.title} ${formatValue(column.value(run))}`).join(", ")}
    </div>
  );
}

/** Those that are filtered out first, and pale. */
function drawLines(canvas: HTMLCanvasElement, width: number, axes: readonly Axis[], runs: readonly ListedRun[], shown: ReadonlySet<number>, x: (index: number) => number, dark: boolean) {
  const scale = window.devicePixelRatio || 1;
  canvas.width = width * scale;
  canvas.height = HEIGHT * scale;
  const context = canvas.getContext("2d");
  if (!context) return;
  context.scale(scale, scale);
  context.lineWidth = 1.3;
  for (const isShown of [false, true])
    for (const run of runs) {
      if (shown.has(run.run) !== isShown) continue;
      context.strokeStyle = inkOf(run, isShown, dark);
      context.beginPath();
      for (const [index, axis] of axes.entries()) context.lineTo(x(index), y(placeOn(axis, run)));
      context.stroke();
    }
}
