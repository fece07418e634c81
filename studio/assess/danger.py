"""Danger: near misses and hard brakes of recorded vehicles, found in the record and told as events.

A near miss is a stretch of time to collision below 1.5 s without a collision in it (R. van der Horst, J. Hogema, Time-to-collision and
collision avoidance systems, 1993: below it drivers are in danger); it is told when the time to collision is least. A hard brake is a
stretch of deceleration above 5 m/s² (T. A. Dingus et al., The 100-car naturalistic driving study, DOT HS 810 593, 2006); it is told when
it begins, with its strongest deceleration, and names whom the driver minds; where somebody else brakes, who is ahead. Stretches that are
nearer to each other than a second are one.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from studio.assess.following import ttc
from studio.assess.intact import intact
from studio.execution.happening import Happening, happening
from studio.execution.record import Record
from studio.execution.simulation import Simulation
from studio.world.commander import NAMES
from studio.world.table.event import EVENTS, HARD_BRAKE, HIT, NEAR_MISS

NEAR = 1.5  # [s]
HARD = 5.0  # [m/s²]
APART = 1.0  # [s]
QUIET = NEAR + APART  # [s] after which nothing belongs to a danger any more, nor a collision to a near miss
DRIVERS = [NAMES.index(each) for each in ("driver", "driver's intervention")]  # who has the brake where a driver brakes himself
FAR = 100.0  # [m] ahead, from which on nobody is a reason to brake hard


def with_dangers(record: Record) -> Record:
    """The record with its near misses and hard brakes among what happened, in the order of time."""
    found = [*near_misses(record), *hard_brakes(record)]
    return replace(record, happenings=tuple(sorted([*record.happenings, *found], key=lambda each: each.time))) if found else record


def near_misses(record: Record) -> Iterator[Happening]:
    """Those of every vehicle with what was ahead of it."""
    return found(record, NEAR_MISSES)


def hard_brakes(record: Record) -> Iterator[Happening]:
    """Those of every vehicle, with the one that was the reason."""
    return found(record, HARD_BRAKES)


class Danger(NamedTuple):
    """A sort of danger: the values that tell it, float64[vehicle, n], where they do, and what is told of a stretch of a row."""

    values: Callable[[Record], np.ndarray]
    holds: Callable[[np.ndarray], np.ndarray]
    told: Callable[[Record, np.ndarray, int, slice], Happening | None]


def found(record: Record, danger: Danger) -> Iterator[Happening]:
    """All of one sort, vehicle by vehicle; none of somebody who was hit before."""
    record = intact(record)
    values = danger.values(record)
    for row, holds in enumerate(danger.holds(values)):
        for part in stretches(holds, record.time):
            if event := danger.told(record, values[row], row, part):
                yield event


def near_miss(record: Record, values: np.ndarray, row: int, part: slice) -> Happening | None:
    """What is told of a time to collision [s] that was short; nothing where a collision came of it."""
    place = part.start + int(np.nanargmin(values[part]))
    units, when = (record.vehicles[row], record.ahead(row, place)), float(record.time[place])
    hits = [event for event in record.happenings if event.kind == EVENTS[HIT].name]
    is_hit = any(set(units) <= set(hit.units) and abs(hit.time - when) < QUIET for hit in hits)
    if is_hit or not all(units):
        return None
    return happening(NEAR_MISS, when, units, place=place_of(record, row, place), ttc=float(values[place]))


def hard_brake(record: Record, values: np.ndarray, row: int, part: slice) -> Happening:
    """What is told of a deceleration [m/s²] that was strong."""
    reason = reason_of(record, row, part.start)
    units = (record.vehicles[row], *([reason] if reason else []))
    place, most = place_of(record, row, part.start), float(np.nanmax(values[part]))
    return happening(HARD_BRAKE, float(record.time[part.start]), units, place=place, deceleration=most)


NEAR_MISSES = Danger(ttc, lambda values: (values >= 0.0) & (values < NEAR), near_miss)
HARD_BRAKES = Danger(lambda record: -record.channel("acceleration"), lambda values: values > HARD, hard_brake)


class Lookout:
    """Tells the dangers of a run that goes on, each once and as in the record of the whole run: when it is over, and neither a sample nor a
    collision can belong to it any more. Only what is not over is looked at again."""

    def __init__(self, simulation: Simulation) -> None:
        self.simulation, self.called = simulation, simulation.called(0)
        self.begins = np.zeros((len(DANGERS), len(simulation.recorded())), dtype=np.int64)  # the first sample that is still looked at

    def look(self) -> list[Happening]:
        """Those that are over now; all that are left, once the run is."""
        first, end = int(self.begins.min(initial=self.simulation.recorder.count)), self.simulation.recorder.count
        if first == end:
            return []
        happenings = tuple(self.simulation.cases[0].happenings)
        record = intact(replace(self.simulation.record_of(list(range(first, end))), called=self.called, happenings=happenings))
        told = [event for number in range(len(DANGERS)) for event in self.over(number, record, first)]
        return sorted(told, key=lambda each: each.time)

    def over(self, number: int, record: Record, first: int) -> Iterator[Happening]:
        """Those of one sort; a stretch that may go on is where the next look begins."""
        danger, begins = DANGERS[number], self.begins[number]
        values, end = danger.values(record), first + record.time.size
        holds = danger.holds(values) & (np.arange(first, end) >= begins[:, None])
        begins[:] = end
        for row in np.flatnonzero(holds.any(axis=1)).tolist():
            for part in stretches(holds[row], record.time):
                if not self.simulation.is_over and record.time[-1] - record.time[part.stop - 1] <= QUIET:
                    begins[row] = first + part.start
                    break
                if event := danger.told(record, values[row], row, part):
                    yield event


DANGERS = (NEAR_MISSES, HARD_BRAKES)


def reason_of(record: Record, row: int, sample: int) -> str:
    """Whom a driver who brakes himself minds; who is ahead and near, where the brake is another's; "" when there is nobody."""
    if record.channel("commands_brake")[row, sample] in DRIVERS:
        return record.minded(row, sample)
    return record.ahead(row, sample) if record.channel("gap")[row, sample] < FAR else ""


def place_of(record: Record, row: int, sample: int) -> tuple[float, float]:
    """Where a vehicle was [m]."""
    return float(record.channel("x")[row, sample]), float(record.channel("y")[row, sample])


def stretches(holds: np.ndarray, time: np.ndarray) -> Iterator[slice]:
    """The stretches of samples over which something holds, bool[n]; those with less than a second between them are one."""
    samples = np.flatnonzero(holds)
    if samples.size:
        breaks = np.flatnonzero(np.diff(time[samples]) > APART)
        for first, last in zip([0, *(breaks + 1)], [*breaks, samples.size - 1], strict=True):
            yield slice(int(samples[first]), int(samples[last]) + 1)
