"""Functions whose last digit numpy takes from the processor, here the same on all of them.

numpy has several codes for the arc tangent, the tangent, powers, exponential and logarithm, and BLAS for sums of products; which
one runs depends on the vector units of the machine, and so does the last digit. A way whose last digit differs is driven by a
run that differs. So maps and ways are made with the C library's functions, number by number, and with sums that are written out.
"""

import math
from typing import Any

import numpy as np

ATAN2, TAN = np.frompyfunc(math.atan2, 2, 1), np.frompyfunc(math.tan, 1, 1)


def arctan2(y, x) -> Any:
    """Direction of (x, y) [rad]; numbers or arrays."""
    return np.float64(ATAN2(y, x))


def tan(x) -> Any:
    """Tangent of an angle [rad]; a number or an array."""
    return np.float64(TAN(x))


def wrapped(angle) -> Any:
    """The same angle between -pi and pi [rad]; a number or an array."""
    return arctan2(np.sin(angle), np.cos(angle))


def dot(a, b) -> float:
    """Inner product of two vectors in the plane."""
    return float(a[0] * b[0] + a[1] * b[1])


def cross(a, b) -> float:
    """How far b points to the left of a: the outer product of two vectors in the plane."""
    return float(a[0] * b[1] - a[1] * b[0])


def turn(a, b) -> float:
    """How far one turns to the left from one direction to another [rad]."""
    return math.atan2(cross(a, b), dot(a, b))


def resolved(along, across, vector) -> tuple[float, float]:
    """How often `along` and `across` make up a vector of the plane (Cramer's rule)."""
    area = cross(along, across)
    return cross(vector, across) / area, cross(along, vector) / area
