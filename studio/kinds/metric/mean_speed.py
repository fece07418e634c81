"""Mean speed of all recorded vehicles over the whole run."""

from studio.assess.total import mean

KIND = "metric"
TITLE = "Mean speed"
UNIT = "m/s"
BETTER = "higher"


def measure(record):
    """Speed [m/s]."""
    return mean(record.channel("speed"))
