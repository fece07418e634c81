"""Greatest distance that a car has driven into its space, over the length of the shortest way that the garage knows."""

from studio.assess.parking import detours

KIND = "metric"
TITLE = "Driven over shortest way into a space"
UNIT = "1"
BETTER = "lower"
ABOUT = "{0}"


def measure(record):
    """Ratio [1]; nothing when nobody has parked."""
    return max(detours(record), default=float("nan"), key=lambda each: each.value)
