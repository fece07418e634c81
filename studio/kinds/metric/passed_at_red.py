"""Stop lines whose light showed red when the front of a vehicle passed them, traffic included. Amber does not count."""

from studio.assess.census import number_of

KIND = "metric"
TITLE = "Red lights passed"
UNIT = "1"
BETTER = "lower"


def measure(record):
    """Number [1]; about the first."""
    return number_of(record, "at red")
