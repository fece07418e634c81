"""Least bumper-to-bumper distance of any recorded vehicle to the vehicle or object ahead."""

from studio.assess.search import least_behind

KIND = "metric"
TITLE = "Least gap"
UNIT = "m"
BETTER = "higher"
ABOUT = "{0} behind {1}"


def measure(record):
    """Gap [m]; nothing when nobody had somebody ahead."""
    return least_behind(record, record.channel("gap"))
