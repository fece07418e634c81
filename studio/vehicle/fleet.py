"""A fleet: vehicles by themselves, as arrays. What a world holds of its vehicles, a test rig and the benchmark too.

fleet([Start(model, x, y, heading, speed), ...])   →  Fleet
advance(fleet, k, tick, step)                      one tick of gearboxes and motion
"""

from dataclasses import dataclass
from functools import cache, cached_property
from typing import NamedTuple

import numpy as np

from studio.errors import Problem, ScenarioError
from studio.model.tyre import Tyre
from studio.rows import Moving
from studio.scenario import catalogue, tir
from studio.scenario.catalogue import VehicleModel
from studio.vehicle import light, motion, shift
from studio.vehicle.column import gearbox_rows, parameter_rows
from studio.vehicle.command import COMMAND, RING, U_APPLIED, U_APPLIED_BRAKE, U_BRAKE, U_STEER, U
from studio.vehicle.contact import GROUND, MU
from studio.vehicle.envelope import bare_rows, light_rows
from studio.vehicle.light import LIGHT
from studio.vehicle.state import VEHICLE, WHEEL
from studio.vehicle.tile import blocks_of, new_tile


class Start(NamedTuple):
    """A vehicle before it is a column: model, place [m], heading [rad] and speed [m/s], and whether it is a light one."""

    model: VehicleModel
    x: float
    y: float
    heading: float
    speed: float
    is_light: bool = False


@dataclass
class Fleet:
    """Arrays of vehicles: [row, vehicle]; of wheels and the ground under them: [row, corner · n + vehicle]."""

    state: Moving
    wheels: Moving
    ground: Moving
    parameter: np.ndarray
    gears: np.ndarray  # [row of the gearbox · GEARS + gear + 1, vehicle]
    commands: Moving  # [row, slot · n + vehicle]
    tyres: np.ndarray  # [tyre, coefficient]
    order: np.ndarray  # columns of full vehicles in the order of the tiles
    blocks: np.ndarray  # first place in that order, count, tyres front and rear, per tile
    light: np.ndarray  # columns of light vehicles
    lightness: np.ndarray  # what they are, [row, light vehicle]
    broken: np.ndarray  # 1 for a vehicle whose state would not be finite any more; it stays as it was
    tile: np.ndarray

    @property
    def size(self) -> int:
        """Number of vehicles."""
        return self.state.shape[1]

    @cached_property
    def tyres_of(self) -> np.ndarray:
        """Which of the tyres every vehicle has, int64[2, n], front and rear; -1 for light ones, of whose tyres nothing is known."""
        found = np.full((2, self.size), -1, dtype=np.int64)
        for start, count, front, rear in self.blocks.T:
            found[:, self.order[start : start + count]] = [[front], [rear]]
        return found


def fleet(starts: list[Start], *, ground: np.ndarray | None = None) -> Fleet:
    """Vehicles on the road, the springs at rest, rolling without slip. The ground is level and dry unless given."""
    n = len(starts)
    is_light = np.array([start.is_light for start in starts], dtype=bool)
    tyres, tyres_of = tyre_table([start.model for start in starts if not start.is_light])
    order, blocks = blocks_of(tyres_of)
    rows = [light_rows_of(start.model) if start.is_light else rows_of(start.model) for start in starts]
    made = Fleet(
        state=np.zeros((len(VEHICLE), n)),
        wheels=np.zeros((len(WHEEL), 4 * n)),
        ground=level_ground(n) if ground is None else ground,
        parameter=columns([each[0] for each in rows]),
        gears=columns([each[1] for each in rows]),
        commands=no_commands(n),
        tyres=tyres,
        order=np.flatnonzero(~is_light)[order],
        blocks=blocks,
        light=np.flatnonzero(is_light),
        lightness=np.array([rows[v][2] for v in np.flatnonzero(is_light)]).reshape(-1, len(LIGHT)).T.copy(),
        broken=np.zeros(n, dtype=np.int64),
        tile=new_tile(),
    )
    for v, each in enumerate(starts):
        place(made, v, each)
    return made


def place(made: Fleet, v: int, at: Start) -> None:
    """Puts one vehicle on the road."""
    shift.start(v, at.x, at.y, at.heading, at.speed, made.state, made.wheels, made.ground, made.parameter, made.gears)


def engage(made: Fleet, v: int, gear: int) -> None:
    """Puts a vehicle into a gear before it starts."""
    w_out = shift.output_speed(v, made.size, made.wheels, made.parameter)
    shift.start_in_gear(v, gear, w_out, made.state, made.parameter, made.gears)


def columns(rows: list[np.ndarray]) -> np.ndarray:
    """One column per vehicle."""
    return np.array(rows).T.copy()


def level_ground(n: int, *, friction: float = 1.0) -> np.ndarray:
    """float64[GROUND, 4 n]: the plane z = 0."""
    ground = np.zeros((len(GROUND), 4 * n))
    ground[MU] = friction
    return ground


def no_commands(n: int) -> np.ndarray:
    """A ring in which nothing is commanded: wheels straight, brakes open, pedal lifted."""
    commands = np.full((len(COMMAND), RING * n), np.nan)
    commands[[U, U_STEER, U_BRAKE, U_APPLIED, U_APPLIED_BRAKE]] = 0.0
    return commands


def tyre_table(models: list[VehicleModel]) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients of all tyres [tyre, coefficient], and which of them every vehicle has, int64[2, n], front and rear."""
    sets = [tyres_of(model) for model in models]
    different = list(dict.fromkeys(each for pair in sets for each in pair))
    places = {each: k for k, each in enumerate(different)}
    found = np.array([[places[front], places[rear]] for front, rear in sets], dtype=np.int64).reshape(-1, 2).T.copy()
    return np.array(different).reshape(-1, len(Tyre._fields)), found


def tyres_of(model: VehicleModel) -> tuple[Tyre, Tyre]:
    """Tyres of the front and the rear axle; raises ScenarioError."""
    return rows_of(model)[2]


def rows_of(model: VehicleModel) -> tuple[np.ndarray, np.ndarray, tuple[Tyre, Tyre]]:
    """Parameter rows, gearbox rows and tyres of a model."""
    return computed_rows(model.name, model.values.model_dump_json(), model.folder)


@cache
def computed_rows(name: str, values: str, folder):
    """The same, by content."""
    vehicle = catalogue.Vehicle.model_validate_json(values)
    tyres = vehicle.tyres
    front = tyre_of(tyres.front, folder, tyres.front_cornering, tyres.front_grip)
    rear = tyre_of(tyres.rear, folder, tyres.rear_cornering, tyres.rear_grip)
    return parameter_rows(vehicle, front, rear), gearbox_rows(vehicle), (front, rear)


def tyre_of(name: str, folder, cornering: float, grip: float) -> Tyre:
    """The tyre of a property file, with its cornering stiffness and peak friction scaled."""
    tyre = Tyre(*tir.coefficients(catalogue.find_tyre(name, folder=folder)))
    return tyre._replace(LKY=tyre.LKY * cornering, LMUX=tyre.LMUX * grip, LMUY=tyre.LMUY * grip)


def light_rows_of(model: VehicleModel) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Parameter rows, a gearbox without gears, and the rows of LIGHT, of a model as a light vehicle."""
    return computed_light_rows(model.name, model.values.model_dump_json(), model.folder)


@cache
def computed_light_rows(name: str, values: str, folder):
    """The same, by content."""
    parameter, gears, tyres = computed_rows(name, values, folder)
    return bare_rows(parameter), np.zeros_like(gears), light_rows(parameter, gears, *tyres)


def check_step(model: VehicleModel, step: float, where: str) -> None:
    """Refuses a step [s] at which the wheels of a vehicle would not move as they do; raises ScenarioError."""
    limit = catalogue.step_limit(model.values)
    if step > limit:
        raise ScenarioError(
            f"{model.name} cannot be integrated with this step.",
            [Problem(where, f"is too long for the wheels of {model.name}", f"{step:g} s", f"≤ {limit:.4f} s")],
        )


def advance(moving: Fleet, k: int, tick: float, step: float) -> None:
    """One tick: gearboxes decide, then everybody moves."""
    f = moving
    shift.shifts(f.order, k, tick, f.state, f.wheels, f.parameter, f.gears, f.commands)
    integrate(f, k, tick, step)


def integrate(moving: Fleet, k: int, tick: float, step: float, steps: int | None = None) -> None:
    """Motion alone: all steps of tick k, or only the first ones of full vehicles; light ones do it in one."""
    f = moving
    if f.light.size:
        light.move(f.light, f.state, f.wheels, f.ground, f.parameter, f.lightness, f.commands, k, tick, f.broken)
    motion.integrate(
        f.blocks, f.order, f.state, f.wheels, f.ground, f.parameter, f.tyres, f.commands, k, tick, step,
        motion.steps_of(tick, step) if steps is None else steps, f.broken, f.tile,
    )  # fmt: skip
