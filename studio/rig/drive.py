"""The open-loop rig: one vehicle on an endless plane, driven by a table of inputs over time.

Inputs are CSV with `time_s`, rising from 0, and any of these columns; between two rows they are linear (a gear holds):

    road_wheel_angle_rad        the road wheels themselves, past the steering's actuator
    steering_wheel_angle_rad    the steering wheel; the road wheels follow over ratio, lag and limits
    throttle, brake             pedals, 0 to 1
    gear                        -1 reverse, 0 neutral, 1 first ...; without the column the gearbox shifts by itself
    engine_torque_request_Nm    instead of the throttle
    drive_torque_Nm             sum at the wheels, put on them past the powertrain
    speed_mps                   speed that is held, by a torque at the wheels past the powertrain
    brake_torque_Nm             sum at the wheels, put on them past the hydraulics

Without throttle, engine torque or gear nobody uses the powertrain: it stays in neutral. The result has every state and force,
with units in the names of the columns; wheels 1 front left, 2 front right, 3 rear left, 4 rear right.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from studio.conventions import DEFAULT_STEP
from studio.errors import Problem, RunError, ScenarioError, UnknownError, nearest
from studio.rig import side, table
from studio.rig.side import Order, Outcome
from studio.scenario import catalogue
from studio.scenario.catalogue import VehicleModel
from studio.vehicle import fleet
from studio.vehicle.parameter import G_RATIO, GEARS, LIMIT
from studio.vehicle.state import OMEGA_E

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
    "speed_mps": (0.0, FASTEST, f"0 to {FASTEST:g} [m/s]"),
}
EXCLUSIVE = (
    ("road_wheel_angle_rad", "steering_wheel_angle_rad"),
    ("throttle", "engine_torque_request_Nm"),
    ("drive_torque_Nm", "speed_mps"),
)
ROAD = {"road.friction": (0.01, 2.0, "0.01 to 2 [1]"), "road.slope": (-0.5, 0.5, "-0.5 to 0.5 [1], rising ahead")}


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
    order = Order(model, given, speed, road)
    check_gear(order)
    (made,) = side.together([order], step=step, period=period, progress=progress)
    return finished(model.name, made)


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


def check_gear(order: Order) -> None:
    """The gear at the start must be there, and not over-rev the engine; raises ScenarioError."""
    if "gear" not in order.inputs:
        return
    gear, ratios = int(order.inputs["gear"][0]), fleet.rows_of(order.model)[1][G_RATIO * GEARS : (G_RATIO + 1) * GEARS]
    gears = [g - 1 for g in range(GEARS) if ratios[g] != 0.0 or g == 1]
    if gear not in gears:
        raise ScenarioError("The vehicle has no such gear.", [Problem("gear", "does not exist", str(gear), f"{gears[0]} to {gears[-1]}")])
    rig = side.of([order])
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


# --- the drive -----------------------------------------------------------------------------------------------------------


def finished(name: str, made: Outcome) -> Drive:
    """A drive that came to its end; raises RunError for one that broke."""
    if made.broke is not None:
        raise RunError(f"{made.quantity} of {name} is not finite any more at {made.broke:.3f} s.")
    return Drive(name, made.columns)


def write(made_drive: Drive, out: Path) -> int:
    """Writes a drive as CSV; the number of rows. Raises ScenarioError when the file cannot be written."""
    head = list(made_drive.columns)
    rows = [[f"{value:.9g}" for value in row] for row in zip(*made_drive.columns.values(), strict=True)]
    table.write(out, [head, *rows])
    return len(rows)
