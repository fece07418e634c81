"""Elementary functions as branch-free polynomials: plain sums and products that a compiler puts into vector registers.

A call of the mathematics library inside a loop keeps the loop scalar; these do not. Every function reduces its argument by
selects and ends in one polynomial, fitted at the Chebyshev points of the reduced interval with 40 digits, in Horner's form with
fused multiply-adds: one rounding each, the same wherever the function is compiled into. Errors against the library stand at
each function; the tests measure them over the whole range.

Source of the reductions: W. J. Cody, W. Waite, Software Manual for the Elementary Functions, 1980.
"""

from math import floor, pi, sqrt
from typing import Any

from numba import extending, types

from studio.compiled import compiled

TAN_EIGHTH, TAN_THREE_EIGHTHS = 0.41421356237309503, 2.414213562373095  # tan(pi/8), tan(3 pi/8)
PI_HIGH, PI_LOW = 3.141592653589793, 1.2246467991473532e-16  # pi in two parts
EXP_LIMIT = 20.0  # arguments of `exp` are bounded by ± this

intrinsic: Any = extending.intrinsic  # its own types are about what makes the code, not about the call


@intrinsic
def fma(typing_context, a, b, c):
    """a b + c, rounded once."""

    def generate(context, builder, signature, arguments):
        return builder.fma(*arguments)

    return types.float64(types.float64, types.float64, types.float64), generate


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
    series = fma(u, -0.03765510601291402, 0.06974197686595265)
    series = fma(u, fma(u, series, -0.08992552906150912), 0.11103456908947464)
    series = fma(u, fma(u, series, -0.14285386553752139), 0.19999993053555815)
    series = fma(u, fma(u, series, -0.33333333276922494), 0.9999999999992447)
    angle = fma(z, series, base)
    return -angle if x < 0.0 else angle


@compiled(forceinline=True)
def sin(x):
    """Sine; absolute error below 2e-13 for |x| < 1000.

    x = n pi + r, sin(x) = (-1)^n sin(r), |r| <= pi/2.
    """
    n = floor(fma(x, 1.0 / pi, 0.5))
    r = fma(n, -PI_LOW, fma(n, -PI_HIGH, x))
    odd = fma(floor(0.5 * n), -2.0, n)
    r = r * fma(odd, -2.0, 1.0)
    u = r * r
    series = fma(u, 1.54112197466489e-10, -2.503026818882279e-08)
    series = fma(u, fma(u, series, 2.7556952912858047e-06), -0.00019841266683130672)
    series = fma(u, fma(u, series, 0.00833333332035835), -0.16666666666466673)
    return r * fma(u, series, 0.9999999999999496)


@compiled(forceinline=True)
def cos(x):
    """Cosine; absolute error below 2e-13 for |x| < 1000."""
    return sin(x + 0.5 * pi)


@compiled(forceinline=True)
def exp(x):
    """Exponential of an argument bounded by ± 20; relative error below 1e-12: exp(x) = exp(x/256)^256."""
    r = min(max(x, -EXP_LIMIT), EXP_LIMIT) * (1.0 / 256.0)
    series = fma(r, fma(r, fma(r, 1.0 / 40320.0, 1.0 / 5040.0), 1.0 / 720.0), 1.0 / 120.0)
    series = fma(r, fma(r, fma(r, series, 1.0 / 24.0), 1.0 / 6.0), 0.5)
    power = fma(r, fma(r, series, 1.0), 1.0)
    for _ in range(8):
        power = power * power
    return power


@compiled(forceinline=True)
def cos_atan(x):
    """cos(atan(x)) = 1/sqrt(1 + x²)."""
    return 1.0 / sqrt(fma(x, x, 1.0))
