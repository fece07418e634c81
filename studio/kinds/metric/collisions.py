"""Pairs of vehicles, traffic included, whose bodies touched."""

KIND = "metric"
TITLE = "Collisions"
UNIT = "1"
BETTER = "lower"


def measure(record):
    """Number of pairs [1]."""
    return sum(event.text.startswith("collision") for event in record.happenings)
