"""Least time to collision of any recorded vehicle: the gap over the closing speed, while it closes.

J. C. Hayward, Near miss determination through use of a scale of danger, 1972.
"""

from studio.assess.following import ttc
from studio.assess.search import least_behind

KIND = "metric"
TITLE = "Least time to collision"
UNIT = "s"
BETTER = "higher"
ABOUT = "{0} behind {1}"


def measure(record):
    """TTC [s]; nothing when nobody ever came nearer to anybody."""
    return least_behind(record, ttc(record))
