"""Time gap: the gap to the car ahead over the own speed, while the car moves."""

import numpy as np

KIND = "channel"
TITLE = "Time gap to the car ahead"
UNIT = "s"
ROLLING = 0.5  # [m/s] below this speed a time gap says nothing


def trace(read):
    """float64[vehicle, n] [s]; not a number while nobody is ahead, or while it stands."""
    speed = read("speed")
    return np.where(speed > ROLLING, read("gap") / np.maximum(speed, ROLLING), np.nan)
