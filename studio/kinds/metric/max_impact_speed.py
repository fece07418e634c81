"""Greatest relative speed at which two vehicles, or a vehicle and an object, touched."""

from studio.assess.impact import impacts

KIND = "metric"
TITLE = "Greatest impact speed"
UNIT = "m/s"
BETTER = "lower"
ABOUT = "{0} and {1}"


def measure(record):
    """Speed [m/s]; nothing without a collision."""
    return max(impacts(record), default=float("nan"), key=lambda each: each.value)
