"""Channels: what can be recorded of a vehicle, with unit and label."""

from typing import NamedTuple

import numpy as np

from studio.world.state import *  # noqa: F403 - the names of the rows
from studio.world.world import World


class Channel(NamedTuple):
    """One quantity of one vehicle over time: where its row stands."""

    name: str
    unit: str
    label: str
    part: str  # array of the world: "state", "mind", "command", "sensor"
    row: int


CHANNELS = (
    Channel("x", "m", "East position", "state", X),
    Channel("y", "m", "North position", "state", Y),
    Channel("heading", "rad", "Heading", "state", PSI),
    Channel("speed", "m/s", "Speed", "state", V_X),
    Channel("acceleration", "m/s²", "Acceleration", "state", A_X),
    Channel("lateral_acceleration", "m/s²", "Lateral acceleration", "state", A_Y),
    Channel("yaw_rate", "rad/s", "Yaw rate", "state", YAW_RATE),
    Channel("steering", "rad", "Road wheel angle", "state", DELTA),
    Channel("roll", "rad", "Roll angle", "state", ROLL),
    Channel("pitch", "rad", "Pitch angle", "state", PITCH),
    Channel("engine_speed", "rad/s", "Engine speed", "state", OMEGA_E),
    Channel("engine_torque", "Nm", "Engine torque", "state", T_ENGINE),
    Channel("gear", "1", "Gear", "state", GEAR),
    Channel("drive_torque", "Nm", "Drive torque, sum of the wheels", "state", TORQUE_DRIVE),
    Channel("brake_torque", "Nm", "Brake torque, sum of the wheels", "state", TORQUE_BRAKE),
    Channel("station", "m", "Distance along the route", "mind", STATION),
    Channel("lateral_offset", "m", "Offset from the path", "mind", OFFSET),
    Channel("gap", "m", "Gap to the car ahead", "mind", GAP),
    Channel("ahead_speed", "m/s", "Speed of the car ahead", "mind", AHEAD_SPEED),
    Channel("desired_speed", "m/s", "Permitted speed", "mind", V_DESIRED),
    Channel("requested_acceleration", "m/s²", "Requested acceleration", "command", U),
    Channel("measured_range", "m", "Range of the front sensor", "sensor", RANGE),
    Channel("gps_error_east", "m", "Error of the satellite position to the east", "sensor", GPS_EAST),
    Channel("gps_error_north", "m", "Error of the satellite position to the north", "sensor", GPS_NORTH),
)
TIME_GAP = Channel("time_gap", "s", "Time gap to the car ahead", "derived", -1)
BY_NAME = {channel.name: channel for channel in (*CHANNELS, TIME_GAP)}


def sample(world: World, columns: np.ndarray, k: int) -> np.ndarray:
    """All channels of some vehicles, float64[channel, vehicle], with the commands of tick k.

    A vehicle that has arrived has no values any more.
    """
    v, n = world.vehicles, world.size
    parts = {"state": v.state, "mind": v.mind, "sensor": world.units.sensors, "command": v.commands}
    start = {"command": (k % RING) * n}
    values = np.array([parts[c.part][c.row, columns + start.get(c.part, 0)] for c in CHANNELS])
    values[:, v.state[ACTIVE, columns] == 0.0] = np.nan
    return values
