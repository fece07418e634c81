"""Probes: what the sensors and applications of units give to be recorded, besides the channels that every vehicle has.

A sensor's first target is `follower_1.front.range`, its second `follower_1.front.2.range`; where there can be
several, `follower_1.front.count` says how many.
What an application logs is `follower_1.cacc.spacing_error`; what it shows to the driver `follower_1.cacc.notice`.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from math import nan
from typing import Any, NamedTuple

import numpy as np

from studio.application import port
from studio.compiled import lean
from studio.kind.quantity import Quantity, width
from studio.world.board.host import Hosted
from studio.world.board.sensing import Mounted
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
    ):
        number, probe = each
        found[number].append(probe)
    return found


def of_sensor(each: Mounted, units: Units) -> Iterator[tuple[int, Probe]]:
    """Those of the sensors of a kind, with the number of their world."""
    for column, (name, unit) in enumerate(zip(each.names, each.unit.tolist(), strict=True)):
        at, world = f"{units.name_of(unit)}.{name}", int(units.world[unit])
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
    shows = any(one.what == port.NOTICE for one in port.done(each.application.module))
    for column, unit in enumerate(each.unit.tolist()):
        at, world = f"{units.name_of(unit)}.{each.application.name}", int(units.world[unit])
        for part, unit_of, i in parts(each.log):
            yield (
                world,
                Probe(
                    f"{at}.{part}", unit_of, f"{part.replace('_', ' ').capitalize()} of {each.application.name}", each, "said", i, column
                ),
            )
        if shows:
            yield world, Probe(f"{at}.notice", "1", f"Notice of {each.application.name}", each, "shown", -1, column)


def parts(of: Sequence[Quantity]) -> Iterator[tuple[str, str, int]]:
    """Every number of some quantities: its name, its unit, its place."""
    place = 0
    for each in of:
        for i in range(each.size):
            yield each.name if each.size == 1 else f"{each.name}_{i}", each.unit or "1", place
            place += 1


@dataclass
class Reader:
    """Reads all probes at once: those of one array in one call."""

    probes: list[Probe]
    shares: list[tuple[Any, str, np.ndarray, np.ndarray, np.ndarray, np.ndarray]] = field(init=False)

    def __post_init__(self) -> None:
        places: dict[tuple[int, str], list[int]] = {}
        for i, each in enumerate(self.probes):
            places.setdefault((id(each.owner), each.field), []).append(i)
        self.shares = [share([self.probes[i] for i in some], some) for some in places.values()]

    def read(self, values: np.ndarray) -> None:
        """All values now, float64[probe]; not a number where there is no target."""
        for owner, name, rows, columns, slots, where in self.shares:
            array = getattr(owner, name)
            pick(array if array.ndim == 2 else array[None].astype(float), rows, columns, slots, where, values)


def share(some: list[Probe], where: list[int]) -> tuple[Any, str, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """What is read from one array: whose, which rows and columns, which targets, where to."""
    rows, columns, slots = (np.array([getattr(each, name) for each in some], dtype=np.int64) for name in ("row", "column", "slot"))
    return some[0].owner, some[0].field, np.maximum(rows, 0), columns, slots, np.array(where, dtype=np.int64)


@lean
def pick(array, rows, columns, slots, where, values):
    """Some numbers of an array whose first row says how many targets there are."""
    for i in range(rows.size):
        there = slots[i] < 0 or array[0, columns[i]] > slots[i]
        values[where[i]] = array[rows[i], columns[i]] if there else nan
