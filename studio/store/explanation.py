"""The explanation of what happened in a saved run, for the command line and REST."""

import numpy as np

from studio.assess.cause import EXPLAINED, Explanation, explain
from studio.errors import UnknownError, nearest
from studio.execution.record import Record
from studio.scenario.finding import short
from studio.store.runs import Runs

NEEDED = ("x", "y", "heading", "commands_brake", "adhesion_front_left")  # channels without which there is nothing to tell
LONGEST = 9  # digits of the number of an event


def explanation(runs: Runs, run: int, event: str = "") -> list[Explanation]:
    """Why things happened in a run, in the order of time: all that can be told, those of one kind, or one by its number from 1 on.

    Raises UnknownError for a run without record, for a kind that is not explained, and for a number that there is not.
    """
    if event and not event.isdecimal() and event not in EXPLAINED:
        raise UnknownError(f"Events {short(event)} are not explained; {nearest(event, EXPLAINED)} (explained: {', '.join(EXPLAINED)})")
    found = explain(whole(runs, run), (event,) if event in EXPLAINED else EXPLAINED)
    if not event.isdecimal():
        return found
    if len(event) > LONGEST or not 1 <= int(event) <= len(found):
        count = f"1 to {len(found)}" if found else "none: no collision, near miss or hard brake"
        raise UnknownError(f"Run {run} has no event {short(event)} to explain; there is {count}.")
    return [found[int(event) - 1]]


def whole(runs: Runs, run: int) -> Record:
    """The record of a run, which must have kept what is asked of it; raises UnknownError."""
    record = runs.record(run)
    lacking = [name for name in NEEDED if record.time.size and np.isnan(record.channel(name)).all()]
    if lacking:
        what = f"Run {run} has not kept the channels {', '.join(lacking)}, so nothing can be explained"
        raise UnknownError(f"{what}; leave `recording.channels` empty to keep all.")
    return record
