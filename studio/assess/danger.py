"""Danger: near misses and hard brakes of recorded vehicles, found in the record and told as events.

A near miss is a stretch of time to collision below 1.5 s without a collision in it (R. van der Horst, J. Hogema, Time-to-collision and
collision avoidance systems, 1993: below it drivers are in danger); it is told when the time to collision is least. A hard brake is a
stretch of deceleration above 5 m/s² (T. A. Dingus et al., The 100-car naturalistic driving study, DOT HS 810 593, 2006); it is told when
it begins, with its strongest deceleration, and names whom the driver minds; where somebody else brakes, who is ahead. Stretches that are
nearer to each other than a second are one.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from studio.assess.following import ttc
from studio.execution.happening import Happening, happening
from studio.execution.record import Record
from studio.world.commander import NAMES
from studio.world.table.event import EVENTS, HARD_BRAKE, HIT, NEAR_MISS

NEAR = 1.5  # [s]
HARD = 5.0  # [m/s²]
APART = 1.0  # [s]
DRIVERS = [NAMES.index(each) for each in ("driver", "driver's intervention")]  # who has the brake where a driver brakes himself
FAR = 100.0  # [m] ahead, from which on nobody is a reason to brake hard


def with_dangers(record: Record) -> Record:
    """The record with its near misses and hard brakes among what happened, in the order of time."""
    found = [*near_misses(record), *hard_brakes(record)]
    return replace(record, happenings=tuple(sorted([*record.happenings, *found], key=lambda each: each.time))) if found else record


def near_misses(record: Record) -> Iterator[Happening]:
    """Those of every vehicle with what was ahead of it."""
    hits = [event for event in record.happenings if event.kind == EVENTS[HIT].name]
    for row, values in enumerate(ttc(record)):
        for part in stretches((values >= 0.0) & (values < NEAR), record.time):
            place = part.start + int(np.nanargmin(values[part]))
            units, when = (record.vehicles[row], record.ahead(row, place)), record.time[place]
            is_hit = any(set(units) <= set(hit.units) and abs(hit.time - when) < NEAR + APART for hit in hits)
            if all(units) and not is_hit:
                yield happening(NEAR_MISS, float(when), units, place=place_of(record, row, place), ttc=float(values[place]))


def hard_brakes(record: Record) -> Iterator[Happening]:
    """Those of every vehicle, with the one that was the reason."""
    for row, values in enumerate(-record.channel("acceleration")):
        for part in stretches(values > HARD, record.time):
            reason = reason_of(record, row, part.start)
            units = (record.vehicles[row], *([reason] if reason else []))
            place = place_of(record, row, part.start)
            yield happening(HARD_BRAKE, float(record.time[part.start]), units, place=place, deceleration=float(np.nanmax(values[part])))


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
