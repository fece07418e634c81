"""Cars of flows that were due and had not come in when the run was over, because there was no room where their ways begin."""

from studio.assess.census import number_of

KIND = "metric"
TITLE = "Never came in"
UNIT = "1"
BETTER = "lower"


def measure(record):
    """Number [1]; about a car of the first flow."""
    return number_of(record, "outside")
