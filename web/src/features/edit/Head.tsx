/** What is edited, what can be undone, who else edits, and where one goes from here. */

import { ActionIcon, Badge, Button, Menu, Text, Title, Tooltip } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { Link } from "@tanstack/react-router";
import type { useNews } from "../../api/editing";
import { trash, useRestore } from "../../api/scenarios";
import type { Editing, Step } from "../../model/editing/item";
import { Icon } from "../../ui/Icon";
import { notifyError } from "../../ui/notify";
import classes from "./Edit.module.css";

interface Props {
  state: Editing;
  news: ReturnType<typeof useNews>;
  onUndo: () => void;
  onRedo: () => void;
}

export function Head({ state, news, onUndo, onRedo }: Props) {
  const [last, next] = [state.done.at(-1), state.undone.at(-1)];
  const params = { scenario: state.scenario } as never;
  return (
    <header className={classes.head}>
      <Title order={1} fz="md" className={classes.title}>
        {state.title}
      </Title>
      <TurnButton step={last} icon="undo" what="Undo" keys="Ctrl+Z" onClick={onUndo} />
      <TurnButton step={next} icon="redo" what="Redo" keys="Ctrl+Shift+Z" onClick={onRedo} />
      <StepList state={state} />
      <Text size="xs" c={news.gone ? "red" : "dimmed"} role="status" className={classes.status}>
        {saying(state, news)}
      </Text>
      {news.gone ? <Back scenario={state.scenario} /> : null}
      <Button size="xs" component={Link} to="/studio/$scenario" params={params} search={{} as never} leftSection={<Icon name="run" size={14} />}>
        Open in the studio
      </Button>
      <Button size="xs" variant="default" component={Link} to="/scenarios/$scenario/text" params={params} leftSection={<Icon name="text" size={14} />}>
        Text
      </Button>
    </header>
  );
}

/** The way back of a scenario that somebody has deleted meanwhile, with its steps. */
function Back({ scenario }: { scenario: string }) {
  const entry = useQuery({ ...trash, refetchInterval: 2000 }).data?.find((each) => each.scenario === scenario);
  const restore = useRestore();
  if (!entry) return null;
  return (
    <Button size="xs" variant="default" loading={restore.isPending} onClick={() => restore.mutate({ entry: entry.id }, { onError: notifyError })}>
      Bring it back
    </Button>
  );
}

function saying(state: Editing, { connected, by, gone }: Props["news"]): string {
  if (gone) return [gone.message, ...gone.problems.map(({ where, what, remedy }) => `${where}: ${[what, remedy].filter(Boolean).join("; ")}.`)].join(" ");
  if (!connected) return "The server does not answer. What was saved is safe; nothing more can be saved until it answers, and it is asked again and again.";
  if (state.sealed) return "Read only";
  if (by && by.revision === state.revision) return `“${by.name}” by ${by.who || "another program"}`;
  const last = state.done.at(-1);
  return last ? `Saved: ${last.name}` : "Every step is saved at once";
}

function TurnButton({ step, icon, what, keys, onClick }: { step: Step | undefined; icon: "undo" | "redo"; what: string; keys: string; onClick: () => void }) {
  const label = step ? `${what}: ${step.name}` : `Nothing to ${what.toLowerCase()}`;
  return (
    <Tooltip label={`${label} (${keys})`}>
      <ActionIcon variant="default" size={30} aria-label={label} disabled={!step} onClick={onClick}>
        <Icon name={icon} />
      </ActionIcon>
    </Tooltip>
  );
}

const MOST_STEPS = 12;

/** The names of the last steps, the latest first. */
function StepList({ state }: { state: Editing }) {
  return (
    <Menu position="bottom-start" width={320}>
      <Menu.Target>
        <Button size="xs" variant="subtle" disabled={state.done.length + state.undone.length === 0}>
          Steps
        </Button>
      </Menu.Target>
      <Menu.Dropdown aria-label="Steps">
        {state.undone.slice(-MOST_STEPS).map((step) => (
          <StepLine key={step.revision} step={step} undone />
        ))}
        {state.done
          .slice(-MOST_STEPS)
          .reverse()
          .map((step) => (
            <StepLine key={step.revision} step={step} />
          ))}
      </Menu.Dropdown>
    </Menu>
  );
}

const StepLine = ({ step, undone = false }: { step: Step; undone?: boolean }) => (
  <Menu.Item closeMenuOnClick={false} c={undone ? "dimmed" : undefined}>
    {step.name}{" "}
    <Text span size="xs" c="dimmed">
      {new Date(step.time).toLocaleTimeString()} {step.who}
    </Text>
    {undone ? (
      <Badge size="xs" variant="light" color="gray" tt="none" ml={4}>
        undone
      </Badge>
    ) : null}
  </Menu.Item>
);
