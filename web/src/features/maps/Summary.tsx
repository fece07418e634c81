/** The numbers of an import: what was found, placed and honoured. */

import { Tooltip } from "@mantine/core";
import type { Report } from "../../model/map";
import { formatDuration, formatNumber } from "../../model/units";
import classes from "./Maps.module.css";

export function Summary({ report }: { report: Report }) {
  const { signals, turn_lanes, speed_limits, buildings, parking, drive_side_why: why, country } = report;
  return (
    <dl className={classes.summary} data-testid="map-summary">
      <Fact name="Drives on the" value={report.drive_side} note={why.includes(country) ? why : `${why}, ${country}`} />
      <Fact name="Lanes" value={`${formatNumber(Number(report.lane_km.toFixed(1)))} km`} note={`${report.junctions} junctions`} />
      <Fact
        name="Signals placed"
        value={`${signals.placed} of ${signals.in_map}`}
        note={`${signals.groups} ${signals.groups === 1 ? "programme" : "programmes"}`}
      />
      <Fact name="Turn lanes as tagged" value={`${turn_lanes.matching} of ${turn_lanes.tagged_lanes}`} note="lanes" />
      <Fact
        name="Speed limits mapped"
        value={`${speed_limits.mapped_ways} ways`}
        note={`${speed_limits.guessed_ways} more guessed`}
        more={byLimit(speed_limits.lane_km)}
      />
      <Fact
        name="Buildings"
        value={String(buildings.placed)}
        note={`${buildings.height_guessed} heights guessed`}
      />
      <Fact name="Parking" value={`${parking.areas} areas`} note={`${parking.spaces} single spaces`} />
      <Fact name="Import took" value={formatDuration(report.seconds)} note={`${report.guesses.length} guesses, ${report.skipped.length} skipped`} />
    </dl>
  );
}

/** Lane kilometres by limit, for whoever points at it. */
const byLimit = (lengths: Record<string, number>): string =>
  Object.entries(lengths)
    .map(([limit, km]) => `${limit} km/h: ${formatNumber(km)} km of lanes`)
    .join("\n");

interface FactProps {
  name: string;
  value: string;
  note: string;
  more?: string;
}

function Fact({ name, value, note, more = "" }: FactProps) {
  return (
    <Tooltip label={more || note} disabled={!more && note.length < 24} multiline style={{ whiteSpace: "pre-line" }}>
      <div>
        <dt>{name}</dt>
        <dd>{value}</dd>
        <dd className={classes.note}>{note}</dd>
      </div>
    </Tooltip>
  );
}
