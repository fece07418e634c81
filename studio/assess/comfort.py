"""Comfort: how jerky the ride was."""

import numpy as np

WINDOW = 0.2  # [s] over which jerk is taken; shorter ones measure the actuators, not the ride


def jerk(acceleration: np.ndarray, time: np.ndarray, window: float = WINDOW) -> np.ndarray:
    """Change of acceleration over a window [m/s³], along the last axis: the mean jerk within it."""
    period = time[1] - time[0]
    shift = max(round(window / period), 1)
    return (acceleration[..., shift:] - acceleration[..., :-shift]) / (shift * period)


def is_long_enough(time: np.ndarray, window: float) -> bool:
    """Whether a record is longer than a window [s]."""
    return time.size >= 2 and time[-1] - time[0] >= window + time[1] - time[0]
