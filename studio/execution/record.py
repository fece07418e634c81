"""The record of a run: channels of the recorded vehicles over time, and what happened."""

import traceback
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np

from studio import bound
from studio.bound import Link
from studio.errors import UnknownError, nearest
from studio.execution.brought import Brought, Fault, acting_since, turns_of
from studio.execution.cast import NOBODY, Cast
from studio.execution.counted import Counted
from studio.execution.happening import Happening
from studio.execution.hearing import Hearing
from studio.execution.message import Messages, none
from studio.execution.shelf import Roll, Shelf
from studio.execution.trail import Trail, stop
from studio.kind import registry
from studio.kind.registry import Kind
from studio.world import channel
from studio.world.channel import CHANNELS, catalogue
from studio.world.world import World

ROW = {each.name: row for row, each in enumerate(CHANNELS)}
NAMED = ("ahead", "minded")  # channels whose numbers stand for names
CHUNK = 8 << 20  # [bytes] for which room is made at a time: from this size on numpy asks for large pages, which are faster to come by
SAME_TIME = 1e-6  # [s] times that differ by less are the same


@dataclass(frozen=True)
class Chain:
    """Vehicles of an application group, each listening to the one before; the first only sends."""

    group: str
    application: str
    vehicles: tuple[str, ...]

    def parts(self, wanted: Collection[str]) -> Iterator["Chain"]:
        """What is left of it with some vehicles only: parts whose vehicles are still neighbours."""
        for is_wanted, run in groupby(self.vehicles, key=lambda each: each in wanted):
            if is_wanted:
                yield replace(self, vehicles=tuple(run))


class Traced(NamedTuple):
    """What a probe has read over time, its unit and label."""

    values: np.ndarray
    unit: str
    label: str


class Body(NamedTuple):
    """What a vehicle is that drives: its size, how far its front is before its centre of gravity, its mass, its wheels' radius."""

    length: float  # [m]
    width: float  # [m]
    front: float  # [m]
    mass: float  # [kg]
    radius: float  # [m]


class Mount(NamedTuple):
    """Where a sensor is, from the middle of the front of its vehicle, and where it looks."""

    forward: float  # [m]
    left: float  # [m]
    yaw: float  # [rad] to the left


def no_ages() -> np.ndarray:
    """Of no links."""
    return np.zeros((0, 0))


class Rows:
    """Some vehicles of values [channel, vehicle, n], copied channel by channel when one is asked for: all at once may be a lot."""

    def __init__(self, values: "np.ndarray | Rows", vehicles: Sequence[int]) -> None:
        own = isinstance(values, Rows)
        self.values: np.ndarray = values.values if own else values
        self.vehicles = [values.vehicles[i] for i in vehicles] if own else list(vehicles)

    def __getitem__(self, key: Any) -> Any:
        """One channel; a stretch of samples; or whatever else numpy gives for it."""
        if isinstance(key, int):
            return self.values[key][self.vehicles]
        if isinstance(key, tuple) and key[:2] == (slice(None), slice(None)):
            return Rows(self.values[key], self.vehicles)
        return np.asarray(self)[key]

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        """All of it."""
        return np.asarray(self.values[:, self.vehicles], dtype)


@dataclass(frozen=True)
class Record:
    """What is kept: `time` [s] float64[n]; `values` float64[channel, vehicle, n]; names of the vehicles; happenings.

    `ages` [s] float64[link, n] are those of the newest message on each of the `links`, which are named sender→receiver. `bodies` are those
    of all vehicles of the run, recorded or not; `called` are the names that the numbers of the channels `ahead` and `minded` stand for,
    `commanders` those that the numbers of the channels `commands_` stand for; `mounts` are those of sensors, by unit and sensor.
    `brought` is what the script may bring to the road, by name; `faults` are those of sensors that it may make. `cast` tells
    model, driver and way of all vehicles. `counted` is what was
    counted of all vehicles, recorded or not; it is there while a run is measured, and None in a record that was read.
    """

    time: np.ndarray
    values: np.ndarray | Rows
    vehicles: tuple[str, ...]
    happenings: tuple[Happening, ...]
    chains: tuple[Chain, ...] = ()
    links: tuple[str, ...] = ()
    ages: np.ndarray = field(default_factory=no_ages)
    probes: dict[str, Traced] = field(default_factory=dict)
    messages: Messages = field(default_factory=none)
    bodies: dict[str, Body] = field(default_factory=dict)
    called: dict[int, str] = field(default_factory=dict)
    commanders: tuple[str, ...] = ()
    mounts: dict[str, Mount] = field(default_factory=dict)
    brought: dict[str, Brought] = field(default_factory=dict)
    faults: tuple[Fault, ...] = ()
    cast: Cast = NOBODY
    counted: tuple[Counted, ...] | None = None

    @cached_property
    def derived(self) -> "Derived":
        """The channels that follow from those that were recorded."""
        return Derived(self)

    @cached_property
    def turns(self) -> dict[str, list[Happening]]:
        """When every entry of the script has begun and ended."""
        return turns_of(self.happenings)

    def acting_since(self, entry: str, time: float) -> float | None:
        """Since when [s] an entry of the script acts at a time [s]; None when it does not."""
        return acting_since(self.turns.get(entry, ()), time)

    def channel(self, name: str) -> np.ndarray:
        """One quantity of all vehicles, float64[vehicle, n]; raises UnknownError with the nearest name."""
        if name in ROW:
            return sealed(self.values[ROW[name]])
        if name not in catalogue():
            raise UnknownError(f"There is no channel {name!r}; {nearest(name, catalogue())}")
        return self.derived.trace(name)

    def of_followers(self, name: str) -> np.ndarray:
        """One quantity of the `followers`, float64[vehicle, n]."""
        return self.channel(name)[[self.vehicles.index(each) for each in self.followers]]

    @cached_property
    def followers(self) -> list[str]:
        """The vehicles that follow in a chain; where there is no chain those that ever had somebody ahead, and all when nobody had."""
        following = {vehicle for chain in self.chains for vehicle in chain.vehicles[1:]} or set(self.behind_somebody)
        return [each for each in self.vehicles if each in following] or list(self.vehicles)

    @property
    def behind_somebody(self) -> list[str]:
        """The vehicles that at some time had another one, or an object, ahead."""
        return [each for each, gap in zip(self.vehicles, self.channel("gap"), strict=True) if np.isfinite(gap).any()]

    def trace(self, name: str) -> np.ndarray:
        """`vehicle.quantity` over time, float64[n]; raises UnknownError with the nearest name."""
        if name in self.probes:
            return self.probes[name].values
        vehicle, _, quantity = name.partition(".")
        if vehicle not in self.vehicles:
            raise UnknownError(f"No vehicle {vehicle!r} was recorded; {nearest(vehicle, self.vehicles)}")
        return self.channel(quantity)[self.vehicles.index(vehicle)]

    def ahead(self, vehicle: int, sample: int) -> str:
        """The name of the vehicle or object ahead of the vehicle in a row at a sample; "" when there is none."""
        return self.called_by("ahead", vehicle, sample)

    def minded(self, vehicle: int, sample: int) -> str:
        """The name of whom, or of the object that, its driver minds; "" when there is none."""
        return self.called_by("minded", vehicle, sample)

    def called_by(self, channel: str, vehicle: int, sample: int) -> str:
        """The name that the number in a channel stands for."""
        number = self.channel(channel)[vehicle, sample]
        return self.called.get(int(number), "") if np.isfinite(number) else ""

    def between(self, begin: float, end: float | None) -> "Record":
        """The samples and happenings from a time to a time [s], both included."""
        end = float("inf") if end is None else end
        where = slice(*np.searchsorted(self.time, [begin - SAME_TIME, end + SAME_TIME]).tolist())
        return replace(
            self,
            time=self.time[where],
            values=self.values[:, :, where],
            happenings=tuple(event for event in self.happenings if begin <= event.time <= end),
            counted=None if self.counted is None else tuple(each for each in self.counted if begin <= each.time <= end),
            ages=self.ages[:, where],
            messages=self.messages.part(
                (self.messages.time >= begin) & (self.messages.time <= end), np.ones(self.messages.receiver.size, dtype=bool)
            ),
            probes={name: each._replace(values=each.values[where]) for name, each in self.probes.items()},
        )

    def of(self, vehicles: Collection[str]) -> "Record":
        """Some vehicles only: their channels, what happened to them or to nobody, chains of them, links and messages to them."""
        rows = [i for i, name in enumerate(self.vehicles) if name in vehicles]
        links = [i for i, name in enumerate(self.links) if name.partition("→")[2] in vehicles]
        units = [i for i, name in enumerate(self.messages.units) if name in vehicles]
        return replace(
            self,
            values=Rows(self.values, rows),
            vehicles=tuple(self.vehicles[i] for i in rows),
            happenings=tuple(event for event in self.happenings if not event.units or set(event.units) & set(vehicles)),
            counted=None if self.counted is None else tuple(each for each in self.counted if {each.who, each.other} & set(vehicles)),
            chains=tuple(part for chain in self.chains for part in chain.parts(vehicles)),
            links=tuple(self.links[i] for i in links),
            ages=self.ages[links],
            messages=self.messages.part(np.ones(self.messages.time.size, dtype=bool), np.isin(self.messages.receiver, units)),
        )

    def ordered(self) -> "Record":
        """The same with vehicles, chains, links and probes in the order of their names."""
        rows, links = (sorted(range(len(each)), key=each.__getitem__) for each in (self.vehicles, self.links))
        return replace(
            self,
            values=self.values if rows == list(range(len(rows))) else Rows(self.values, rows),
            vehicles=tuple(self.vehicles[i] for i in rows),
            chains=tuple(sorted(self.chains, key=lambda each: each.group)),
            links=tuple(self.links[i] for i in links),
            ages=self.ages if links == list(range(len(links))) else self.ages[links],
            probes=dict(sorted(self.probes.items())),
            bodies=dict(sorted(self.bodies.items())),
        )

    def names(self) -> list[str]:
        """All `vehicle.quantity`."""
        return [f"{vehicle}.{quantity}" for vehicle in self.vehicles for quantity in catalogue()] + list(self.probes)


def sealed(values: np.ndarray) -> np.ndarray:
    """The same values, which cannot be written to: kinds read the record, and nobody changes it."""
    view = values.view()
    view.flags.writeable = False
    return view


def renumber(values: np.ndarray, numbers: dict[int, int]) -> np.ndarray:
    """Channels in which the numbers that stand for names are those of a record, by those that they had."""
    low = min([-1, *numbers])
    new = np.arange(low, len(numbers) + 1, dtype=float)  # who is nobody stays so
    new[np.array(list(numbers), dtype=np.int64) - low] = list(numbers.values())
    for name in NAMED:
        row = values[ROW[name]]
        known = np.isfinite(row)
        row[known] = new[row[known].astype(np.int64) - low]
    return values


@dataclass
class Derived:
    """Channels that kinds make of others, each once; one that raises has no values."""

    record: Record
    traces: dict[str, np.ndarray] = field(default_factory=dict)
    raised: dict[str, str] = field(default_factory=dict)

    def make(self, tell: Callable[[str], None]) -> None:
        """All of them; those that raise are told with their tracebacks."""
        for name in registry.known("channel"):
            self.trace(name)
        for text in self.raised.values():
            tell(text)

    def trace(self, name: str) -> np.ndarray:
        """One of them, float64[vehicle, n]."""
        if name not in self.traces:
            self.traces[name] = np.full(self.shape, np.nan)  # what a channel sees that reads itself
            try:
                self.traces[name] = sealed(self.made(registry.find("channel", name)))
            except Exception:
                self.raised[name] = f"The channel {name!r} raised:\n{traceback.format_exc()}"
        return self.traces[name]

    def made(self, kind: Kind) -> np.ndarray:
        """What a kind gives; raises TypeError when it is of another shape."""
        found = np.asarray(kind.module.trace(self.read), np.float64)
        if found.shape != self.shape:
            raise TypeError(f"trace() of {kind.name!r} returned the shape {found.shape}, not {self.shape}, [vehicle, sample]")
        return found

    def read(self, name: str) -> np.ndarray:
        """What a kind may read: any other channel, float64[vehicle, n], and `time` [s], float64[n]."""
        return sealed(self.record.time) if name == "time" else self.record.channel(name)

    @property
    def shape(self) -> tuple[int, int]:
        """Vehicles, samples."""
        return len(self.record.vehicles), self.record.time.size


@dataclass(frozen=True)
class Chunk:
    """Room for some samples: their times, and values [sample, channel, vehicle]."""

    time: np.ndarray
    values: np.ndarray


@dataclass
class Recorder:
    """Collects samples every `every` ticks: those of all worlds of a batch side by side, in chunks that stay where they are.

    `columns` are the recorded vehicles, world after world; the shares of a world are those of its number; `most` samples will come.
    """

    columns: np.ndarray
    every: int
    most: int
    vehicle_share: list[slice]
    hearing: Hearing
    trail: Trail
    probe_share: list[slice]
    shelf: Shelf
    times_of: Roll = field(init=False)
    values_of: Roll = field(init=False)  # a sample lies in one piece
    progress: np.ndarray = field(init=False)  # how many samples there are, up to when [s], for who finds the shelf without its process
    now: Chunk = field(init=False)  # the last chunk
    used: np.ndarray = field(default_factory=lambda: np.zeros(1, np.int64))  # samples in it
    count: int = 0
    heard: list[Link] | None = None  # what of a sample is about messages
    writing: Link = field(init=False)  # writes the channels into the last chunk
    sample: bound.Chain = field(init=False)  # writes a whole sample

    def __post_init__(self) -> None:
        self.times_of = self.shelf.roll("times", (self.room,))
        self.values_of = self.shelf.roll("values", (self.room, len(CHANNELS), self.columns.size))
        self.progress = self.shelf.roll("progress", (2,)).begin()
        self.progress[:] = 0.0

    def take(self, world: World, k: int) -> None:
        """Takes a sample when it is time for one; commands are those of tick k."""
        if world.clock.k % self.every == 0:
            time = world.clock.time
            self.make_room(world)
            self.sample(k, time)
            self.hearing.mark()
            self.count += 1
            self.progress[0], self.progress[1] = self.count, time

    def make_room(self, world: World) -> None:
        """So that one more sample finds room; where something begins anew, what writes it is given that once."""
        is_new = self.count % self.room == 0
        if is_new:
            self.begin(world)
        self.hearing.make_room()
        if self.trail.make_room() or is_new:
            self.heard = self.hearing.links(world) if self.heard is None else self.heard
            self.sample = bound.Chain([self.writing, *self.heard, self.trail.link])

    def begin(self, world: World) -> None:
        """The next chunk."""
        self.now, self.used[0] = Chunk(self.times_of.begin(), self.values_of.begin()), 0
        self.writing = Link(channel.sampler(world, self.columns, self.used, self.now.time, self.now.values), stop)

    @cached_property
    def room(self) -> int:
        """How many samples a chunk holds."""
        return max(min(CHUNK // (8 * (1 + len(CHANNELS) * self.columns.size)), self.most), 1)

    def chunk(self, number: int) -> Chunk:
        """One that has begun."""
        return Chunk(self.times_of[number], self.values_of[number])

    def chunks(self, count: int) -> Iterator[Chunk]:
        """The first samples, chunk by chunk."""
        for first in range(0, count, self.room):
            chunk, here = self.chunk(first // self.room), slice(count - first)
            yield Chunk(chunk.time[here], chunk.values[here])

    def times(self, count: int) -> np.ndarray:
        """Times of the first samples [s]."""
        return np.concatenate([np.zeros(0), *(chunk.time for chunk in self.chunks(count))])

    def values(self, world: int, count: int) -> np.ndarray:
        """float64[channel, vehicle, sample] of one world, its first samples."""
        share = self.vehicle_share[world]
        found, first = self.shelf.room("channels", (len(CHANNELS), share.stop - share.start, count)), 0
        for chunk in self.chunks(count):
            found[:, :, first : first + chunk.time.size] = np.moveaxis(chunk.values[:, :, share], 0, -1)
            first += chunk.time.size
        return found

    def samples(self, numbers: list[int]) -> tuple[np.ndarray, np.ndarray]:
        """Times and values of some samples, of all worlds."""
        chunks = {i: self.chunk(i) for i in {number // self.room for number in numbers}}
        found = [(chunks[i // self.room], i % self.room) for i in numbers]
        values = np.array([chunk.values[place] for chunk, place in found])
        return np.array([chunk.time[place] for chunk, place in found]), np.moveaxis(values, 0, -1)

    def traced(self, world: int, samples: Sequence[int]) -> dict[str, Traced]:
        """What the probes of one world have read at some samples, by name."""
        share, numbers = self.probe_share[world], np.asarray(samples, dtype=np.int64)
        found = self.trail.parts.series(numbers, share, self.shelf)
        return {each.name: Traced(found[i], each.unit, each.label) for i, each in enumerate(self.trail.reader.probes[share])}

    def ages(self, links: list[int], count: int) -> np.ndarray:
        """Ages [s] of the newest message on some links, float64[link, sample]; the first samples."""
        return self.hearing.ages(links, self.times(count))
