"""Layers: what can be drawn over the scene of what was recorded, at one time of a run that goes on or is over.

Layers(setting).at(record, i)   →  answer.Layers, at sample i of a record

One and the same for both: a live run gives a record of its last samples. Places are in the frame of the car that they belong to, its
origin below the centre of gravity, wherever the picture has the car just now; only trails and paths lie on the map. What was not recorded
is told, so that nobody takes it for nothing.
"""

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cached_property
from math import cos, degrees, isfinite, sin
from typing import NamedTuple

import numpy as np

from studio.execution.message import Messages
from studio.execution.record import Body, Record
from studio.kind import registry
from studio.kind.sensor import Looking
from studio.road.ways.path import PATH_HEADING, PATH_HEIGHT, PATH_SPACING, PATH_X, PATH_Y
from studio.road.ways.relief import height_at, relief_of
from studio.server import answer
from studio.world.setting import Setting

SHOWN = 0.3  # [s] that a message is seen, for it is under way for a thousandth of that
MOST_LINES = 400  # messages that are drawn at a time
TRAIL, TRAIL_STEP = 5.0, 0.5  # [s] of a trail, and between its points
AHEAD, LEAST_AHEAD, PATH_STEP = 4.0, 20.0, 4.0  # [s], [m] of the way ahead, and [m] between its points
FAR_AHEAD = 150.0  # [m] a longer gap is nobody's concern
# Brake lights by UN Regulation 13-H, 5.2.22.4: of cars whose brakes are not modelled the deceleration tells, above 1.3 m/s² in any case.
BRAKING, SLOWING = 20.0, -1.3  # [Nm] of all brakes, [m/s²]
# There are no indicators in the simulation: they are shown for a bend of the planned way by so much within so much of it, estimated.
BEND, SOON = 40.0, 25.0  # [°], [m]
POLAR, FLAT = ("range", "azimuth"), ("ahead", "left")  # how a sensor says where something is


class Eye(NamedTuple):
    """A sensor of a vehicle: whose, where it is mounted, what it reaches; the probes that give its targets, and how they do."""

    car: int
    x: float  # [m]
    y: float  # [m]
    yaw: float  # [rad]
    range: float  # [m]
    angle: float  # [rad]
    name: str


@dataclass(frozen=True)
class Layers:
    """Of a setting, and the bodies of its vehicles."""

    setting: Setting
    bodies: dict[str, Body]

    def at(self, record: Record, i: int) -> answer.Layers:
        """Everything at sample i."""
        return answer.Layers(
            time=float(record.time[i]),
            cars=list(self.cars(record, i)),
            fields=[self.field(eye, record, i) for eye in self.eyes],
            messages=list(self.messages(record.messages, float(record.time[i]))),
            trails=list(self.trails(record, i)),
            paths=list(self.paths(record, i)),
        )

    @cached_property
    def number(self) -> dict[str, int]:
        """Of every vehicle."""
        return {name: number for number, name in enumerate(self.setting.names)}

    # -- cars ----------------------------------------------------------------------------------------

    def cars(self, record: Record, i: int) -> Iterator[answer.LayerCar]:
        """Speed, lamps, who is ahead and how far, and what the driver is shown; of those that are there."""
        rows = {name: record.channel(name)[:, i] for name in ("x", "speed", "acceleration", "brake_torque", "station", "gap", "ahead")}
        for v, name in enumerate(record.vehicles):
            if name not in self.number or not isfinite(rows["x"][v]):
                continue
            own = {key: float(row[v]) for key, row in rows.items()}
            yield answer.LayerCar(
                car=self.number[name],
                speed=some(own["speed"]),
                brakes=is_braking(own["brake_torque"], own["acceleration"]),
                turns=self.turns(name, own["station"]),
                ahead=self.number.get(record.called.get(int(own["ahead"]), "")) if isfinite(own["ahead"]) else None,
                gap=some(own["gap"]) if own["gap"] < FAR_AHEAD else None,
                notice=self.notice(name, record, i),
            )

    def turns(self, name: str, station: float) -> int:
        """1 where the way bends to the left soon, -1 to the right, 0 when it does not."""
        if not isfinite(station):
            return 0
        points = self.setting.cars[self.number[name]].path.points[PATH_HEADING]
        here, there = (min(max(int(s / PATH_SPACING), 0), points.size - 1) for s in (station, station + SOON))
        bend = degrees(float(np.unwrap(points[here : there + 1])[-1] - points[here]))
        return 0 if abs(bend) < BEND else 1 if bend > 0 else -1

    def notice(self, name: str, record: Record, i: int) -> str:
        """What the applications of a vehicle show to its driver."""
        found = []
        for group, sentences in self.shows:
            probe = record.probes.get(f"{name}.{group}.notice")
            number = probe.values[i] if probe else 0.0
            if 1 <= number <= len(sentences):
                found.append(sentences[int(number) - 1])
        return " ".join(found)

    @cached_property
    def shows(self) -> list[tuple[str, tuple[str, ...]]]:
        """The groups whose application shows something, and its sentences."""
        modules = {name: registry.find("application", each.application).module for name, each in self.setting.scenario.applications.items()}
        return [(name, module.NOTICES) for name, module in modules.items() if getattr(module, "NOTICES", ())]

    # -- sensors -------------------------------------------------------------------------------------

    @cached_property
    def eyes(self) -> list[Eye]:
        """The sensors of named vehicles that look around."""
        return [
            Eye(self.number[name], self.bodies[name].front + each.forward, each.left, each.yaw, each.range, each.opening_angle, sensor)
            for name, vehicle in self.setting.scenario.vehicles.items()
            for sensor, each in vehicle.sensors.items()
            if isinstance(each, Looking) and each.range > 0.0
        ]

    def field(self, eye: Eye, record: Record, i: int) -> answer.LayerField:
        """Where a sensor looks, and what it has said of targets."""
        return answer.LayerField(
            car=eye.car,
            sensor=eye.name,
            x=eye.x,
            y=eye.y,
            yaw=eye.yaw,
            range=eye.range,
            angle=eye.angle,
            seen=list(self.seen(eye, record, i)),
        )

    def seen(self, eye: Eye, record: Record, i: int) -> Iterator[list[float]]:
        """Its targets, in the frame of the car [m]."""
        at = f"{self.setting.names[eye.car]}.{eye.name}"
        for where, form in slots(at, record):
            a, b = (float(record.probes[f"{where}.{part}"].values[i]) for part in form)
            if isfinite(a) and isfinite(b):
                yield placed(eye, a, b) if form == POLAR else [self.bodies[self.setting.names[eye.car]].front + a, b]

    # -- messages ------------------------------------------------------------------------------------

    def messages(self, log: Messages, t: float) -> Iterator[answer.LayerMessage]:
        """The newest message on every link that has had one lately, whether it arrived or not."""
        first, last = np.searchsorted(log.time, [t - SHOWN, t], side="right").tolist()
        starts = np.cumsum(log.count) - log.count
        newest: dict[tuple[int, int], tuple[int, int]] = {}
        for m in range(first, last):
            for e in range(int(starts[m]), int(starts[m] + log.count[m])):
                newest[int(log.sender[m]), int(log.receiver[e])] = m, e
        for (sender, receiver), (m, e) in list(newest.items())[-MOST_LINES:]:
            ends = self.end(log.units[sender]), self.end(log.units[receiver])
            if ends[0] and ends[1]:
                yield answer.LayerMessage(sender=ends[0], receiver=ends[1], kind=log.kinds[int(log.kind[m])], lost=bool(log.cause[e]))

    def end(self, unit: str) -> answer.LayerEnd | None:
        """Where a unit is that sends or hears: a vehicle, or a station at its place."""
        if unit in self.number:
            return answer.LayerEnd(car=self.number[unit])
        x, y = self.setting.spots.get(unit, (None, None))
        return None if x is None else answer.LayerEnd(x=x, y=y)

    # -- lines on the map ----------------------------------------------------------------------------

    def trails(self, record: Record, i: int) -> Iterator[answer.LayerLine]:
        """Where everybody came from."""
        t = record.time[i]
        steps = np.unique(np.searchsorted(record.time[: i + 1], np.arange(t - TRAIL, t, TRAIL_STEP)))
        x, y, station = (record.channel(name) for name in ("x", "y", "station"))
        for v, name in enumerate(record.vehicles):
            there = [j for j in steps if isfinite(x[v, j])]
            if name in self.number and isfinite(x[v, i]) and there:
                heights = height_at(self.setting.cars[self.number[name]].path, station[v, there])
                yield self.line(name, np.column_stack([x[v, there], y[v, there]]), heights)

    def paths(self, record: Record, i: int) -> Iterator[answer.LayerLine]:
        """Where everybody's way leads within the next seconds."""
        station, speed = record.channel("station")[:, i], record.channel("speed")[:, i]
        for v, name in enumerate(record.vehicles):
            if name in self.number and isfinite(station[v]) and isfinite(speed[v]):
                reach = max(AHEAD * float(speed[v]), LEAST_AHEAD)
                yield self.line(name, *self.way(name, float(station[v]), reach))

    def way(self, name: str, station: float, reach: float) -> tuple[np.ndarray, np.ndarray]:
        """Points of a vehicle's path from a station on, float64[n, 2] [m], and the heights of the road there [m]."""
        points = self.setting.cars[self.number[name]].path.points
        at = np.arange(station, station + reach, PATH_STEP) / PATH_SPACING
        known, own = np.arange(points.shape[1]), at[at <= points.shape[1] - 1]
        x, y, height = (np.interp(own, known, points[row]) for row in (PATH_X, PATH_Y, PATH_HEIGHT))
        return np.column_stack([x, y]), height

    def line(self, name: str, points: np.ndarray, heights: np.ndarray) -> answer.LayerLine:
        """A line of a vehicle through points, float64[n, 2] [m], on roads of these heights [m]."""
        relief, lifts = relief_of(self.setting.network), np.zeros(0)
        if relief is not None and len(points):
            lifts, _ = relief.at(points[:, 0], points[:, 1], heights)
        return answer.LayerLine(car=self.number[name], points=rounded(points), lifts=np.round(lifts, 2).tolist() if lifts.any() else [])


def missing(record: Record, kept: Collection[str]) -> dict[str, str]:
    """What of a record that is over cannot be drawn, layer by layer, and why; `kept` are the channels that were recorded.

    A channel that was kept may hold no number: a gap is none where nobody is ahead.
    """
    known = {name.partition(".")[2] for name in kept}
    wanted = {"gaps": ("gap", "ahead"), "paths": ("station",), "trails": ("x", "y"), "speed": ("speed",)}
    found = {
        layer: NOT_KEPT.format(", ".join(lacking)) for layer, names in wanted.items() if (lacking := [n for n in names if n not in known])
    }
    if not {"acceleration", "brake_torque"} & known:
        found["lamps"] = NOT_KEPT.format("acceleration")
    if not record.messages.units:
        found["messages"] = "this run has no log of messages"
    return found


NOT_KEPT = "{} was not recorded: see recording.channels"


def slots(at: str, record: Record) -> Iterator[tuple[str, tuple[str, str]]]:
    """Where the targets of a sensor stand among the probes, and how they say where they are."""
    form = next((form for form in (POLAR, FLAT) if all(f"{at}.{part}" in record.probes for part in form)), None)
    slot, where = 1, at
    while form and f"{where}.{form[0]}" in record.probes:
        yield where, form
        slot += 1
        where = f"{at}.{slot}"


def placed(eye: Eye, distance: float, azimuth: float) -> list[float]:
    """A target seen by a sensor, in the frame of its car [m]."""
    return [eye.x + distance * cos(eye.yaw + azimuth), eye.y + distance * sin(eye.yaw + azimuth)]


def is_braking(torque: float, acceleration: float) -> bool:
    """Whether the brake lights are on."""
    return abs(torque) > BRAKING if isfinite(torque) else acceleration < SLOWING


def some(value: float) -> float | None:
    """A number for JSON, with as much of it as is seen."""
    return round(value, 3) if isfinite(value) else None


def rounded(points: list[tuple[float, float]] | np.ndarray) -> list[list[float]]:
    """Points with centimetres."""
    return np.round(np.asarray(points, float).reshape(-1, 2), 2).tolist()
