"""Mean gap of the followers, while somebody is ahead: how much road a platoon needs."""

import numpy as np

KIND = "metric"
TITLE = "Mean gap of the followers"
UNIT = "m"
BETTER = "lower"


def measure(record):
    """Gap [m]; nothing when nobody followed anybody."""
    gap = record.of_followers("gap")
    return np.mean(gap[np.isfinite(gap)]) if np.isfinite(gap).any() else float("nan")
