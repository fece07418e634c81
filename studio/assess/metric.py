"""The value of a metric in a run. What metrics there are the registry of kinds knows; each is a file in studio/kinds/metric."""

from dataclasses import dataclass
from typing import Literal

Direction = Literal["higher", "lower"] | None


@dataclass(frozen=True)
class Measured:
    """The value of a metric in a run; None when there was nothing to measure. `goal` says which direction is better.

    `subject` are the vehicles that it is about, `time` [s] is when; None when it is about the whole run. `kind` names the metric, and
    `about` tells subject and time in words, or why there was nothing to measure.
    """

    value: float | None
    unit: str
    goal: Direction
    subject: tuple[str, ...] = ()
    time: float | None = None
    kind: str = ""
    about: str = ""
