/** Runs by what was decided about them; a card is carried to another verdict, which asks for the reason. */

import { Text, Title } from "@mantine/core";
import { Link } from "@tanstack/react-router";
import { type DragEvent, type KeyboardEvent, useMemo, useState } from "react";
import { changesOf } from "../../model/lineage";
import { type ListedRun, shortNames } from "../../model/run";
import { formatMoment, formatValue, words } from "../../model/units";
import { hindrance, type Word } from "../../model/verdict";
import { StatusBadge } from "../../ui/StatusBadge";
import classes from "./Board.module.css";

const COLUMNS: readonly { word: Word; title: string; empty: string }[] = [
  { word: "open", title: "Open", empty: "About every run something was decided." },
  { word: "candidate", title: "Candidates", empty: "Drag a run here, or press c on it." },
  { word: "discarded", title: "Discarded", empty: "Drag a run here, or press d on it." },
];
/** So many cards of a column are shown; of more the filter chooses. */
const SHOWN = 200;
const DATA = "text/x-studio-run";

interface Props {
  runs: readonly ListedRun[];
  onJudge: (run: ListedRun, word: Word) => void;
}

export function Board({ runs, onJudge }: Props) {
  const known = useMemo(() => new Map(runs.map((run) => [run.run, run])), [runs]);
  return (
    <div className={classes.board} data-testid="board">
      {COLUMNS.map((column) => (
        <Column
          key={column.word}
          {...column}
          runs={runs.filter(({ verdict }) => verdict === column.word)}
          known={known}
          onJudge={onJudge}
        />
      ))}
    </div>
  );
}

interface ColumnProps {
  word: Word;
  title: string;
  empty: string;
  runs: readonly ListedRun[];
  /** All runs that are shown, by number. */
  known: ReadonlyMap<number, ListedRun>;
  onJudge: Props["onJudge"];
}

function Column({ word, title, empty, runs, known, onJudge }: ColumnProps) {
  const [over, setOver] = useState(false);
  const drop = (event: DragEvent) => {
    event.preventDefault();
    setOver(false);
    const run = known.get(Number(event.dataTransfer.getData(DATA)));
    if (run && run.verdict !== word) onJudge(run, word);
  };
  const follow = (event: DragEvent) => {
    if (!event.dataTransfer.types.includes(DATA)) return;
    event.preventDefault();
    setOver(true);
  };
  return (
    <section
      className={classes.column}
      aria-label={title}
      data-over={over || undefined}
      onDragOver={follow}
      onDragLeave={() => setOver(false)}
      onDrop={drop}
    >
      <Title order={2} fz="sm">
        {title}{" "}
        <Text span c="dimmed" size="sm">
          {runs.length}
        </Text>
      </Title>
      <div className={classes.cards}>
        {runs.length === 0 ? (
          <Text size="sm" c="dimmed" p="xs">
            {empty}
          </Text>
        ) : null}
        {runs.slice(0, SHOWN).map((run) => (
          <Card key={run.run} run={run} parent={run.parent === null ? undefined : known.get(run.parent)} onJudge={onJudge} />
        ))}
        {runs.length > SHOWN ? (
          <Text size="sm" c="dimmed" p="xs">
            {runs.length - SHOWN} more: filter for those that matter.
          </Text>
        ) : null}
      </div>
    </section>
  );
}

interface CardProps {
  run: ListedRun;
  parent: ListedRun | undefined;
  onJudge: Props["onJudge"];
}

const KEYS: Record<string, Word> = { c: "candidate", d: "discarded", o: "open" };

function Card({ run, parent, onJudge }: CardProps) {
  const changes = parent ? changesOf(run, parent) : [];
  const short = shortNames(changes.map(({ path }) => path));
  const key = (event: KeyboardEvent) => {
    const word = KEYS[event.key.toLowerCase()];
    if (!word || event.ctrlKey || event.metaKey || event.altKey || word === run.verdict) return;
    event.preventDefault();
    event.stopPropagation();
    onJudge(run, word);
  };
  return (
    <article
      className={classes.card}
      tabIndex={0}
      aria-label={`Run ${run.run}`}
      draggable={!hindrance(run, "discarded")}
      onDragStart={(event) => event.dataTransfer.setData(DATA, String(run.run))}
      onKeyDown={key}
    >
      <div className={classes.head}>
        <Link to="/runs/$run" params={{ run: String(run.run) }} className={classes.number}>
          #{run.run}
        </Link>
        <b>{run.name}</b>
        <StatusBadge status={run.status} error={run.error} unmet={run.unmet} />
      </div>
      <Text size="xs" c="dimmed">
        {run.scenario}, {formatMoment(run.created)}
      </Text>
      {changes.map(({ path, from, to }) => (
        <Text key={path} size="xs" title={path}>
          {words(short[path] ?? path)} <s>{formatValue(from)}</s> <b>{formatValue(to)}</b>
        </Text>
      ))}
      {run.reason ? (
        <Text size="sm" mt={4}>
          {run.reason}
        </Text>
      ) : null}
    </article>
  );
}
