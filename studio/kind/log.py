"""What a log holds, and a format of logs gives: signals over their own times, and what can be said of one: rate, gaps, range.

Log(path.name, {"yaw rate": signal("yaw rate", "deg/s", times, values)})
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from studio.errors import Problem, ScenarioError, UnknownError, nearest

SHARED = 0.1  # [1] of the samples that may have the time of another: where more do, times have lost digits
GAP = 3.0  # [1] of the usual time between two samples: more than this between them is a gap


@dataclass(frozen=True)
class Signal:
    """One recorded quantity: times [s] that rise, values in `unit`, which is "" where the log does not say."""

    name: str
    unit: str
    time: np.ndarray
    values: np.ndarray

    @property
    def is_number(self) -> np.ndarray:
        """Which samples say something."""
        return np.isfinite(self.values)

    @property
    def period(self) -> float:
        """Usual time between two samples [s]: the median."""
        known = self.time[self.is_number]
        return float(np.median(np.diff(known))) if known.size > 1 else float("nan")

    def gaps(self) -> list[tuple[float, float]]:
        """From when to when [s] nothing was recorded."""
        known = self.time[self.is_number]
        wide = np.flatnonzero(np.diff(known) > GAP * self.period)
        return [(float(known[i]), float(known[i + 1])) for i in wide]

    def facts(self) -> dict[str, Any]:
        """Unit, count, rate, gaps and range, as plain data."""
        known = self.values[self.is_number]
        span = [float(known.min()), float(known.max())] if known.size else [None, None]
        rate = 1.0 / self.period if known.size > 1 and self.period > 0.0 else None
        return {
            "name": self.name, "unit": self.unit, "count": int(known.size), "rate": rate, "gaps": self.gaps(),
            "from": float(self.time[0]) if self.time.size else None, "to": float(self.time[-1]) if self.time.size else None,
            "low": span[0], "high": span[1],
        }  # fmt: skip


@dataclass(frozen=True)
class Log:
    """A recorded drive: where it comes from, and its signals by name."""

    name: str
    signals: Mapping[str, Signal]

    def __getitem__(self, name: str) -> Signal:
        """One signal; raises UnknownError that names the nearest."""
        if name not in self.signals:
            raise UnknownError(f"{self.name} has no signal {name!r}; {nearest(name, self.signals)}")
        return self.signals[name]


def signal(name: str, unit: str, time: np.ndarray, values: np.ndarray) -> Signal:
    """A signal whose times rise: samples are put in order, of equal times the last one counts, and what is not a number is none.

    Raises ScenarioError for a clock that jumps back, or that many samples share: putting those in order would lose a part of the drive.
    """
    time, values = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    known = np.flatnonzero(np.isfinite(time) & np.isfinite(values))
    runs_on(name, time[known])
    order = known[np.argsort(time[known], kind="stable")]
    time, values = time[order], values[order]
    last = np.append(np.diff(time) > 0.0, True)[: time.size]
    tells_apart(name, time)
    return Signal(name, unit, time[last], values[last])


def runs_on(name: str, time: np.ndarray) -> None:
    """Refuses times that jump back by more than samples that come late do; raises ScenarioError."""
    steps = np.diff(time)
    if not steps.size or steps.min() >= 0.0:
        return
    at, usual = int(np.argmin(steps)), float(np.median(np.abs(steps)))
    if -steps[at] > GAP * usual:
        what = f"has a clock that jumps back by {-steps[at]:.6g} s, after sample {at + 1} of {time.size}"
        remedy = "cut the log there into two, or record it again with one clock"
        raise ScenarioError(
            "The clock of a log runs back.",
            [Problem(name, what, f"{time[at]:.10g} s, then {time[at + 1]:.10g} s", "times that rise", remedy)],
        )


def tells_apart(name: str, time: np.ndarray) -> None:
    """Refuses times in their order that many samples share; raises ScenarioError."""
    shared = int((np.diff(time) == 0.0).sum())
    if shared > SHARED * time.size:
        what = f"has {shared} of {time.size} samples at the time of another"
        remedy = "write times with as many digits as tell samples apart, and drives that follow each other into logs of their own"
        raise ScenarioError("The clock of a log does not tell its samples apart.", [Problem(name, what, remedy=remedy)])
