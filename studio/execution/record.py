"""The record of a run: channels of the recorded vehicles over time, and what happened."""

from dataclasses import dataclass, field

import numpy as np

from studio.errors import UnknownError, nearest
from studio.vehicle.state import ACTIVE
from studio.world.channel import BY_NAME, CHANNELS, TIME_GAP, sample
from studio.world.unit import SENT
from studio.world.world import World

ROLLING = 0.5  # [m/s] below this speed a time gap says nothing


@dataclass(frozen=True)
class Happening:
    """Something that happened: when [s], what, to which vehicle."""

    time: float
    text: str
    vehicle: str


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
        return self.values[[channel.name for channel in CHANNELS].index(name)]

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


@dataclass
class Recorder:
    """Collects samples every `every` ticks."""

    columns: np.ndarray
    every: int
    times: list[float] = field(default_factory=list)
    samples: list[np.ndarray] = field(default_factory=list)

    ages: list[np.ndarray] = field(default_factory=list)

    def take(self, world: World, k: int) -> None:
        """Takes a sample when it is time for one; commands are those of tick k."""
        if world.clock.k % self.every == 0:
            self.times.append(world.clock.time)
            self.samples.append(sample(world, self.columns, k))
            self.ages.append(link_ages(world))

    def values(self) -> np.ndarray:
        """float64[channel, vehicle, n]."""
        if not self.samples:
            return np.zeros((len(CHANNELS), self.columns.size, 0))
        return np.moveaxis(np.array(self.samples), 0, -1)

    def mean_ages(self) -> np.ndarray:
        """Mean age [s] of the newest message on every link; not a number for a link that never had both ends."""
        ages = np.array(self.ages)
        known = np.isfinite(ages)
        with np.errstate(invalid="ignore"):
            return np.where(known, ages, 0.0).sum(axis=0) / known.sum(axis=0)


def link_ages(world: World) -> np.ndarray:
    """Age [s] of the newest message on every link, the time since the start while none has come.

    Not a number once one of its ends has left.
    """
    units, active = world.units, world.vehicles.state[ACTIVE]
    there = (active[units.link_receiver] > 0.0) & (active[units.link_sender] > 0.0)
    return np.where(there, world.clock.time - np.maximum(units.inbox[SENT], 0.0), np.nan)
