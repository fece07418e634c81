"""Metrics: a number per run, with its unit and which direction is better.

A metric is a function from a Record to a float, registered under a name. Not a number means: this record has nothing to
measure it on (no platoon, nobody ahead); it is stored as empty, and no goal is met by it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from inspect import getdoc
from typing import TYPE_CHECKING, Literal

from studio.errors import StudioError

if TYPE_CHECKING:  # values of metrics are read where nothing is simulated
    from studio.execution.record import Record

Direction = Literal["higher", "lower"] | None


@dataclass(frozen=True)
class Metric:
    """A registered metric; `goal` says which direction is better."""

    name: str
    unit: str
    goal: Direction
    title: str
    measure: Callable[["Record"], float]

    @property
    def explanation(self) -> str:
        """What exactly is measured, as its function says; empty when that says nothing."""
        return getdoc(self.measure) or ""


@dataclass(frozen=True)
class Measured:
    """The value of a metric in a run; None when there was nothing to measure."""

    value: float | None
    unit: str
    goal: Direction


_registered: dict[str, Metric] = {}


def metric(name: str, *, unit: str, goal: Direction, title: str):
    """Decorator that registers a metric; a name can be given once."""

    def register(measure: Callable[["Record"], float]) -> Callable[["Record"], float]:
        if name in _registered:
            raise StudioError(f"The metric name {name!r} is taken.")
        _registered[name] = Metric(name, unit, goal, title, measure)
        return measure

    return register


def registered() -> dict[str, Metric]:
    """The metrics registered so far, by name."""
    return dict(_registered)
