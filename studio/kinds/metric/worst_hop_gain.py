"""Greatest gain from car to car, over all chains: above 1 a car works harder than the one ahead of it.

The gain of a hop is the ratio of the accelerations' L2 norms (J. Ploeg et al., IEEE Trans. Control Systems Technology 22 (2014) 786).
"""

from studio.assess.string_stability import hops
from studio.kind.metric import Found

KIND = "metric"
TITLE = "Greatest gain from car to car"
UNIT = "1"
BETTER = "lower"
ABOUT = "from {0} to {1}"


def measure(record):
    """Gain [1]; nothing without a chain, or without a disturbance to pass on."""
    found = [Found(hop.gain, (hop.ahead, hop.behind)) for chain in record.chains for hop in hops(record, chain)]
    return max(found, default=float("nan"), key=lambda each: each.value)
