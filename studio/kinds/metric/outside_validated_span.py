"""Share of the time that a vehicle drove as it was never compared with the real one; the vehicle that did so most counts.

A vehicle file may say for what its car was validated against recorded drives: speed, longitudinal and lateral acceleration, yaw rate
(`studio validate --out`). Outside of that a result may be right, but nothing says so. What led outside farthest, in its own span's
width, is told with it. Vehicles without such a span, and light ones, do not count.
"""

from math import nan

import numpy as np

from studio.assess.beyond import outside
from studio.kind.metric import Found

KIND = "metric"
TITLE = "Time outside the validated span"
UNIT = "1"
BETTER = "lower"
ABOUT = "{0}, by its {1}"


def measure(record):
    """Share [1]."""
    found = outside(record)
    if not found:
        return Found(nan, why="no vehicle here has a validated span")
    return max(found, key=lambda each: np.nan_to_num(each.value))
