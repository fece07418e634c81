"""What is told of a channel in one number: its least, greatest and mean value, percentiles, and its value at a moment.

With the samples x_1 ≤ x_2 ≤ … ≤ x_n that are numbers, put in order, the quantile p lies at the place h = 1 + (n - 1) p between two of them:

    x_p = x_k + (h - k) (x_(k+1) - x_k),    k = ⌊h⌋

which is type 7 of Hyndman & Fan, "Sample quantiles in statistical packages", The American Statistician 50 (1996) 361-365. The mean is that
of the samples, which are evenly spaced in time. At a moment counts the last sample that is not after it: later ones were not yet.
"""

from typing import NamedTuple

import numpy as np

from studio.execution.record import SAME_TIME

MEANINGS = {
    "min": "the least sample that is a number",
    "max": "the greatest sample that is a number",
    "mean": "mean of all samples that are numbers",
    "p5": "5th percentile of these samples, linear between two",
    "p95": "95th percentile of these samples, linear between two",
    "at_event": "the last sample not after the event",
}


class Aggregate(NamedTuple):
    """One number about samples: of which kind, in the samples' unit, None where there is none, and when it was [s] if it was at a time."""

    kind: str
    value: float | None
    time: float | None = None


def aggregates(time: np.ndarray, values: np.ndarray, moment: float | None = None) -> list[Aggregate]:
    """All of float64[n] values at float64[n] times [s]; that at a moment [s] is None without one."""
    there = np.isfinite(values)
    x, t = values[there], time[there]
    if x.size == 0:
        return [Aggregate(kind, None) for kind in MEANINGS]
    least, most = int(x.argmin()), int(x.argmax())
    p5, p95 = np.percentile(x, [5, 95])
    return [
        Aggregate("min", float(x[least]), float(t[least])),
        Aggregate("max", float(x[most]), float(t[most])),
        Aggregate("mean", float(x.mean())),
        Aggregate("p5", float(p5)),
        Aggregate("p95", float(p95)),
        at(time, values, moment),
    ]


def at(time: np.ndarray, values: np.ndarray, moment: float | None) -> Aggregate:
    """The value of the last sample not after a moment; None when it is no number, or there is no such sample."""
    last = -1 if moment is None else int(np.searchsorted(time, moment + SAME_TIME, side="right")) - 1
    return (
        Aggregate("at_event", float(values[last]), float(time[last]))
        if last >= 0 and np.isfinite(values[last])
        else Aggregate("at_event", None)
    )
