"""Vehicles side by side move as each does alone; a speed is held, closely, where one is given."""

import numpy as np
import pytest

from studio.rig import side
from studio.rig.drive import drive
from studio.rig.side import Order
from studio.scenario import catalogue

STEP = 0.005
TIME = np.linspace(0.0, 3.0, 31)
WEAVE = {"time_s": TIME, "road_wheel_angle_rad": 0.02 * np.sin(3.0 * TIME)}
PEDALS = {"time_s": np.array([0.0, 1.0, 2.5]), "throttle": np.array([0.8, 0.0, 0.0]), "brake": np.array([0.0, 0.2, 0.5])}
HANDWHEEL = {"time_s": TIME, "steering_wheel_angle_rad": np.minimum(TIME, 1.0), "speed_mps": np.full(31, 15.0)}
GEARED = {"time_s": np.array([0.0, 1.0, 2.0]), "gear": np.array([2.0, 2.0, 3.0]), "throttle": np.array([0.5, 0.5, 0.5])}
DRIVEN = [("bmw_320i", WEAVE, 20.0), ("suv", PEDALS, 0.0), ("smart_fortwo", HANDWHEEL, 15.0), ("bmw_320i", GEARED, 8.0)]


def test_everyone_moves_as_alone():
    """Bit by bit, whatever the others are and however long they drive."""
    orders = [Order(catalogue.find_vehicle(name), inputs, speed) for name, inputs, speed in DRIVEN]
    made = side.together(orders, step=STEP, period=0.01)
    for (name, inputs, speed), outcome in zip(DRIVEN, made, strict=True):
        alone = drive(name, inputs, speed=speed)
        assert outcome.columns["time_s"].size == alone.time.size
        different = [column for column in alone.columns if not (outcome.columns[column] == alone[column]).all()]
        assert different == [], name


def test_a_road_is_that_of_its_vehicle():
    car = catalogue.find_vehicle("bmw_320i")
    downhill, level = side.together(
        [Order(car, {"time_s": np.array([0.0, 4.0])}, 10.0, {"road.slope": -0.1}), Order(car, {"time_s": np.array([0.0, 4.0])}, 10.0)],
        step=STEP,
        period=0.01,
    )
    assert downhill.columns["vx_mps"][-1] > 10.0 > level.columns["vx_mps"][-1]


def test_a_speed_is_held_and_followed():
    """As a mass with proportional and integral part: neither resistance nor a ramp nor a bend leaves a difference."""
    ramp = drive("bmw_320i", {"time_s": [0.0, 8.0], "speed_mps": [10.0, 18.0]}, speed=10.0)
    behind = 10.0 + ramp.time - ramp["vx_mps"]
    mass = np.exp(-side.HELD / 2 * ramp.time) * ramp.time  # s/(s² + HELD s + HELD KEPT) of the ramp's 1/s²
    assert np.abs(behind - mass).max() < 0.4 * mass.max() and abs(behind[-1]) < 1e-3
    turned = {"time_s": [0.0, 1.0, 8.0], "road_wheel_angle_rad": [0.0, 0.03, 0.03], "speed_mps": [20.0, 20.0, 20.0]}
    assert drive("bmw_320i", turned, speed=20.0)["vx_mps"][-1] == pytest.approx(20.0, abs=1e-3)


def test_nobody_holds_where_no_speed_is_given():
    """From the moment at which the speed is not a number the car rolls free."""
    car = catalogue.find_vehicle("bmw_320i")
    inputs = {"time_s": np.array([0.0, 2.0, 2.01, 6.0]), "speed_mps": np.array([20.0, 20.0, np.nan, np.nan])}
    (made,) = side.together([Order(car, inputs, 20.0)], step=STEP, period=0.01)
    speed, time = made.columns["vx_mps"], made.columns["time_s"]
    assert np.ptp(speed[time < 2.0]) < 0.2 and speed[-1] < speed[time < 2.0][-1] - 0.3
    assert made.columns["drive_torque_Nm"][-1] == 0.0


def test_one_that_breaks_stops_nobody_else():
    car = catalogue.find_vehicle("bmw_320i")
    inputs = {"time_s": np.array([0.0, 1.0])}
    bad, good = side.together(
        [Order(car, inputs | {"drive_torque_Nm": np.array([0.0, np.nan])}, 10.0), Order(car, inputs, 10.0)], step=STEP, period=0.01
    )
    assert bad.broke is not None and good.broke is None
    assert np.isfinite(good.columns["x_m"]).all()
