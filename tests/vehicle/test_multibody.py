"""Our cars against another program's on all of its runs, and against themselves at half the step.

The tables stand in the output of the test run (tests/conftest.py); the tolerances are those stated with the reference.
"""

import numpy as np
import pytest

from studio.rig.drive import drive
from studio.scenario import catalogue
from studio.vehicle.parameter import J_Z, L_F, L_R, MASS
from tests import multibody
from tests.closed_form import axles, single_track, slope
from tests.multibody import CARS, HALVED_AFTER, MANEUVERS
from tests.proving_ground import Ground

HALVING_BOUND = {"step": 0.1, "sine": 0.005, "dlc": 0.001, "long": 0.03}  # [m]; measured: 0.094, 0.003, 0.0001, 0.026


@pytest.mark.parametrize("run", multibody.runs(), ids=lambda run: run.name)
def test_our_car_does_what_the_multi_body_car_does(run):
    """Yaw rate, lateral acceleration, roll, rise, lag, loads, deceleration: within the tolerance, or within it of what theirs
    would be with the wheels' own lateral velocities and with patches that take up slip as ours do."""
    rows = [row for row in multibody.table() if row.run == run.name]
    assert len(rows) >= 3
    assert [row for row in rows if row.verdict == "NO"] == []


def test_all_runs_are_compared():
    """28 runs of either car, and few rows that need an explanation."""
    runs, rows = multibody.runs(), multibody.table()
    assert [sum(run.car == car for run in runs) for car in CARS] == [28, 28]
    assert {run.maneuver for run in runs} == set(MANEUVERS)
    verdicts = [row.verdict for row in rows]
    assert len(rows) > 300 and verdicts.count("ok") > 0.85 * len(rows) and verdicts.count("why") < 0.07 * len(rows)


def test_a_wrong_car_is_found_out():
    """The comparison bites: the Escort's answers against the BMW's runs miss their tolerances."""
    answers = multibody.driven(0.005)
    missed = 0
    for run in multibody.runs():
        if run.car == "bmw_320i":
            wrong = answers[run.name.replace("bmw_320i", "ford_escort")]
            missed += sum(row.verdict == "NO" for row in multibody.compared(wrong, run))
    assert missed > 50


def test_the_consistent_reference_is_the_reference_where_nothing_is_fast():
    """At 0.25 Hz slip angles with and without the roll rate differ little: yaw gain within 1 %, lag within 10 ms."""
    for run in multibody.runs():
        if "sine_f0.25" in run.name:
            made = multibody.consistent(run)
            assert abs(multibody.response(made, "r")) == pytest.approx(abs(multibody.response(run, "r")), rel=0.01)
            assert multibody.lag(made, "r") == pytest.approx(multibody.lag(run, "r"), abs=0.01)


@pytest.mark.parametrize("title", ["long_v20_a-4.0", "long_v10_a2.0"])
def test_the_rig_drives_the_same(title):
    """studio.rig.drive with a run's inputs as columns does what this comparison's feeding does."""
    run = next(run for run in multibody.runs() if run.title == title and run.car == "ford_escort")
    times = 0.005 * np.arange(round(run.end / 0.005) + 1)
    model = catalogue.find_vehicle(run.car, {"air.drag_coefficient": 0.0, "wheels.rolling_resistance": 0.0})
    torque = model.values.body.mass * model.values.wheels.radius * np.array([multibody.asked(run, t, 0.0) for t in times])
    columns = {"time_s": times, "road_wheel_angle_rad": 0.0 * times, "drive_torque_Nm": np.maximum(torque, 0.0)}
    answer = drive(model, {**columns, "brake_torque_Nm": np.maximum(-torque, 0.0)}, speed=run.speed)
    ours = multibody.driven(0.005)[run.name].columns
    assert answer["ax_mps2"][-1] == pytest.approx(np.interp(run.end, ours["t"], ours["a_x"]), rel=1e-9)
    assert answer["x_m"][-1] == pytest.approx(np.interp(run.end, ours["t"], ours["x"]), rel=1e-9)


@pytest.mark.parametrize("speed", [10.0, 20.0])
def test_the_patch_is_what_the_closed_form_says(speed):
    """A patch of no length is the single track without patches: two poles, w_n² and 2 zeta w_n of the textbook."""
    ground = Ground("bmw_320i")
    A, _ = single_track(ground, speed, sigma=1e-6)
    slow = sorted(np.linalg.eigvals(A), key=abs)[:2]
    m, J, l_f, l_r = ground.p[[MASS, J_Z, L_F, L_R]]
    C_f, C_r = (-2.0 * slope(axle, alpha=True)[0] for axle in axles(ground))
    stiffness = C_f * C_r * (l_f + l_r) ** 2 / (m * J * speed**2) + (C_r * l_r - C_f * l_f) / J
    damping = (C_f + C_r) / (m * speed) + (C_f * l_f**2 + C_r * l_r**2) / (J * speed)
    assert (slow[0] * slow[1]).real == pytest.approx(stiffness, rel=1e-4)
    assert -(slow[0] + slow[1]).real == pytest.approx(damping, rel=1e-4)


@pytest.mark.parametrize("maneuver", MANEUVERS)
@pytest.mark.parametrize("car", CARS)
def test_halving_the_step(car, maneuver):
    """After 10 s of a maneuver cars at 5 ms and at 2.5 ms are apart by less than 0.1 m (steps of steering: 200 m of a bend),
    5 mm (sines), 1 mm (lane changes), 3 cm (braking and driving)."""
    assert multibody.halving()[car, maneuver] < HALVING_BOUND[maneuver]
    assert HALVED_AFTER == 10.0


def test_the_difference_of_steps_shrinks_with_the_step():
    """First order: from 2.5 ms to 1.25 ms it is about half of that from 5 ms to 2.5 ms."""
    coarse, middle, fine = (multibody.driven(step) for step in (0.005, 0.0025, 0.00125))
    for run in multibody.runs():
        if run.title in ("step_v20_d0.03", "long_v20_a-4.0"):
            a, b, c = (multibody.place(answers[run.name]) for answers in (coarse, middle, fine))
            assert np.hypot(*(b - c)) / np.hypot(*(a - b)) == pytest.approx(0.5, abs=0.1)
