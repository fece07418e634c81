"""Least distance to what is ahead minus the safe one of responsibility-sensitive safety; negative: it was not kept.

S. Shalev-Shwartz, S. Shammah, A. Shashua, On a formal model of safe and scalable self-driving cars, arXiv 1708.06374, definition 1.
"""

from studio.assess.rss import Rules, margin_behind
from studio.assess.search import least_behind

KIND = "metric"
TITLE = "Least margin to the RSS distance ahead"
UNIT = "m"
BETTER = "higher"
ABOUT = "{0} behind {1}"


class Settings(Rules):
    """What RSS assumes."""


def measure(record, settings):
    """Margin [m]; nothing when nobody had somebody ahead."""
    return least_behind(record, margin_behind(record, settings))
