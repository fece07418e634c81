/** What chance makes of the setting that is shown: its metrics over all seeds that it was run with. */

import { ScrollArea, Text } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { Link } from "@tanstack/react-router";
import { useMemo } from "react";
import { useGlossary } from "../../api/glossary";
import { runs as runsQuery } from "../../api/queries";
import { titleOf } from "../../model/measure";
import { isLive, type RunDetail } from "../../model/run";
import { alike, isSameSetting, spreadOf } from "../../model/spread";
import { formatNumber, unitText } from "../../model/units";
import { Empty } from "../../ui/State";
import classes from "./Studio.module.css";

/** So many runs of the scenario are looked through, the newest. */
const MOST = 10_000;

export function Seeds({ scenario, run }: { scenario: string; run: RunDetail | undefined }) {
  const { data = [] } = useQuery(runsQuery({ scenario, limit: MOST }));
  const known = useGlossary().metrics;
  const some = useMemo(() => (run ? alike(data, run) : []), [data, run]);
  const going = run ? data.filter((each) => isLive(each.status) && isSameSetting(each, run)).length : 0;
  const rows = useMemo(() => spreadOf(some), [some]);
  if (some.length < 2) {
    return (
      <Empty icon="table" title={going ? `${going} still going` : some.length ? "One seed so far" : "No whole run of this setting yet"}>
        Set how many seeds are run at once beside the seed above: how far their metrics spread is told here.
      </Empty>
    );
  }
  return (
    <ScrollArea className={classes.history} classNames={{ content: classes.historyContent ?? "" }} type="auto">
      <Text size="xs" c="dimmed" p={6}>
        {some.length} seeds of this setting: {some.map(({ seed }) => seed).join(", ")}
        {going ? `; ${going} still going` : ""}
      </Text>
      <table className={classes.measures} aria-label="Spread over seeds">
        <thead>
          <tr>
            <th scope="col">Metric</th>
            <th scope="col">Mean ± deviation</th>
            <th scope="col">Least to greatest</th>
          </tr>
        </thead>
        <tbody>
          {rows.map(({ metric, unit, count, mean, deviation, least, most }) => (
            <tr key={metric}>
              <th scope="row">
                {titleOf(metric, known)}
                {unitText(unit) ? ` [${unitText(unit)}]` : ""}
                {count < some.length ? ` (${count} seeds)` : ""}
              </th>
              <td>
                {formatNumber(mean)} ± {formatNumber(Number(deviation.toPrecision(2)))}
              </td>
              <td>
                <To {...least} /> to <To {...most} />
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </ScrollArea>
  );
}

/** A value, and the way to the run that had it. */
function To({ value, run }: { value: number; run: number }) {
  return (
    <Link to="/runs/$run" params={{ run: String(run) }} title={`Run #${run}`}>
      {formatNumber(value)}
    </Link>
  );
}
