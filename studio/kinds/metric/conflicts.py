"""Conflicts of right of way: a vehicle enters a place where it gives way while one that goes first is on its way there.

That is, nearer than 30 m and 8 s of driving, and not held by a light. Of all vehicles, traffic included, on ways through junctions.
"""

from studio.assess.census import number_of

KIND = "metric"
TITLE = "Conflicts of right of way"
UNIT = "1"
BETTER = None
ABOUT = "{0} before {1}"


def measure(record):
    """Number [1]; about the first."""
    return number_of(record, "conflict")
