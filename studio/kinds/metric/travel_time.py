"""Mean time that the vehicles which arrived took from the start of the run, or of the window, to the ends of their routes."""

import numpy as np

from studio.assess.total import mean

ARRIVED = "arrived"
KIND = "metric"
TITLE = "Mean travel time of those that arrived"
UNIT = "s"
BETTER = "lower"


def measure(record):
    """Time [s]; nothing when nobody arrived."""
    times = [event.time - record.time[0] for event in record.happenings if event.kind == ARRIVED]
    return mean(np.array(times))
