"""Census: what was counted of all vehicles, traffic included, as a `Found` that names the first or the worst.

number_of(record, kind)    how many, about the first
longest(record, kind)      the greatest value, about whom it is; 0 when there was none
"""

from studio.execution.counted import Counted
from studio.execution.record import Record
from studio.kind.metric import Found


def counted(record: Record, kind: str) -> list[Counted]:
    """Everything of one kind, in the order of time."""
    return [each for each in record.counted if each.kind == kind]


def number_of(record: Record, kind: str) -> Found:
    """How many; about the first of them."""
    found = counted(record, kind)
    return about(float(len(found)), found[0]) if found else Found(0.0)


def longest(record: Record, kind: str) -> Found:
    """The longest; about the first of several."""
    found = counted(record, kind)
    if not found:
        return Found(0.0)
    worst = max(found, key=lambda each: each.value)
    return about(worst.value, worst)


def about(value: float, one: Counted) -> Found:
    """A value about one thing that was counted."""
    return Found(value, tuple(filter(None, (one.who, one.other))), one.time)
