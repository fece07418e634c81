"""Strongest deceleration of a follower: how hard the cars had to brake that were not told to by the script."""

from studio.assess.search import greatest

KIND = "metric"
TITLE = "Strongest deceleration of a follower"
UNIT = "m/s²"
BETTER = "lower"


def measure(record):
    """Deceleration [m/s²]."""
    return greatest(record, -record.of_followers("acceleration"), record.followers)
