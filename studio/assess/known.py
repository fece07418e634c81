"""Known: what a unit knew of another one at a moment, by its sensors and by messages: the last that it was told, and how old that was.

A sensor does not say whom it has seen, and an application may not know. The record tells both afterwards: the target belongs to the vehicle
whose outline is nearest to where the sensor has put it, at the time at which it was measured, if it is not farther away than 3 m; or to
whatever the script has brought to the road, people and cyclists among it. Vehicles that were not recorded are nobody here, and no sensor
sees the vehicle that carries it. A sensor that has lost somebody is asked for its last reading of him, as far back as 2 s.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np

from studio.execution.brought import Pose
from studio.execution.happening import Number
from studio.execution.message import Messages
from studio.execution.record import SAME_TIME, Mount, Record
from studio.world.table.cause import CAUSES

MEMORY = 2.0  # [s] for which a sensor's last reading of somebody counts as known: about what a driver needs to look again
NEAR = 3.0  # [m] from an outline, within which a target is taken for that of this vehicle
SENSED = (("range", "azimuth"), ("ahead", "left"))  # fields that say where a target is: from the sensor, or from the middle of the front
OF_THE_SENSOR = ("count", "measured")  # what is no field of a target
PLACES = ("x", "y", "heading")  # channels that say where a vehicle is
AT_THE_FRONT = Mount(0.0, 0.0, 0.0)
WHY = {number: each.name for number, each in enumerate(CAUSES)}


@dataclass(frozen=True)
class Lost:
    """A message that did not come: when it was sent [s], and why."""

    time: float
    why: str


@dataclass(frozen=True)
class Known:
    """What `unit` knew `about` another: from which sensor or message, how old [s], and which messages of it were lost since.

    `time` [s] is when it was measured, or sent; None like the age when nothing had come.
    """

    unit: str
    about: str
    source: str
    age: float | None
    time: float | None = None
    what: dict[str, Number] = field(default_factory=dict)
    lost: tuple[Lost, ...] = ()

    def as_json(self) -> dict[str, Any]:
        """Plain data."""
        what = {name: each._asdict() for name, each in self.what.items()}
        return vars(self) | {"what": what, "lost": [vars(each) for each in self.lost]}

    @property
    def text(self) -> str:
        """All of it in a sentence."""
        what = "".join(f", {name.replace('_', ' ')} {each.value:.4g} {each.unit}".removesuffix(" 1") for name, each in self.what.items())
        if self.age is None:
            return f"{self.unit} never heard {self.about} by {self.source}{lost_text(self.lost)}"
        return f"{self.unit} knew {self.about} by {self.source}, {self.age:.2f} s old (of {self.time:.2f} s){what}{lost_text(self.lost)}"


def lost_text(lost: tuple[Lost, ...]) -> str:
    """What is missing since."""
    if not lost:
        return ""
    last, count = lost[-1], f"{len(lost)} message{'s' * (len(lost) > 1)}"
    return f"; lost since: {count}, the last of {last.time:.2f} s ({last.why})"


class Overseer(NamedTuple):
    """A unit without a vehicle that guides: what it had told somebody, and what it knew about another, by the newest messages of both."""

    told: Known
    knew: Known

    @property
    def text(self) -> str:
        """Both in a sentence."""
        by, unit, about = self.told.about, self.told.unit, self.knew.about
        heard = f"which {unit} had heard by {self.told.source}, {self.told.age:.2f} s old"
        return f"{by}, {heard}, knew {about} by {self.knew.source}, {self.knew.age:.2f} s old"


def overseers(record: Record, unit: str, about: str, when: float) -> Iterator[Overseer]:
    """Who beside the road had told a unit something and knew another, by messages of the last seconds: these need not hear each other."""
    for post in record.messages.units:
        if post in record.vehicles or post in (unit, about):
            continue
        told, knew = (newest(heard(record, *pair, when)) for pair in ((unit, post), (post, about)))
        if told and knew:
            yield Overseer(told, knew)


def newest(found: Iterator[Known]) -> Known | None:
    """The newest of what had come in the last seconds."""
    fresh = [each for each in found if each.age is not None and each.age <= MEMORY]
    return min(fresh, key=lambda each: each.age or 0.0, default=None)


def known(record: Record, unit: str, about: str, sample: int, when: float) -> Iterator[Known]:
    """Everything that a unit knew about a vehicle, or whatever the script has brought: by its sensors, then by messages.

    `sample` is the last one whose readings count, `when` [s] the moment from which ages are told.
    """
    yield from sensed(record, unit, about, sample, when)
    yield from heard(record, unit, about, when)


# -- by sensors ----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Target:
    """One target of a sensor: the name of the sensor with its unit, and the probes of its fields."""

    sensor: str
    fields: dict[str, str]

    @property
    def name(self) -> str:
        """That of the sensor on its unit."""
        return self.sensor.partition(".")[2]


def targets(record: Record, unit: str) -> Iterator[Target]:
    """All targets that sensors of a unit may have: probes of one place that tell where it is."""
    places: dict[str, dict[str, str]] = {}
    for name in record.probes:
        place, _, part = name.rpartition(".")
        if place.partition(".")[0] == unit:
            places.setdefault(place, {})[part] = name
    for place, fields in places.items():
        sensor = ".".join(place.split(".")[:2])
        if f"{sensor}.measured" in record.probes and any(set(pair) <= fields.keys() for pair in SENSED):
            yield Target(sensor, fields)


def sensed(record: Record, unit: str, about: str, sample: int, when: float) -> Iterator[Known]:
    """What each sensor has said last about somebody."""
    if unit not in record.vehicles or about not in (*record.vehicles, *record.brought):
        return
    for _, group in groupby(sorted(targets(record, unit), key=lambda each: each.sensor), key=lambda each: each.sensor):
        yield from last_seen(record, list(group), unit, about, sample, when)


def last_seen(record: Record, places: list[Target], unit: str, about: str, sample: int, when: float) -> list[Known]:
    """The targets of one sensor that belong to somebody, at the last sample at which one does; none when that is longer ago."""
    first = int(np.searchsorted(record.time, when - MEMORY - SAME_TIME))
    is_given = np.stack([given(record, each)[first : sample + 1] for each in places])  # [place, sample]
    for k in reversed(np.flatnonzero(is_given.any(axis=0)).tolist()):
        mine = [each for each, is_here in zip(places, is_given[:, k].tolist(), strict=True) if is_here]
        if found := [seen for each in mine if (seen := seen_at(record, each, unit, about, first + k, when))]:
            return found
    return []


def given(record: Record, target: Target) -> np.ndarray:
    """Where a target has values, bool[n]."""
    return np.logical_and.reduce([np.isfinite(record.probes[name].values) for name in target.fields.values()])


def seen_at(record: Record, target: Target, unit: str, about: str, sample: int, when: float) -> Known | None:
    """What a target has said at a sample, if it belongs to somebody."""
    values = {part: float(record.probes[name].values[sample]) for part, name in target.fields.items()}
    since = float(record.probes[f"{target.sensor}.measured"].values[sample])
    at = int(np.searchsorted(record.time, since - SAME_TIME))
    place, outline = place_of(record, unit, target.sensor, values, at), outline_of(record, about, at)
    # His own outline is asked first: all others only where it may be his.
    if outline is None or outside(outline, place) > NEAR or belongs_to(record, place, at, unit) != about:
        return None
    what = {part: Number(value, record.probes[target.fields[part]].unit) for part, value in values.items() if part not in OF_THE_SENSOR}
    return Known(unit, about, target.name, round(when - since, 6), round(since, 6), what)


def place_of(record: Record, unit: str, sensor: str, values: dict[str, float], sample: int) -> np.ndarray:
    """Where a target is in the world [m], as the sensor says."""
    row, front = record.vehicles.index(unit), record.bodies[unit].front
    x, y, psi = (record.channel(name)[row, sample] for name in PLACES)
    if {"ahead", "left"} <= values.keys():
        ahead, left = values["ahead"], values["left"]
    else:
        mount = record.mounts.get(sensor, AT_THE_FRONT)
        angle = values["azimuth"] + mount.yaw
        ahead, left = mount.forward + values["range"] * np.cos(angle), mount.left + values["range"] * np.sin(angle)
    ahead += front
    return np.array([x + ahead * np.cos(psi) - left * np.sin(psi), y + ahead * np.sin(psi) + left * np.cos(psi)])


def belongs_to(record: Record, place: np.ndarray, sample: int, seer: str = "") -> str:
    """Whose outline is nearest to a place [m] at a sample, of recorded vehicles besides the seer and what the script has brought.

    "" when none is near.
    """
    found = [(outside(outline, place), name) for name, outline in outlines(record, sample) if name != seer]
    distance, name = min(found, default=(np.inf, ""))
    return name if distance <= NEAR else ""


class Outline(NamedTuple):
    """A rectangle on the road: a point in it and its heading, how far [m] it reaches before and behind the point, and its width [m]."""

    pose: Pose
    front: float
    rear: float
    width: float


def outlines(record: Record, sample: int) -> Iterator[tuple[str, Outline]]:
    """Those of all who are there at a sample."""
    for name in (*record.vehicles, *record.brought):
        if outline := outline_of(record, name, sample):
            yield name, outline


def outline_of(record: Record, name: str, sample: int) -> Outline | None:
    """That of a vehicle, or of what the script has brought; None when it is not there."""
    return of_vehicle(record, name, sample) if name in record.vehicles else of_brought(record, name, float(record.time[sample]))


def of_vehicle(record: Record, name: str, sample: int) -> Outline | None:
    """That of a vehicle at a sample."""
    row, body = record.vehicles.index(name), record.bodies[name]
    pose = Pose(*(float(record.channel(each)[row, sample]) for each in PLACES))
    return Outline(pose, body.front, body.length - body.front, body.width) if np.isfinite(pose).all() else None


def of_brought(record: Record, name: str, time: float) -> Outline | None:
    """That of what the script has brought, at a time [s]."""
    each = record.brought[name]
    since = record.acting_since(each.entry, time)
    if since is None or (pose := each.after(time - since)) is None:
        return None
    return Outline(pose, 0.5 * each.length, 0.5 * each.length, each.width)


def outside(outline: Outline, place: np.ndarray) -> float:
    """How far a place is outside an outline [m]."""
    x, y, psi = outline.pose
    east, north, c, s = place[0] - x, place[1] - y, np.cos(psi), np.sin(psi)
    ahead, left = east * c + north * s, north * c - east * s
    return float(np.hypot(max(ahead - outline.front, -outline.rear - ahead, 0.0), max(abs(left) - 0.5 * outline.width, 0.0)))


# -- by messages ---------------------------------------------------------------------------------------


def heard(record: Record, unit: str, about: str, when: float) -> Iterator[Known]:
    """What messages say about somebody: for every kind the newest that had come at a time [s], and those that were lost since."""
    sent = record.messages
    if not {unit, about} <= set(sent.units):
        return
    for kind in sent.kinds:
        link = sent.link(about, unit, kind)
        if (link := link[sent.time[sent.of[link]] <= when]).size:
            yield of_link(sent, link, unit, about, kind, when)


def of_link(sent: Messages, link: np.ndarray, unit: str, about: str, kind: str, when: float) -> Known:
    """The same of one link with the entries of what was sent until then."""
    times = sent.time[sent.of[link]]
    had_come = sent.is_received[link] & (sent.came[link] <= when)
    newest = float(times[had_come].max(initial=-np.inf))
    missing = link[~sent.is_received[link] & (times > newest)]
    age, time = (round(when - newest, 6), round(newest, 6)) if had_come.any() else (None, None)
    return Known(
        unit, about, kind, age, time, lost=tuple(Lost(round(float(sent.time[sent.of[i]]), 6), WHY[sent.cause[i]]) for i in missing)
    )
