"""Runs that are far from the others of their maneuver: hints for who looks at them. No verdict changes by them, and no run is left out.

Grubbs' test for one outlier among n values (F. E. Grubbs, Technometrics 11 (1969) 1; NIST/SEMATECH e-Handbook of Statistical Methods,
1.3.5.17.1), two-sided at the level p = 1 %: the value farthest from the mean is one where

    G = max |x_i - x̄| / s  >  (n - 1) / √n · √(t² / (n - 2 + t²)),   t = t⁻¹(1 - p / 2n, n - 2)

It takes three values, and finds one outlier and not two that hide each other. Repetitions that differ less from the mean of the others than
the criterion allows the simulation are not named: with many quantities one in a hundred would be, by chance.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from scipy import stats

from studio.log.recording import Recording
from studio.validation.criterion import Limits, Measure
from studio.validation.table import quantity

LEVEL = 0.01  # [1] of the test: how often it names one of values that are all alike
REMEDY = "look at its sign, its units and its cut, and leave it out only with a reason"


def farthest(values: np.ndarray) -> int | None:
    """Which one is an outlier; none without one, or of fewer than three values."""
    count, spread = values.size, float(np.std(values, ddof=1)) if values.size >= 3 else 0.0
    if not (np.isfinite(values).all() and spread > 0.0):
        return None
    away = np.abs(values - values.mean()) / spread
    return int(away.argmax()) if away.max() > bound(count) else None


def bound(count: int) -> float:
    """Of G for so many values."""
    t = stats.t.ppf(1.0 - LEVEL / (2 * count), count - 2)
    return float((count - 1) / np.sqrt(count) * np.sqrt(t**2 / (count - 2 + t**2)))


def hints(maneuver: str, runs: Sequence[Recording], measures: Sequence[Measure], limits: Limits) -> list[str]:
    """The outliers of a maneuver in words, a run each with all that it is far off in."""
    found: dict[int, list[str]] = {}
    for each in measures:
        for i, words in far(each, limits):
            found.setdefault(i, []).append(words)
    return [
        f"{maneuver}: {called(runs[i])} is far from the other runs in {'; '.join(words)} (Grubbs' test, {100 * LEVEL:g} %): {REMEDY}"
        for i, words in found.items()
    ]


def far(found: Measure, limits: Limits) -> Iterator[tuple[int, str]]:
    """The run whose value is far off, with both values."""
    i = farthest(found.theirs)
    if i is None:
        return
    own, others = float(found.theirs[i]), float(np.delete(found.theirs, i).mean())
    allowed = {"gain": limits.gain * abs(others), "lag": limits.lag, "time": limits.time}.get(found.rule, 0.0)
    if abs(own - others) > allowed:
        yield i, f"{found.name}, {quantity(own, found.unit)} where the others have {quantity(others, found.unit)} in the mean"


def called(run: Recording) -> str:
    """A run by its log, and where it begins in it."""
    return f"{run.name} from {run.start:g} s" if run.start > 0.0 else run.name
