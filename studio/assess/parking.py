"""Parking: what the record of a car in a garage tells, that logs what the application `parking` does (studio/kinds/application/parking.py).

stays(record)        →  Stay, ...     every car that has been handed over
clearance(record)    →  Found         the least distance of one that drives by itself to another car, a pillar or a wall of the deck
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import shapely

from studio.execution.record import Record
from studio.garage import plan
from studio.garage.plan import Plan, Pose
from studio.kind.metric import Found

DRIVING_IN, PARKED, COMING_BACK, GIVEN_BACK = 1.0, 2.0, 3.0, 4.0
LOGGED = ("phase", "x", "y", "left")  # what the application logs; others may log or sense things of these names, but not all of them
PLAN = ("groups", "together", "space_length", "space_width", "aisle")  # what a garage logs of its deck
EVERY = 0.2  # [s] clearances are measured


class Stay(NamedTuple):
    """One car: in which phase it is, where it takes the middle of its outline to be, and how much of its way is left; each float64[n]."""

    vehicle: str
    phase: np.ndarray
    x: np.ndarray  # [m]
    y: np.ndarray  # [m]
    left: np.ndarray  # [m]


def stays(record: Record) -> Iterator[Stay]:
    """Every car that has been handed over."""
    for name in record.vehicles:
        groups = (probe.removesuffix("phase") for probe in record.probes if probe.startswith(f"{name}.") and probe.endswith(".phase"))
        for group in groups:
            if all(group + each in record.probes for each in LOGGED):
                phase, x, y, left = (record.probes[group + each].values for each in LOGGED)
                if np.any(phase == DRIVING_IN):
                    yield Stay(name, phase, x, y, left)


def deck(record: Record) -> Plan:
    """The deck of the garage that logs one."""
    for probe in record.probes:
        group = probe.removesuffix(PLAN[0])
        if group != probe and all(group + each in record.probes for each in PLAN):
            groups, together, *rest = (float(record.probes[group + each].values[-1]) for each in PLAN)
            return Plan(int(groups), int(together), *rest)
    return plan.SIXTY


def begun(record: Record, stay: Stay, phase: float) -> float:
    """When a phase has begun [s]; nothing when it has not."""
    at = np.flatnonzero(stay.phase == phase)
    return float(record.time[at[0]]) if at.size else float("nan")


def parking_times(record: Record) -> Iterator[Found]:
    """From the handing over until it stands in its space [s]."""
    for stay in stays(record):
        time = begun(record, stay, PARKED)
        if np.isfinite(time):
            yield Found(time - begun(record, stay, DRIVING_IN), (stay.vehicle,), time)


def middle(record: Record, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Where the middle of a car's outline is [m]."""
    x, y, heading = (record.trace(f"{name}.{each}") for each in ("x", "y", "heading"))
    body = record.bodies[name]
    ahead = body.front - body.length / 2.0
    return x + ahead * np.cos(heading), y + ahead * np.sin(heading)


def detours(record: Record) -> Iterator[Found]:
    """Distance driven into a space over the length of the way there from where the car was handed over [1]."""
    for stay in stays(record):
        on = np.flatnonzero(stay.phase == DRIVING_IN)
        if np.any(stay.phase == PARKED):
            way = float(np.sum(np.abs(record.trace(f"{stay.vehicle}.speed")[on[1:]]) * np.diff(record.time[on])))
            yield Found(way / max(float(stay.left[on[0]]), 1.0), (stay.vehicle,), begun(record, stay, PARKED))


def errors(record: Record, stay: Stay) -> np.ndarray:
    """Distance [m] between where a car takes the middle of its outline to be and where it is, while it drives itself."""
    on = np.isin(stay.phase, (DRIVING_IN, COMING_BACK))
    x, y = middle(record, stay.vehicle)
    return np.hypot(stay.x - x, stay.y - y)[on]


def clearance(record: Record) -> Found | float:
    """The least distance [m]; nothing when nobody was handed over."""
    alone = {stay.vehicle: np.isin(stay.phase, (DRIVING_IN, COMING_BACK)) for stay in stays(record)}
    step = max(round(EVERY / float(record.time[1] - record.time[0])), 1) if record.time.size > 1 else 1
    samples = [(k, [name for name, on in alone.items() if on[k]]) for k in range(0, record.time.size, step)]
    found = [nearest(record, k, moving) for k, moving in samples if moving]
    return min(found, default=float("nan"), key=lambda each: each.value)


def nearest(record: Record, k: int, moving: list[str]) -> Found:
    """At one sample, of those that move."""
    outlines = {name: outline(record, name, k) for name in record.vehicles}
    there = {name: each for name, each in outlines.items() if each is not None}
    best = Found(float("inf"), (), float(record.time[k]))
    for name in moving:
        others = [other for other in there if other != name]
        away = shapely.distance(there[name], np.array([there[other] for other in others] + [plan.structure(deck(record))]))
        i = int(np.argmin(away))
        if away[i] < best.value:
            best = Found(float(away[i]), (name, others[i]) if i < len(others) else (name,), float(record.time[k]))
    return best


def outline(record: Record, name: str, k: int) -> shapely.Polygon | None:
    """Of a car at a sample; nothing once it has arrived."""
    x, y, heading = (float(record.trace(f"{name}.{each}")[k]) for each in ("x", "y", "heading"))
    body = record.bodies[name]
    return plan.box(Pose(x, y, heading), body.front, body.length - body.front, body.width) if np.isfinite(x) else None
