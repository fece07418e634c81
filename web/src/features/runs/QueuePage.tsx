/** Runs that go on and runs that wait for their turn, in their order, whoever has begun them; each can be cancelled. */

import { Button, Progress, Text, Title } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { Link, useNavigate } from "@tanstack/react-router";
import { type KeyboardEvent, useEffect, useRef } from "react";
import { queue, useCancelRun } from "../../api/queries";
import type { Queued } from "../../model/run";
import { formatNumber, formatTime } from "../../model/units";
import { Icon } from "../../ui/Icon";
import { notifyError } from "../../ui/notify";
import { Empty, Failure, Loading } from "../../ui/State";
import classes from "./Queue.module.css";

export function QueuePage() {
  const { data, error, refetch } = useQuery(queue);
  const navigate = useNavigate();
  if (error && !data) return <Failure error={error} onRetry={() => void refetch()} />;
  if (!data) return <Loading what="the queue" />;
  if (data.length === 0) {
    return (
      <Empty
        icon="compiling"
        title="No run goes on or waits"
        action={<Button onClick={() => navigate({ to: "/" })}>Open the studio</Button>}
      >
        Runs that are asked for while others take all places wait here for their turn, in the order in which they
        were asked for. Those that are over stand under Runs.
      </Empty>
    );
  }
  return <Places places={data} />;
}

const STEPS: Record<string, number> = { ArrowDown: 1, j: 1, ArrowUp: -1, k: -1 };

function Places({ places }: { places: readonly Queued[] }) {
  const list = useRef<HTMLTableSectionElement>(null);
  const at = useRef(0);
  const buttons = () => [...(list.current?.querySelectorAll<HTMLElement>("[data-cancel]") ?? [])];
  const focus = (place: number) => buttons()[Math.max(0, Math.min(place, buttons().length - 1))]?.focus();
  // Whoever cancels one run after the other stays in the list when the row goes.
  useEffect(() => {
    if (places.length && document.activeElement === document.body) focus(at.current);
  }, [places]);
  const move = (event: KeyboardEvent) => {
    const step = STEPS[event.key];
    if (step === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    focus(at.current + step);
  };
  const waiting = places.filter(({ status }) => status === "waiting").length;
  return (
    <article className={classes.page}>
      <header className={classes.head}>
        <Title order={1} fz="lg">
          Queue
        </Title>
        <Text size="sm" c="dimmed" role="status" data-testid="queue-counts">
          {places.length - waiting} going on, {waiting} waiting
        </Text>
      </header>
      <table className={classes.table} data-testid="queue">
        <thead>
          <tr>
            <th scope="col">Place</th>
            <th scope="col">Run</th>
            <th scope="col">Scenario</th>
            <th scope="col">Set</th>
            <th scope="col">Recorded</th>
            <th scope="col" aria-label="Cancel" />
          </tr>
        </thead>
        <tbody
          ref={list}
          onKeyDown={move}
          onFocus={({ target }) => {
            at.current = Math.max(0, buttons().indexOf(target));
          }}
        >
          {places.map((place) => (
            <Row key={place.run} place={place} />
          ))}
        </tbody>
      </table>
    </article>
  );
}

function Row({ place: { run, scenario, status, position, parameters, time, duration } }: { place: Queued }) {
  const cancel = useCancelRun();
  const waits = status === "waiting";
  const set = Object.entries(parameters).map(([path, value]) => `${path}=${JSON.stringify(value)}`);
  return (
    <tr data-testid={`queue-${run}`}>
      <td>{waits ? position : "goes on"}</td>
      <td>
        <Link to="/runs/$run" params={{ run: String(run) }}>
          #{run}
        </Link>
      </td>
      <td>{scenario}</td>
      <td className={classes.set} title={set.join(", ")}>
        {set.join(", ") || "as in the file"}
      </td>
      <td className={classes.time}>
        {waits ? null : (
          <>
            {formatTime(time)} of {formatNumber(duration)} s
            <Progress size="xs" value={(100 * time) / duration} aria-label={`Recorded part of run ${run}`} />
          </>
        )}
      </td>
      <td>
        <Button
          size="compact-xs"
          variant="default"
          data-cancel
          data-testid={`cancel-${run}`}
          leftSection={<Icon name="close" size={12} />}
          aria-label={waits ? `Cancel run ${run}, place ${position}` : `Cancel run ${run}, which goes on`}
          loading={cancel.isPending}
          onClick={() => cancel.mutate(run, { onError: notifyError })}
        >
          Cancel
        </Button>
      </td>
    </tr>
  );
}
