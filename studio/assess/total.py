"""Total: sums that are exact before they are rounded once, so that the order of what is summed changes nothing.

J. R. Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric predicates, 1997, as `math.fsum` does it.
"""

from math import fsum, nan

import numpy as np


def total(values: np.ndarray) -> float:
    """The sum of all values that are numbers."""
    return fsum(values[np.isfinite(values)].tolist())


def mean(values: np.ndarray) -> float:
    """The mean of all values that are numbers; not a number when there is none."""
    count = int(np.isfinite(values).sum())
    return total(values) / count if count else nan
