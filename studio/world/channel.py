"""Channels: what can be recorded of a vehicle. Every row of these tables that has a label is one."""

from typing import NamedTuple

import numpy as np

from studio.rows import Table
from studio.vehicle.command import COMMAND, RING
from studio.vehicle.state import ACTIVE, VEHICLE
from studio.world.mind import MIND
from studio.world.unit import SENSOR
from studio.world.world import World


class Channel(NamedTuple):
    """One quantity of one vehicle over time: where its row stands, -1 for one that is made of others."""

    name: str
    unit: str
    label: str
    meaning: str
    table: str
    row: int


def channels_of(table: Table) -> list[Channel]:
    """The rows of a table that can be recorded."""
    return [Channel(row.name, row.unit, row.label, row.meaning, table.name, i) for i, row in enumerate(table) if row.label]


CHANNELS = tuple(channel for table in (VEHICLE, MIND, COMMAND, SENSOR) for channel in channels_of(table))
TIME_GAP = Channel("time_gap", "s", "Time gap to the car ahead", "gap over the own speed, while the car moves", "derived", -1)
BY_NAME = {channel.name: channel for channel in (*CHANNELS, TIME_GAP)}


def sample(world: World, columns: np.ndarray, k: int) -> np.ndarray:
    """All channels of some vehicles, float64[channel, vehicle], with the commands of tick k.

    A vehicle that has arrived has no values any more.
    """
    v, n = world.vehicles, world.size
    parts = {VEHICLE.name: v.state, MIND.name: v.mind, SENSOR.name: world.units.sensors, COMMAND.name: v.commands}
    start = {COMMAND.name: (k % RING) * n}
    values = np.array([parts[c.table][c.row, columns + start.get(c.table, 0)] for c in CHANNELS])
    values[:, v.state[ACTIVE, columns] == 0.0] = np.nan
    return values
