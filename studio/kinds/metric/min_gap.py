"""Least bumper-to-bumper distance of any recorded vehicle to the vehicle ahead."""

from studio.assess.safety import smallest

KIND = "metric"
TITLE = "Least gap"
UNIT = "m"
BETTER = "higher"


def measure(record):
    """Gap [m]; nothing when nobody had somebody ahead."""
    return smallest(record.channel("gap"))
