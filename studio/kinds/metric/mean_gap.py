"""Mean gap of the followers, while somebody is ahead: how much road a platoon needs.

Where nobody follows in a chain, those count who had somebody ahead, and all where nobody had.
"""

from studio.assess.total import mean

KIND = "metric"
TITLE = "Mean gap of the followers"
UNIT = "m"
BETTER = "lower"


def measure(record):
    """Gap [m]; nothing when nobody followed anybody."""
    return mean(record.of_followers("gap"))
