"""Sensor, radio, actuators, brakes and air: their laws."""

from math import exp, pi

import pytest

from studio.conventions import AIR_DENSITY
from studio.model import actuator, aerodynamics, brake, sensor
from studio.model.radio import arrival


def test_a_lag_follows_its_exponential():
    """63.2 % after one time constant; the implicit step converges to it."""
    for dt, tolerance in ((0.005, 0.02), (0.0005, 0.002)):
        value = 0.0
        for _ in range(round(0.1 / dt)):
            value = actuator.lag(value, 1.0, 0.1, dt)
        assert value == pytest.approx(1 - exp(-1), abs=tolerance)


def test_a_lag_without_time_is_immediate_and_never_overshoots():
    assert actuator.lag(0.0, 1.0, 0.0, 0.005) == 1.0
    assert 0.0 < actuator.lag(0.0, 1.0, 1e-6, 10.0) <= 1.0


def test_a_rate_is_limited_both_ways():
    assert actuator.rate_limited(0.0, 1.0, 0.05, 0.4, 0.005) == pytest.approx(0.002)
    assert actuator.rate_limited(0.0, -1.0, 0.05, 0.4, 0.005) == pytest.approx(-0.002)
    assert actuator.rate_limited(0.0, 1e-4, 0.05, 0.4, 0.005) == actuator.lag(0.0, 1e-4, 0.05, 0.005)


def test_an_acceleration_asks_for_inertia_and_resistances():
    assert actuator.wheel_force(2.0, 1500.0, 300.0, 120.0) == 3420.0


def test_brake_pressure_follows_within_its_limits():
    """tau dP/dt = b u - P; torque K_b P, shared between the axles and no more than the greatest one."""
    K_b, T_max, tau, dt = 2e-4, 3000.0, 0.1, 1e-4
    P = 0.0
    for _ in range(1000):
        P = brake.pressure(P, 2000.0, K_b, T_max, tau, dt)
    assert K_b * P == pytest.approx(2000.0 * (1.0 - exp(-1.0)), rel=1e-3)
    front, rear = brake.axle_torque(P, K_b, 0.7), brake.axle_torque(P, K_b, 0.3)
    assert front / rear == pytest.approx(0.7 / 0.3) and front + rear == pytest.approx(K_b * P)
    assert brake.pressure(0.0, 1e9, K_b, T_max, 0.0, dt) == pytest.approx(T_max / K_b)
    assert brake.pressure(0.0, -500.0, K_b, T_max, 0.0, dt) == 0.0


def test_air_drags_against_the_motion():
    """Massow & Radusch 2018, Eq. 12."""
    assert aerodynamics.air_drag(0.37, 1.93, 30.0) == pytest.approx(0.5 * 1.293 * 0.37 * 1.93 * 900.0)
    assert aerodynamics.air_drag(0.37, 1.93, -30.0) == -aerodynamics.air_drag(0.37, 1.93, 30.0)
    assert AIR_DENSITY == 1.293


def test_the_corridor_bends_with_the_road():
    """On a bend of 50 m radius the car ahead on the same arc is in the corridor; straight ahead is not."""
    kappa = sensor.own_curvature(10.0, 0.2)
    assert kappa == pytest.approx(1 / 50)
    forward, left = 30.0, 30.0**2 / 100
    assert sensor.in_corridor(forward, left, kappa) and not sensor.in_corridor(forward, 0.0, kappa)


def test_the_cone():
    assert sensor.in_view(10.0, 0.0, 50.0, 0.3)
    assert not sensor.in_view(10.0, 0.0, 9.0, 0.3)
    assert not sensor.in_view(10.0, 4.0, 50.0, 0.3)
    assert not sensor.in_view(-10.0, 0.0, 50.0, pi)


def test_radio_limits():
    assert arrival.is_lost(301.0, 300.0, 0.0, 0.0, 0.999)
    assert not arrival.is_lost(299.0, 300.0, 0.0, 0.0, 1e-9)
    assert arrival.is_lost(100.0, 300.0, 0.1, 0.001, 0.19) and not arrival.is_lost(100.0, 300.0, 0.1, 0.001, 0.21)
    assert arrival.delay(0.02, 0.005, 0.0) == pytest.approx(0.015)
    assert arrival.delay(0.001, 0.005, 0.0) == 0.0
