/** A piece of a chart's line, as it stands in legends. */

interface Props {
  color: string;
  /** [px] Stroke and gap in turn. */
  dash?: readonly number[] | undefined;
  width?: number;
}

export function Stroke({ color, dash, width = 16 }: Props) {
  return (
    <svg width={width} height="8" aria-hidden="true">
      <line x1="0" y1="4" x2={width} y2="4" stroke={color} strokeWidth="2.5" strokeDasharray={dash?.join(" ")} />
    </svg>
  );
}
