"""Measuring: every metric of a record, and the goals that are not met."""

import math
import traceback
from collections.abc import Callable

from studio.assess.metric import Measured
from studio.execution.record import Record
from studio.kind import registry
from studio.kind.registry import Kind
from studio.scenario.schema import Goal


def measure_all(record: Record, tell: Callable[[str], None] = lambda text: None) -> dict[str, Measured]:
    """Every metric of a record; one that raises measures nothing, and is told with its traceback."""
    return {name: measured(each, record, tell) for name, each in registry.known("metric").items()}


def measured(kind: Kind, record: Record, tell: Callable[[str], None]) -> Measured:
    """One metric of a record. Not a number means that there was nothing to measure: it is empty then, and meets no goal."""
    try:
        value = float(kind.module.measure(record)) if record.time.size else math.nan
    except Exception:
        tell(f"The metric {kind.name!r} raised:\n{traceback.format_exc()}")
        value = math.nan
    return Measured(value if math.isfinite(value) else None, kind.module.UNIT, kind.module.BETTER)


def unmet(goals: dict[str, Goal], metrics: dict[str, Measured]) -> list[str]:
    """Sentences about the goals that are not met."""
    return [text for name, goal in goals.items() if (text := failing(name, goal, metrics.get(name)))]


def failing(name: str, goal: Goal, found: Measured | None) -> str:
    """Why a goal is not met, or nothing."""
    if found is None or found.value is None:
        return f"{name} could not be measured"
    if goal.least is not None and found.value < goal.least:
        return f"{name} is {found.value:.4g} {found.unit}, at least {goal.least:g} is wanted"
    if goal.most is not None and found.value > goal.most:
        return f"{name} is {found.value:.4g} {found.unit}, at most {goal.most:g} is wanted"
    return ""
