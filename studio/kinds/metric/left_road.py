"""Times that a vehicle left the lanes of its direction with its centre of gravity, to either side, traffic included.

Who is driven into a space beside them, to park, has left them, too.
"""

from studio.assess.census import number_of

KIND = "metric"
TITLE = "Left the road"
UNIT = "1"
BETTER = "lower"


def measure(record):
    """Number [1]; about the first."""
    return number_of(record, "off")
