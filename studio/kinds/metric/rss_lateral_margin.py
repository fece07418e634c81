"""Least lateral distance minus the safe one of responsibility-sensitive safety, of two side by side.

S. Shalev-Shwartz, S. Shammah, A. Shashua, On a formal model of safe and scalable self-driving cars, arXiv 1708.06374, definition 6.
"""

from studio.assess.rss import Rules, beside_margin, least_margin

KIND = "metric"
TITLE = "Least margin to the lateral RSS distance"
UNIT = "m"
BETTER = "higher"
ABOUT = "{0} beside {1}"
REACH = 10.0  # [m] beyond which nobody is beside anybody


class Settings(Rules):
    """What RSS assumes."""


def measure(record, settings):
    """Margin [m]; nothing when nobody was beside anybody."""
    return least_margin(record, REACH, lambda seen: beside_margin(seen, settings))
