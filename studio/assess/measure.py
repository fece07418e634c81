"""Measuring: every metric of a record, and the goals that are not met."""

import math

from studio.assess import comfort, cooperation, safety, string_stability, traffic  # noqa: F401 - they register
from studio.assess.metric import Measured, Metric, registered
from studio.execution.record import Record
from studio.scenario.schema import Goal


def measure_all(record: Record) -> dict[str, Measured]:
    """Every metric of a record."""
    return {name: measured(each, record) for name, each in registered().items()}


def measured(each: Metric, record: Record) -> Measured:
    """One metric of a record."""
    value = float(each.measure(record)) if record.time.size else math.nan
    return Measured(value if math.isfinite(value) else None, each.unit, each.goal)


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
