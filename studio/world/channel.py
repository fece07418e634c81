"""Channels: what can be recorded of a vehicle, with unit and label."""

from math import nan
from typing import NamedTuple

import numpy as np

from studio.compiled import compiled
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


PARTS = ("state", "mind", "sensor", "command")
PART_OF = np.array([PARTS.index(channel.part) for channel in CHANNELS])
ROW_OF = np.array([channel.row for channel in CHANNELS])


def sample(world: World, columns: np.ndarray, k: int, values: np.ndarray) -> None:
    """All channels of some vehicles, float64[channel, vehicle], with the commands of tick k.

    A vehicle that has arrived has no values any more.
    """
    v = world.vehicles
    gather(columns, (k % RING) * world.size, PART_OF, ROW_OF, v.state, v.mind, world.units.sensors, v.commands, values)


@compiled
def gather(columns, commanded, part_of, row_of, state, mind, sensors, commands, values):
    """The pass behind it; `commanded` is the first column of the tick's commands."""
    for c in range(part_of.size):
        if part_of[c] == 0:
            pick(state[row_of[c]], columns, 0, values[c])
        elif part_of[c] == 1:
            pick(mind[row_of[c]], columns, 0, values[c])
        elif part_of[c] == 2:
            pick(sensors[row_of[c]], columns, 0, values[c])
        else:
            pick(commands[row_of[c]], columns, commanded, values[c])
    for i in range(columns.size):
        if state[ACTIVE, columns[i]] == 0.0:
            values[:, i] = nan


@compiled
def pick(row, columns, start, values):
    """One row of some vehicles."""
    for i in range(columns.size):
        values[i] = row[start + columns[i]]


def link_ages(world: World, ages: np.ndarray) -> None:
    """Age [s] of the newest message on every link, the time since the start while none has come.

    Not a number once one of its ends has left.
    """
    u = world.units
    age(world.clock.time, world.vehicles.state, u.link_receiver, u.link_sender, u.inbox, ages)


@compiled
def age(time, state, link_receiver, link_sender, inbox, ages):
    """The pass behind it."""
    for link in range(ages.size):
        there = state[ACTIVE, link_receiver[link]] > 0.0 and state[ACTIVE, link_sender[link]] > 0.0
        ages[link] = time - max(inbox[SENT, link], 0.0) if there else nan
