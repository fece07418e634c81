/** What is looked for, and what was found: values with their uncertainty, how well the car follows, and what these runs cannot tell. */

import { ActionIcon, Alert, Button, Group, Select, Text, TextInput } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { iteration, usePatch } from "../../api/validations";
import { formatNumber, unitText, words } from "../../model/units";
import { addParameter, choices, removeParameter, type Project, type Said } from "../../model/validation";
import { Icon } from "../../ui/Icon";
import { NumberEntry } from "../../ui/NumberEntry";
import { notifyError } from "../../ui/notify";
import { Failure, Loading } from "../../ui/State";
import classes from "./Validation.module.css";

interface Props {
  project: Project;
  said: Said;
  at: number | undefined;
  busy: boolean;
  onAt: (at: number) => void;
  onStart: (step: string) => void;
}

export function Calibrations({ project, said, at, busy, onStart }: Props) {
  const patch = usePatch(project.name, project.digest);
  const calibrations = project.iterations.filter(({ valid }) => valid === null);
  const shown = calibrations.find((each) => each.iteration === at) ?? calibrations[0];
  return (
    <div className={classes.stack}>
      {Object.entries(said.calibration).map(([step, { parameters, maneuvers }]) => (
        <section key={step} className={classes.card} aria-label={`Step ${step}`}>
          <h2>
            {step}{" "}
            <span className={classes.dim}>
              with {maneuvers.length > 0 ? maneuvers.join(", ") : "all maneuvers that have runs for calibration"}
            </span>
          </h2>
          <table className={classes.table}>
            <thead>
              <tr>
                <th scope="col">Parameter</th>
                <th scope="col">Lowest</th>
                <th scope="col">Highest</th>
                <th scope="col">Known before</th>
                <th scope="col">Unit</th>
                <td />
              </tr>
            </thead>
            <tbody>
              {Object.entries(parameters).map(([path, { low, high, prior, spread }]) => (
                <tr key={path}>
                  <th scope="row" title={parameterOf(project, path)?.title}>
                    {path}
                  </th>
                  <td>{String(low)}</td>
                  <td>{String(high)}</td>
                  <td>{prior === null ? "–" : `${formatNumber(prior)} ± ${formatNumber(spread ?? 0)}`}</td>
                  <td>{unitText(parameterOf(project, path)?.unit ?? "") || "–"}</td>
                  <td>
                    <ActionIcon
                      size="sm"
                      variant="subtle"
                      color="gray"
                      aria-label={`Look for ${path} no longer`}
                      disabled={busy || patch.isPending}
                      onClick={() => patch.mutate(removeParameter(said, step, path), { onError: notifyError })}
                    >
                      <Icon name="trash" />
                    </ActionIcon>
                  </td>
                </tr>
              ))}
            </tbody>
          </table>
          <Button size="compact-xs" variant="default" disabled={busy} onClick={() => onStart(step)}>
            Calibrate this step
          </Button>
        </section>
      ))}
      <NewParameter project={project} said={said} />
      {shown ? <Found number={shown.iteration} step={shown.step} /> : null}
    </div>
  );
}

const parameterOf = ({ parameters }: Project, path: string) => parameters.find((each) => each.path === path);

function NewParameter({ project, said }: { project: Project; said: Said }) {
  const patch = usePatch(project.name, project.digest);
  const [step, setStep] = useState(Object.keys(said.calibration)[0] ?? "lateral");
  const [path, setPath] = useState<string | null>(null);
  const [range, setRange] = useState<{ low: number | ""; high: number | "" }>({ low: "", high: "" });
  const { low, high } = range;
  const chosen = path === null ? undefined : parameterOf(project, path);
  const fits = path !== null && step.trim() !== "" && low !== "" && high !== "" && low < high;
  const choose = (next: string | null) => {
    const known = next === null ? undefined : parameterOf(project, next);
    setPath(next);
    setRange({ low: known?.low ?? "", high: known?.high ?? "" });
  };
  const add = () => {
    if (path === null || low === "" || high === "") return;
    patch.mutate(addParameter(said, step.trim(), path, low, high), {
      onError: notifyError,
      onSuccess: () => choose(null),
    });
  };
  return (
    <section className={classes.card} aria-label="Another parameter">
      <h2>Another parameter</h2>
      <Group gap="xs" align="end">
        <TextInput size="xs" label="Step" value={step} onChange={(event) => setStep(event.currentTarget.value)} />
        <Select
          size="xs"
          w={380}
          label="Parameter of the vehicle"
          placeholder="by title or path"
          searchable
          clearable
          clearButtonProps={{ "aria-label": "Choose no parameter" }}
          nothingFoundMessage="The vehicle has no such number."
          data={choices(project.parameters)}
          value={path}
          onChange={choose}
        />
        <NumberEntry size="xs" label="Lowest" w={130} unit={chosen && chosen.unit !== "1" ? chosen.unit : undefined} value={low} onNumber={(next) => setRange({ low: next, high })} onEmpty={() => setRange({ low: "", high })} />
        <NumberEntry size="xs" label="Highest" w={130} unit={chosen && chosen.unit !== "1" ? chosen.unit : undefined} value={high} onNumber={(next) => setRange({ low, high: next })} onEmpty={() => setRange({ low, high: "" })} />
        <Button size="xs" variant="default" disabled={!fits} loading={patch.isPending} onClick={add}>
          Look for it
        </Button>
      </Group>
      {chosen ? (
        <Text size="xs" c="dimmed">
          Now {formatNumber(chosen.value)} {unitText(chosen.unit)}
          {chosen.low !== null ? "; the range is what the vehicle's file gives." : "; the vehicle's file gives no range."}
        </Text>
      ) : null}
      {chosen && low !== "" && high !== "" && low < high && (chosen.value < low || chosen.value > high) ? (
        <Text size="xs" c="orange" role="status">
          What the vehicle has lies outside of this range: the best that is allowed may be worse.
        </Text>
      ) : null}
      {low !== "" && high !== "" && low >= high ? (
        <Text size="xs" c="red" role="alert">
          The lowest value must be less than the highest.
        </Text>
      ) : null}
    </section>
  );
}

interface Estimate {
  path: string;
  unit: string;
  start: number;
  value: number;
  spread: number;
  low: number;
  high: number;
}

interface Result {
  estimates: Estimate[];
  misfit: Record<string, [number, number]>;
  warnings: string[];
  evaluations: number;
}

function Found({ number, step }: { number: number; step: string }) {
  const { data, error } = useQuery(iteration(number));
  if (error) return <Failure error={error} />;
  if (!data) return <Loading what="what was found" />;
  const { estimates, misfit, warnings, evaluations } = data.result as unknown as Result;
  const percent = (share: number) => `${formatNumber(100 * share)} %`;
  return (
    <section className={classes.card} aria-label={`Found by iteration ${number}`}>
      <h2>
        Found by iteration {number} <span className={classes.dim}>{step}, {evaluations} evaluations</span>
      </h2>
      {warnings.map((each) => (
        <Alert key={each} color="orange" variant="outline" icon={<Icon name="warning" />} py={6}>
          {each}
        </Alert>
      ))}
      <table className={classes.table} data-testid="estimates">
        <thead>
          <tr>
            <th scope="col">Parameter</th>
            <th scope="col">Before</th>
            <th scope="col">Found</th>
            <th scope="col">± two standard deviations</th>
            <th scope="col">Unit</th>
            <th scope="col">Allowed</th>
          </tr>
        </thead>
        <tbody>
          {estimates.map((each) => (
            <tr key={each.path}>
              <th scope="row">{each.path}</th>
              <td>{formatNumber(each.start)}</td>
              <td>{each.value.toPrecision(5)}</td>
              <td>{(2 * each.spread).toPrecision(2)}</td>
              <td>{unitText(each.unit) || "–"}</td>
              <td>
                {String(each.low)} to {String(each.high)}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      <table className={classes.table}>
        <thead>
          <tr>
            <th scope="col">RMS difference over the range of</th>
            <th scope="col">Before</th>
            <th scope="col">After</th>
          </tr>
        </thead>
        <tbody>
          {Object.entries(misfit).map(([name, [before, after]]) => (
            <tr key={name}>
              <th scope="row">{words(name)}</th>
              <td>{percent(before)}</td>
              <td>{percent(after)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}
