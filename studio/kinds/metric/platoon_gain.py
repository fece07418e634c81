"""Product of the gains from car to car along a chain; the worst chain counts.

The gain of a hop is the ratio of the accelerations' L2 norms (J. Ploeg et al., IEEE Trans. Control Systems Technology 22 (2014) 786).
"""

import math

from studio.assess.string_stability import hops
from studio.kind.metric import Found

KIND = "metric"
TITLE = "Gain from the first to the last car"
UNIT = "1"
BETTER = "lower"
ABOUT = "from {0} to {1}"


def measure(record):
    """Gain [1]; nothing without a chain, or without a disturbance to pass on."""
    chains = [found for chain in record.chains if (found := hops(record, chain))]
    found = [Found(math.prod(hop.gain for hop in each), (each[0].ahead, each[-1].behind)) for each in chains]
    return max(found, default=float("nan"), key=lambda each: each.value)
