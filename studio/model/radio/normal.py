"""The standard normal distribution from one draw.

The quantile is that of P. J. Acklam (2003), three rational functions with a relative error below 1.2e-9, here without his refinement.
"""

from math import log, sqrt

from studio.compiled import compiled

TAIL = 0.02425  # probability at which the middle begins


@compiled
def quantile(p):
    """z with Phi(z) = p, for p in (0, 1)."""
    if p < TAIL:
        return outer(sqrt(-2.0 * log(p)))
    if p > 1.0 - TAIL:
        return -outer(sqrt(-2.0 * log(1.0 - p)))
    return inner(p - 0.5)


@compiled
def outer(q):
    """In the lower tail; q = sqrt(-2 ln p)."""
    above = ((((-7.784894002430293e-03 * q - 3.223964580411365e-01) * q - 2.400758277161838) * q - 2.549732539343734) * q
             + 4.374664141464968) * q + 2.938163982698783  # fmt: skip
    below = (((7.784695709041462e-03 * q + 3.224671290700398e-01) * q + 2.445134137142996) * q + 3.754408661907416) * q + 1.0
    return above / below


@compiled
def inner(q):
    """In the middle; q = p - 1/2."""
    r = q * q
    above = ((((-3.969683028665376e01 * r + 2.209460984245205e02) * r - 2.759285104469687e02) * r + 1.383577518672690e02) * r
             - 3.066479806614716e01) * r + 2.506628277459239  # fmt: skip
    below = ((((-5.447609879822406e01 * r + 1.615858368580409e02) * r - 1.556989798598866e02) * r + 6.680131188771972e01) * r
             - 1.328068155288572e01) * r + 1.0  # fmt: skip
    return q * above / below
