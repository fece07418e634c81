"""A channel of stored runs in a few numbers, each run's beside the others': of all of it or of a stretch, and at an event."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from studio.assess.aggregate import Aggregate, aggregates
from studio.errors import Problem, UnknownError, nearest, short
from studio.execution.record import SAME_TIME
from studio.store.comparison import check_numbers
from studio.store.runs import Runs


class Aggregated(NamedTuple):
    """Those of one run: from when to when [s], of how many samples that are numbers, the unit, and when the event was [s]."""

    run: int
    unit: str
    begin: float
    end: float
    samples: int
    moment: float | None
    aggregates: list[Aggregate]


def aggregated(runs: Runs, numbers: Sequence[int], channel: str, *, begin: float | None = None, end: float | None = None,
               event: str = "") -> list[Aggregated]:  # fmt: skip
    """Those of each run. Raises UnknownError for a channel or an event that is not there, and a stretch without samples."""
    check_numbers(numbers)
    return [one(runs, run, channel, begin, end, event) for run in numbers]


def one(runs: Runs, run: int, channel: str, begin: float | None, end: float | None, event: str) -> Aggregated:
    """Those of a run."""
    columns = runs.trace(run, [channel])
    unit = next(each["unit"] for each in runs.channels(run) if each["name"] == channel)
    whole = columns["time"]
    if whole.size == 0:
        raise UnknownError(f"Run {run} recorded no sample.")
    first, last = (whole[0] if begin is None else begin), (whole[-1] if end is None else end)
    inside = (whole >= first - SAME_TIME) & (whole <= last + SAME_TIME)
    time, values = whole[inside], columns[channel][inside]
    if time.size == 0:
        problem = Problem(
            "begin, end", "hold no sample", f"{first:g} to {last:g} s", f"within {whole[0]:g} to {whole[-1]:g} s, begin before end"
        )
        raise UnknownError(f"Nothing of run {run} was recorded between these times.", [problem])
    moment = moment_of(runs, run, event, float(time[0]), float(time[-1])) if event else None
    found = aggregates(time, values, moment)
    return Aggregated(run, unit, float(time[0]), float(time[-1]), int(np.isfinite(values).sum()), moment, found)


def moment_of(runs: Runs, run: int, event: str, begin: float, end: float) -> float:
    """When the first event of a kind was in a stretch [s]."""
    known = runs.events(run)
    times = [each.time for each in known if each.kind == event and begin - SAME_TIME <= each.time <= end + SAME_TIME]
    if not times:
        kinds = sorted({each.kind for each in known if each.kind})
        remedy = nearest(event, kinds) or "another event, or a longer stretch"
        problem = Problem("event", "has not happened there", short(event), ", ".join(kinds) or "this run has no events", remedy)
        raise UnknownError(f"Run {run} has no such event between {begin:g} and {end:g} s.", [problem])
    return min(times)
