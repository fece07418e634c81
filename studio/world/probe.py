"""Probes: what the sensors and applications of units give to be recorded, besides the channels that every vehicle has.

A sensor's first target is `follower_1.front.range`, its second `follower_1.front.2.range`; where there can be
several, `follower_1.front.count` says how many. `follower_1.front.measured` is the time at which all of this was so.
What an application logs stands under the name of its group, `follower_1.platoon.spacing_error`; what it shows to the driver
is `follower_1.platoon.notice`.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from math import nan
from typing import Any, NamedTuple

import numpy as np

from studio.compiled import lean
from studio.kind.quantity import Quantity, width
from studio.vehicle.state import VEHICLE
from studio.world.board.air import Air
from studio.world.board.host import Hosted
from studio.world.board.sensing import Mounted
from studio.world.table.mind import MIND
from studio.world.table.unit import MEASURED
from studio.world.world import Units, World


class Probe(NamedTuple):
    """One recorded number: `unit.quantity`, its unit and label; where it stands: whose field, which row and column, which target."""

    name: str
    unit: str
    label: str
    owner: Any
    field: str
    row: int
    column: int
    slot: int = -1

    @property
    def quantity(self) -> str:
        """Its name without that of the unit."""
        return self.name.partition(".")[2]


def probes(world: World) -> list[list[Probe]]:
    """All probes, world by world."""
    units = world.units
    found: list[list[Probe]] = [[] for _ in world.names]
    for each in (
        *(probe for one in units.mounted for probe in of_sensor(one, units)),
        *(p for one in world.hosted for p in of_log(one, units)),
        *(p for one in units.airs if one.is_loaded for p in of_air(one, units)),
    ):
        number, probe = each
        found[number].append(probe)
    return found


def of_sensor(each: Mounted, units: Units) -> Iterator[tuple[int, Probe]]:
    """Those of the sensors of a kind, with the number of their world."""
    for column, (name, unit) in enumerate(zip(each.names, each.unit.tolist(), strict=True)):
        at, world = f"{units.name_of(unit)}.{name}", int(units.world[unit])
        yield world, Probe(f"{at}.measured", "s", f"Time at which {name} measured", each, "health", MEASURED, column)
        if each.capacity > 1:
            yield world, Probe(f"{at}.count", "1", f"Targets of {name}", each, "out", 0, column)
        for slot in range(each.capacity):
            place = at if slot == 0 else f"{at}.{slot + 1}"
            row = 1 + slot * width(each.kind.module.Reading)
            for part, unit_of, i in parts(each.reading):
                label = f"{part.replace('_', ' ').capitalize()} of {name}" + (f", target {slot + 1}" if slot else "")
                yield world, Probe(f"{place}.{part}", unit_of, label, each, "out", row + i, column, slot)


def of_log(each: Hosted, units: Units) -> Iterator[tuple[int, Probe]]:
    """What an application logs and shows, with the number of the world."""
    for column, unit in enumerate(each.unit.tolist()):
        group, world = each.group_of(column).name, int(units.world[unit])
        at = f"{units.name_of(unit)}.{group}"
        for part, unit_of, i in parts(each.log):
            label = f"{part.replace('_', ' ').capitalize()} of {group}"
            yield world, Probe(f"{at}.{part}", unit_of, label, each, "said", i, column)
        if each.shows:
            yield world, Probe(f"{at}.notice", "1", f"Notice of {group}", each, "shown", -1, column)


def of_air(each: Air, units: Units) -> Iterator[tuple[int, Probe]]:
    """How busy the channel is where every unit is, with the number of the world, in worlds with this kind of radio."""
    for unit, world in enumerate(units.world.tolist()):
        if world in each.worlds:
            yield world, Probe(f"{units.name_of(unit)}.channel_load", "1", "Load of the channel", each, "load", -1, unit)


def parts(of: Sequence[Quantity]) -> Iterator[tuple[str, str, int]]:
    """Every number of some quantities: its name, its unit, its place."""
    place = 0
    for each in of:
        for i in range(each.size):
            yield each.name if each.size == 1 else f"{each.name}_{i}", each.unit or "1", place
            place += 1


FIRST, STEP, COUNT, COUNTER, SLOT, WHERE = range(6)  # of a stretch: numbers that follow each other in the buffer, and where they go


@dataclass
class Reader:
    """Reads all probes at once, from the buffer of everything that moves, laid out in one line."""

    probes: list[Probe]
    numbers: np.ndarray
    stretches: np.ndarray = field(init=False)  # int64[row, stretch]

    def __post_init__(self) -> None:
        start = self.numbers.ctypes.data
        found = [stretch(self.probes[first], count, first, start) for first, count in runs(self.probes, follows)]
        self.stretches = np.array(found, dtype=np.int64).reshape(-1, 6).T.copy()

    def read(self, values: np.ndarray) -> None:
        """All values now, float64[probe]; not a number where there is no target."""
        pick(self.numbers, self.stretches, values)


def reader(probes: list[Probe], world: World) -> Reader:
    """What reads some probes of a world, once everything that moves is in one buffer."""
    return Reader(probes, world.arena.view(np.float64))


def runs(probes: list[Probe], is_together: Callable[[Probe, Probe], bool]) -> Iterator[tuple[int, int]]:
    """Where probes begin of which each is together with the one before it, and how many."""
    start = 0
    for i in range(1, len(probes) + 1):
        if i == len(probes) or not is_together(probes[i - 1], probes[i]):
            yield start, i - start
            start = i


def follows(one: Probe, other: Probe) -> bool:
    """Whether a probe of the same column stands in the row behind another's."""
    same = one.owner is other.owner and (one.field, one.column, one.slot) == (other.field, other.column, other.slot)
    return same and other.row == one.row + 1


def stretch(probe: Probe, count: int, where: int, start: int) -> tuple[int, ...]:
    """So many numbers from a probe's on, which go to a place: what a sensor gives stands together, all else row by row.

    `start` is the address of the buffer.
    """
    array = getattr(probe.owner, probe.field)
    along, across = (array.shape[1], 1) if probe.field == "out" else (1, array.shape[-1])
    at = place(array, start) + probe.column * along
    return at + max(probe.row, 0) * across, across, count, at, probe.slot, where


def measured_at(sensor: Probe, start: int) -> int:
    """Where it stands in the buffer when a sensor has measured what it gives."""
    return place(sensor.owner.health[MEASURED], start) + sensor.column


def place(array: np.ndarray, start: int) -> int:
    """Where an array of real numbers begins in the buffer."""
    assert array.dtype == np.float64 and array.flags.c_contiguous, "what is laid out in one line is real numbers, one behind the other"
    return (array.ctypes.data - start) // array.itemsize


@lean
def pick(numbers, stretches, values):
    """Some stretches of an array; not a number for those of a target beyond the number of targets."""
    for i in range(stretches.shape[1]):
        at, where = stretches[FIRST, i], stretches[WHERE, i]
        there = stretches[SLOT, i] < 0 or numbers[stretches[COUNTER, i]] > stretches[SLOT, i]
        for j in range(stretches[COUNT, i]):
            values[where + j] = numbers[at + j * stretches[STEP, i]] if there else nan


# -- for conditions --------------------------------------------------------------------------------------


def reader_of(world: World) -> Reader | None:
    """Reads the values that the conditions of a script look at; None when they look at none."""
    watched = world.script.watched
    if not watched:
        return None
    known = [{each.name: each for each in some} for some in probes(world)]
    return reader([known[w][name] if name in known[w] else of_vehicle(w, name, world) for w, name in watched], world)


def of_vehicle(number: int, name: str, world: World) -> Probe:
    """A row of a vehicle's state, or of what its driver has in mind."""
    vehicle, _, quantity = name.partition(".")
    for array, table in ROWS.items():
        for row, each in enumerate(table):
            if each.name == quantity and each.label:
                return Probe(name, each.unit, each.label, world.vehicles, array, row, world.column(vehicle, number))
    raise KeyError(name)  # names are looked at before: setting.py


ROWS = {"state": VEHICLE, "mind": MIND}
