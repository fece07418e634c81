"""The attentive driver: asked alone, as machine code and as Python."""

from math import inf, isfinite

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.kind import registry
from studio.kind.driver import Sees
from studio.kind.number import numbers, tuple_of
from studio.kinds.driver import attentive
from studio.model import driver

USUAL = tuple_of(attentive, attentive.Settings)(*numbers(attentive.Settings()))
speeds, gaps, small = st.floats(0, 60), st.one_of(st.just(inf), st.floats(-5, 300)), st.floats(-1, 1)
anything = st.builds(
    Sees, speeds, small, speeds, gaps, speeds, gaps, speeds, gaps, small, small, st.floats(-0.1, 0.1), st.floats(0, 0.01),
    st.floats(0.1, 1), st.floats(0.1, 1), st.floats(1, 7), st.floats(0, 0.01), small, speeds,
)  # fmt: skip


def asked(**sees):
    """The acceleration of the usual driver who sees nothing but this."""
    return attentive.decide(USUAL, Sees(steering_max=0.6, **sees)).acceleration


@given(sees=anything)
def test_compiled_and_interpreted_agree(sees):
    compiled, plain = attentive.decide(USUAL, sees), attentive.decide.py_func(USUAL, sees)
    assert compiled == pytest.approx(plain, rel=1e-12) and all(map(isfinite, compiled))


def test_he_accelerates_on_a_free_road_and_keeps_his_speed():
    assert asked(speed=0.0, desired_speed=15.0) == USUAL.acceleration
    assert asked(speed=15.0, desired_speed=15.0) == 0.0


def test_whoever_asks_most_is_minded():
    """Each alone, and all together: the least of them."""
    speeds = {"speed": 12.0, "desired_speed": 15.0}
    ahead, first, light = {"ahead_gap": 30.0, "ahead_speed": 10.0}, {"first_gap": 20.0, "first_speed": 8.0}, {"stop_distance": 40.0}
    alone = [asked(**speeds, **each) for each in (ahead, first, light)]
    assert asked(**speeds, **ahead, **first, **light) == min(alone) < max(alone) < asked(**speeds)


def test_courtesy_has_a_limit():
    """Somebody who goes first is not braked for as hard as somebody who is there."""
    near = {"speed": 15.0, "desired_speed": 15.0}
    assert asked(**near, first_gap=5.0) == -driver.COURTESY > asked(**near, ahead_gap=5.0)


def test_he_is_the_usual_driver():
    assert registry.find("driver", "attentive").is_built_in
