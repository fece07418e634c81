"""Two runs side by side: the parameters that differ, and every metric with its difference and what is better."""

from dataclasses import dataclass
from typing import Any, Literal

from studio.assess.metric import Direction, Measured
from studio.scenario.edit import flatten

SAME = 1e-9  # relative difference below which two values are the same


@dataclass(frozen=True)
class ParameterDifference:
    """A parameter that differs; None where a run does not have it."""

    path: str
    a: Any
    b: Any
    unit: str = ""


@dataclass(frozen=True)
class MetricDifference:
    """A metric of both runs. `difference` is b - a, `relative` is that over |a|."""

    name: str
    unit: str
    goal: Direction
    a: float | None
    b: float | None
    difference: float | None
    relative: float | None
    better: Literal["a", "b", "same"] | None


def parameters(a: dict[str, Any], b: dict[str, Any]) -> list[ParameterDifference]:
    """Leaves of two documents that differ; one that stands on one side only is shown, not dropped."""
    left, right = flatten(a), flatten(b)
    paths = [*left, *(path for path in right if path not in left)]
    return [ParameterDifference(path, left.get(path), right.get(path)) for path in paths if left.get(path) != right.get(path)]


def metrics(a: dict[str, Measured], b: dict[str, Measured]) -> list[MetricDifference]:
    """Every metric that one of the runs has."""
    names = [*a, *(name for name in b if name not in a)]
    return [metric(name, a.get(name), b.get(name)) for name in names]


def metric(name: str, a: Measured | None, b: Measured | None) -> MetricDifference:
    """One metric."""
    known = a or b
    assert known, f"no run has {name}"
    left, right = (each.value if each else None for each in (a, b))
    if left is None or right is None:
        return MetricDifference(name, known.unit, known.goal, left, right, None, None, None)
    difference = right - left
    relative = difference / abs(left) if left else None
    return MetricDifference(name, known.unit, known.goal, left, right, difference, relative, better(left, right, known.goal))


def better(a: float, b: float, goal: Direction) -> Literal["a", "b", "same"] | None:
    """Which of two values is better; nothing when the metric has no direction."""
    if abs(b - a) <= SAME * max(abs(a), abs(b)):
        return "same"
    if goal is None:
        return None
    return "b" if (b > a) == (goal == "higher") else "a"
