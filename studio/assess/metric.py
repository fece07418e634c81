"""Metrics: a number per run, with its unit and which direction is better.

A metric is a function from a Record to a float, registered under a name. Not a number means: this record has nothing to
measure it on (no platoon, nobody ahead); it is stored as empty, and no goal is met by it.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from studio.errors import StudioError
from studio.execution.record import Record
from studio.scenario.schema import Goal

Direction = Literal["higher", "lower"] | None


@dataclass(frozen=True)
class Metric:
    """A registered metric; `goal` says which direction is better."""

    name: str
    unit: str
    goal: Direction
    title: str
    measure: Callable[[Record], float]


@dataclass(frozen=True)
class Measured:
    """The value of a metric in a run; None when there was nothing to measure."""

    value: float | None
    unit: str
    goal: Direction


_registered: dict[str, Metric] = {}


def metric(name: str, *, unit: str, goal: Direction, title: str):
    """Decorator that registers a metric; a name can be given once."""

    def register(measure: Callable[[Record], float]) -> Callable[[Record], float]:
        if name in _registered:
            raise StudioError(f"The metric name {name!r} is taken.")
        _registered[name] = Metric(name, unit, goal, title, measure)
        return measure

    return register


def known() -> dict[str, Metric]:
    """All metrics by name."""
    from studio.assess import comfort, cooperation, safety, string_stability, traffic  # noqa: F401 - they register

    return dict(_registered)


def measure_all(record: Record) -> dict[str, Measured]:
    """Every metric of a record."""
    return {name: measured(each, record) for name, each in known().items()}


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
