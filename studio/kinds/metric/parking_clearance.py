"""Least distance of a car that drives itself in a garage to another car, a pillar or a wall of the drawn deck; five times a second."""

from studio.assess.parking import clearance

KIND = "metric"
TITLE = "Least clearance in the garage"
UNIT = "m"
BETTER = "higher"
ABOUT = "{0} and {1}"


def measure(record):
    """Distance [m], outline to outline; nothing when nobody was handed over."""
    return clearance(record)
