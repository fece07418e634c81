"""For how long one vehicle was nearer to what is ahead than the safe distance of responsibility-sensitive safety; the longest counts.

S. Shalev-Shwartz, S. Shammah, A. Shashua, On a formal model of safe and scalable self-driving cars, arXiv 1708.06374, definition 1.
"""

from studio.assess.effort import lasting
from studio.assess.rss import Rules, margin_behind
from studio.assess.search import worst_vehicle

KIND = "metric"
TITLE = "Time within the RSS distance ahead"
UNIT = "s"
BETTER = "lower"


class Settings(Rules):
    """What RSS assumes."""


def measure(record, settings):
    """Time [s]."""
    return worst_vehicle(record, lasting(margin_behind(record, settings) < 0.0, record.time))
