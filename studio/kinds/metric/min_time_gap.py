"""Least time gap of a follower: the gap over its own speed, while it rolls. Also called time headway, of the gap.

Where nobody follows in a chain, those count who had somebody ahead, and all where nobody had.
"""

from studio.assess.search import least_behind

KIND = "metric"
TITLE = "Least time gap of a follower"
UNIT = "s"
BETTER = "higher"
ABOUT = "{0} behind {1}"


def measure(record):
    """Time gap [s]; nothing when nobody followed anybody."""
    return least_behind(record, record.of_followers("time_gap"), record.followers)
