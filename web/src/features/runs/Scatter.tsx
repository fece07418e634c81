/** Runs as points over each pair of axes; a rectangle that is drawn over them filters by both. */

import { useElementSize } from "@mantine/hooks";
import { type PointerEvent, useEffect, useRef, useState } from "react";
import { type Axis, placeOn, rangeAt } from "../../model/axes";
import type { ListedRun } from "../../model/run";
import { formatNumber, withUnit } from "../../model/units";
import { useDark } from "../../ui/dark";
import { inkOf } from "./ink";
import type { Drawn } from "./Space";
import classes from "./Space.module.css";

const SIZE = 128;
const PAD = 8;
/** [px] So near to a point one means it. */
const NEAR = 8;

export function Scatter(drawn: Drawn) {
  const { axes } = drawn;
  return (
    <div className={classes.matrix} role="region" aria-label="Pairs of axes" tabIndex={0} style={{ gridTemplateColumns: `90px repeat(${axes.length - 1}, minmax(90px, 1fr))` }}>
      {axes.slice(1).map((row) => (
        <Row key={row.column.id} row={row} {...drawn} />
      ))}
      <span />
      {axes.slice(0, -1).map((axis) => (
        <Ends key={axis.column.id} axis={axis} />
      ))}
    </div>
  );
}

/** Below the diagonal every pair stands once. */
function Row({ row, axes, ...drawn }: Drawn & { row: Axis }) {
  const at = axes.indexOf(row);
  return (
    <>
      <Ends axis={row} />
      {axes.slice(0, -1).map((column, index) =>
        index < at ? <Cell key={column.column.id} across={column} up={row} axes={axes} {...drawn} /> : <span key={column.column.id} />,
      )}
    </>
  );
}

/** What an axis is of, and from where to where it goes. */
function Ends({ axis: { column, low, high } }: { axis: Axis }) {
  return (
    <span className={classes.ends} title={column.name}>
      <b>{withUnit(column.title, column.unit)}</b>
      {formatNumber(low)} to {formatNumber(high)}
    </span>
  );
}

interface CellProps extends Drawn {
  across: Axis;
  up: Axis;
}

interface Box {
  from: readonly [number, number];
  to: readonly [number, number];
}

function Cell({ across, up, runs, shown, onRange, onHover }: CellProps) {
  const { ref, width } = useElementSize();
  const canvas = useRef<HTMLCanvasElement>(null);
  const dark = useDark();
  const [box, setBox] = useState<Box>();
  const place = (run: ListedRun): readonly [number, number] | undefined => {
    const [right, top] = [placeOn(across, run), placeOn(up, run)];
    return right === undefined || top === undefined ? undefined : [PAD + right * (width - 2 * PAD), SIZE - PAD - top * (SIZE - 2 * PAD)];
  };
  useEffect(() => {
    if (canvas.current && width > 0) drawPoints(canvas.current, width, runs, shown, place, dark);
  }, [width, across, up, runs, shown, dark]);
  const at = (event: PointerEvent<HTMLElement>): readonly [number, number] => {
    const { left, top } = event.currentTarget.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  };
  const release = () => {
    if (!box) return;
    setBox(undefined);
    const wide = Math.abs(box.to[0] - box.from[0]) > 3 || Math.abs(box.to[1] - box.from[1]) > 3;
    const range = (axis: Axis, places: readonly number[]) =>
      rangeAt(axis, places);
    const ends = [box.from, box.to];
    onRange([
      [across, wide ? range(across, ends.map(([x]) => (x - PAD) / (width - 2 * PAD))) : undefined],
      [up, wide ? range(up, ends.map(([, y]) => (SIZE - PAD - y) / (SIZE - 2 * PAD))) : undefined],
    ]);
  };
  const near = (point: readonly [number, number]) =>
    runs.find((run) => {
      const own = shown.has(run.run) ? place(run) : undefined;
      return own && Math.hypot(own[0] - point[0], own[1] - point[1]) < NEAR;
    });
  return (
    <div
      ref={ref}
      className={classes.cell}
      style={{ height: SIZE }}
      role="img"
      aria-label={`${up.column.title} over ${across.column.title}`}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        setBox({ from: at(event), to: at(event) });
      }}
      onPointerMove={(event) => (box ? setBox({ ...box, to: at(event) }) : onHover(near(at(event))?.run))}
      onPointerUp={release}
      onPointerCancel={() => setBox(undefined)}
      onPointerLeave={() => onHover(undefined)}
    >
      <canvas ref={canvas} className={classes.lines} />
      {box ? <span className={classes.box} style={styleOf(box)} /> : null}
    </div>
  );
}

const styleOf = ({ from, to }: Box) => ({
  left: Math.min(from[0], to[0]),
  top: Math.min(from[1], to[1]),
  width: Math.abs(to[0] - from[0]),
  height: Math.abs(to[1] - from[1]),
});

function drawPoints(canvas: HTMLCanvasElement, width: number, runs: readonly ListedRun[], shown: ReadonlySet<number>, place: (run: ListedRun) => readonly [number, number] | undefined, dark: boolean) {
  const scale = window.devicePixelRatio || 1;
  canvas.width = width * scale;
  canvas.height = SIZE * scale;
  const context = canvas.getContext("2d");
  if (!context) return;
  context.scale(scale, scale);
  for (const isShown of [false, true])
    for (const run of runs) {
      const at = shown.has(run.run) === isShown ? place(run) : undefined;
      if (!at) continue;
      context.fillStyle = inkOf(run, isShown, dark);
      context.beginPath();
      context.arc(at[0], at[1], 3.2, 0, 2 * Math.PI);
      context.fill();
    }
}
