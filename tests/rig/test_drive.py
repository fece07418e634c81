"""The open-loop rig: inputs, outputs, what is refused; and drives that once went wrong."""

import csv

import numpy as np
import pytest
import yaml

import studio
from studio.errors import RunError, ScenarioError, UnknownError
from studio.rig import drive as rig
from studio.rig import side
from studio.rig.drive import drive
from studio.scenario import catalogue
from studio.vehicle.parameter import MASS

VEHICLES = catalogue.vehicle_names()
STRAIGHT = {"time_s": [0.0, 5.0], "throttle": [1.0, 1.0]}


def problems(call, *arguments, **options):
    """The problems of a refusal."""
    with pytest.raises(ScenarioError) as caught:
        call(*arguments, **options)
    return caught.value.problems


def written(tmp_path, text, name="inputs.csv"):
    path = tmp_path / name
    path.write_text(text)
    return path


# --- what comes out ------------------------------------------------------------------------------------------------------


def test_every_promised_column(tmp_path):
    made = studio.drive("bmw_320i", STRAIGHT)
    wheels = [f"{name}_{i}" for name in ("Fz_N", "wheel_speed_radps") for i in (1, 2, 3, 4)]
    names = "x_m y_m yaw_rad vx_mps vy_mps yaw_rate_radps ax_mps2 ay_mps2 roll_rad pitch_rad gear engine_speed_radps".split()
    assert {*names, *wheels, "time_s"} <= set(made.columns)
    assert all(column.shape == made.time.shape for column in made.columns.values())
    assert made.time[[0, -1]].tolist() == [0.0, 5.0] and np.allclose(np.diff(made.time), 0.01)
    rig.write(made, tmp_path / "out.csv")
    with (tmp_path / "out.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == made.time.size
    assert float(rows[-1]["vx_mps"]) == pytest.approx(made["vx_mps"][-1], rel=1e-8)
    with pytest.raises(UnknownError, match="vx_mps"):
        made["vx_mp"]


def test_a_file_and_columns_are_the_same(tmp_path):
    path = written(tmp_path, "\ufefftime_s, throttle\r\n0,1\r\n\r\n5,1\r\n")
    by_file, by_columns = drive("suv", path), drive("suv", STRAIGHT)
    assert (by_file["x_m"] == by_columns["x_m"]).all()


def test_inputs_are_linear_and_gears_hold():
    made = drive("bmw_320i", {"time_s": [0, 1, 2], "road_wheel_angle_rad": [0, 0.1, 0], "gear": [2, 3, 3]}, speed=8.0)
    at = lambda t: int(np.argmin(abs(made.time - t)))  # noqa: E731
    assert made["road_wheel_angle_rad"][at(0.5)] == pytest.approx(0.05, abs=1e-3)
    assert made["road_wheel_angle_rad"][at(1.5)] == pytest.approx(0.05, abs=1e-3)
    assert (made["gear"][: at(1.0)] == 2).all() and made["gear"][-1] == 3


def test_without_the_powertrain_it_is_in_neutral():
    made = drive("bmw_320i", {"time_s": [0, 1], "brake_torque_Nm": [0, 0]}, speed=20.0)
    assert (made["gear"] == 0).all() and (made["drive_torque_Nm"] == 0).all()


@pytest.mark.parametrize("step", [0.005, 0.0025, 0.001, 0.0005])
@pytest.mark.parametrize("vehicle", ["truck", "smart_fortwo"])
def test_dead_times_do_not_depend_on_the_step(vehicle, step):
    """The brake begins a dead time after the pedal, within one step."""
    delay = catalogue.find_vehicle(vehicle).values.brakes.delay
    made = drive(vehicle, {"time_s": [0, 0.5, 0.5001, 1], "brake": [0, 0, 1, 1]}, speed=20.0, step=step, period=step)
    begins = made.time[np.argmax(made["brake_torque_Nm"] > 0)]
    assert begins == pytest.approx(0.5 + delay, abs=2.1 * step)


def test_road_and_tyre_can_be_changed(root):
    slope = drive("bmw_320i", {"time_s": [0, 2], "brake": [0, 0]}, speed=5.0, changes={"road.slope": -0.1})
    assert slope["vx_mps"][-1] > 6.0 and slope["z_m"][-1] < slope["z_m"][0]
    file = root / "studio" / "scenario" / "tyres" / "smart_145_65r15.tir"
    by_file, by_name = (drive("bmw_320i", STRAIGHT, tyre=tyre) for tyre in (file, "smart_145_65r15"))
    assert (by_file["x_m"] == by_name["x_m"]).all()
    assert by_file["x_m"][-1] != drive("bmw_320i", STRAIGHT)["x_m"][-1]


def test_a_rollover_is_told():
    made = drive("ford_escort", {"time_s": [0, 0.3, 4], "road_wheel_angle_rad": [0, 0.3, 0.3]}, speed=25.0, changes={"road.friction": 1.5})
    assert made.rolled_over is not None and 0.3 < made.rolled_over < 3.0
    assert drive("suv", STRAIGHT).rolled_over is None


# --- drives that once went wrong -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("vehicle", VEHICLES)
@pytest.mark.parametrize("friction", [0.1, 0.3, 1.0])
@pytest.mark.parametrize("step", [0.005, 0.01])
def test_spinning_wheels(vehicle, friction, step):
    """Full throttle from rest: no force beyond the tyre's peak, no acceleration beyond the friction."""
    made = drive(vehicle, {"time_s": [0, 1, 1.1, 8], "throttle": [0, 0, 1, 1]}, changes={"road.friction": friction}, step=step)
    assert made["vx_mps"][-1] > 0.5
    assert np.abs(made["ax_mps2"]).max() < 1.25 * friction * 9.81
    check_forces(made, friction)


def check_forces(made, friction):
    for wheel in (1, 2, 3, 4):
        assert (np.abs(made[f"Fx_N_{wheel}"]) <= 1.3 * friction * made[f"Fz_N_{wheel}"] + 1.0).all()


@pytest.mark.parametrize("vehicle", VEHICLES)
def test_into_gear_with_a_screaming_engine(vehicle):
    """From neutral at full throttle into first: it goes, and no tyre gives more than it has."""
    made = drive(vehicle, {"time_s": [0, 2, 2.01, 6], "throttle": [1, 1, 1, 1], "gear": [0, 0, 1, 1]})
    assert made["vx_mps"][-1] > 2.0
    check_forces(made, 1.0)


@pytest.mark.parametrize("vehicle", ["bmw_320i", "ford_escort", "suv"])
def test_wheels_pulled_backwards_behind_a_converter(vehicle):
    made = drive(vehicle, {"time_s": [0, 3], "throttle": [0, 0], "gear": [1, 1], "drive_torque_Nm": [-3000, -3000]})
    assert (made["vx_mps"] <= 0.1).all()
    assert made["engine_speed_radps"].max() < 150.0  # a turbine turned backwards drives no engine


@pytest.mark.parametrize("vehicle", VEHICLES)
def test_locked_wheels_ask_for_no_lower_gear(vehicle):
    """Brakes that lock the wheels on ice for two seconds: the engine is not over-revved when they roll again."""
    model = catalogue.find_vehicle(vehicle).values
    inputs = {"time_s": [0, 1, 1.01, 3, 3.01, 12], "throttle": [0] * 6, "brake": [0, 0, 1, 1, 0, 0]}
    made = drive(vehicle, inputs, speed=20.0, changes={"road.friction": 0.3})
    assert made["engine_speed_radps"].max() < 1.05 * model.engine.limit_speed


def test_an_electric_car_rolls_back_freely_with_the_pedal_lifted():
    """Nothing drives it that nobody asked for: on a slope it gets faster."""
    made = drive("electric_compact", {"time_s": [0, 5], "throttle": [0, 0]}, changes={"road.slope": 0.2})
    assert made["vx_mps"][-1] < -5.0
    assert (made["engine_torque_Nm"] < 40.0).all()


@pytest.mark.parametrize("vehicle", ["truck", "smart_fortwo"])
@pytest.mark.parametrize("slope", [0.0, 0.12, 0.2])
def test_a_hill_start_does_not_stall_or_hunt(vehicle, slope):
    """Full pedal: the engine stays near idle or above, and every gear is shifted to once."""
    inputs = {"time_s": [0, 1, 1.2, 1.4, 30], "brake": [1, 1, 1, 0, 0], "throttle": [0, 0, 1, 1, 1]}
    made = drive(vehicle, inputs, changes={"road.slope": slope})
    idle = catalogue.find_vehicle(vehicle).values.engine.idle_speed
    assert made["engine_speed_radps"].min() > 0.8 * idle
    assert (np.diff(made["gear"]) >= 0).all() and made["vx_mps"][-1] > 3.0


# --- what is refused -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "where", "what"),
    [
        ("time_s,throttle\n0,0\n2,1\n1,1\n", "line 4, column time_s", "not later"),
        ("time_s,throttle\n0,0\n1,nan\n", "line 3, column throttle", "not a number"),
        ("time_s,throttle\n0,0\n1,inf\n", "line 3, column throttle", "out of range"),
        ("time_s,throttle\n0,0\n1,1.2\n", "line 3, column throttle", "out of range"),
        ("time_s,trottle\n0,0\n1,1\n", "line 1", "not known"),
        ("throttle\n0\n", "line 1", "time_s"),
        ("time_s,throttle\n1,0\n2,0\n", "line 2, column time_s", "begin with 0"),
        ("time_s,throttle\n0,0\n", "inputs.csv", "one row"),
        ("time_s,gear\n0,1.5\n1,2\n", "line 2, column gear", "whole"),
        ("time_s,road_wheel_angle_rad,steering_wheel_angle_rad\n0,0,0\n1,0,0\n", "line 1", "the same"),
        ("", "inputs.csv", "empty"),
    ],
)
def test_bad_inputs_are_named(tmp_path, text, where, what):
    found = problems(drive, "bmw_320i", written(tmp_path, text))
    assert where in found[0].where and what in found[0].what, found


@pytest.mark.parametrize(
    ("options", "where"),
    [
        ({"speed": -1.0}, "--speed"),
        ({"speed": 71.0}, "--speed"),
        ({"speed": float("nan")}, "--speed"),
        ({"step": 0.1}, "--step"),
        ({"step": 0.0}, "--step"),
        ({"period": 0.0123}, "--period"),
        ({"period": float("nan")}, "--period"),
        ({"period": float("inf")}, "--period"),
        ({"changes": {"road.slope": 2.0}}, "road.slope"),
        ({"changes": {"road.friction": "much"}}, "road.friction"),
        ({"changes": {"road.colour": 1.0}}, "road.colour"),
        ({"changes": {"body.mass": -5.0}}, "body.mass"),
        ({"tyre": "no_such_tyre"}, "tyre"),
    ],
)
def test_bad_options_are_named(options, where):
    assert where in problems(drive, "bmw_320i", STRAIGHT, **options)[0].where


def test_a_gear_that_over_revs_at_the_start_is_refused():
    (problem,) = problems(drive, "suv", {"time_s": [0, 1], "gear": [1, 1]}, speed=50.0)
    assert problem.where == "gear" and "over-revs" in problem.what


def test_a_vehicle_too_heavy_for_its_tyres_is_refused():
    assert problems(drive, "truck", STRAIGHT, changes={"body.mass": 39_000.0})[0].where.startswith("tyres.")


def test_a_state_that_is_none_ends_the_drive(monkeypatch):
    """It is told which quantity of which vehicle, and when."""
    made = side.of

    def poisoned(*arguments):
        fleet = made(*arguments)
        fleet.parameter[MASS] = np.nan
        return fleet

    monkeypatch.setattr(side, "of", poisoned)
    with pytest.raises(RunError, match=r"acceleration of suv is not finite any more at 0\.005 s"):
        drive("suv", STRAIGHT)


def test_an_own_file_drives_as_the_catalogue(tmp_path):
    source = catalogue.VEHICLES / "suv.yaml"
    path = tmp_path / "mine.yaml"
    path.write_text(source.read_text())
    assert (drive(str(path), STRAIGHT)["x_m"] == drive("suv", STRAIGHT)["x_m"]).all()
    heavier = yaml.safe_load(path.read_text())
    heavier["body"]["mass"]["value"] *= 1.3
    heavier["body"]["mass"].pop("range", None)
    path.write_text(yaml.safe_dump(heavier, allow_unicode=True))
    assert drive(str(path), STRAIGHT)["x_m"][-1] < drive("suv", STRAIGHT)["x_m"][-1]
