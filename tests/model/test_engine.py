"""The engine: what the pedal means, drag, rev limit, idle, governor and lag."""

import itertools
from math import exp

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.model import engine

T_DRAG, T_CURVE, LIMIT, IDLE, J_E = -25.0, 150.0, 600.0, 80.0, 0.15


def test_drag_opposes_rotation_and_grows():
    assert engine.drag(100.0, 20.0, 0.05) == pytest.approx(-25.0)
    assert engine.drag(-100.0, 20.0, 0.05) == pytest.approx(25.0)
    assert engine.drag(0.0, 20.0, 0.05) == 0.0  # an engine at rest pushes nowhere


def test_full_load_fades_to_the_drag_at_the_rev_limit():
    fades_from = LIMIT * (1.0 - engine.TAPER)
    assert engine.full_load(fades_from, T_CURVE, T_DRAG, LIMIT) == pytest.approx(T_CURVE)
    assert engine.full_load(0.5 * (fades_from + LIMIT), T_CURVE, T_DRAG, LIMIT) == pytest.approx(0.5 * (T_CURVE + T_DRAG))
    assert engine.full_load(LIMIT, T_CURVE, T_DRAG, LIMIT) == T_DRAG
    assert engine.full_load(1.2 * LIMIT, T_CURVE, T_DRAG, LIMIT) == T_DRAG


def test_regeneration_brakes_a_turning_motor_only():
    assert engine.lowest(200.0, T_DRAG, 100.0) == T_DRAG - 100.0
    assert engine.lowest(0.0, 0.0, 100.0) == 0.0


def test_a_motor_gives_way_as_its_wheels_slide():
    """All of it up to GRIPS, half in the middle, nothing from SLIDES on; wheels that are driven, or roll, take nothing away."""
    middle = 0.5 * (engine.GRIPS + engine.SLIDES)
    assert [engine.taken_back(slip) for slip in (0.2, 0.0, -0.99 * engine.GRIPS, -engine.SLIDES, -1.0)] == [1.0, 1.0, 1.0, 0.0, 0.0]
    assert engine.taken_back(-middle) == pytest.approx(0.5)


def test_the_pedal_goes_from_drag_to_full_load_and_most_at_first():
    torques = [engine.by_pedal(u, T_DRAG, T_CURVE) for u in (0.0, 0.25, 0.5, 0.75, 1.0)]
    steps = [b - a for a, b in itertools.pairwise(torques)]
    assert torques[0] == T_DRAG and torques[-1] == T_CURVE
    assert steps == sorted(steps, reverse=True) and steps[-1] > 0.0
    assert engine.by_pedal(-0.5, T_DRAG, T_CURVE) == T_DRAG and engine.by_pedal(1.5, T_DRAG, T_CURVE) == T_CURVE


@given(st.floats(0, 1), st.floats(-50, -1), st.floats(20, 800))
def test_pedal_and_torque_are_each_others_inverse(u, T_drag, T_curve):
    assert engine.pedal_for(engine.by_pedal(u, T_drag, T_curve), T_drag, T_curve) == pytest.approx(u, abs=1e-6)


def test_an_engine_left_alone_idles():
    """From 60 rad/s up and from 300 rad/s down to the idle speed, where it stays."""
    for w in (60.0, 300.0):
        T_e, dt = 0.0, 0.005
        for _ in range(4000):
            T_drag = engine.drag(w, 20.0, 0.05)
            T = engine.idled(engine.by_pedal(0.0, T_drag, T_CURVE), w, IDLE, J_E)
            T_e = engine.torque(T_e, T, T_drag, T_CURVE, 0.02, dt)
            w += dt * T_e / J_E
        assert w == pytest.approx(IDLE, rel=1e-3)


def test_a_motor_does_not_idle():
    assert engine.idled(-5.0, 0.0, 0.0, J_E) == -5.0


def test_the_governor_lets_a_slipping_clutch_bring_up_the_revs():
    """At the wanted speed the engine gives what the clutch carries; below more, above less: what removes the difference in
    SPEED_TIME. Never more than asked."""
    per_speed = J_E / engine.SPEED_TIME
    assert engine.governed(150.0, 200.0, 200.0, 90.0, J_E) == 90.0
    assert engine.governed(150.0, 180.0, 200.0, 90.0, J_E) == pytest.approx(90.0 + 20.0 * per_speed)
    assert engine.governed(150.0, 220.0, 200.0, 90.0, J_E) == pytest.approx(90.0 - 20.0 * per_speed)
    assert engine.governed(50.0, 180.0, 200.0, 90.0, J_E) == 50.0


def test_an_engine_is_brought_up_for_a_lower_gear():
    """Without clutch it goes to the new input speed as exp(-t/MATCH_TIME), and only upwards."""
    w, dt = 150.0, 1e-4
    for _ in range(round(engine.MATCH_TIME / dt)):
        w += dt * engine.matched(0.0, w, 300.0, J_E) / J_E
    assert w == pytest.approx(300.0 - 150.0 * exp(-1.0), rel=1e-3)
    assert engine.matched(-20.0, 350.0, 300.0, J_E) < 0.0 and engine.matched(80.0, 350.0, 300.0, J_E) == 80.0


def test_torque_follows_its_lag_within_what_the_engine_can():
    T_e, dt = 0.0, 1e-4
    for _ in range(2000):
        T_e = engine.torque(T_e, 500.0, T_DRAG, T_CURVE, 0.2, dt)
    assert T_e == pytest.approx(T_CURVE * (1.0 - exp(-1.0)), rel=1e-3)
    for _ in range(20_000):
        T_e = engine.torque(T_e, -500.0, T_DRAG, T_CURVE, 0.2, dt)
    assert T_e == pytest.approx(T_DRAG, rel=1e-3)
