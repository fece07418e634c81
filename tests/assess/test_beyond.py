"""Outside the validated span: closed forms of shares, and the quantity that led there."""

from dataclasses import replace

import numpy as np
import pytest

from studio.assess.beyond import stretches
from studio.execution.cast import Cast, Manned
from studio.kinds.metric import outside_validated_span as metric
from tests.assess.drive import record

SPAN = {"speed": [0.0, 20.0], "acceleration": [-4.0, 2.0], "lateral_acceleration": [-3.0, 3.0], "yaw_rate": [-0.5, 0.5]}
TIME = np.linspace(0.0, 10.0, 101)


def made(span, **channels):
    manned = {"a": Manned("car", {}, 0, "full", span), "b": Manned("car", {}, 0)}
    return replace(record(TIME, **channels), cast=Cast(manned, (), (0.0, 0.0)))


def test_the_share_and_what_led_there():
    """From 0 to 25 m/s within 10 s: the last fifth is too fast; the other car has no span and does not count."""
    found = metric.measure(made(SPAN, speed=np.array([2.5 * TIME, 10 * TIME])))
    assert found.value == pytest.approx(20 / 101) and found.subject == ("a", "speed") and found.time == 10.0


def test_the_farthest_is_told():
    """A speed a quarter of its span too high is farther than a yaw rate a tenth too high."""
    speed, yaw = np.where(TIME > 5, 25.0, 10.0), np.where(TIME < 2, 0.6, 0.0)
    found = metric.measure(made(SPAN, speed=np.array([speed, speed]), yaw_rate=np.array([yaw, yaw])))
    assert found.value == pytest.approx((50 + 20) / 101) and found.subject == ("a", "speed")


def test_bounds_belong_to_the_span():
    assert metric.measure(made(SPAN, speed=np.full((2, 101), 20.0))).value == 0.0


def test_without_a_span_it_is_said():
    found = metric.measure(made(None, speed=np.full((2, 101), 20.0)))
    assert np.isnan(found.value) and found.why == "no vehicle here has a validated span"


def test_where_it_was_and_what_led_there():
    """Too fast from 8 s on, up to 25 m/s; before, for a second, it turns too fast; of what was not recorded nothing is said."""
    yaw = np.where((TIME >= 2.0) & (TIME < 3.0), 0.75, 0.0)
    speed, lateral = 2.5 * TIME, np.full((2, 101), np.nan)
    (found,) = stretches(made(SPAN, speed=np.array([speed, speed]), yaw_rate=np.array([yaw, yaw]), lateral_acceleration=lateral))
    assert found.vehicle == "a" and found.not_recorded == ("lateral_acceleration",)
    turned, fast = found.stretches
    assert turned == (pytest.approx(2.0), pytest.approx(3.0), "yaw_rate", 0.75, -0.5, 0.5)
    assert fast == (pytest.approx(8.1), 10.0, "speed", 25.0, 0.0, 20.0)


def test_light_dynamics_and_cars_without_a_span_have_no_stretches():
    fast = {"speed": np.full((2, 101), 90.0)}
    light = Cast({"a": Manned("car", {}, 0, "light", SPAN), "b": Manned("car", {}, 0)}, (), (0.0, 0.0))
    assert stretches(made(None, **fast)) == [] == stretches(replace(made(None, **fast), cast=light))
