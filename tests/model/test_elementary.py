"""The polynomials against the mathematics library, over the whole range that their docstrings promise."""

import math

import numba
import numpy as np
import pytest

from studio.model import elementary

RNG_SEED = 20


def evaluated(function, x):
    """The function at every x, inside a compiled loop as it is used."""

    @numba.njit(error_model="numpy")
    def loop(x, y):
        for i in range(x.size):
            y[i] = function(x[i])

    y = np.empty_like(x)
    loop(x, y)
    return y


def both_signs(magnitudes):
    return np.concatenate([-magnitudes[::-1], magnitudes])


def scattered(low, high, n=200_000):
    return np.random.default_rng(RNG_SEED).uniform(low, high, n)


def test_atan():
    """Relative error below 1e-12 over 24 decades, dense around the seams at tan(pi/8) and tan(3 pi/8)."""
    seams = [np.nextafter(seam, side) for seam in (elementary.TAN_EIGHTH, elementary.TAN_THREE_EIGHTHS) for side in (0.0, 9.0)]
    x = both_signs(np.sort(np.concatenate([np.logspace(-12, 12, 200_000), scattered(0.3, 3.0), seams])))
    assert np.max(np.abs(evaluated(elementary.atan, x) / np.arctan(x) - 1.0)) < 1e-12


def test_atan_at_its_ends():
    zero, infinite, minus_infinite, nan = evaluated(elementary.atan, np.array([0.0, np.inf, -np.inf, np.nan]))
    assert zero == 0.0
    assert infinite == pytest.approx(0.5 * math.pi, rel=1e-15)
    assert minus_infinite == pytest.approx(-0.5 * math.pi, rel=1e-15)
    assert math.isnan(nan)


@pytest.mark.parametrize(("ours", "library"), [(elementary.sin, np.sin), (elementary.cos, np.cos)], ids=["sin", "cos"])
def test_sine_and_cosine(ours, library):
    """Absolute error below 2e-13 for |x| < 1000, dense around the seams at half-odd multiples of pi."""
    seams = (np.arange(-318, 318) + 0.5) * math.pi
    near = np.concatenate([seams + shift for shift in (-1e-9, -1e-15, 0.0, 1e-15, 1e-9)])
    x = np.concatenate([scattered(-1000.0, 1000.0), scattered(-4.0, 4.0), near, [0.0, -1000.0, 1000.0]])
    assert np.max(np.abs(evaluated(ours, x) - library(x))) < 2e-13


def test_exponential():
    """Relative error below 1e-12 between -20 and 20; beyond, the value at the bound."""
    x = np.concatenate([scattered(-20.0, 20.0), [-20.0, 0.0, 20.0]])
    assert np.max(np.abs(evaluated(elementary.exp, x) / np.exp(x) - 1.0)) < 1e-12
    low, at_low, high, at_high = evaluated(elementary.exp, np.array([-800.0, -20.0, 800.0, 20.0]))
    assert (low, high) == (at_low, at_high)


def test_the_cosine_of_the_arc_tangent():
    """As far as the library resolves it."""
    x = both_signs(np.logspace(-12, 3, 100_000))
    assert evaluated(elementary.cos_atan, x) == pytest.approx(np.cos(np.arctan(x)), rel=1e-12)
