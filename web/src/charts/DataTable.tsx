/** What a chart draws, as a table: for who cannot see it, or wants the numbers. */

import { Modal, Text } from "@mantine/core";
import { formatNumber, formatTime, unitText, withUnit } from "../model/units";
import { tableOf } from "../model/sampled";
import type { Columns, Line } from "./TimeChart";
import classes from "./TimeChart.module.css";
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
  return (
    <Modal opened onClose={onClose} title={withUnit(title, unit)} size="xl">
      <Text size="xs" c="dimmed" mb={6}>
        {rows.length === of ? `${of} samples` : `${rows.length} of ${of} samples, evenly taken; a shorter stretch has more of its own`}
        {span ? `, from ${formatTime(span[0])} to ${formatTime(span[1])} s` : ""}. A dash is a gap.
      </Text>
      {/* A part that scrolls must be reached by keys. */}
      <div className={classes.samples} tabIndex={0} role="region" aria-label={`${title} as a table`}>
        <table>
          <thead>
            <tr>
              <th scope="col">Time [s]</th>
              {lines.map(({ key, label, right }) => (
                <th key={key} scope="col">
                  {label} [{unitText(right ? (rightUnit ?? "") : unit) || "1"}]
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {rows.map(([time, ...values]) => (
              <tr key={time}>
                <th scope="row">{formatTime(time as number)}</th>
                {lines.map(({ key }, place) => (
                  <td key={key}>{typeof values[place] === "number" ? formatNumber(values[place]) : "–"}</td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </Modal>
  );
}
