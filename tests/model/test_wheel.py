"""The wheel: slip taken up over a length, bounded at rest, and a spin that is stable at any step."""

from math import copysign, exp

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.model import wheel
from studio.model.wheel import SIGMA

J, R, DT = 1.5, 0.3, 0.005


def rolled(V_slide, V_x, distance, dt):
    """Slip after a distance, from none."""
    slip = 0.0
    for _ in range(round(distance / abs(V_x) / dt)):
        slip = wheel.uptake(slip, V_slide, V_x, dt)
    return slip


@pytest.mark.parametrize("V_x", [0.5, 5.0, 50.0, -5.0])
def test_slip_is_taken_up_over_a_length_whatever_the_speed(V_x):
    """63.2 % of V_slide/|V_x| after sigma, all of it after ten."""
    steady, dt = 0.04, SIGMA / abs(V_x) / 500
    assert rolled(steady * abs(V_x), V_x, SIGMA, dt) == pytest.approx(steady * (1.0 - exp(-1.0)), rel=2e-3)
    assert rolled(steady * abs(V_x), V_x, 10 * SIGMA, dt) == pytest.approx(steady, rel=1e-3)


def test_at_rest_slip_is_a_spring():
    """A patch that does not roll stores the way over sigma: 2 mm are 2 %."""
    slip = 0.0
    for _ in range(100):
        slip = wheel.uptake(slip, 0.02 * SIGMA / (100 * DT), 0.0, DT)
    assert slip == pytest.approx(0.02)
    assert wheel.uptake(slip, 0.0, 0.0, DT) == slip  # and keeps it


@given(st.floats(-1.5, 1.5), st.floats(-70, 70), st.floats(-70, 70))
def test_uptake_never_overshoots(slip, V_slide, V_x):
    """The new slip lies between the old one and the steady one, however long the step."""
    after = wheel.uptake(slip, V_slide, V_x, 10.0)
    if V_x == 0.0:
        return
    steady = V_slide / abs(V_x)
    assert min(slip, steady) - 1e-9 <= after <= max(slip, steady) + 1e-9


def test_what_slides_may_take_up_more():
    assert wheel.slip_bound(0.1, 0.0) == 0.1
    assert wheel.slip_bound(0.1, 0.5) == pytest.approx(0.6)
    assert wheel.slip_bound(0.1, 100.0) == wheel.SLIP_MAX
    assert wheel.bounded(0.3, 0.1) == 0.1 and wheel.bounded(-0.3, 0.1) == -0.1 and wheel.bounded(0.05, 0.1) == 0.05


def test_damping_at_rest_fades_out_with_speed():
    tau = 0.02
    assert wheel.rest_gain(tau, 0.0) == pytest.approx(tau / SIGMA)
    assert wheel.rest_gain(tau, wheel.V_REST) == 0.0 and wheel.rest_gain(tau, -30.0) == 0.0
    assert 0.0 < wheel.rest_gain(tau, 0.7 * wheel.V_REST) < tau / SIGMA


def test_secant_stiffness_is_positive_on_both_sides_of_the_peak():
    assert wheel.secant_stiffness(3000.0, 0.1, 60_000.0) == pytest.approx(30_000.0)
    assert wheel.secant_stiffness(-3000.0, -0.1, 60_000.0) == pytest.approx(30_000.0)
    assert wheel.secant_stiffness(0.0, 0.0, 60_000.0) == 60_000.0  # the slope at the origin
    assert wheel.secant_stiffness(-50.0, 0.001, 60_000.0) == 0.0  # a shifted curve
    assert wheel.secant_stiffness(100.0, 1e-4, 60_000.0) == 60_000.0


def test_slip_per_spin_is_the_derivative_of_what_the_tyre_uses():
    """kappa_used = uptake + gain v_s, by finite differences over omega."""
    V_x, gain, omega, slip = 1.3, 0.12, 5.0, 0.03
    used = [wheel.uptake(slip, R * w - V_x, V_x, DT) + gain * (R * w - V_x) for w in (omega - 1e-4, omega + 1e-4)]
    assert wheel.slip_per_spin(R, V_x, gain, DT) == pytest.approx((used[1] - used[0]) / 2e-4, rel=1e-6)


@given(st.floats(-200, 200), st.floats(0, 1e5))
def test_a_brake_stops_a_wheel_and_never_turns_it_back(omega, T_brake):
    after = wheel.spin(omega, 0.0, 0.0, T_brake, R, J, DT)
    assert after * omega >= 0.0
    assert abs(after) == pytest.approx(max(abs(omega) - DT * T_brake / J, 0.0))


def test_a_brake_holds_against_drive_up_to_its_torque():
    assert wheel.spin(0.0, 0.0, 400.0, 500.0, R, J, DT) == 0.0
    assert wheel.spin(0.0, 0.0, 600.0, 500.0, R, J, DT) == pytest.approx(DT * 100.0 / J)
    assert wheel.spin(0.0, 0.0, -600.0, 500.0, R, J, DT) == pytest.approx(-DT * 100.0 / J)


def test_drive_and_tyre_force_change_the_spin():
    assert wheel.spin(50.0, 1000.0, 450.0, 0.0, R, J, DT) == pytest.approx(50.0 + DT * 150.0 / J)


@pytest.mark.parametrize("V_x", [0.05, 1.0, 70.0])
@pytest.mark.parametrize("omega", [0.0, 300.0])
def test_a_wheel_finds_its_rolling_speed_at_any_step(V_x, omega):
    """A free wheel on a stiff linear tyre, 5 ms and 0.1 s: it comes to R omega = V_x without end or explosion."""
    for dt in (0.005, 0.1):
        w, slip, K = omega, 0.0, 80_000.0
        gain = wheel.rest_gain(0.02, V_x)
        for _ in range(4000):
            v_s = R * w - V_x
            slip = wheel.bounded(wheel.uptake(slip, v_s, V_x, dt), wheel.SLIP_MAX)
            used = slip + gain * v_s
            F_x = copysign(min(K * abs(used), 4000.0), used)
            slope = wheel.secant_stiffness(F_x, used, K) * wheel.slip_per_spin(R, V_x, gain, dt)
            w = wheel.spin(w, F_x, 0.0, 0.0, R, wheel.implicit_inertia(J, R, slope, dt), dt)
        assert R * w == pytest.approx(V_x, rel=1e-3)


def test_rolling_resistance_fades_at_rest():
    assert wheel.rolling_torque(0.012, 4000.0, R, 10.0) == pytest.approx(0.012 * 4000.0 * R)
    assert wheel.rolling_torque(0.012, 4000.0, R, -10.0) == pytest.approx(0.012 * 4000.0 * R)
    assert wheel.rolling_torque(0.012, 4000.0, R, 0.0) == 0.0
