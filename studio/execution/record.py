"""The record of a run: channels of the recorded vehicles over time, and what happened."""

import traceback
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from studio.errors import UnknownError, nearest
from studio.execution.happening import Happening
from studio.kind import registry
from studio.kind.registry import Kind
from studio.world import channel
from studio.world.channel import CHANNELS, catalogue
from studio.world.probe import Reader
from studio.world.world import World

ROW = {each.name: row for row, each in enumerate(CHANNELS)}
CHUNK = 8 << 20  # [bytes] for which room is made at a time: from this size on numpy asks for large pages, which are faster to come by


@dataclass(frozen=True)
class Chain:
    """Vehicles of an application group, each listening to the one before; the first only sends."""

    group: str
    application: str
    vehicles: tuple[str, ...]


class Traced(NamedTuple):
    """What a probe has read over time, its unit and label."""

    values: np.ndarray
    unit: str
    label: str


@dataclass(frozen=True)
class Record:
    """What is kept: `time` [s] float64[n]; `values` float64[channel, vehicle, n]; names of the vehicles; happenings."""

    time: np.ndarray
    values: np.ndarray
    vehicles: tuple[str, ...]
    happenings: tuple[Happening, ...]
    chains: tuple[Chain, ...] = ()
    links: dict[str, float] = field(default_factory=dict)
    probes: dict[str, Traced] = field(default_factory=dict)

    @cached_property
    def derived(self) -> "Derived":
        """The channels that follow from those that were recorded."""
        return Derived(self)

    def channel(self, name: str) -> np.ndarray:
        """One quantity of all vehicles, float64[vehicle, n]; raises UnknownError with the nearest name."""
        if name in ROW:
            return sealed(self.values[ROW[name]])
        if name not in catalogue():
            raise UnknownError(f"There is no channel {name!r}; {nearest(name, catalogue())}")
        return self.derived.trace(name)

    def of_followers(self, name: str) -> np.ndarray:
        """One quantity of the vehicles that follow in a chain, float64[vehicle, n]; of all when there is no chain."""
        following = {vehicle for chain in self.chains for vehicle in chain.vehicles[1:]}
        rows = [i for i, vehicle in enumerate(self.vehicles) if vehicle in following]
        return self.channel(name)[rows] if rows else self.channel(name)

    def trace(self, name: str) -> np.ndarray:
        """`vehicle.quantity` over time, float64[n]; raises UnknownError with the nearest name."""
        if name in self.probes:
            return self.probes[name].values
        vehicle, _, quantity = name.partition(".")
        if vehicle not in self.vehicles:
            raise UnknownError(f"No vehicle {vehicle!r} was recorded; {nearest(vehicle, self.vehicles)}")
        return self.channel(quantity)[self.vehicles.index(vehicle)]

    def names(self) -> list[str]:
        """All `vehicle.quantity`."""
        return [f"{vehicle}.{quantity}" for vehicle in self.vehicles for quantity in catalogue()] + list(self.probes)


def sealed(values: np.ndarray) -> np.ndarray:
    """The same values, which cannot be written to: kinds read the record, and nobody changes it."""
    view = values.view()
    view.flags.writeable = False
    return view


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
    """Room for some samples: their times, values [sample, channel, vehicle], ages of all links [sample, link], and probes."""

    time: np.ndarray
    values: np.ndarray
    ages: np.ndarray
    probes: np.ndarray


@dataclass
class Recorder:
    """Collects samples every `every` ticks: those of all worlds of a batch side by side, in chunks that stay where they are.

    `columns` are the recorded vehicles, world after world; the shares of a world are those of its number.
    """

    columns: np.ndarray
    every: int
    vehicle_share: list[slice]
    links: int
    reader: Reader
    probe_share: list[slice]
    count: int = 0
    chunks: list[Chunk] = field(default_factory=list)

    def take(self, world: World, k: int) -> None:
        """Takes a sample when it is time for one; commands are those of tick k."""
        if world.clock.k % self.every == 0:
            place = self.count % self.room
            if place == 0:
                self.chunks.append(self.chunk())
            chunk = self.chunks[-1]
            chunk.time[place] = world.clock.time
            channel.sample(world, self.columns, k, chunk.values[place])
            channel.link_ages(world, chunk.ages[place])
            self.reader.read(chunk.probes[place])
            self.count += 1

    @cached_property
    def room(self) -> int:
        """How many samples a chunk holds."""
        return max(CHUNK // (8 * sum(self.widths)), 1)

    @cached_property
    def widths(self) -> tuple[int, ...]:
        """How many numbers of a sample are its time, values, ages and probes."""
        return 1, len(CHANNELS) * self.columns.size, self.links, len(self.reader.probes)

    def chunk(self) -> Chunk:
        """An empty one: a sample lies in one piece."""
        block = np.empty((self.room, sum(self.widths)))
        time, values, ages, probes = np.split(block, np.cumsum(self.widths)[:-1], axis=1)
        return Chunk(time[:, 0], values.reshape(self.room, len(CHANNELS), self.columns.size), ages, probes)

    def times(self, count: int) -> np.ndarray:
        """Times of the first samples [s]."""
        return self.joined([chunk.time for chunk in self.chunks], np.zeros(0), count)

    def values(self, world: int, count: int) -> np.ndarray:
        """float64[channel, vehicle, sample] of one world, its first samples."""
        share = self.vehicle_share[world]
        none = np.zeros((0, len(CHANNELS), share.stop - share.start))
        return np.moveaxis(self.joined([chunk.values[:, :, share] for chunk in self.chunks], none, count), 0, -1)

    def samples(self, numbers: list[int]) -> tuple[np.ndarray, np.ndarray]:
        """Times and values of some samples, of all worlds."""
        found = [(self.chunks[i // self.room], i % self.room) for i in numbers]
        values = np.array([chunk.values[place] for chunk, place in found])
        return np.array([chunk.time[place] for chunk, place in found]), np.moveaxis(values, 0, -1)

    def traced(self, world: int, count: int) -> dict[str, Traced]:
        """What the probes of one world have read, by name; its first samples."""
        share = self.probe_share[world]
        none = np.zeros((0, share.stop - share.start))
        return self.named(share, self.joined([chunk.probes[:, share] for chunk in self.chunks], none, count))

    def traced_samples(self, world: int, numbers: list[int]) -> dict[str, Traced]:
        """The same of some samples, by their numbers."""
        share = self.probe_share[world]
        return self.named(share, np.array([self.chunks[i // self.room].probes[i % self.room, share] for i in numbers]))

    def named(self, share: slice, values: np.ndarray) -> dict[str, Traced]:
        """What some probes have read, float64[sample, probe], by their names."""
        return {each.name: Traced(values[:, i], each.unit, each.label) for i, each in enumerate(self.reader.probes[share])}

    def mean_ages(self, count: int) -> np.ndarray:
        """Mean age [s] of the newest message on every link; not a number for a link that never had both ends."""
        ages = self.joined([chunk.ages for chunk in self.chunks], np.zeros((0, self.links)), count)
        known = np.isfinite(ages)
        with np.errstate(invalid="ignore"):
            return np.where(known, ages, 0.0).sum(axis=0) / known.sum(axis=0)

    def joined(self, parts: list[np.ndarray], none: np.ndarray, count: int) -> np.ndarray:
        """The first samples of all chunks, one after another."""
        return np.concatenate([none, *(part[: max(count - i * self.room, 0)] for i, part in enumerate(parts))])
