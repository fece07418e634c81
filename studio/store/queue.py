"""The queue: runs of a database that go on or wait for their turn, whoever has begun them, and how they are cancelled.

A run that a server cannot begin at once has its row already and says "waiting"; its number is its place in the order. Whoever has the
database may cancel any run: one that waits is taken out of the order, one that goes on is told to end, by a file in its recording.
"""

import time
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass
from math import isfinite
from typing import Any

import psutil

from studio.errors import Problem, ServerError, StoreError
from studio.store import owner, recording
from studio.store.runs import Row, Runs

PATIENCE = 6.0  # [s] for a run to end when it is told to
LOOK = 0.05  # [s] between two looks whether it has
CANCELLED = "Cancelled before its turn came."
OWNER = ("process", "process_mark")


@dataclass(frozen=True)
class Place:
    """A run in the queue: `position` counts from 1 among those that wait for the same server, and is 0 once a run has begun.

    `time` [s] is up to when it has been recorded, of `duration` [s].
    """

    run: int
    scenario: str
    status: str
    position: int
    created: str
    parameters: dict[str, Any]
    time: float
    duration: float


def queue(runs: Runs) -> list[Place]:
    """Those that go on, then those that wait, each in the order of their numbers."""
    rows = runs.rows("select run, process, process_mark, created from runs where status in ('running', 'waiting') order by status, run")
    found, waiting = [], Counter()
    for row in rows:
        seen = runs.find(row["run"])
        if seen.status in ("running", "waiting"):
            of = tuple(row[each] for each in OWNER)
            waiting[of] += seen.status == "waiting"
            position = waiting[of] if seen.status == "waiting" else 0
            time = recording.until(recording.folder_of(runs.path, row))
            found.append(Place(seen.run, seen.scenario, seen.status, position, seen.created, seen.parameters, time, duration(runs, seen)))
    return found


def duration(runs: Runs, row: Row) -> float:
    """How long a run is to be [s]; 0 where its scenario is damaged: that holds up nobody else."""
    with suppress(StoreError, LookupError, TypeError, ValueError):
        found = float(runs.document(row)["clock"]["duration"])
        return found if isfinite(found) else 0.0
    return 0.0


def cancel(runs: Runs, run: int, force: bool = False, patience: float = PATIENCE) -> Row:
    """Takes a run out of the queue, or ends it; returns its row then. What was recorded until then is kept.

    By force the process of one that does not react is ended. Raises UnknownError, or ServerError for a run that is over or does not react.
    """
    row = runs.find(run)
    if row.status not in ("running", "waiting"):
        raise ServerError(f"Run {run} is over.", [Problem("run", "is over", row.status, "a run that goes on or waits")])
    if runs.take_out(run, CANCELLED) or ends_within(runs, run, patience):
        return runs.find(run)
    if not force:
        problem = Problem(f"run {run}", "does not react", allowed=f"within {patience:g} s", remedy=f"studio cancel {run} --force")
        raise ServerError(f"Run {run} was told to end, and has not ended.", [problem])
    end_process(runs, run)
    return runs.find(run)


def ends_within(runs: Runs, run: int, patience: float) -> bool:
    """Tells a run to end; whether it has after so many seconds."""
    recording.tell_to_end(runs.folder(run))
    until = time.monotonic() + patience
    while runs.find(run).status == "running" and time.monotonic() < until:
        time.sleep(LOOK)
    return runs.find(run).status != "running"


def end_process(runs: Runs, run: int) -> None:
    """Ends the process of a run on this machine. Raises ServerError when it is of another."""
    row = runs.rows("select process, process_mark from runs where run = ?", [run])[0]
    if not owner.is_here(row["process_mark"]):
        raise ServerError(f"Run {run} goes on elsewhere.", [Problem("process", "is of another machine or container", str(row["process"]))])
    process = psutil.Process(row["process"])
    process.kill()
    psutil.wait_procs([process], PATIENCE)
    runs.break_off(run, "stopped", "It did not react; its process was ended.")
