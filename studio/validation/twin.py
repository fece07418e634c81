"""Whether two recordings are of one drive, though not to the last bit: a copy with other digits, one sample changed, the end cut off.

Two drives are never alike in all their signals at once for long: instruments scatter, and nobody steers twice the same. Where the signals
move, most samples of a copy agree with those of its original to two thousandths of their range.
"""

import numpy as np

from studio.log.recording import Recording

NEAR = 2e-3  # [1] of the range of a signal
SHARE, LENGTH = 0.5, 0.9  # [1] of the moving samples that agree; of the longer recording that the shorter one has


def are_twins(a: Recording, b: Recording) -> bool:
    """Whether they are of one drive."""
    shared = [name for name in a.signals if name in b.signals]
    count = min(a.time.size, b.time.size)
    if not shared or count < LENGTH * max(a.time.size, b.time.size):
        return False
    pairs = [(a[name][:count], b[name][:count]) for name in shared]
    moving = np.any([np.diff(one, prepend=one[0]) != 0.0 for one, _ in pairs], axis=0)
    agree = np.all([near(one, other) for one, other in pairs], axis=0)
    return bool(moving.any() and agree[moving].mean() > SHARE)


def near(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Where a signal agrees with another; where neither is known it does."""
    known = one[np.isfinite(one)]
    allowed = NEAR * float(np.ptp(known)) + 1e-9 * float(np.abs(known).max()) if known.size else 0.0
    return (np.abs(one - other) <= allowed) | (np.isnan(one) & np.isnan(other))
