"""Comfort: how jerky the ride was."""

import numpy as np

WINDOW = 0.2  # [s] over which jerk is taken; shorter ones measure the actuators, not the ride


def jerk(acceleration: np.ndarray, time: np.ndarray) -> np.ndarray:
    """Change of acceleration over the window [m/s³], along the last axis."""
    period = time[1] - time[0]
    shift = max(round(WINDOW / period), 1)
    return (acceleration[..., shift:] - acceleration[..., :-shift]) / (shift * period)
