"""Greatest change of speed that a collision gave a vehicle, if both stayed together: Δv = m'/(m + m') v.

It tells best how badly people are hurt (L. Evans, Driver injury and fatality risk in two-car crashes versus mass ratio, Accident Analysis
and Prevention 26 (1994) 609). What stands fast has an infinite mass.
"""

from studio.assess.impact import speed_changes

KIND = "metric"
TITLE = "Greatest change of speed in a collision"
UNIT = "m/s"
BETTER = "lower"
ABOUT = "{0} hit by {1}"


def measure(record):
    """Δv [m/s] of the first one; nothing without a collision."""
    return max(speed_changes(record), default=float("nan"), key=lambda each: each.value)
