"""Two runs side by side: the parameters that differ, and every metric with its difference and what is better."""

from dataclasses import dataclass
from math import isclose
from typing import Any, Literal

from studio.assess.metric import Direction, Measured
from studio.scenario.edit import flatten

# [1] Of the greater value: what differs by less is the same. Other draws of the sensors' noise alone move 31 of the 32 measured
# metrics of the motorway sample by up to 0.9 %, so nobody can tell such a difference from chance.
ALIKE = 0.01
# In any unit: a millimetre, a millisecond. Nobody measures finer on the road, and a share of less than that is a share of nothing:
# between offsets of 1e-6 m and 7e-6 m lie 600 %, and no difference.
FINEST = 1e-3


@dataclass(frozen=True)
class ParameterDifference:
    """A parameter that differs; None where a run does not have it."""

    path: str
    a: Any
    b: Any
    unit: str = ""


@dataclass(frozen=True)
class MetricDifference:
    """A metric of both runs. `difference` is b - a, `relative` is that over |a|, where that is more than anybody could measure."""

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


def metrics(a: dict[str, Measured], b: dict[str, Measured], is_ranked: bool = True) -> list[MetricDifference]:
    """Every metric that one of the runs has; `is_ranked` says whether one may be better."""
    names = [*a, *(name for name in b if name not in a)]
    return [metric(name, a.get(name), b.get(name), is_ranked) for name in names]


def metric(name: str, a: Measured | None, b: Measured | None, is_ranked: bool = True) -> MetricDifference:
    """One metric."""
    known = a or b
    assert known, f"no run has {name}"
    left, right = (each.value if each else None for each in (a, b))
    if left is None or right is None:
        return MetricDifference(name, known.unit, known.goal, left, right, None, None, None)
    difference = right - left
    relative = difference / abs(left) if abs(left) > FINEST else None
    found = better(left, right, known.goal) if is_ranked else None
    return MetricDifference(name, known.unit, known.goal, left, right, difference, relative, found)


def better(a: float, b: float, goal: Direction) -> Literal["a", "b", "same"] | None:
    """Which of two values is better; nothing when the metric has no direction.

    Neither where chance alone may be the difference, or nobody could measure it.
    """
    if isclose(a, b, rel_tol=ALIKE, abs_tol=FINEST):
        return "same"
    if goal is None:
        return None
    return "b" if (b > a) == (goal == "higher") else "a"
