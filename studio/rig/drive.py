"""The open-loop rig: one vehicle on an endless plane, driven by a table of inputs over time.

Inputs are CSV with `time_s`, rising from 0, and any of these columns; between two rows they are linear (a gear holds):

    road_wheel_angle_rad        the road wheels themselves, past the steering's actuator
    steering_wheel_angle_rad    the steering wheel; the road wheels follow over ratio, lag and limits
    throttle, brake             pedals, 0 to 1
    gear                        -1 reverse, 0 neutral, 1 first ...; without the column the gearbox shifts by itself
    engine_torque_request_Nm    instead of the throttle
    drive_torque_Nm             sum at the wheels, put on them past the powertrain
    brake_torque_Nm             sum at the wheels, put on them past the hydraulics

Without throttle, engine torque or gear nobody uses the powertrain: it stays in neutral. The result has every state and force,
with units in the names of the columns; wheels 1 front left, 2 front right, 3 rear left, 4 rear right.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import ceil
from pathlib import Path
from typing import Any

import numpy as np

from studio.conventions import DEFAULT_STEP
from studio.errors import Problem, RunError, ScenarioError, UnknownError, nearest
from studio.rig import table
from studio.scenario import catalogue
from studio.scenario.catalogue import VehicleModel
from studio.vehicle import broken, fleet
from studio.vehicle.command import RING, U_APPLIED, U_APPLIED_BRAKE, U_BRAKE, U_ENGINE, U_GEAR, U_PEDAL, U_STEER
from studio.vehicle.contact import SLOPE_X
from studio.vehicle.fleet import Fleet, Start
from studio.vehicle.parameter import BRAKE_MAX, DELAY_BRAKE, DELAY_DRIVE, G_RATIO, GEARS, IDLE, LIMIT, STEER_RATIO
from studio.vehicle.state import (
    A_X,
    A_Y,
    A_Z,
    ACCELERATOR,
    ALPHA,
    CLUTCH,
    DELTA,
    F_X,
    F_Y,
    F_Z,
    GEAR,
    J_GEAR,
    KAPPA,
    M_Z,
    NEXT_GEAR,
    NEXT_RATIO,
    OMEGA,
    OMEGA_E,
    PITCH,
    PITCH_RATE,
    PRESSURE_F,
    PRESSURE_R,
    PSI,
    RATIO,
    ROLL,
    ROLL_RATE,
    T_ENGINE,
    TORQUE_BRAKE,
    TORQUE_DRIVE,
    TRAVEL,
    V_X,
    V_Y,
    YAW_RATE,
    X,
    Y,
    Z,
)  # fmt: skip

PERIOD = 0.01  # [s] between two rows of the result
LONGEST = 3600.0  # [s] of inputs
FASTEST = 70.0  # [m/s] at the start
OVERSPEED = 1.05  # [1] of the rev limit that a gear at the start may ask for
ROLLED = 1.0  # [rad] a vehicle that leans farther has rolled over
INPUTS: table.Ranges = {
    "time_s": (0.0, LONGEST, f"0 to {LONGEST:g} [s]"),
    "road_wheel_angle_rad": (-1.5, 1.5, "-1.5 to 1.5 [rad]"),
    "steering_wheel_angle_rad": (-60.0, 60.0, "-60 to 60 [rad]"),
    "throttle": (0.0, 1.0, "0 to 1 [1]"),
    "brake": (0.0, 1.0, "0 to 1 [1]"),
    "gear": (-1.0, 8.0, "-1 to 8 [1]"),
    "engine_torque_request_Nm": (-10_000.0, 10_000.0, "-10000 to 10000 [Nm]"),
    "drive_torque_Nm": (-200_000.0, 200_000.0, "-200000 to 200000 [Nm]"),
    "brake_torque_Nm": (0.0, 500_000.0, "0 to 500000 [Nm]"),
}
EXCLUSIVE = (("road_wheel_angle_rad", "steering_wheel_angle_rad"), ("throttle", "engine_torque_request_Nm"))
USES_POWERTRAIN = ("throttle", "engine_torque_request_Nm", "gear")
ROAD = {"road.friction": (0.01, 2.0, "0.01 to 2 [1]"), "road.slope": (-0.5, 0.5, "-0.5 to 0.5 [1], rising ahead")}

BODY_COLUMNS = {
    "x_m": X, "y_m": Y, "z_m": Z, "yaw_rad": PSI, "roll_rad": ROLL, "pitch_rad": PITCH, "vx_mps": V_X, "vy_mps": V_Y,
    "yaw_rate_radps": YAW_RATE, "roll_rate_radps": ROLL_RATE, "pitch_rate_radps": PITCH_RATE, "ax_mps2": A_X, "ay_mps2": A_Y,
    "az_mps2": A_Z, "road_wheel_angle_rad": DELTA, "gear": GEAR, "clutch": CLUTCH, "accelerator": ACCELERATOR,
    "engine_speed_radps": OMEGA_E, "engine_torque_Nm": T_ENGINE, "drive_torque_Nm": TORQUE_DRIVE,
    "brake_torque_Nm": TORQUE_BRAKE, "brake_pressure_front_Pa": PRESSURE_F, "brake_pressure_rear_Pa": PRESSURE_R,
}  # fmt: skip
WHEEL_COLUMNS = {
    "Fz_N": F_Z, "Fx_N": F_X, "Fy_N": F_Y, "Mz_Nm": M_Z, "wheel_speed_radps": OMEGA, "slip_ratio": KAPPA,
    "slip_angle_rad": ALPHA, "suspension_travel_m": TRAVEL,
}  # fmt: skip


@dataclass(frozen=True)
class Drive:
    """A drive: `time` [s] and the columns of the result by name, all of one length."""

    vehicle: str
    columns: dict[str, np.ndarray]

    @property
    def rolled_over(self) -> float | None:
        """Time [s] at which the vehicle rolled over, if it did: nothing after it is claimed."""
        over = np.flatnonzero(np.abs(self.columns["roll_rad"]) > ROLLED)
        return float(self.time[over[0]]) if over.size else None

    @property
    def time(self) -> np.ndarray:
        """Times of the rows [s]."""
        return self.columns["time_s"]

    def __getitem__(self, name: str) -> np.ndarray:
        """One column; raises UnknownError that names the nearest."""
        if name not in self.columns:
            raise UnknownError(f"A drive has no column {name!r}; {nearest(name, self.columns)}")
        return self.columns[name]


def drive(
    vehicle: str | VehicleModel,
    inputs: Path | str | Mapping[str, Any],
    *,
    speed: float = 0.0,
    tyre: Path | str | None = None,
    changes: Mapping[str, Any] | None = None,
    step: float = DEFAULT_STEP,
    period: float = PERIOD,
    progress: Callable[[float], None] = lambda share: None,
) -> Drive:
    """Drives a vehicle by a table of inputs: a CSV file, or columns by name.

    vehicle is a name of the catalogue, a path of a vehicle file, or a model; speed [m/s] at the start; tyre a .tir file, or a
    name of the catalogue, for all wheels; changes by path (`body.mass`, `road.friction`, `road.slope`); step [s] of the
    integration; period [s] of the result. Raises ScenarioError, UnknownError; RunError when a state is not finite any more.
    """
    model, road = prepared(vehicle, tyre, dict(changes or {}))
    given = given_inputs(inputs)
    check(model, speed, step, period)
    rig = made(model, road, speed, given)
    return recorded(model.name, rig, given, step, period, progress)


# --- what is driven ------------------------------------------------------------------------------------------------------


def prepared(vehicle: str | VehicleModel, tyre: Path | str | None, changes: dict[str, Any]) -> tuple[VehicleModel, dict[str, float]]:
    """The model with its changes, and the road."""
    road = {path: road_value(path, changes.pop(path)) for path in list(changes) if path.startswith("road.")}
    if tyre is not None:
        path = str(catalogue.tyre_file(str(tyre)).resolve())
        changes |= {"tyres.front": path, "tyres.rear": path}
    if isinstance(vehicle, VehicleModel):
        return (catalogue.changed(vehicle, changes) if changes else vehicle), road
    return catalogue.find_vehicle(vehicle, changes), road


def road_value(path: str, value: Any) -> float:
    """Friction or slope of the road; raises ScenarioError."""
    if path not in ROAD:
        raise ScenarioError("The road cannot be changed so.", [Problem(path, "does not exist", remedy=nearest(path, ROAD))])
    low, high, allowed = ROAD[path]
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not low <= value <= high:
        raise ScenarioError("The road cannot be like this.", [Problem(path, "is out of range", str(value), allowed)])
    return float(value)


def check(model: VehicleModel, speed: float, step: float, period: float) -> None:
    """Speed, step and period within what makes sense."""
    problems = []
    if not 0.0 <= speed <= FASTEST:
        problems.append(Problem("--speed", "is out of range", f"{speed:g}", f"0 to {FASTEST:g} [m/s]"))
    if not 1e-4 <= step <= 0.01:
        problems.append(Problem("--step", "is out of range", f"{step:g}", "0.0001 to 0.01 [s]"))
    elif not step * (1 - 1e-9) <= period <= LONGEST or abs(period / step - round(period / step)) > 1e-6:
        problems.append(Problem("--period", "is not a whole number of steps", f"{period:g} s", f"n · {step:g} s"))
    table.refuse(model.name, problems, "cannot be driven like this")
    fleet.check_step(model, step, "--step")


def made(model: VehicleModel, road: Mapping[str, float], speed: float, given: Mapping[str, np.ndarray]) -> Fleet:
    """The vehicle on its road, heading east, in neutral when nobody uses the powertrain."""
    ground = fleet.level_ground(1, friction=road.get("road.friction", 1.0))
    ground[SLOPE_X] = road.get("road.slope", 0.0)
    rig = fleet.fleet([Start(model, 0.0, 0.0, 0.0, speed)], ground=ground)
    if not any(name in given for name in USES_POWERTRAIN):
        rig.commands[U_GEAR] = 0.0
        rig.state[[GEAR, NEXT_GEAR, RATIO, NEXT_RATIO, J_GEAR]] = 0.0
        rig.state[OMEGA_E] = rig.parameter[IDLE]
    elif "gear" in given:
        put_in_gear(rig, int(given["gear"][0]))
    return rig


def put_in_gear(rig: Fleet, gear: int) -> None:
    """Starts in a gear; raises ScenarioError when there is none of this number."""
    ratios = rig.gears[G_RATIO * GEARS : (G_RATIO + 1) * GEARS, 0]
    gears = [g - 1 for g in range(GEARS) if ratios[g] != 0.0 or g == 1]
    if gear not in gears:
        raise ScenarioError("The vehicle has no such gear.", [Problem("gear", "does not exist", str(gear), f"{gears[0]} to {gears[-1]}")])
    fleet.engage(rig, 0, gear)
    if abs(rig.state[OMEGA_E, 0]) > rig.parameter[LIMIT, 0] * OVERSPEED:
        what = f"over-revs at this speed: {rig.state[OMEGA_E, 0]:.0f} rad/s"
        problem = Problem("gear", what, str(gear), f"up to {rig.parameter[LIMIT, 0]:.0f} rad/s", "begin in a higher gear")
        raise ScenarioError("The vehicle cannot start like this.", [problem])


# --- inputs --------------------------------------------------------------------------------------------------------------


def given_inputs(inputs: Path | str | Mapping[str, Any]) -> dict[str, np.ndarray]:
    """The inputs by name, checked; raises ScenarioError."""
    rows = as_table(inputs) if isinstance(inputs, Mapping) else table.read(Path(inputs), needed=("time_s",), known=INPUTS)
    columns = {name: limits for name, limits in INPUTS.items() if name in rows.head}
    values = dict(zip(columns, table.numbers(rows, columns), strict=True))
    table.refuse(rows.name, sequence_problems(rows, values) + pairs_problems(rows), "cannot be driven")
    return values


def as_table(columns: Mapping[str, Any]) -> table.Table:
    """Columns given in Python as a table, so that one check serves both."""
    arrays = {name: np.atleast_1d(values) for name, values in columns.items()}
    lengths = {name: array.shape for name, array in arrays.items()}
    strange = [Problem("inputs", "is not an input", name, remedy=nearest(name, INPUTS)) for name in arrays if name not in INPUTS]
    if "time_s" not in arrays:
        strange.append(Problem("inputs", "have no time_s", remedy="add the times [s]"))
    elif any(shape != lengths["time_s"] or len(shape) != 1 for shape in lengths.values()):
        strange.append(Problem("inputs", "differ in length", str(lengths), "one value for each time"))
    table.refuse("the inputs", strange, "cannot be driven")
    rows = [[repr(float(value)) for value in row] for row in zip(*arrays.values(), strict=True)]
    return table.Table("inputs", list(arrays), rows, list(range(len(rows))))


def sequence_problems(rows: table.Table, values: Mapping[str, np.ndarray]) -> list[Problem]:
    """Time must begin with 0 and rise; gears must be whole."""
    time, problems = values["time_s"], []
    if time[0] != 0.0:
        problems.append(Problem(rows.where(0, "time_s"), "does not begin with 0", f"{time[0]:g}", "0 [s]"))
    if time.size < 2:
        problems.append(Problem(rows.name, "has one row only", allowed="two rows or more"))
    for i in np.flatnonzero(np.diff(time) <= 0.0).tolist():
        what = f"is not later than the row before ({time[i]:g} s)"
        problems.append(Problem(rows.where(i + 1, "time_s"), what, f"{time[i + 1]:g}", remedy="sort the rows by time"))
    return problems + [
        Problem(rows.where(i, "gear"), "is not a whole number", f"{values['gear'][i]:g}", "-1, 0, 1, 2 ...")
        for i in np.flatnonzero(values.get("gear", np.zeros(1)) % 1.0).tolist()
    ]


def pairs_problems(rows: table.Table) -> list[Problem]:
    """Two columns that command the same."""
    return [
        Problem(f"{rows.name}, line 1", f"has {first} and {second}, which command the same", remedy="leave one of them out")
        for first, second in EXCLUSIVE
        if first in rows.head and second in rows.head
    ]


def value_at(given: Mapping[str, np.ndarray], name: str, time: float) -> float:
    """An input at a time: linear between the rows, a gear holds."""
    if name == "gear":
        return float(given[name][max(np.searchsorted(given["time_s"], time + 1e-9, side="right") - 1, 0)])
    return float(np.interp(time, given["time_s"], given[name]))


def command(rig: Fleet, given: Mapping[str, np.ndarray], delays: Mapping[str, float], k: int, time: float) -> None:
    """Writes the inputs that reach the actuators in a step into its slot of the ring."""
    slot, parameter = rig.commands[:, k % RING], rig.parameter[:, 0]
    for name in given:
        value = value_at(given, name, time - delays.get(name, 0.0))
        if name == "road_wheel_angle_rad":
            slot[U_STEER] = rig.state[DELTA, 0] = value
        elif name == "steering_wheel_angle_rad":
            slot[U_STEER] = value / parameter[STEER_RATIO]
        elif name == "brake":
            slot[U_BRAKE] = value * parameter[BRAKE_MAX]
        elif name in ROWS:
            slot[ROWS[name]] = value


ROWS = {
    "throttle": U_PEDAL, "gear": U_GEAR, "engine_torque_request_Nm": U_ENGINE, "drive_torque_Nm": U_APPLIED,
    "brake_torque_Nm": U_APPLIED_BRAKE,
}  # fmt: skip


def take_delays(rig: Fleet) -> dict[str, float]:
    """Dead times [s] of the inputs; the rig looks them up in its table, exactly, so the ring need not hold them."""
    drive, brake = float(rig.parameter[DELAY_DRIVE, 0]), float(rig.parameter[DELAY_BRAKE, 0])
    rig.parameter[[DELAY_DRIVE, DELAY_BRAKE]] = 0.0
    return {"throttle": drive, "engine_torque_request_Nm": drive, "brake": brake}


# --- the drive -----------------------------------------------------------------------------------------------------------


def recorded(name: str, rig: Fleet, given: Mapping[str, np.ndarray], step: float, period: float, progress) -> Drive:
    """Drives from the first to the last time of the inputs."""
    every, steps = round(period / step), ceil(given["time_s"][-1] / step - 1e-6)
    delays, rows = take_delays(rig), [sample(rig, 0.0)]
    for k in range(steps):
        command(rig, given, delays, k, k * step)
        fleet.advance(rig, k, step, step)
        if broken.columns(rig).size:
            found = broken.first(rig, 0, k=k, tick=step, step=step)
            raise RunError(f"{found.quantity} of {name} is not finite any more at {k * step + found.after:.3f} s.")
        if (k + 1) % every == 0:
            rows.append(sample(rig, (k + 1) * step))
            progress((k + 1) / steps)
    return Drive(name, dict(zip(column_names(), np.array(rows).T, strict=True)))


def column_names() -> list[str]:
    """Columns of the result."""
    wheels = [f"{name}_{corner}" for name in WHEEL_COLUMNS for corner in (1, 2, 3, 4)]
    return ["time_s", *BODY_COLUMNS, "steering_wheel_angle_rad", *wheels]


def sample(rig: Fleet, time: float) -> np.ndarray:
    """One row of the result."""
    state, wheels = rig.state[:, 0], rig.wheels.copy()
    wheels[ALPHA] = np.arctan(wheels[ALPHA])
    handwheel = state[DELTA] * rig.parameter[STEER_RATIO, 0]
    return np.concatenate([[time], state[list(BODY_COLUMNS.values())], [handwheel], wheels[list(WHEEL_COLUMNS.values())].ravel()])


def write(made_drive: Drive, out: Path) -> int:
    """Writes a drive as CSV; the number of rows. Raises ScenarioError when the file cannot be written."""
    head = list(made_drive.columns)
    rows = [[f"{value:.9g}" for value in row] for row in zip(*made_drive.columns.values(), strict=True)]
    table.write(out, [head, *rows])
    return len(rows)
