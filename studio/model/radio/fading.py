"""Fading: echoes of one signal add up or cancel, so that every message comes with another power around the mean.

The power, over its mean, has the distribution Gamma(m, 1/m) (M. Nakagami, The m-distribution, 1960): m = 1 is Rayleigh's fading, without
a direct ray; the larger m, the steadier; 0.5 is the wildest there is. The share that is above a threshold which lies `margin` dB below the
mean is

    Q(m, m 10^(-margin/10))        with Q = 1 - P, the regularised incomplete gamma functions

A power is made of one draw u by inversion, P(m, x) = u, g = x/m: no draw is thrown away, so that one number of a counter is one power. P is
a series below m + 1 and a continued fraction above (M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, 1964, 6.5.29 and
6.5.31). The inversion starts at the power law of small x, or at the cube of Wilson & Hilferty (1931), and improves by Halley's method:
the density f = x^(m-1) e^-x/Gamma(m) has f'/f = (m - 1)/x - 1.
"""

from math import exp, lgamma, log, sqrt

from studio.compiled import compiled
from studio.model.radio.normal import quantile

TERMS, STEPS = 300, 12
TINY = 1e-300
EXACT = 1e-12  # relative


@compiled
def m_of(distance, near, far, change):
    """The m of a distance: `near` up to `change` [m], `far` beyond."""
    return near if distance < change else far


@compiled
def above(m, margin):
    """The share of messages with a power above a threshold that lies `margin` [dB] below the mean."""
    return 1.0 - lower(m, m * 10.0 ** (-0.1 * margin))


@compiled
def power(m, draw):
    """Power over its mean [1] of one message; draw in (0, 1)."""
    x = start(m, draw)
    for _ in range(STEPS):
        step = (lower(m, x) - draw) / max(density(m, x), TINY)
        step /= 1.0 - 0.5 * min(1.0, step * ((m - 1.0) / x - 1.0))
        x = x - step if step < x else 0.5 * x
        if abs(step) < EXACT * x:
            break
    return x / m


@compiled
def start(m, draw):
    """An x near that with P(m, x) = draw."""
    small = exp((log(draw) + lgamma(m + 1.0)) / m)  # P is x^m/Gamma(m + 1) for small x
    if small < 0.3 * (m + 1.0):
        return max(small * (1.0 + small / (m + 1.0)), TINY)
    cube = 1.0 - 1.0 / (9.0 * m) + quantile(draw) / (3.0 * sqrt(m))
    return max(m * cube * cube * cube, 0.1 * small)


@compiled
def density(m, x):
    """That of P."""
    return exp((m - 1.0) * log(x) - x - lgamma(m))


@compiled
def lower(m, x):
    """P(m, x), the share below x."""
    if x <= 0.0:
        return 0.0
    head = exp(m * log(x) - x - lgamma(m))
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
