"""Longest time that a vehicle stood in a ring of vehicles each of which waits for the next, traffic included.

Rings are searched for once a second in the graph of whom every standing driver minds; a long queue before a light is none.
"""

from studio.assess.census import longest

KIND = "metric"
TITLE = "Longest deadlock"
UNIT = "s"
BETTER = "lower"


def measure(record):
    """Time [s], 0 when there was none; about one of the ring, when it was over."""
    return longest(record, "ring")
