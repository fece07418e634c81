"""Root mean square of the jerk of the followers, over the whole run.

Jerk is the change of acceleration over 0.2 s (studio/assess/comfort.py says why). Passengers feel it before they feel the
acceleration itself. Where nobody follows in a chain, those count who had somebody ahead,
and all where nobody had.
"""

from math import sqrt

from studio.assess.comfort import WINDOW, is_long_enough, jerk
from studio.assess.total import mean

KIND = "metric"
TITLE = "Jerk of the followers, root mean square"
UNIT = "m/s³"
BETTER = "lower"


def measure(record):
    """Jerk [m/s³]; nothing when the record is shorter than the window."""
    if not is_long_enough(record.time, WINDOW):
        return float("nan")
    return sqrt(mean(jerk(record.of_followers("acceleration"), record.time) ** 2))
