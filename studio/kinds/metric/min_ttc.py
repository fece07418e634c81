"""Least time to collision of any recorded vehicle: the gap over the closing speed, while it closes.

J. C. Hayward, Near miss determination through use of a scale of danger, 1972.
"""

from studio.assess.safety import smallest, ttc

KIND = "metric"
TITLE = "Least time to collision"
UNIT = "s"
BETTER = "higher"


def measure(record):
    """TTC [s]; nothing when nobody ever came nearer to anybody."""
    return smallest(ttc(record))
