/** The border between the scene and the charts: dragged, or moved with the arrow keys, and remembered. */

import { useLocalStorage } from "@mantine/hooks";
import { type CSSProperties, type KeyboardEvent, type PointerEvent, useMemo } from "react";
import classes from "./Studio.module.css";

/** [px] Neither side vanishes. */
const LEAST = 120;
const USUAL = 270;
const STEP = 24;

interface Bottom {
  height: number;
  onHeight: (height: number) => void;
  style: CSSProperties | undefined;
}

/** The height of the charts [px], as somebody has left it. */
export function useBottom(): Bottom {
  const [kept, keep] = useLocalStorage<number | null>({ key: "height of the charts", defaultValue: null, getInitialValueInEffect: false });
  const style = useMemo(() => (kept === null ? undefined : ({ "--bottom": `${kept}px` }) as CSSProperties), [kept]);
  return { height: kept ?? USUAL, onHeight: (height) => keep(Math.round(Math.max(LEAST, height))), style };
}

export function Splitter({ height, onHeight }: Bottom) {
  const drag = (event: PointerEvent<HTMLDivElement>) => {
    if (!event.currentTarget.hasPointerCapture(event.pointerId)) return;
    const { bottom, top } = (event.currentTarget.parentElement as HTMLElement).getBoundingClientRect();
    onHeight(Math.min(bottom - event.clientY, bottom - top - 2 * LEAST));
  };
  const key = (event: KeyboardEvent) => {
    const way = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!way) return;
    event.preventDefault();
    onHeight(height + way * STEP);
  };
  return (
    <div
      className={classes.splitter}
      role="separator"
      aria-orientation="horizontal"
      aria-label="Height of the charts"
      aria-valuenow={height}
      tabIndex={0}
      onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)}
      onPointerMove={drag}
      onKeyDown={key}
      onDoubleClick={() => onHeight(USUAL)}
    />
  );
}
