"""Strongest deceleration of a follower: how hard the cars behind the first of a chain had to brake.

Where nobody follows in a chain, those count who had somebody ahead, and all where nobody had, those that the script brakes too.
"""

from studio.assess.search import greatest

KIND = "metric"
TITLE = "Strongest deceleration of a follower"
UNIT = "m/s²"
BETTER = "lower"


def measure(record):
    """Deceleration [m/s²]."""
    return greatest(record, -record.of_followers("acceleration"), record.followers)
