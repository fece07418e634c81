"""Strongest lateral acceleration of any recorded vehicle, to either side."""

import numpy as np

from studio.assess.search import greatest

KIND = "metric"
TITLE = "Strongest lateral acceleration"
UNIT = "m/s²"
BETTER = "lower"


def measure(record):
    """Acceleration [m/s²]."""
    return greatest(record, np.abs(record.channel("lateral_acceleration")))
