"""Greatest use of adhesion of any wheel: the tyre's force over the greatest that it can transmit there, at its load and on that road.

At 1 a tyre slides or is about to. Forces along and across are taken together as an ellipse (studio/model/adhesion.py).
Light vehicles have no tyres, and do not count.
"""

from studio.assess.adhesion import most_used, nothing_known
from studio.assess.search import greatest

KIND = "metric"
TITLE = "Greatest use of adhesion"
UNIT = "1"
BETTER = "lower"


def measure(record):
    """Share [1]."""
    return nothing_known(record) or greatest(record, most_used(record))
