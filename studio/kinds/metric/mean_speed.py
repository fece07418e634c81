"""Mean speed of all recorded vehicles over the whole run."""

import numpy as np

KIND = "metric"
TITLE = "Mean speed"
UNIT = "m/s"
BETTER = "higher"


def measure(record):
    """Speed [m/s]."""
    return np.nanmean(record.channel("speed"))
