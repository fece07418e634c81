"""Maneuvers that who had asked for them has taken back: nobody answered in time, one refused, or one did not do what it had told.

By the messages of the kind `maneuver` with the step 6, each number of each unit once.
"""

from studio.assess.agreement import aborted

KIND = "metric"
TITLE = "Maneuvers aborted"
UNIT = "1"
BETTER = "lower"


def measure(record):
    """Number [1]; nothing when no maneuver was asked for."""
    return aborted(record)
