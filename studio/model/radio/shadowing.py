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

Who moves a little stays in its cells: their corners are drawn again only when it comes into others (`Around`).

If both ends move by Delta it is forgotten as exp(-Delta/d_cor); if one moves only, half of it stays.
"""

from math import cos, exp, floor, nan, pi, sin, sqrt
from typing import Annotated, NamedTuple

import numpy as np

from studio.compiled import compiled
from studio.model.random import HALF, LOW, philox

FINE, COARSE, SHARE = 0.4, 1.8, 0.45  # cells over d_cor, share of the variance that the fine ones have
FORGOTTEN = 40.0  # times d_cor: from there on 2 + 2 exp(-D/d_cor) is 2, to the last bit
TURN_COS, TURN_SIN = cos(pi / 6.0), sin(pi / 6.0)
MIDDLE = 2147483648.0  # lattice numbers are not negative
UNIFORM = 2.0**-16
QUARTER, LOW_HALF = np.uint64(16), np.uint64(0xFFFF)


class Around(NamedTuple):
    """Numbers and corners of the cells that a place lies in."""

    fine_i: Annotated[float, "1"] = nan
    fine_j: Annotated[float, "1"] = nan
    fine_00: Annotated[float, "1"] = 0.0
    fine_10: Annotated[float, "1"] = 0.0
    fine_01: Annotated[float, "1"] = 0.0
    fine_11: Annotated[float, "1"] = 0.0
    coarse_i: Annotated[float, "1"] = nan
    coarse_j: Annotated[float, "1"] = nan
    coarse_00: Annotated[float, "1"] = 0.0
    coarse_10: Annotated[float, "1"] = 0.0
    coarse_01: Annotated[float, "1"] = 0.0
    coarse_11: Annotated[float, "1"] = 0.0


@compiled
def of_both(f_p, f_q, distance, d_cor):
    """The shadow between two places whose fields are f_p and f_q, a distance [m] apart, over its standard deviation [1]."""
    apart = distance / d_cor
    return (f_p + f_q) / sqrt(2.0 + 2.0 * exp(-apart)) if apart < FORGOTTEN else (f_p + f_q) / sqrt(2.0)


@compiled
def bounds(f_p, f_q):
    """Between which values that is at any distance; cheap."""
    near, far = (f_p + f_q) / 2.0, (f_p + f_q) / sqrt(2.0)
    return min(near, far), max(near, far)


@compiled
def field(seed, stream, x, y, around):
    """f at a place, in units of d_cor, and what is around it; `around` is what was around the place before."""
    u, v = x / FINE, y / FINE
    i, j = float(floor(u)), float(floor(v))
    z = (around.fine_00, around.fine_10, around.fine_01, around.fine_11)
    if i != around.fine_i or j != around.fine_j:
        z = corners(seed, stream, i, j)
    s, t = (TURN_COS * x - TURN_SIN * y) / COARSE, (TURN_SIN * x + TURN_COS * y) / COARSE
    k, l = float(floor(s)), float(floor(t))
    far = (around.coarse_00, around.coarse_10, around.coarse_01, around.coarse_11)
    if k != around.coarse_i or l != around.coarse_j:
        far = corners(seed, stream + 1, k, l)
    f = sqrt(SHARE) * lattice(u - i, v - j, z) + sqrt(1.0 - SHARE) * lattice(s - k, t - l, far)
    return f, Around(i, j, z[0], z[1], z[2], z[3], k, l, far[0], far[1], far[2], far[3])


@compiled
def lattice(s, t, z):
    """f of one lattice at s, t within a cell with these corners."""
    weights = ((1.0 - s) ** 2 + s**2) * ((1.0 - t) ** 2 + t**2)
    return ((1.0 - t) * ((1.0 - s) * z[0] + s * z[1]) + t * ((1.0 - s) * z[2] + s * z[3])) / sqrt(weights)


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
