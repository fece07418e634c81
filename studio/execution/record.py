"""The record of a run: channels of the recorded vehicles over time, and what happened."""

from dataclasses import dataclass, field

import numpy as np

from studio.errors import UnknownError, nearest
from studio.execution.happening import Happening
from studio.world import channel
from studio.world.channel import BY_NAME, CHANNELS, TIME_GAP
from studio.world.world import World

ROLLING = 0.5  # [m/s] below this speed a time gap says nothing
CHUNK = 128  # samples that room is made for at a time


@dataclass(frozen=True)
class Chain:
    """Vehicles of an application group, each listening to the one before; the first only sends."""

    group: str
    application: str
    vehicles: tuple[str, ...]


@dataclass(frozen=True)
class Record:
    """What is kept: `time` [s] float64[n]; `values` float64[channel, vehicle, n]; names of the vehicles; happenings."""

    time: np.ndarray
    values: np.ndarray
    vehicles: tuple[str, ...]
    happenings: tuple[Happening, ...]
    chains: tuple[Chain, ...] = ()
    links: dict[str, float] = field(default_factory=dict)

    def channel(self, name: str) -> np.ndarray:
        """One quantity of all vehicles, float64[vehicle, n]."""
        if name == TIME_GAP.name:
            speed = self.channel("speed")
            return np.where(speed > ROLLING, self.channel("gap") / np.maximum(speed, ROLLING), np.nan)
        return self.values[[each.name for each in CHANNELS].index(name)]

    def of_followers(self, name: str) -> np.ndarray:
        """One quantity of the vehicles that follow in a chain, float64[vehicle, n]; of all when there is no chain."""
        following = {vehicle for chain in self.chains for vehicle in chain.vehicles[1:]}
        rows = [i for i, vehicle in enumerate(self.vehicles) if vehicle in following]
        return self.channel(name)[rows] if rows else self.channel(name)

    def trace(self, name: str) -> np.ndarray:
        """`vehicle.quantity` over time, float64[n]; raises UnknownError with the nearest name."""
        vehicle, _, quantity = name.partition(".")
        if vehicle not in self.vehicles:
            raise UnknownError(f"No vehicle {vehicle!r} was recorded; {nearest(vehicle, self.vehicles)}")
        if quantity not in BY_NAME:
            raise UnknownError(f"There is no channel {quantity!r}; {nearest(quantity, BY_NAME)}")
        return self.channel(quantity)[self.vehicles.index(vehicle)]

    def names(self) -> list[str]:
        """All `vehicle.quantity`."""
        return [f"{vehicle}.{quantity}" for vehicle in self.vehicles for quantity in BY_NAME]


@dataclass(frozen=True)
class Chunk:
    """Room for CHUNK samples: their times, values [sample, channel, vehicle], and the ages of all links [sample, link]."""

    time: np.ndarray
    values: np.ndarray
    ages: np.ndarray


@dataclass
class Recorder:
    """Collects samples every `every` ticks: those of all worlds of a batch side by side, in chunks that stay where they are.

    `columns` are the recorded vehicles, world after world; the shares of a world are those of its number.
    """

    columns: np.ndarray
    every: int
    vehicle_share: list[slice]
    link_share: list[slice]
    count: int = 0
    chunks: list[Chunk] = field(default_factory=list)

    def take(self, world: World, k: int) -> None:
        """Takes a sample when it is time for one; commands are those of tick k."""
        if world.clock.k % self.every == 0:
            place = self.count % CHUNK
            if place == 0:
                self.chunks.append(self.chunk())
            chunk = self.chunks[-1]
            chunk.time[place] = world.clock.time
            channel.sample(world, self.columns, k, chunk.values[place])
            channel.link_ages(world, chunk.ages[place])
            self.count += 1

    def chunk(self) -> Chunk:
        """An empty one."""
        links = self.link_share[-1].stop
        return Chunk(np.empty(CHUNK), np.empty((CHUNK, len(CHANNELS), self.columns.size)), np.empty((CHUNK, links)))

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
        found = [(self.chunks[i // CHUNK], i % CHUNK) for i in numbers]
        values = np.array([chunk.values[place] for chunk, place in found])
        return np.array([chunk.time[place] for chunk, place in found]), np.moveaxis(values, 0, -1)

    def mean_ages(self, world: int, count: int) -> np.ndarray:
        """Mean age [s] of the newest message on every link; not a number for a link that never had both ends."""
        share = self.link_share[world]
        none = np.zeros((0, share.stop - share.start))
        ages = self.joined([chunk.ages[:, share] for chunk in self.chunks], none, count)
        known = np.isfinite(ages)
        with np.errstate(invalid="ignore"):
            return np.where(known, ages, 0.0).sum(axis=0) / known.sum(axis=0)

    @staticmethod
    def joined(parts: list[np.ndarray], none: np.ndarray, count: int) -> np.ndarray:
        """The first samples of all chunks, one after another."""
        return np.concatenate([none, *parts])[:count]
