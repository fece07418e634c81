"""Mean time from the handing over of a car to its garage until it stands in its space."""

import numpy as np

from studio.assess.parking import parking_times
from studio.assess.total import mean

KIND = "metric"
TITLE = "Mean time to park"
UNIT = "s"
BETTER = "lower"


def measure(record):
    """Time [s]; nothing when nobody has parked."""
    return mean(np.array([each.value for each in parking_times(record)]))
