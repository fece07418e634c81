"""Replay: recorded inputs drive our vehicle open loop, all runs side by side; what comes out has our signals on the clock of the run.

Before a run the first values of its inputs are held for a while with its first speed, so that the car has settled in them. Then the
recorded speed is held where the driver held one (`HOLDS_SPEED`), and else only what pedals, torques and gears do counts.
"""

from collections.abc import Callable, Mapping, Sequence
from types import ModuleType

import numpy as np

from studio.conventions import DEFAULT_STEP
from studio.errors import Problem, ScenarioError
from studio.log.quantity import QUANTITIES
from studio.log.recording import PERIOD, Recording
from studio.log.smooth import smooth, stretches
from studio.rig import side
from studio.rig.side import Order, Outcome
from studio.scenario import catalogue
from studio.scenario.catalogue import VehicleModel

LEAD = 2.0  # [s]
STEERS = ("road_wheel_angle", "steering_wheel_angle")
PUSHES = ("throttle", "engine_torque_request", "gear", "brake_torque", "brake", "drive_torque")
INSTEAD = {"throttle": "engine_torque_request", "brake": "brake_torque"}  # what is fed where both were recorded: it is past a model
BOUNDS = {"throttle": (0.0, 1.0), "brake": (0.0, 1.0), "brake_torque": (0.0, np.inf)}
LOST = "the car that was calculated was lost"


def replay(
    model: VehicleModel, runs: Sequence[Recording], module: ModuleType, road: Mapping[str, float],
    progress: Callable[[float], None] = lambda share: None,
) -> list[Recording]:  # fmt: skip
    """The vehicle in every run; raises ScenarioError for a gap in an input, or when a state is not finite any more."""
    return [
        simulated(run, made) for run, made in zip(runs, driven([order(model, run, module, road) for run in runs], progress), strict=True)
    ]


def driven(orders: Sequence[Order], progress: Callable[[float], None] = lambda share: None) -> list[Outcome]:
    """All drives, with a step that suits every vehicle."""
    limit = min(catalogue.step_limit(each.model.values) for each in orders)
    step = DEFAULT_STEP if limit >= DEFAULT_STEP else PERIOD / np.ceil(PERIOD / limit)
    return side.together(orders, step=step, period=PERIOD, progress=progress)


def order(model: VehicleModel, run: Recording, module: ModuleType, road: Mapping[str, float]) -> Order:
    """What the rig is told of one run."""
    time = np.concatenate([[0.0, LEAD - 1e-3], LEAD + run.time])
    fed = {name: whole(run, name) for name in inputs(run, module)}
    columns = {"time_s": time} | {column_of(name): led(values) for name, values in fed.items()}
    speed = smooth(run.time, whole(run, "speed"))
    held = np.clip(speed, 0.0, None) if module.HOLDS_SPEED else np.full(run.time.size, np.nan)
    columns["speed_mps"] = np.concatenate([[speed[0], speed[0]], held])
    if "gear" in columns:
        columns["gear"] = np.round(columns["gear"])
    return Order(model, columns, max(float(speed[0]), 0.0), road)


def inputs(run: Recording, module: ModuleType) -> list[str]:
    """Which signals are fed: the angle nearest to the road, and what pushes the car unless its speed is held."""
    steers = [name for name in STEERS if name in run.signals][:1]
    pushes = [] if module.HOLDS_SPEED else [name for name in PUSHES if name in run.signals and INSTEAD.get(name) not in run.signals]
    if "drive_torque" in pushes:
        pushes = [name for name in pushes if name in ("drive_torque", "brake_torque", "brake")]
    return [*steers, *pushes]


def column_of(name: str) -> str:
    """The rig's name of an input."""
    return QUANTITIES[name].column or name


def led(values: np.ndarray) -> np.ndarray:
    """With its first value before it."""
    return np.concatenate([[values[0], values[0]], values])


def whole(run: Recording, name: str) -> np.ndarray:
    """An input without gaps, within what the rig takes; raises ScenarioError that says where the gap is."""
    values = run[name]
    holes = stretches(~np.isfinite(values))
    if holes:
        a, b = holes[0]
        where = f"{run.start + run.time[a]:g} to {run.start + run.time[b - 1]:g} s"
        problem = Problem(
            run.name, f"has a gap in {name}", where, remedy="cut the run before or behind it: what was steered there, nobody knows"
        )
        raise ScenarioError(f"{run.name} cannot be replayed.", [problem])
    return np.clip(values, *BOUNDS.get(name, (-np.inf, np.inf)))


def simulated(run: Recording, made: Outcome) -> Recording:
    """A drive on the clock of the run that it replays; raises ScenarioError when it broke."""
    if made.broke is not None:
        problem = Problem(
            run.name, f"{LOST}: {made.quantity} at {made.broke - LEAD:.2f} s", remedy="look at what is fed, and at the vehicle"
        )
        raise ScenarioError(f"{run.name} cannot be replayed.", [problem])
    time = made.columns["time_s"] - LEAD
    columns = {name: each.column for name, each in QUANTITIES.items() if each.column in made.columns}
    found = {name: np.interp(run.time, time, made.columns[column]) for name, column in columns.items()}
    return Recording(run.name, run.time, found, run.start)
