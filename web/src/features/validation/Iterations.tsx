/** The history of a project: every calibration and every validation, with the one that it goes on from. */

import { Anchor, Button, Text } from "@mantine/core";
import { reportOf } from "../../api/validations";
import { formatMoment } from "../../model/units";
import type { Project } from "../../model/validation";
import classes from "./Validation.module.css";
import { Valid } from "./ValidationsPage";

interface Props {
  project: Project;
  at: number | undefined;
  onAt: (at: number, isCalibration: boolean) => void;
}

export function Iterations({ project, at, onAt }: Props) {
  return (
    <section className={classes.card} aria-label="Iterations">
      <h2>Iterations</h2>
      {project.iterations.length === 0 ? (
        <Text size="sm" c="dimmed">
          None yet. Validate judges the car as it is; Calibrate looks for its parameters first.
        </Text>
      ) : (
        <table className={classes.table} data-testid="iterations">
          <thead>
            <tr>
              <th scope="col">Iteration</th>
              <th scope="col">From</th>
              <th scope="col">Step</th>
              <th scope="col">What came out</th>
              <th scope="col">Verdict</th>
              <th scope="col">When</th>
              <th scope="col">Report</th>
            </tr>
          </thead>
          <tbody>
            {project.iterations.map(({ iteration, parent, step, told, valid, created, has_report }) => (
              <tr key={iteration} aria-current={iteration === at || undefined}>
                <td>
                  <Button size="compact-xs" variant="subtle" onClick={() => onAt(iteration, valid === null)}>
                    {iteration}
                  </Button>
                </td>
                <td>{parent ?? "–"}</td>
                <td>{step}</td>
                <td className={classes.told}>{told}</td>
                <td>{valid === null ? "–" : <Valid valid={valid} />}</td>
                <td>{formatMoment(created)}</td>
                <td>
                  {has_report ? (
                    <Anchor size="sm" href={reportOf(project.name, iteration)} target="_blank" rel="noreferrer">
                      open
                    </Anchor>
                  ) : (
                    "–"
                  )}
                </td>
              </tr>
            ))}
          </tbody>
        </table>
      )}
    </section>
  );
}
