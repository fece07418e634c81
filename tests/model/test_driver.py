"""The driver's laws against their closed forms."""

from math import sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.model import driver

# Treiber's highway and city drivers: v0 [m/s], T [s], s0 [m], a, b [m/s²]
HIGHWAY, CITY = (120 / 3.6, 1.0, 2.0, 1.0, 1.5), (54 / 3.6, 1.0, 2.0, 1.0, 1.5)


@pytest.mark.parametrize(("speed", "set_", "gap"), [(50, HIGHWAY, 16.13), (80, HIGHWAY, 27.04), (100, HIGHWAY, 41.38), (50, CITY, 30.87)])
def test_equilibrium_gap(speed, set_, gap):
    """At s_e = (s0 + vT)/sqrt(1 - (v/v0)^4) nobody accelerates (Treiber et al. 2000, Eq. 6)."""
    v0, T, s0, a, b = set_
    v = speed / 3.6
    assert (s0 + v * T) / sqrt(1 - (v / v0) ** 4) == pytest.approx(gap, abs=0.01)
    assert driver.following_acceleration(v, v0, gap, 0.0, s0, T, a, b) == pytest.approx(0.0, abs=1e-3)


@given(v=st.floats(0, 50), v0=st.floats(1, 50))
def test_free_road(v, v0):
    """Faster below the wish, slower above it, never beyond a and b."""
    u = driver.free_acceleration(v, v0, 1.4, 2.0)
    assert -2.0 <= u <= 1.4
    assert (u >= 0) == (v <= v0)


def test_stop_or_go():
    """Stops exactly when v²/(2d) stays below the firm deceleration."""
    v = 13.9
    needed = v * v / (2 * driver.STOP_FIRM)
    assert driver.must_stop(v, needed * 1.01) and not driver.must_stop(v, needed * 0.99)
