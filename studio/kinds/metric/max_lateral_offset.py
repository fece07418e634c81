"""Greatest offset of any recorded vehicle from its path, to either side: whether it kept its lane."""

import numpy as np

from studio.assess.search import greatest

KIND = "metric"
TITLE = "Greatest offset from the path"
UNIT = "m"
BETTER = "lower"


def measure(record):
    """Offset [m]."""
    return greatest(record, np.abs(record.channel("lateral_offset")))
