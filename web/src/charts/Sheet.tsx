/** What a chart draws, as a table: for who cannot see it, or wants the numbers. */

import { Modal, Text } from "@mantine/core";
import { useState } from "react";
import type { Cell } from "../model/sampled";
import { formatNumber } from "../model/units";
import classes from "./TimeChart.module.css";

export interface SheetData {
  title: string;
  /** How much of what is drawn it has. */
  note: string;
  /** With their units; the first column names the row. */
  heads: readonly string[];
  rows: readonly (readonly Cell[])[];
}

export function Sheet({ title, note, heads, rows, onClose }: SheetData & { onClose: () => void }) {
  return (
    <Modal opened onClose={onClose} title={title} size="xl">
      <Text size="xs" c="dimmed" mb={6}>
        {note} A dash is a gap.
      </Text>
      {/* A part that scrolls must be reached by keys. */}
      <div className={classes.samples} tabIndex={0} role="region" aria-label={`${title} as a table`}>
        <table>
          <thead>
            <tr>
              {heads.map((head, place) => (
                <th key={place} scope="col">
                  {head}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {rows.map(([first, ...rest], row) => (
              <tr key={row}>
                <th scope="row">{told(first)}</th>
                {rest.map((value, place) => (
                  <td key={place}>{told(value)}</td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </Modal>
  );
}

const told = (value: Cell): string => (typeof value === "number" && Number.isFinite(value) ? formatNumber(value) : typeof value === "string" ? value : "–");

/** The button below a chart that opens its table, which is made when it is asked for. */
export function AsTable({ sheet }: { sheet: () => SheetData }) {
  const [isOpen, setOpen] = useState(false);
  return (
    <>
      <button type="button" className={classes.action} onClick={() => setOpen(true)}>
        As table
      </button>
      {isOpen ? <Sheet {...sheet()} onClose={() => setOpen(false)} /> : null}
    </>
  );
}
