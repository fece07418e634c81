"""The acceleration of the car ahead, estimated from the own radar: a Kalman filter on Singer's model of a target.

Singer's target holds an acceleration for about 1/alpha and then another one, which is a first-order Gauss-Markov process:

    d' = r,    r' = a - a_own,    a' = -alpha a + w,    S_w = 2 alpha sigma_m²,    sigma_m² = a_max²/3 (1 + 4 P_max - P_0)

d gap, r its rate, a acceleration of the target, P_max and P_0 the probabilities that it is at its limits and that it has none. Measured
are d and r, each with white noise. R. A. Singer, Estimating optimal tracking filter performance for manned maneuvering targets, IEEE
Trans. Aerospace and Electronic Systems 6 (1970) 473; alpha, a_max, P_max and P_0 as J. Ploeg et al., Graceful degradation of cooperative
adaptive cruise control, IEEE Trans. ITS 16 (2015) 488, have them.

The estimate is a tuple: d [m], r [m/s], a [m/s²], then the upper triangle of its covariance, row by row.
"""

from math import exp

from studio.compiled import compiled

ALPHA = 1.25  # [1/s]
STRONGEST, AT_LIMIT, WITHOUT = 3.0, 0.01, 0.1  # [m/s²], [1], [1]
VARIANCE = STRONGEST * STRONGEST / 3.0 * (1.0 + 4.0 * AT_LIMIT - WITHOUT)  # [m²/s⁴] sigma_m²
RANGE_NOISE, RATE_NOISE = 0.1, 0.05  # [m], [m/s] of a front radar, as studio/kinds/sensor/front_radar.py has it
ANOTHER = 3.0  # [m] by which a gap that is measured may be off before it is taken for that of another target
NOBODY = (-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@compiled
def begun(d, r):
    """What is known when a target is seen for the first time: gap [m] and rate [m/s]."""
    return (d, r, 0.0, RANGE_NOISE * RANGE_NOISE, 0.0, 0.0, RATE_NOISE * RATE_NOISE, 0.0, VARIANCE)


@compiled
def predicted(x, a_own, T):
    """The estimate T [s] later, while the own car accelerates with a_own [m/s²]."""
    d, r, a, P11, P12, P13, P22, P23, P33 = x
    phi = exp(-ALPHA * T)
    g, f = (1.0 - phi) / ALPHA, (ALPHA * T - 1.0 + phi) / (ALPHA * ALPHA)  # what an acceleration of 1 adds to rate and gap
    q = 2.0 * ALPHA * VARIANCE * T
    # P = F P F' + Q with F = [[1, T, f], [0, 1, g], [0, 0, phi]]; A are the rows of F P that are needed.
    A11, A12, A13 = P11 + T * P12 + f * P13, P12 + T * P22 + f * P23, P13 + T * P23 + f * P33
    A22, A23 = P22 + g * P23, P23 + g * P33
    return (
        d + T * r + f * a - 0.5 * T * T * a_own, r + g * a - T * a_own, phi * a,
        A11 + T * A12 + f * A13 + q * T**4 / 20.0, A12 + g * A13 + q * T**3 / 8.0, phi * A13 + q * T * T / 6.0,
        A22 + g * A23 + q * T * T / 3.0, phi * A23 + q * T / 2.0, phi * phi * P33 + q,
    )  # fmt: skip


@compiled
def corrected_by_range(x, measured):
    """The estimate after a gap [m] was measured."""
    d, r, a, P11, P12, P13, P22, P23, P33 = x
    S, z = P11 + RANGE_NOISE * RANGE_NOISE, measured - d
    k1, k2, k3 = P11 / S, P12 / S, P13 / S
    return (
        d + k1 * z, r + k2 * z, a + k3 * z,
        P11 - k1 * P11, P12 - k1 * P12, P13 - k1 * P13, P22 - k2 * P12, P23 - k2 * P13, P33 - k3 * P13,
    )  # fmt: skip


@compiled
def corrected_by_rate(x, measured):
    """The estimate after a rate [m/s] was measured."""
    d, r, a, P11, P12, P13, P22, P23, P33 = x
    S, z = P22 + RATE_NOISE * RATE_NOISE, measured - r
    k1, k2, k3 = P12 / S, P22 / S, P23 / S
    return (
        d + k1 * z, r + k2 * z, a + k3 * z,
        P11 - k1 * P12, P12 - k1 * P22, P13 - k1 * P23, P22 - k2 * P22, P23 - k2 * P23, P33 - k3 * P23,
    )  # fmt: skip


@compiled
def followed(x, d, r, a_own, T):
    """The estimate after a tick T [s] at which gap d [m] and rate r [m/s] were measured; another target is begun anew."""
    if x[0] < 0.0:
        return begun(d, r)
    x = predicted(x, a_own, T)
    if abs(x[0] - d) > ANOTHER:
        return begun(d, r)
    return corrected_by_rate(corrected_by_range(x, d), r)
