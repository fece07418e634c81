"""Mean age of the newest message, over the links that applications use; the worst link counts.

While both ends take part. It is what a cooperative application acts on: the age of information of S. Kaul, R. Yates and
M. Gruteser, Real-time status: how often should one update?, INFOCOM 2012.
"""

KIND = "metric"
TITLE = "Mean age of the newest message, worst link"
UNIT = "s"
BETTER = "lower"


def measure(record):
    """Age [s]; nothing without a link."""
    return max(record.links.values(), default=float("nan"))
