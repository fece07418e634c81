"""What the eye gets of a world: poses of the vehicles as the scene wants them, the lights, the objects on the road."""

from typing import NamedTuple

import numpy as np

from studio.road.ways.relief import Relief, relief_of
from studio.scene import pose
from studio.scene.fleet import Look
from studio.scene.obstacle import Place
from studio.scene.vehicle import Dimensions
from studio.vehicle.contact import HEIGHT, SLOPE_X, SLOPE_Y
from studio.vehicle.parameter import L_F, L_R, LENGTH, RADIUS, TRACK_F, WIDTH, H
from studio.vehicle.state import ACTIVE, DELTA, PITCH, PSI, ROLL, ROTATION, X, Y, Z
from studio.world.build import at_start
from studio.world.setting import Setting
from studio.world.table.street import O_HEADING, O_LIFT, O_X, O_Y
from studio.world.thing import things
from studio.world.world import Vehicles, World

JUMP = 5.0  # [m] a car that moved farther within a tick has come in anew, and is not drawn on its way
MOTION = (pose.X, pose.Y, pose.Z, pose.YAW, pose.ROLL, pose.PITCH, pose.STEER, pose.WHEEL_ANGLE, pose.TILT)


class Frame(NamedTuple):
    """One picture: poses float32[POSE_ROWS, vehicle], lights int8[link], which objects stand int8[object], and where they are,
    float32[x, y, heading and lift, object]."""

    poses: np.ndarray
    lights: np.ndarray
    standing: np.ndarray
    objects: np.ndarray


def frame(world: World, seen: np.ndarray) -> Frame:
    """The picture of a world in which the vehicles are seen at these poses."""
    o = world.obstacles
    return Frame(
        seen, world.roads.shown.astype(np.int8), o.standing.astype(np.int8), o.table[[O_X, O_Y, O_HEADING, O_LIFT]].astype(np.float32)
    )


def first_frame(setting: Setting) -> Frame:
    """The picture at the start."""
    found = list(things(setting.sites))
    standing = [int(setting.sites[each.entry].is_there_from_the_start) for each in found]
    objects = np.array([(each.x, each.y, each.heading, each.tread.at(0.0).lift) for each in found], np.float32).reshape(-1, 4).T
    return Frame(poses(at_start(setting), relief_of(setting.network)), first_lights(setting), np.array(standing, dtype=np.int8), objects)


def places(setting: Setting) -> list[Place]:
    """All objects that may stand on the road."""
    return [Place(each.looks, each.x, each.y, each.heading, (each.length, each.width)) for each in things(setting.sites)]


def poses(vehicles: Vehicles, relief: Relief | None) -> np.ndarray:
    """float32[POSE_ROWS, vehicle] of the vehicles now; the body rolls, pitches and heaves on its springs.

    The picture is flat but for the relief: height and slope of the road, those under the first wheel, are taken off.
    """
    state, parameter = vehicles.state, vehicles.parameter
    n = state.shape[1]
    height, g_x, g_y = vehicles.ground[[HEIGHT, SLOPE_X, SLOPE_Y], :n]
    rows = np.zeros((pose.POSE_ROWS, n), np.float32)
    rows[pose.X], rows[pose.Y], rows[pose.YAW] = state[X], state[Y], state[PSI]
    rows[pose.Z] = state[Z] - parameter[H] - (height + g_x * state[X] + g_y * state[Y])
    rows[pose.ROLL] = state[ROLL]
    rows[pose.PITCH] = state[PITCH] + np.arctan(g_x * np.cos(state[PSI]) + g_y * np.sin(state[PSI]))
    rows[pose.STEER] = state[DELTA]
    rows[pose.WHEEL_ANGLE] = vehicles.wheels[ROTATION, 2 * n : 3 * n]
    rows[pose.VISIBLE] = state[ACTIVE]
    return lifted(rows, relief, height + g_x * state[X] + g_y * state[Y])


def lifted(rows: np.ndarray, relief: Relief | None, height: np.ndarray) -> np.ndarray:
    """Poses float32[POSE_ROWS, n] on roads of these heights [m], put where these are drawn: above the land, or below it."""
    if relief is not None and rows.shape[1]:
        lift, (g_x, g_y) = relief.at(rows[pose.X], rows[pose.Y], height)
        tilt = -np.arctan(g_x * np.cos(rows[pose.YAW]) + g_y * np.sin(rows[pose.YAW]))
        rows[pose.Z] += lift
        rows[pose.PITCH] += tilt
        rows[pose.TILT] = tilt
    return rows


def blend(before: np.ndarray, after: np.ndarray, share: float) -> np.ndarray:
    """Poses between two ticks, for motion slower than real time."""
    between = after.copy()
    near = np.hypot(after[pose.X] - before[pose.X], after[pose.Y] - before[pose.Y]) < JUMP
    for row in MOTION:
        between[row, near] += np.float32(share - 1.0) * (after[row, near] - before[row, near])
    return between


def looks(setting: Setting) -> list[Look]:
    """How the vehicles look, in the order of their columns."""
    parameter = at_start(setting).parameter
    heights = [car.model.values.body.height for car in setting.cars]
    return [Look(car.name, car.colour, dimensions(parameter[:, v], heights[v])) for v, car in enumerate(setting.cars)]


def dimensions(p: np.ndarray, height: float) -> Dimensions:
    """Outer dimensions from a column of parameters; the dynamics have no use for the height."""
    return Dimensions(
        length=float(p[LENGTH]),
        width=float(p[WIDTH]),
        height=height,
        wheelbase=float(p[L_F] + p[L_R]),
        track=float(p[TRACK_F]),
        wheel_radius=float(p[RADIUS]),
        front_axle=float(p[L_F]),
    )


def first_lights(setting: Setting) -> np.ndarray:
    """int8[link]: what every signal shows at the start."""
    signals, start = setting.network.signals, setting.scenario.map.signal_start
    return np.array([signals.state(link, start) for link in range(len(signals))], dtype=np.int8)
