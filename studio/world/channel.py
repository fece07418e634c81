"""Channels: what can be recorded of a vehicle. Every row of these tables that has a label is one, and every kind that follows from them."""

from functools import cache
from math import nan
from typing import NamedTuple

import numpy as np

from studio.bound import Step, step
from studio.compiled import inlined, lean
from studio.kind import registry
from studio.kind.registry import Kind
from studio.rows import Table
from studio.vehicle import adhesion
from studio.vehicle.adhesion import ADHESION
from studio.vehicle.command import COMMAND, RING
from studio.vehicle.light import UNKNOWN
from studio.vehicle.state import ACTIVE, VEHICLE
from studio.world.table.mind import MIND
from studio.world.table.unit import H_NUMBER, H_TIME, PRESENT, SATELLITE
from studio.world.world import World


class Channel(NamedTuple):
    """One quantity of one vehicle over time: where its row stands, -1 for one that a kind makes of others."""

    name: str
    unit: str
    label: str
    meaning: str
    table: str
    row: int


def channels_of(table: Table) -> list[Channel]:
    """The rows of a table that can be recorded."""
    return [Channel(row.name, row.unit, row.label, row.meaning, table.name, i) for i, row in enumerate(table) if row.label]


RECORDED = (VEHICLE, MIND, COMMAND, SATELLITE)
KEPT = tuple(channel for table in RECORDED for channel in channels_of(table))  # in arrays that are there
CHANNELS = (*KEPT, *channels_of(ADHESION))  # made when they are recorded
TABLE_OF = np.array([[table.name for table in RECORDED].index(channel.table) for channel in KEPT])
ROW_OF = np.array([channel.row for channel in KEPT])
LACKED = tuple(i for i, each in enumerate(KEPT) if each.table == VEHICLE.name and each.row in UNKNOWN)  # by light vehicles


@cache
def catalogue() -> dict[str, Channel]:
    """All channels by name: the rows, then the kinds."""
    made = [derived(kind) for kind in registry.known("channel").values()]
    return {channel.name: channel for channel in (*CHANNELS, *made)}


def derived(kind: Kind) -> Channel:
    """The channel that a kind makes of others."""
    return Channel(kind.name, kind.module.UNIT, kind.title, kind.explanation.partition("\n\n")[0], "derived", -1)


registry.listen(catalogue.cache_clear)


def sampler(world: World, columns: np.ndarray, count: np.ndarray, times: np.ndarray, values: np.ndarray) -> Step:
    """What writes a time [s] and all channels of some vehicles, with the commands of tick k, behind `count` samples.

    `times` are float64[sample], `values` float64[sample, channel, vehicle].
    """
    v = world.vehicles
    adhesion = (v.tyres, v.tyres_of, v.wheels, v.ground)
    seen = (TABLE_OF, ROW_OF, v.state, v.mind, v.commands, world.units.satellite)
    return step(sample, columns, *adhesion, *seen, count, times, values, takes=("k", "time"))


@lean
def sample(columns, tyres, tyres_of, wheels, ground, table_of, row_of, state, mind, commands, satellite, count, times, values, k,
           time):  # fmt: skip
    """The pass behind it. A vehicle that has arrived has no values any more, and a light one none of what it does not know."""
    n, place = state.shape[1], count[0]
    count[0], times[place] = place + 1, time
    adhesion.use(columns, n, tyres, tyres_of, wheels, ground, values[place, row_of.size :])
    gather(columns, (k % RING) * n, table_of, row_of, state, mind, commands, satellite, values[place])
    for i in range(columns.size):
        if not adhesion.has_tyres(columns[i], tyres_of):
            for c in LACKED:
                values[place, c, i] = nan


@lean
def gather(columns, commanded, table_of, row_of, state, mind, commands, satellite, values):
    """The pass behind it; `commanded` is the first column of the tick's commands."""
    for c in range(row_of.size):
        if table_of[c] == 0:
            pick(state[row_of[c]], columns, 0, values[c])
        elif table_of[c] == 1:
            pick(mind[row_of[c]], columns, 0, values[c])
        elif table_of[c] == 2:
            pick(commands[row_of[c]], columns, commanded, values[c])
        else:
            pick(satellite[row_of[c]], columns, 0, values[c])
    for i in range(columns.size):
        if state[ACTIVE, columns[i]] == 0.0:
            values[:, i] = nan


@lean
def pick(row, columns, start, values):
    """One row of some vehicles."""
    for i in range(columns.size):
        values[i] = row[start + columns[i]]


def present(world: World) -> np.ndarray:
    """Of every unit, above 0 while it is there."""
    return world.units.now[PRESENT]


@lean
def look(present, there):
    """Puts down in `there` which units are there, of whom `present` is above 0; whether they are others than before."""
    others = False
    for u in range(there.size):
        others = others or (present[u] > 0.0) != there[u]
        there[u] = present[u] > 0.0
    return others


@lean
def note(first, link_first, taken, looks, came, came_count, inbox, looked, seen, newest, link, sent, count):
    """Writes down the links of a post, numbered from `first` on, that have heard something newer than `newest` [s], and when it was sent.

    `seen` is how often the post had looked for what has come in, and `looked` how often links of every sender had taken a message, when it
    was noted last. Where the post has looked once since then, it says itself who has taken one.
    """
    if looks[0] == seen[0] + 1:
        for k in range(came_count[0]):
            note_link(first, came[k], inbox, newest, link, sent, count)
        for s in range(taken.size):
            looked[s] = taken[s]
    elif looks[0] != seen[0]:
        for s in range(taken.size):
            if looked[s] != taken[s]:
                looked[s] = taken[s]
                for i in range(link_first[s], link_first[s + 1]):
                    note_link(first, i, inbox, newest, link, sent, count)
    seen[0] = looks[0]


@inlined
def note_link(first, i, inbox, newest, link, sent, count):
    """One link, when it has heard something newer."""
    if inbox[H_TIME, i] != newest[i] and inbox[H_NUMBER, i] >= 0.0:
        newest[i] = inbox[H_TIME, i]
        link[count[0]], sent[count[0]] = first + i, newest[i]
        count[0] += 1
