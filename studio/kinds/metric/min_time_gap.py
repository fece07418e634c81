"""Least time gap of a follower: the gap over its own speed, while it rolls."""

from studio.assess.safety import smallest

KIND = "metric"
TITLE = "Least time gap of a follower"
UNIT = "s"
BETTER = "higher"


def measure(record):
    """Time gap [s]; nothing when nobody followed anybody."""
    return smallest(record.of_followers("time_gap"))
