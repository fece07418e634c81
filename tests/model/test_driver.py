"""The driver's laws against their closed forms."""

from math import atan, atanh, sqrt

import numpy as np
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


def gain(v, T, a, b, v0=120 / 3.6, s0=2.0):
    """Greatest |V/V_ahead| over the frequency, and where [Hz]: G = (f_s - jw f_c)/(f_s - w² - jw (f_v + f_c)) about the equilibrium."""
    s, h = (s0 + v * T) / sqrt(1 - (v / v0) ** 4), 1e-6

    def f(dv, c, ds):
        return driver.following_acceleration(v + dv, v0, s + ds, c, s0, T, a, b)

    f_s, f_v, f_c = ((f(*d) - f(*-d)) / (2 * h) for d in (np.array([0, 0, h]), np.array([h, 0, 0]), np.array([0, h, 0])))
    frequency = np.arange(0.0005, 0.1, 5e-5)
    jw = 2j * np.pi * frequency
    found = np.abs((f_s - jw * f_c) / (f_s + jw * jw - jw * (f_v + f_c)))
    return found.max(), frequency[found.argmax()]


@pytest.mark.parametrize(
    ("settings", "speed", "peak", "at"),
    [
        ((1.2, 1.4, 2.0), 54, 1.00231, 0.0150),
        ((1.0, 1.0, 1.5), 40, 1.01438, 0.0252),
        ((1.0, 1.0, 1.5), 80, 1.0, 0.0005),
        ((1.6, 0.73, 1.67), 54, 1.02237, 0.0167),
        ((1.0, 0.6, 1.5), 54, 1.02941, 0.0200),
    ],
)
def test_how_much_a_wave_grows_from_car_to_car(settings, speed, peak, at):
    assert gain(speed / 3.6, *settings) == pytest.approx((peak, at), abs=1e-4)


@pytest.mark.parametrize(("v", "gap", "hardest"), [(14.0, 300.0, 1.789), (20.0, 300.0, 2.006), (30.0, 400.0, 2.219)])
def test_towards_an_object(v, gap, hardest):
    """A point mass on its wanted speed: greatest deceleration, and the gap at rest."""
    v0, dt, found = v, 0.002, []
    while v > 1e-3 or not found:
        found.append(driver.following_acceleration(v, v0, gap, v, 2.0, 1.2, 1.4, 2.0))
        if v < 0.01 and found[-1] > -1e-4:
            break
        v = max(v + found[-1] * dt, 0.0)
        gap -= v * dt
    assert -min(found) == pytest.approx(hardest, abs=2e-3)
    assert gap == pytest.approx(1.94, abs=0.005)


@pytest.mark.parametrize(("a", "wanted", "speed", "seconds"), [(1.0, 120, 100, 31.561), (1.4, 50, 45, 10.938), (1.4, 130, 100, 21.591)])
def test_on_a_free_road(a, wanted, speed, seconds):
    """t = v0/(2a) (atanh x + atan x), x = v/v0: the law integrated, against its closed form."""
    v0, x = wanted / 3.6, speed / wanted
    assert v0 / (2 * a) * (atanh(x) + atan(x)) == pytest.approx(seconds, abs=5e-4)
    v = np.linspace(0.0, speed / 3.6, 20_001)
    middle = 0.5 * (v[1:] + v[:-1])
    assert sum(v[1] / driver.free_acceleration(each, v0, a, 2.0) for each in middle) == pytest.approx(seconds, abs=1e-3)


# -- lights --------------------------------------------------------------------------------------------


def test_stop_or_go():
    """Stops exactly when v t + v²/(2 b) is left before the place where he stops."""
    v = 13.9
    needed = 0.3 * v + v * v / (2 * driver.STOP_FIRM) + driver.STOP_CLOSE
    assert driver.must_stop(v, needed * 1.01) and not driver.must_stop(v, needed * 0.99)
    assert driver.must_stop(0.0, 0.5)  # whoever stands near the line waits


def stopped(v, distance, delay=0.2, dt=0.01):
    """Requests of a driver towards a line, on a point mass that answers late; and where it stands before the line [m]."""
    asked = []
    while v > 0.0 and distance > 0.0:
        asked.append(driver.stopping_acceleration(v, distance, 1.4, 2.0))
        v += dt * asked[max(len(asked) - 1 - round(delay / dt), 0)] * (len(asked) > delay / dt)
        distance -= v * dt
    return np.array(asked), distance


@given(v=st.floats(3, 25))
def test_a_stop_takes_no_more_than_the_decision_assumed(v):
    """At the last moment, where firm braking just does: 4 m/s² are asked for, and no more, and he stands at his place."""
    asked, rest = stopped(v, 1.001 * (0.3 * v + v * v / (2 * driver.STOP_FIRM) + driver.STOP_CLOSE))
    assert -asked.min() <= driver.STOP_FIRM + 1e-9
    assert rest == pytest.approx(driver.STOP_CLOSE, abs=0.35)


@given(v=st.floats(3, 25))
def test_a_stop_from_afar_is_a_comfortable_one(v):
    asked, rest = stopped(v, v * v / 2.0 + 10.0)
    assert -asked.min() < 2.3
    assert rest == pytest.approx(driver.STOP_CLOSE, abs=0.35)


@given(v=st.floats(0, 40), distance=st.floats(0, 300))
def test_towards_a_line_is_never_faster_than_free(v, distance):
    assert driver.stopping_acceleration(v, distance, 1.4, 2.0) <= 1.4
