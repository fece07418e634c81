/** A mark as it is on the plan. */

import { MARK_COLOURS, SHAPES, SIGNS } from "../../charts/marks";
import type { Mark } from "../../model/finding";

/** With a title it speaks for itself; without one, the text beside it does. */
export function MarkIcon({ mark, title = "", size = 15 }: { mark: Mark; title?: string; size?: number }) {
  return (
    <svg
      width={size}
      height={size}
      viewBox="-9 -9 18 18"
      strokeLinejoin="round"
      {...(title ? { role: "img", "aria-label": title } : { "aria-hidden": true })}
    >
      <path d={SHAPES[mark]} fill={MARK_COLOURS[mark]} stroke="#fff" strokeWidth="1.5" />
      {SIGNS[mark] ? <path d={SIGNS[mark]} fill="none" stroke="#fff" strokeWidth="1.8" strokeLinecap="round" /> : null}
    </svg>
  );
}
