"""Strongest jerk of a follower, to either side: the mean over 1 s, as ISO 15622 bounds that of an adaptive cruise control.

Where nobody follows in a chain, those count who had somebody ahead, and all where nobody had.
"""

import numpy as np

from studio.assess.comfort import is_long_enough, jerk
from studio.assess.search import greatest

KIND = "metric"
TITLE = "Strongest jerk of a follower, mean of 1 s"
UNIT = "m/s³"
BETTER = "lower"
WINDOW = 1.0  # [s]


def measure(record):
    """Jerk [m/s³], at the beginning of its second; nothing when the record is shorter than that."""
    if not is_long_enough(record.time, WINDOW):
        return float("nan")
    return greatest(record, np.abs(jerk(record.of_followers("acceleration"), record.time, WINDOW)), record.followers)
