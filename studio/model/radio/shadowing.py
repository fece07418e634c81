"""Shadowing: hills, houses and lorries, as a chance in dB that belongs to places, so that neighbours hear alike.

Between places that are Delta apart the correlation shall be that of M. Gudmundson (Electronics Letters 27, 1991), with the distance d_cor:

    rho(Delta) = exp(-Delta/d_cor)

A field f of mean 0 and variance 1 over the plane has at every corner of a lattice a number z that hangs on seed and corner only, and
between corners their sum with the weights w of the place within its cell, over the root of the sum of w², which keeps the variance:

    w = (1 - s or s) (1 - t or t)            f = sum w z / sqrt(sum w²)

Two lattices, cells of 0.4 d_cor with the share 0.45 of the variance and cells of 1.8 d_cor, turned by 30°, with the rest, make the
correlation that of Gudmundson within 0.07 in all directions. z is the sum of four uniform numbers, f nearly normal.

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
UNIFORM = 2.0**-32


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
    low = (1.0 - s) * corner(seed, stream, i, j) + s * corner(seed, stream, i + 1.0, j)
    high = (1.0 - s) * corner(seed, stream, i, j + 1.0) + s * corner(seed, stream, i + 1.0, j + 1.0)
    weights = ((1.0 - s) ** 2 + s**2) * ((1.0 - t) ** 2 + t**2)
    return ((1.0 - t) * low + t * high) / sqrt(weights)


@compiled
def corner(seed, stream, i, j):
    """z of a corner: mean 0, variance 1."""
    a, b, c, d = philox(
        np.uint64(i + MIDDLE) & LOW, np.uint64(j + MIDDLE) & LOW, np.uint64(stream) & LOW, 1, np.uint64(seed) & LOW, np.uint64(seed) >> HALF
    )
    return (UNIFORM * (np.float64(a) + np.float64(b) + np.float64(c) + np.float64(d)) - 2.0) * sqrt(3.0)
