"""Scope: the part of a record that a metric looks at, from a moment to a moment and of some vehicles.

scoped(record, scope)   →  Record, or None when its beginning never came
"""

from studio.execution.happening import Happening
from studio.execution.record import Record
from studio.kind.metric import Moment, Scope

BEGINS = "script_begun"  # what is meant when an entry of the script is named, and no event


def scoped(record: Record, scope: Scope) -> Record | None:
    """The part that is asked for."""
    begin = moment(record, scope.begin, 0.0) if scope.begin else 0.0
    if begin is None:
        return None
    end = moment(record, scope.end, begin) if scope.end else None
    part = record if scope.begin is None and end is None else record.between(begin, end)
    return part.of(scope.vehicles) if scope.vehicles else part


def moment(record: Record, wanted: Moment, since: float) -> float | None:
    """When a moment is [s]; of an event, the first that is not before `since`; None when it never comes."""
    if not wanted.is_of_an_event:
        return wanted.at
    times = [event.time for event in record.happenings if event.time >= since and fits(event, wanted)]
    return min(times) + wanted.at if times else None


def fits(event: Happening, wanted: Moment) -> bool:
    """Whether an event is one of those that are meant."""
    kind = wanted.event or BEGINS
    is_about = wanted.unit is None or wanted.unit in event.units
    return event.kind == kind and is_about and wanted.entry in (None, event.words.get("entry"))
