"""Fading: echoes of one signal add up or cancel, so that every message comes with another power around the mean.

The power, over its mean, has the distribution Gamma(m, 1/m) (M. Nakagami, The m-distribution, 1960): m = 1 is Rayleigh's fading, without
a direct ray; the larger m, the steadier; 0.5 is the wildest there is. The share that is above a threshold which lies `margin` dB below the
mean is

    Q(m, m 10^(-margin/10))        with Q = 1 - P, the regularised incomplete gamma functions

A power is made of one draw u by inversion, P(m, x) = u, g = x/m: no draw is thrown away, so that one number of a counter is one power. P is
a series below m + 1 and a continued fraction above (M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, 1964, 6.5.29 and
6.5.31). The inversion starts at the power law of small x, or at the cube of Wilson & Hilferty (1931), and improves by Halley's method:
the density f = x^(m-1) e^-x/Gamma(m) has f'/f = (m - 1)/x - 1.

That takes long. Where it is enough to know between which values a power lies, a table of the quantiles at k/n tells it: g grows with u, so
it lies between the two beside u. Nothing is interpolated, and whatever is decided so is decided as the power itself would have it.
"""

from math import exp, lgamma, log, log10, sqrt

import numpy as np

from studio.compiled import compiled
from studio.model.radio.normal import quantile

TERMS, STEPS = 300, 12
TINY = 1e-300
ENTRIES = 1024
POINTS = ENTRIES + 1
LEAST_DRAW = 2.0**-33  # of a draw of 32 bits, and as much below 1 is the greatest
SLACK = 1e-4  # [dB] more than `power` is wrong by
NEAR = 1e-4  # relative; the error after a step is about its third power


@compiled
def m_of(distance, near, far, change):
    """The m of a distance: `near` up to `change` [m], `far` beyond."""
    return near if distance < change else far


@compiled
def power(m, draw):
    """Power over its mean [1] of one message; draw in (0, 1)."""
    x, log_gamma = start(m, draw), lgamma(m)
    for _ in range(STEPS):
        share, density = lower(m, x, log_gamma), exp((m - 1.0) * log(x) - x - log_gamma)
        step = (share - draw) / max(density, TINY)
        step /= 1.0 - 0.5 * min(1.0, step * ((m - 1.0) / x - 1.0))
        x = x - step if step < x else 0.5 * x
        if abs(step) < NEAR * x:
            break
    return x / m


@compiled
def quantiles(m):
    """Powers over the mean [dB] of the draws k/ENTRIES, from the least that there is to the greatest."""
    found = np.empty(POINTS)
    for k in range(POINTS):
        found[k] = 10.0 * log10(power(m, min(max(k / ENTRIES, LEAST_DRAW), 1.0 - LEAST_DRAW)))
    return found


@compiled
def bounds(table, first, draw):
    """Two powers over the mean [dB] between which that of a draw of 32 bits lies; quantiles stand in a table from `first` on."""
    k = first + int(draw * ENTRIES)
    return table[k] - SLACK, table[k + 1] + SLACK


@compiled
def start(m, draw):
    """An x near that with P(m, x) = draw."""
    small = exp((log(draw) + lgamma(m + 1.0)) / m)  # P is x^m/Gamma(m + 1) for small x
    if small < 0.3 * (m + 1.0):
        return max(small * (1.0 + small / (m + 1.0)), TINY)
    cube = 1.0 - 1.0 / (9.0 * m) + quantile(draw) / (3.0 * sqrt(m))
    return max(m * cube * cube * cube, 0.1 * small)


@compiled
def lower(m, x, log_gamma):
    """P(m, x), the share below x; log_gamma is ln Gamma(m)."""
    if x <= 0.0:
        return 0.0
    head = exp(m * log(x) - x - log_gamma)
    return head * series(m, x) if x < m + 1.0 else 1.0 - head * fraction(m, x)


@compiled
def series(m, x):
    """Sum of x^k/(m (m + 1) ... (m + k))."""
    term = total = 1.0 / m
    for k in range(1, TERMS):
        term *= x / (m + k)
        total += term
        if term < 1e-17 * total:
            break
    return total


@compiled
def fraction(m, x):
    """1/(x + 1 - m - 1 (1 - m)/(x + 3 - m - 2 (2 - m)/(x + 5 - m - ...))), from its head (Lentz 1976)."""
    b = x + 1.0 - m
    c, d = 1.0 / TINY, 1.0 / b
    value = d
    for k in range(1, TERMS):
        a = -k * (k - m)
        b += 2.0
        d, c = 1.0 / (a * d + b), b + a / c
        value *= d * c
        if abs(d * c - 1.0) < 1e-16:
            break
    return value
