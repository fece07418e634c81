"""String stability: whether a disturbance grows from car to car.

Per-hop gain in the L2 sense, ||a_i|| / ||a_{i-1}|| of the accelerations (J. Ploeg et al., IEEE Trans. Control Systems
Technology 22 (2014) 786): above 1 the next car works harder than the one ahead of it.
"""

import itertools

import numpy as np

from studio.execution.record import Chain, Record

QUIET = 0.05  # [m/s²] root mean square below which there is no disturbance to pass on


def strength(record: Record, vehicle: str) -> float:
    """Root mean square of the acceleration [m/s²]."""
    return float(np.sqrt(np.nanmean(record.trace(f"{vehicle}.acceleration") ** 2)))


def gains(record: Record, chain: Chain) -> list[float]:
    """Gain of every hop of a chain that had something to pass on."""
    levels = [strength(record, vehicle) for vehicle in chain.vehicles if vehicle in record.vehicles]
    return [level / ahead for ahead, level in itertools.pairwise(levels) if ahead > QUIET]
