/** One quantity over another: a curve for each car, and where it is at the time of the playback. */

import { Text } from "@mantine/core";
import { type ReactNode, useMemo, useSyncExternalStore } from "react";
import { pairsOf, partOf } from "../model/sampled";
import { formatNumber } from "../model/units";
import { AsTable } from "./Sheet";
import { Stroke } from "./Stroke";
import type { Head } from "./TimeChart";
import classes from "./TimeChart.module.css";

export interface Curve {
  key: string;
  label: string;
  color: string;
  time: readonly number[];
  x: readonly (number | null | undefined)[];
  y: readonly (number | null | undefined)[];
}

interface Props {
  x: string;
  y: string;
  curves: readonly Curve[];
  /** What the curves cover is told anew when this changes. */
  version?: number;
  lead?: ReactNode;
  head?: Head | undefined;
}

const WIDTH = 600;
const HEIGHT = 260;
const LEFT = 56;
const BOTTOM = 34;
const TOP = 8;
const RIGHT = 12;

export interface Range {
  low: number;
  high: number;
}

/** From the least to the greatest value, with a little air; never without height. */
export function rangeOf(values: Iterable<number | null | undefined>): Range {
  let [low, high] = [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY];
  for (const value of values) {
    if (typeof value !== "number") continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) return { low: 0, high: 1 };
  const air = Math.max(0.05 * (high - low), 0.02 * Math.abs(high), 0.05);
  return { low: low - air, high: high + air };
}

/** Round values within a range: 1, 2 or 5 times a power of ten apart, about so many. */
export function ticksOf({ low, high }: Range, about = 5): number[] {
  const rough = (high - low) / about;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5, 10].find((each) => each * power >= rough) ?? 10);
  const found: number[] = [];
  for (let i = Math.ceil(low / step); i * step <= high; i += 1) found.push(Number((i * step).toPrecision(12)));
  return found;
}

export function XYChart({ x, y, curves, version, lead, head }: Props) {
  const [across, up] = useMemo(
    () => [rangeOf(curves.flatMap((curve) => curve.x as number[])), rangeOf(curves.flatMap((curve) => curve.y as number[]))],
    [curves, version],
  );
  const px = (value: number) => LEFT + ((value - across.low) / (across.high - across.low)) * (WIDTH - LEFT - RIGHT);
  const py = (value: number) => HEIGHT - BOTTOM - ((value - up.low) / (up.high - up.low)) * (HEIGHT - BOTTOM - TOP);
  const time = useSyncExternalStore(head?.subscribe ?? still, () => (head ? Math.round(head.time / GRAIN) * GRAIN : null));
  return (
    <figure className={classes.figure} aria-label={`${y} over ${x}`}>
      <figcaption className={classes.legend}>
        {lead}
        {curves.map(({ key, label, color }) => (
          <span key={key} className={classes.item}>
            <Stroke color={color} /> {label}
          </span>
        ))}
        <AsTable sheet={() => sheetOf(x, y, curves)} />
      </figcaption>
      {curves.some(hasPoints) ? null : (
        <Text size="xs" c="dimmed">
          No car has values of both quantities here.
        </Text>
      )}
      <svg className={classes.xy} viewBox={`0 0 ${WIDTH} ${HEIGHT}`} role="img" aria-label={`${curves.length} curves`}>
        {ticksOf(across).map((tick) => (
          <g key={tick}>
            <line x1={px(tick)} x2={px(tick)} y1={TOP} y2={HEIGHT - BOTTOM} className={classes.grid} />
            <text x={px(tick)} y={HEIGHT - BOTTOM + 14} textAnchor="middle">
              {formatNumber(tick)}
            </text>
          </g>
        ))}
        {ticksOf(up).map((tick) => (
          <g key={tick}>
            <line x1={LEFT} x2={WIDTH - RIGHT} y1={py(tick)} y2={py(tick)} className={classes.grid} />
            <text x={LEFT - 6} y={py(tick) + 4} textAnchor="end">
              {formatNumber(tick)}
            </text>
          </g>
        ))}
        <text x={(LEFT + WIDTH) / 2} y={HEIGHT - 4} textAnchor="middle">
          {x}
        </text>
        <text transform={`translate(11 ${(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)`} textAnchor="middle">
          {y}
        </text>
        {curves.map((curve) => (
          <path key={curve.key} d={pathOf(curve, px, py)} fill="none" stroke={curve.color} strokeWidth={1.5} />
        ))}
        {time === null ? null : curves.map((curve) => <Now key={curve.key} curve={curve} time={time} px={px} py={py} />)}
      </svg>
    </figure>
  );
}

function sheetOf(x: string, y: string, curves: readonly Curve[]) {
  const { rows, of } = pairsOf(curves);
  return { title: `${y} over ${x}`, note: partOf(rows.length, of, "samples"), heads: ["Curve", "Time [s]", x, y], rows };
}

/** Whether there is anything to draw of a curve. */
const hasPoints = ({ x, y }: Curve): boolean => x.some((value, i) => typeof value === "number" && typeof y[i] === "number");

const still = () => () => undefined;
/** [s] Not every picture of a playback is worth a rendering. */
const GRAIN = 0.05;

type Scale = (value: number) => number;

/** A line through all points; one that is missing makes a gap. */
export function pathOf({ x, y }: Pick<Curve, "x" | "y">, px: Scale, py: Scale): string {
  let up = true;
  const parts: string[] = [];
  for (let i = 0; i < x.length; i += 1) {
    const [across, along] = [x[i], y[i]];
    if (typeof across !== "number" || typeof along !== "number") {
      up = true;
      continue;
    }
    parts.push(`${up ? "M" : "L"}${px(across).toFixed(1)} ${py(along).toFixed(1)}`);
    up = false;
  }
  return parts.join("");
}

function Now({ curve, time, px, py }: { curve: Curve; time: number; px: Scale; py: Scale }) {
  const after = curve.time.findIndex((each) => each >= time);
  const at = after < 0 ? curve.time.length - 1 : after;
  const [x, y] = [curve.x[at], curve.y[at]];
  if (typeof x !== "number" || typeof y !== "number") return null;
  return <circle cx={px(x)} cy={py(y)} r={5} fill={curve.color} className={classes.now} />;
}
