"""Longest time from the handing over of a car to its garage until it stands in its space."""

from studio.assess.parking import parking_times

KIND = "metric"
TITLE = "Longest time to park"
UNIT = "s"
BETTER = "lower"
ABOUT = "{0}"


def measure(record):
    """Time [s]; nothing when nobody has parked."""
    return max(parking_times(record), default=float("nan"), key=lambda each: each.value)
