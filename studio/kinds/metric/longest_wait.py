"""Longest time that a vehicle stood before it drove on, traffic included, for lights and others; a wait that goes on at the end counts.

It begins below 0.5 m/s and ends above 2 m/s; time between, in which one only moves up, is left out.
"""

from studio.assess.census import longest

KIND = "metric"
TITLE = "Longest wait"
UNIT = "s"
BETTER = "lower"


def measure(record):
    """Time [s]; about who waited, when it was over."""
    return longest(record, "waited")
