"""Mean age of the newest message, over the links that applications use; the worst link counts.

While both ends take part. It is what a cooperative application acts on: the age of information of S. Kaul, R. Yates and
M. Gruteser, Real-time status: how often should one update?, INFOCOM 2012.
"""

from studio.assess.freshness import mean
from studio.assess.search import worst_link

KIND = "metric"
TITLE = "Mean age of the newest message, worst link"
UNIT = "s"
BETTER = "lower"
ABOUT = "{0} heard by {1}"


def measure(record):
    """Age [s]; nothing without a link."""
    return worst_link(record, mean(record.ages))
