"""Least post-encroachment time: from one vehicle's leaving the area where two ways cross to another one's entering it.

B. L. Allen, B. T. Shin, P. J. Cooper, Analysis of traffic conflicts and collisions, Transportation Research Record 667 (1978) 67. Below
2 s it is a conflict; negative, both were there at once. Of recorded vehicles.
"""

from studio.assess.encroachment import encroachments

KIND = "metric"
TITLE = "Least post-encroachment time"
UNIT = "s"
BETTER = "higher"
ABOUT = "{0} after {1}"


def measure(record):
    """PET [s], when the second one enters; nothing when no two ways crossed."""
    return min(encroachments(record), default=float("nan"), key=lambda each: each.value)
