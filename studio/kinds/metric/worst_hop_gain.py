"""Greatest gain from car to car, over all chains: above 1 a car works harder than the one ahead of it.

The gain of a hop is the ratio of the accelerations' L2 norms (J. Ploeg et al., IEEE Trans. Control Systems Technology 22 (2014) 786).
"""

from studio.assess.string_stability import gains

KIND = "metric"
TITLE = "Greatest gain from car to car"
UNIT = "1"
BETTER = "lower"


def measure(record):
    """Gain [1]; nothing without a chain, or without a disturbance to pass on."""
    return max((gain for chain in record.chains for gain in gains(record, chain)), default=float("nan"))
