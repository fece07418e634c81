"""Sensor, radio and actuators: their laws."""

from math import exp, pi

import pytest

from studio.model import actuator, radio, sensor, vehicle, wheel


def test_a_lag_follows_its_exponential():
    """63.2 % after one time constant; the implicit step converges to it."""
    for dt, tolerance in ((0.005, 0.02), (0.0005, 0.002)):
        value = 0.0
        for _ in range(round(0.1 / dt)):
            value = actuator.lag(value, 1.0, 0.1, dt)
        assert value == pytest.approx(1 - exp(-1), abs=tolerance)


def test_power_limits_the_torque():
    R, P = 0.3, 60_000.0
    assert actuator.drive_torque(1e6, R, 20.0, 1e9, P) == pytest.approx(P * R / 20.0)
    assert actuator.drive_torque(-100.0, R, 20.0, 1e9, P) == 0.0
    assert actuator.brake_torque(-100.0, R, 1e9) == pytest.approx(30.0)


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
    assert radio.is_lost(301.0, 300.0, 0.0, 0.0, 0.999)
    assert not radio.is_lost(299.0, 300.0, 0.0, 0.0, 1e-9)
    assert radio.is_lost(100.0, 300.0, 0.1, 0.001, 0.19) and not radio.is_lost(100.0, 300.0, 0.1, 0.001, 0.21)
    assert radio.delay(0.02, 0.005, 0.0) == pytest.approx(0.015)
    assert radio.delay(0.001, 0.005, 0.0) == 0.0


def test_ackermann_points_at_one_centre():
    """Both front wheels and the rear axle turn about the same point: cot(right) - cot(left) = track/wheelbase."""
    from math import tan

    L, track, delta = 2.6, 1.4, 0.3
    left, right = vehicle.ackermann(delta, L, track / 2), vehicle.ackermann(delta, L, -track / 2)
    assert left > delta > right
    assert 1 / tan(right) - 1 / tan(left) == pytest.approx(track / L)


def test_a_brake_holds_and_never_reverses():
    omega, _ = wheel.spin(0.5, 0.1, 0.0, 60_000.0, 1.7, 0.3, 0.0, 5000.0, 0.0, 0.005)
    assert omega == 0.0
    still, F_x = wheel.spin(0.0, 0.0, 0.0, 60_000.0, 1.7, 0.3, 100.0, 5000.0, 0.0, 0.005)
    assert still == 0.0 and F_x == 0.0
