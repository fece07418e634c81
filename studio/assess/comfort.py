"""Comfort: how jerky the ride was."""

import numpy as np

from studio.assess.metric import metric
from studio.execution.record import Record

WINDOW = 0.2  # [s] over which jerk is taken; shorter ones measure the actuators, not the ride


def jerk(acceleration: np.ndarray, time: np.ndarray) -> np.ndarray:
    """Change of acceleration over the window [m/s³], along the last axis."""
    period = time[1] - time[0]
    shift = max(round(WINDOW / period), 1)
    return (acceleration[..., shift:] - acceleration[..., :-shift]) / (shift * period)


@metric("jerk_rms", unit="m/s³", goal="lower", title="Jerk of the followers, root mean square")
def jerk_rms(record: Record) -> float:
    """Root mean square over the followers and the whole run."""
    if record.time.size < 2 + WINDOW / (record.time[-1] / max(record.time.size - 1, 1) or 1.0):
        return float("nan")
    return float(np.sqrt(np.nanmean(jerk(record.of_followers("acceleration"), record.time) ** 2)))


@metric("max_lateral_acceleration", unit="m/s²", goal="lower", title="Strongest lateral acceleration")
def max_lateral_acceleration(record: Record) -> float:
    """Of any recorded vehicle."""
    return float(np.nanmax(np.abs(record.channel("lateral_acceleration"))))
