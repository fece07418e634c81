"""Census: what was counted of all vehicles, traffic included, as a `Found` that names the first or the worst.

number_of(record, kind)    how many, about the first
longest(record, kind)      the greatest value, about whom it is; 0 when there was none
"""

from math import nan

from studio.execution.counted import Counted
from studio.execution.record import Record
from studio.kind.metric import Found

NOT_KEPT = Found(nan, why="the run was broken off, and what was counted until then is not kept")


def counted(record: Record, *kinds: str) -> list[Counted]:
    """Everything of some kinds, in the order of time."""
    return [each for each in record.counted or () if each.kind in kinds]


def number_of(record: Record, kind: str) -> Found:
    """How many; about the first of them."""
    found = counted(record, kind)
    if record.counted is None:
        return NOT_KEPT
    return about(float(len(found)), found[0]) if found else Found(0.0)


def longest(record: Record, *kinds: str) -> Found:
    """The longest; about the first of several."""
    worst = max(counted(record, *kinds), key=lambda each: each.value, default=None)
    if record.counted is None:
        return NOT_KEPT
    return about(worst.value, worst) if worst else Found(0.0)


def about(value: float, one: Counted) -> Found:
    """A value about one thing that was counted."""
    return Found(value, tuple(filter(None, (one.who, one.other))), one.time)
