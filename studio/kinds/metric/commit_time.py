"""Longest time from a request for a maneuver to its commitment, of the maneuvers that were agreed on.

By the messages of the kind `maneuver`: the first request of a unit with a number, and its first commitment with the same number.
"""

from studio.assess.agreement import agreements

KIND = "metric"
TITLE = "Longest time from request to commitment"
UNIT = "s"
BETTER = "lower"
ABOUT = "{0}"


def measure(record):
    """Time [s]; nothing when no maneuver was agreed on."""
    return max(agreements(record), default=float("nan"), key=lambda each: each.value)
