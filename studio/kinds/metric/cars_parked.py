"""Cars that have been parked by a garage and stood in their spaces."""

from studio.assess.parking import parking_times

KIND = "metric"
TITLE = "Cars parked by a garage"
UNIT = "1"
BETTER = "higher"


def measure(record):
    """Number [1]."""
    return float(sum(1 for _ in parking_times(record)))
