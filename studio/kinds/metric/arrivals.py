"""Vehicles that have come to the ends of their ways, traffic included: that which comes in again counts each time."""

from studio.assess.census import number_of

KIND = "metric"
TITLE = "Arrivals"
UNIT = "1"
BETTER = "higher"


def measure(record):
    """Number [1]; about the first."""
    return number_of(record, "arrived")
