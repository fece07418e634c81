"""Strongest lateral acceleration of any recorded vehicle, to either side."""

import numpy as np

KIND = "metric"
TITLE = "Strongest lateral acceleration"
UNIT = "m/s²"
BETTER = "lower"


def measure(record):
    """Acceleration [m/s²]."""
    return np.nanmax(np.abs(record.channel("lateral_acceleration")))
