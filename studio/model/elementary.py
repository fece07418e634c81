"""Elementary functions as branch-free polynomials: plain sums and products that a compiler puts into vector registers.

A call of the mathematics library inside a loop keeps the loop scalar; these do not. Every function reduces its argument by
selects and ends in one polynomial, fitted at the Chebyshev points of the reduced interval with 40 digits. Errors against the
library stand at each function; the tests measure them over the whole range.

Source of the reductions: W. J. Cody, W. Waite, Software Manual for the Elementary Functions, 1980.
"""

from math import floor, pi, sqrt

from studio.compiled import compiled

TAN_EIGHTH, TAN_THREE_EIGHTHS = 0.41421356237309503, 2.414213562373095  # tan(pi/8), tan(3 pi/8)
PI_HIGH, PI_LOW = 3.141592653589793, 1.2246467991473532e-16  # pi in two parts
EXP_LIMIT = 20.0  # arguments of `exp` are bounded by ± this


@compiled(forceinline=True)
def atan(x):
    """Arc tangent [rad]; relative error below 1e-12.

    x > tan(3 pi/8): pi/2 - atan(1/x).   x > tan(pi/8): pi/4 + atan((x - 1)/(x + 1)).
    """
    a = abs(x)
    far, near = a > TAN_THREE_EIGHTHS, a <= TAN_EIGHTH
    above = -1.0 if far else (a if near else a - 1.0)
    below = a if far else (1.0 if near else a + 1.0)
    base = 0.5 * pi if far else (0.0 if near else 0.25 * pi)
    z = above / below
    u = z * z
    series = 0.06974197686595265 + u * -0.03765510601291402
    series = 0.11103456908947464 + u * (-0.08992552906150912 + u * series)
    series = 0.19999993053555815 + u * (-0.14285386553752139 + u * series)
    series = 0.9999999999992447 + u * (-0.33333333276922494 + u * series)
    angle = base + z * series
    return -angle if x < 0.0 else angle


@compiled(forceinline=True)
def sin(x):
    """Sine; absolute error below 2e-13 for |x| < 1000.

    x = n pi + r, sin(x) = (-1)^n sin(r), |r| <= pi/2.
    """
    n = floor(x * (1.0 / pi) + 0.5)
    r = (x - n * PI_HIGH) - n * PI_LOW
    odd = n - 2.0 * floor(0.5 * n)
    r = r * (1.0 - 2.0 * odd)
    u = r * r
    series = -2.503026818882279e-08 + u * 1.54112197466489e-10
    series = -0.00019841266683130672 + u * (2.7556952912858047e-06 + u * series)
    series = -0.16666666666466673 + u * (0.00833333332035835 + u * series)
    return r * (0.9999999999999496 + u * series)


@compiled(forceinline=True)
def cos(x):
    """Cosine; absolute error below 2e-13 for |x| < 1000."""
    return sin(x + 0.5 * pi)


@compiled(forceinline=True)
def exp(x):
    """Exponential of an argument bounded by ± 20; relative error below 1e-12: exp(x) = exp(x/256)^256."""
    r = min(max(x, -EXP_LIMIT), EXP_LIMIT) * (1.0 / 256.0)
    series = 1.0 / 120.0 + r * (1.0 / 720.0 + r * (1.0 / 5040.0 + r * (1.0 / 40320.0)))
    power = 1.0 + r * (1.0 + r * (0.5 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * series))))
    for _ in range(8):
        power = power * power
    return power


@compiled(forceinline=True)
def cos_atan(x):
    """cos(atan(x)) = 1/sqrt(1 + x²)."""
    return 1.0 / sqrt(1.0 + x * x)


@compiled(forceinline=True)
def sin_double_atan(x):
    """sin(2 atan(x)) = 2 x/(1 + x²)."""
    return 2.0 * x / (1.0 + x * x)
