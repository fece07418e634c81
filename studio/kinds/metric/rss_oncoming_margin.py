"""Least distance minus the safe one of responsibility-sensitive safety, of two that come towards each other in one lane.

S. Shalev-Shwartz, S. Shammah, A. Shashua, On a formal model of safe and scalable self-driving cars, arXiv 1708.06374, definition 2. The
one that is named first is taken for the one in its own lane.
"""

from studio.assess.rss import Rules, least_margin, oncoming_margin

KIND = "metric"
TITLE = "Least margin to the oncoming RSS distance"
UNIT = "m"
BETTER = "higher"
ABOUT = "{0} and {1}"
REACH = 300.0  # [m] beyond which nobody is looked at


class Settings(Rules):
    """What RSS assumes."""


def measure(record, settings):
    """Margin [m]; nothing when nobody came towards anybody."""
    return least_margin(record, REACH, lambda seen: oncoming_margin(seen, settings))
