"""Shadowing: hills, houses and lorries, as a chance in dB that belongs to places, so that neighbours hear alike.

Between places that are Delta apart the correlation shall be that of M. Gudmundson (Electronics Letters 27, 1991), with the distance d_cor:

    rho(Delta) = exp(-Delta/d_cor)

A field f of mean 0 and variance 1 over the plane has at every corner of a lattice a number z that hangs on seed and corner only, and
between corners their sum with the weights w of the place within its cell, over the root of the sum of w², which keeps the variance:

    w = (1 - s or s) (1 - t or t)            f = sum w z / sqrt(sum w²)

Two lattices, cells of 0.4 d_cor with the share 0.45 of the variance and cells of 1.8 d_cor, turned by 30°, with the rest, make the
correlation that of Gudmundson within 0.07 in all directions. z is the sum of two uniform numbers; f is nearly normal.

The shadow between two places p and q is that of both, the same in both directions, with the variance 1 at any distance D of them:

    S = (f(p) + f(q)) / sqrt(2 + 2 exp(-D/d_cor))

If both ends move by Delta it is forgotten as exp(-Delta/d_cor); if one moves only, half of it stays.
"""

from math import cos, exp, floor, pi, sin, sqrt

import numpy as np

from studio.compiled import compiled
from studio.model.random import HALF, LOW, philox

FINE, COARSE, SHARE = 0.4, 1.8, 0.45  # cells over d_cor, share of the variance that the fine ones have
TURN_COS, TURN_SIN = cos(pi / 6.0), sin(pi / 6.0)
MIDDLE = 2147483648.0  # lattice numbers are not negative
UNIFORM = 2.0**-16
QUARTER, LOW_HALF = np.uint64(16), np.uint64(0xFFFF)


@compiled
def between(seed, stream, x_p, y_p, x_q, y_q, distance, d_cor):
    """The shadow between two places [m], over its standard deviation [1]."""
    both = field(seed, stream, x_p / d_cor, y_p / d_cor) + field(seed, stream, x_q / d_cor, y_q / d_cor)
    return both / sqrt(2.0 + 2.0 * exp(-distance / d_cor))


@compiled
def field(seed, stream, x, y):
    """f at a place, in units of d_cor."""
    fine = lattice(seed, stream, x / FINE, y / FINE)
    coarse = lattice(seed, stream + 1, (TURN_COS * x - TURN_SIN * y) / COARSE, (TURN_SIN * x + TURN_COS * y) / COARSE)
    return sqrt(SHARE) * fine + sqrt(1.0 - SHARE) * coarse


@compiled
def lattice(seed, stream, x, y):
    """f of one lattice at a place, in units of its cells."""
    i, j = floor(x), floor(y)
    s, t = x - i, y - j
    z_00, z_10, z_01, z_11 = corners(seed, stream, i, j)
    weights = ((1.0 - s) ** 2 + s**2) * ((1.0 - t) ** 2 + t**2)
    return ((1.0 - t) * ((1.0 - s) * z_00 + s * z_10) + t * ((1.0 - s) * z_01 + s * z_11)) / sqrt(weights)


@compiled
def corners(seed, stream, i, j):
    """z of the four corners of a cell. Four corners each, in a square that begins at even numbers, are drawn together."""
    u, v = floor(0.5 * i), floor(0.5 * j)
    here = square(seed, stream, u, v)
    if i == 2.0 * u and j == 2.0 * v:
        return here
    right = square(seed, stream, u + 1.0, v) if i > 2.0 * u else here
    above = square(seed, stream, u, v + 1.0) if j > 2.0 * v else here
    if i == 2.0 * u:
        return here[2], here[3], above[0], above[1]
    if j == 2.0 * v:
        return here[1], right[0], here[3], right[2]
    return here[3], right[2], above[1], square(seed, stream, u + 1.0, v + 1.0)[0]


@compiled
def square(seed, stream, u, v):
    """z of four corners, the lower two first."""
    a, b, c, d = philox(
        np.uint64(u + MIDDLE) & LOW, np.uint64(v + MIDDLE) & LOW, np.uint64(stream) & LOW, 1, np.uint64(seed) & LOW, np.uint64(seed) >> HALF
    )
    return two_halves(a), two_halves(b), two_halves(c), two_halves(d)


@compiled
def two_halves(word):
    """A number of mean 0 and variance 1: the sum of two uniform ones, of 16 bits each."""
    return (UNIFORM * (np.float64(word >> QUARTER) + np.float64(word & LOW_HALF) + 1.0) - 1.0) * sqrt(6.0)
