/** A chart over time as a table: a row for each sample that is taken. */

import { tableOf } from "../model/sampled";
import { formatTime, unitText, withUnit } from "../model/units";
import { Sheet } from "./Sheet";
import type { Columns, Line } from "./TimeChart";
import type { Span } from "./zoom";

interface Props {
  title: string;
  unit: string;
  rightUnit: string | undefined;
  lines: readonly Line[];
  data: Columns;
  span: Span | undefined;
  onClose: () => void;
}

export function DataTable({ title, unit, rightUnit, lines, data, span, onClose }: Props) {
  const { rows, of } = tableOf(data, span);
  const some = rows.length === of ? `The ${of} points that the chart has` : `${rows.length} of the ${of} points that the chart has; a shorter stretch has more of its own, a file under Export all of them`;
  const heads = lines.map(({ label, right }) => `${label} [${unitText(right ? (rightUnit ?? "") : unit) || "1"}]`);
  return (
    <Sheet
      title={withUnit(title, unit)}
      note={`${some}${span ? `, from ${formatTime(span[0])} to ${formatTime(span[1])} s` : ""}.`}
      heads={["Time [s]", ...heads]}
      rows={rows.map(([time, ...values]) => [formatTime(time as number), ...values])}
      onClose={onClose}
    />
  );
}
