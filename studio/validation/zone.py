"""Experimental data zones: where the mean of repeated runs lies, with the confidence that is asked for (Eq. 16).

    {low, high} = mean ∓ T s / √n,   T = t⁻¹(p, n - 1)

s is the standard deviation of the runs (n - 1 in its denominator), T the quantile of Student's distribution. For 95 % two-sided
p = 0.975. The paper writes t_inv(0.95, ·), which leaves 5 % on one side and 10 % outside: that is `one-sided`.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy import stats

Confidence = Literal["two-sided", "one-sided"]
QUANTILE: dict[Confidence, float] = {"two-sided": 0.975, "one-sided": 0.95}
WORDS: dict[Confidence, str] = {
    "two-sided": "95 % confidence interval of the mean, two-sided, t(0.975, n - 1)",
    "one-sided": "one-sided 95 % bounds of the mean, t(0.95, n - 1): a two-sided interval of 90 %",
}


@dataclass(frozen=True)
class Zone:
    """Mean and bounds, of one number or over time, and of how many runs; without a second run there are no bounds."""

    mean: np.ndarray
    low: np.ndarray
    high: np.ndarray
    count: np.ndarray

    def holds(self, values: np.ndarray) -> np.ndarray:
        """Where values lie inside, bounds included; False where there are none."""
        return (values >= self.low) & (values <= self.high)


def quantile(count, confidence: Confidence = "two-sided"):
    """T for so many runs; not a number for less than two."""
    count = np.asarray(count, dtype=float)
    return np.where(count >= 2, stats.t.ppf(QUANTILE[confidence], np.maximum(count - 1.0, 1.0)), np.nan)


def zone(runs, confidence: Confidence = "two-sided") -> Zone:
    """The zone of runs [run, ...]; where a run says nothing (not a number), the others count."""
    runs = np.asarray(runs, dtype=float)
    known = np.isfinite(runs)
    count = known.sum(axis=0)
    mean = np.where(known, runs, 0.0).sum(axis=0) / np.where(count > 0, count, np.nan)
    spread = np.sqrt((np.where(known, runs - mean, 0.0) ** 2).sum(axis=0) / np.where(count > 1, count - 1, np.nan))
    half = quantile(count, confidence) * spread / np.sqrt(np.maximum(count, 1))
    return Zone(mean, mean - half, mean + half, count)
