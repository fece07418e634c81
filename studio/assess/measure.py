"""Measuring: every metric of a record, as usual and as the scenario asks for it."""

import math
import traceback
from collections.abc import Callable, Mapping
from typing import Any

from studio.assess.intact import intact
from studio.assess.metric import Measured
from studio.assess.scope import scoped
from studio.execution.record import Record
from studio.kind import registry
from studio.kind.metric import Found, Scope
from studio.kind.registry import Kind


def measure_all(
    record: Record, listed: Mapping[str, Any] | None = None, tell: Callable[[str], None] = lambda text: None
) -> dict[str, Measured]:
    """The measures that are listed, as the scenario has them, then every metric that none of them has the name of.

    Everything is looked at in the order of names, so that nothing hangs on the order in a scenario's file. One that raises measures
    nothing, and is told with its traceback. Nothing counts of a vehicle from its first collision on.
    """
    record = intact(record.ordered())
    known, listed = registry.known("metric"), listed or {}
    asked = {name: known[each.kind] for name, each in listed.items()} | {name: known[name] for name in known if name not in listed}
    return {name: measured(each, record, listed.get(name), tell) for name, each in asked.items()}


def measured(kind: Kind, record: Record, scope: Scope | None, tell: Callable[[str], None]) -> Measured:
    """One metric of a record. Not a number means that there was nothing to measure: it is empty then, and meets no goal."""
    try:
        found = found_by(kind, record, scope or usual(kind))
    except Exception:
        tell(f"The metric {kind.name!r} raised:\n{traceback.format_exc()}")
        found = Found(math.nan)
    if not math.isfinite(found.value):
        return Measured(None, kind.module.UNIT, kind.module.BETTER, kind=kind.name, about=found.why)
    time = round(float(found.time), 6) if math.isfinite(found.time) else None
    subject, about = tuple(found.subject), told(kind, found, time)
    return Measured(float(found.value), kind.module.UNIT, kind.module.BETTER, subject, time, kind.name, about)


def usual(kind: Kind) -> Scope:
    """The settings of a metric that nobody has set."""
    made = kind.settings.model_validate({}) if kind.settings else None
    assert isinstance(made, Scope), "every metric has a scope"
    return made


def found_by(kind: Kind, record: Record, scope: Scope) -> Found:
    """What a metric finds in the part of a record that it is to look at."""
    part = scoped(record, scope)
    if part is None or not part.time.size:
        return Found(math.nan, why="its window never began" if part is None else "nothing was recorded in its window")
    found = kind.module.measure(part, scope) if hasattr(kind.module, "Settings") else kind.module.measure(part)
    return found if isinstance(found, Found) else Found(float(found))


def told(kind: Kind, found: Found, time: float | None) -> str:
    """Subject and time in words."""
    names = getattr(kind.module, "ABOUT", "")
    fits = names and names.count("{") == len(found.subject)
    who = names.format(*found.subject) if fits else " and ".join(found.subject)
    return f"{who} at {time:.2f} s".strip() if time is not None else who
