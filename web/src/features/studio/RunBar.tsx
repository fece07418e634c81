/** Run, pause, step and stop; how fast, and how far the run is. */

import { ActionIcon, Button, NativeSelect, Progress, Text, Tooltip } from "@mantine/core";
import { Link } from "@tanstack/react-router";
import type { Pace } from "../../api/types";
import type { Status } from "../../model/run";
import { isLive } from "../../model/run";
import { formatNumber, formatTime } from "../../model/units";
import { Icon, type IconName } from "../../ui/Icon";
import { NumberEntry } from "../../ui/NumberEntry";
import { StatusBadge } from "../../ui/StatusBadge";
import { MOST_SEEDS } from "./control";
import classes from "./Studio.module.css";

export interface Progressing {
  run: number;
  status: Status;
  time: number;
  duration: number;
  factor: number;
  /** Place among the runs that wait, from 1 on. */
  position: number;
  error: string | null;
}

export interface Controls {
  onRun: () => void;
  onPause: () => void;
  onResume: () => void;
  onStep: () => void;
  onStop: () => void;
  onPace: (pace: Pace) => void;
  /** Null: as the scenario says. */
  onSeed: (seed: number | null) => void;
  /** How many seeds are run at once. */
  onSeeds: (seeds: number) => void;
}

interface Props extends Controls {
  progress: Progressing | undefined;
  duration: number;
  pace: Pace;
  seed: number;
  seeds: number;
  starting: boolean;
  /** Why no run can be started; empty when one can. */
  blocked: string;
}

const PACES = [
  ...[0.05, 0.1, 0.25, 0.5, 1, 2, 4, 8].map((pace) => ({ value: String(pace), label: `${pace} × real time` })),
  { value: "fast", label: "As fast as possible" },
];

export function RunBar(props: Props) {
  const { progress, pace, seed, seeds, starting, blocked, onRun, onSeed, onSeeds, onPace } = props;
  const live = isLive(progress?.status);
  return (
    <div className={classes.bar} role="toolbar" aria-label="Run control">
      <Tooltip label={blocked} disabled={!blocked || live} multiline maw={360}>
        {/* A disabled button says nothing when it is pointed at; its frame does. */}
        <span className={classes.start}>
          <Button
            size="xs"
            data-testid="run"
            leftSection={<Icon name="run" size={14} />}
            onClick={onRun}
            disabled={live || blocked !== ""}
            loading={starting}
          >
            {seeds > 1 ? `Run ${seeds} seeds` : progress && !live ? "Run again" : "Run"}
          </Button>
        </span>
      </Tooltip>
      <Motion {...props} />
      <NativeSelect
        size="xs"
        className={classes.pace}
        aria-label="Pace"
        data-testid="pace"
        data={PACES}
        value={String(pace)}
        onChange={({ currentTarget: { value } }) => onPace(value === "fast" ? value : Number(value))}
      />
      <span className={classes.seed}>
        <label htmlFor="seed">Seed</label>
        <NumberEntry
          size="xs"
          className={classes.seedField}
          id="seed"
          data-testid="seed"
          min={0}
          step={1}
          whole
          disabled={live}
          value={seed}
          onNumber={onSeed}
          onEmpty={() => onSeed(null)}
        />
        <Tooltip label="So many seeds at once, from this one on: the first is shown, the others run unseen, and the tab Seeds tells their spread" multiline maw={300}>
          <label htmlFor="seeds">×</label>
        </Tooltip>
        <NumberEntry
          size="xs"
          className={classes.seedsField}
          id="seeds"
          aria-label="Seeds at once"
          min={1}
          max={MOST_SEEDS}
          step={1}
          whole
          disabled={live}
          value={seeds}
          onNumber={onSeeds}
          onEmpty={() => onSeeds(1)}
        />
      </span>
      <TimeShown progress={progress} duration={progress?.duration || props.duration} />
    </div>
  );
}

/** Pause or resume, whichever is possible; one tick; stop. */
function Motion({ progress, blocked, onPause, onResume, onStep, onStop }: Props) {
  const status = progress?.status;
  return (
    <ActionIcon.Group>
      {status === "paused" ? (
        <Press id="resume" icon="run" label="Resume (space)" onClick={onResume} />
      ) : (
        <Press
          id="pause"
          icon="pause"
          label="Pause (space)"
          onClick={onPause}
          disabled={status !== "running"}
        />
      )}
      <Press
        id="step"
        icon="step"
        label="Step one tick, 20 ms (.)"
        onClick={onStep}
        reason={isLive(status) ? "" : blocked}
        disabled={status !== undefined && status !== "paused"}
      />
      <Press id="stop" icon="stop" label="Stop" onClick={onStop} disabled={!isLive(status)} />
    </ActionIcon.Group>
  );
}

interface PressProps {
  id: string;
  icon: IconName;
  label: string;
  onClick: () => void;
  disabled?: boolean;
  /** Why it is disabled. */
  reason?: string;
}

function Press({ id, icon, label, onClick, disabled = false, reason = "" }: PressProps) {
  return (
    <Tooltip label={label}>
      <ActionIcon
        size={30}
        variant="default"
        data-testid={id}
        aria-label={label}
        onClick={onClick}
        disabled={disabled || reason !== ""}
        title={reason || undefined}
      >
        <Icon name={icon} />
      </ActionIcon>
    </Tooltip>
  );
}

function TimeShown({ progress, duration }: { progress: Progressing | undefined; duration: number }) {
  const time = progress?.time ?? 0;
  return (
    <div className={classes.clock}>
      <div className={classes.clockText}>
        <span>
          <b data-testid="sim-time">{formatTime(time)}</b>
          <Text span size="xs" c="dimmed">
            {" "}
            / {formatNumber(duration)} s
          </Text>
        </span>
        {progress ? (
          <span className={classes.runState}>
            <Text span size="xs" c="dimmed" className={classes.factor} title="Simulated seconds per second of real time">
              {progress.status === "running"
                ? `${formatNumber(Number(progress.factor.toFixed(2)))} × real time`
                : ""}
            </Text>
            <Text span size="xs" fw={600} data-testid="current-run">
              #{progress.run}
            </Text>
            {progress.position ? (
              <Link to="/queue" data-testid="position">
                place {progress.position}
              </Link>
            ) : null}
            <StatusBadge status={progress.status} error={progress.error} />
          </span>
        ) : null}
      </div>
      <Progress
        size="sm"
        value={duration > 0 ? Math.min(100, (100 * time) / duration) : 0}
        aria-label="Simulated part of the run"
      />
    </div>
  );
}
