"""Product of the gains from car to car along a chain; the worst chain counts.

The gain of a hop is the ratio of the accelerations' L2 norms (J. Ploeg et al., IEEE Trans. Control Systems Technology 22 (2014) 786).
"""

import math

from studio.assess.string_stability import gains

KIND = "metric"
TITLE = "Gain from the first to the last car"
UNIT = "1"
BETTER = "lower"


def measure(record):
    """Gain [1]; nothing without a chain, or without a disturbance to pass on."""
    found = [gains(record, chain) for chain in record.chains]
    return max((math.prod(each) for each in found if each), default=float("nan"))
