/** The validation projects: does our car drive like that car? */

import { Badge, Button, Text, Title } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { Link, useNavigate } from "@tanstack/react-router";
import { useState } from "react";
import { projectJob, useNewProject, useSample, validationKinds, validations } from "../../api/validations";
import { freeName } from "../../model/scenario";
import type { ProjectRow } from "../../model/validation";
import { Icon } from "../../ui/Icon";
import { notifyError } from "../../ui/notify";
import { Empty, Failure, Loading } from "../../ui/State";
import { NewProject } from "./NewProject";
import { Progressing } from "./Progressing";
import classes from "./Validation.module.css";

export function ValidationsPage() {
  const { data, error, refetch } = useQuery(validations);
  const [making, setMaking] = useState(false);
  const names = data?.map(({ name }) => name) ?? [];
  if (error && !data) return <Failure error={error} onRetry={() => void refetch()} />;
  if (!data) return <Loading what="the projects" />;
  const actions = <Actions names={names} onNew={() => setMaking(true)} onMade={() => void refetch()} />;
  return (
    <article className={classes.page}>
      <header className={classes.head}>
        <Title order={1} fz="lg">
          Validation
        </Title>
        <Text size="sm" c="dimmed">
          Does our car drive like that car?
        </Text>
        {data.length > 0 ? <div className={classes.tools}>{actions}</div> : null}
      </header>
      {data.length === 0 ? (
        <Empty icon="check" title="No projects yet" action={<div className={classes.row}>{actions}</div>}>
          A project takes recorded drives of a real car, calibrates a vehicle with some of them, and judges it by the others: the car
          that comes out says for which speeds and accelerations it may be believed. The sample has ten drives whose truth is known.
        </Empty>
      ) : (
        <Rows rows={data} />
      )}
      {making ? <Making names={names} onClose={() => setMaking(false)} /> : null}
    </article>
  );
}

interface ActionsProps {
  names: readonly string[];
  onNew: () => void;
  onMade: () => void;
}

function Actions({ names, onNew, onMade }: ActionsProps) {
  const sample = useSample();
  const navigate = useNavigate();
  const [job, setJob] = useState<number>();
  const { data: now } = useQuery(projectJob(job));
  const goes = sample.isPending || now?.status === "running";
  const make = () =>
    sample.mutate(freeName("known_truth", names), { onSuccess: ({ id }) => setJob(id), onError: notifyError });
  if (now?.status === "done") {
    setJob(undefined);
    onMade();
    void navigate({ to: "/validate/$project", params: { project: now.project }, search: {} });
  }
  return (
    <>
      {now && now.status !== "done" ? <Progressing job={now} /> : null}
      <Button size="xs" variant="default" loading={goes} onClick={make}>
        Make the sample
      </Button>
      <Button size="xs" leftSection={<Icon name="plus" size={14} />} onClick={onNew}>
        New project
      </Button>
    </>
  );
}

function Rows({ rows }: { rows: readonly ProjectRow[] }) {
  return (
    <table className={classes.table} data-testid="projects">
      <thead>
        <tr>
          <th scope="col">Project</th>
          <th scope="col">Vehicle</th>
          <th scope="col">Maneuvers</th>
          <th scope="col">Runs</th>
          <th scope="col">Last iteration</th>
          <th scope="col">Last verdict</th>
        </tr>
      </thead>
      <tbody>
        {rows.map(({ name, title, vehicle, maneuvers, runs, latest, valid, problem }) => (
          <tr key={name}>
            <th scope="row">
              <Link to="/validate/$project" params={{ project: name }} search={{}}>
                {title}
              </Link>
              {problem ? (
                <Text size="xs" c="red">
                  {problem}
                </Text>
              ) : null}
            </th>
            <td>{vehicle}</td>
            <td>{maneuvers}</td>
            <td>{runs}</td>
            <td>{latest ?? "–"}</td>
            <td>{valid === null ? "–" : <Valid valid={valid} />}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

export function Valid({ valid }: { valid: boolean }) {
  return (
    <Badge variant="light" tt="none" color={valid ? "teal" : "red"}>
      {valid ? "valid" : "not valid"}
    </Badge>
  );
}

function Making({ names, onClose }: { names: readonly string[]; onClose: () => void }) {
  const kinds = useQuery(validationKinds);
  const create = useNewProject();
  const navigate = useNavigate();
  if (!kinds.data) return null;
  return (
    <NewProject
      vehicles={kinds.data.vehicles}
      taken={names}
      error={create.error}
      pending={create.isPending}
      onClose={onClose}
      onMake={(body) =>
        create.mutate(body, {
          onSuccess: ({ name }) => void navigate({ to: "/validate/$project", params: { project: name }, search: {} }),
        })
      }
    />
  );
}
