"""The world: all arrays of a batch of runs, in one place. One copy of it is a snapshot, its bytes are the hash."""

import hashlib
from dataclasses import dataclass, field

import numpy as np

from studio.application.host import Hosted
from studio.road.network.shadow import Shadow
from studio.world.fleet import Fleet
from studio.world.state import OBJECT


@dataclass
class Clock:
    """Time: `k` ticks of length `tick` [s] have passed; vehicles integrate with `step` [s]."""

    tick: float
    step: float
    k: int = 0

    @property
    def time(self) -> float:
        """Seconds since the start."""
        return self.k * self.tick


@dataclass
class Vehicles(Fleet):
    """A fleet with drivers: what they want, know and are told, [row, vehicle]."""

    drivers: np.ndarray
    mind: np.ndarray
    script: np.ndarray
    returns: np.ndarray  # 1 for traffic, which comes in again after it has arrived
    app_command: np.ndarray  # [actuator, vehicle] of applications, not a number where there is none


@dataclass
class Worlds:
    """Which vehicles belong to which world: `of` and `entity` per vehicle; `first`, `count`, `seed` per world."""

    of: np.ndarray
    entity: np.ndarray
    first: np.ndarray
    count: np.ndarray
    seed: np.ndarray


@dataclass
class Roads:
    """Paths as one array of points with a first point and a count per vehicle; stop lines; zones; signals."""

    points: np.ndarray
    path_first: np.ndarray
    path_count: np.ndarray
    raised: np.ndarray  # 1 for a vehicle whose path has height
    stop_first: np.ndarray
    stop_count: np.ndarray
    stop_station: np.ndarray
    stop_link: np.ndarray
    zone_pair: np.ndarray  # int64[2, z]
    zone_span: np.ndarray  # float64[4, z]
    signal_time: np.ndarray  # [cycle, offset] per link
    signal_first: np.ndarray
    signal_count: np.ndarray
    phase_end: np.ndarray
    phase_state: np.ndarray
    shown: np.ndarray
    weather: np.ndarray  # friction [1] per world
    pieces: np.ndarray  # of slippery stretches, [row, piece]
    near: np.ndarray  # scratch: pieces around one vehicle
    place_of: np.ndarray  # number of the map, per world
    shadow: Shadow  # the buildings of all maps


@dataclass
class Changes:
    """Changes of the road. `phase` and since when are state; what follows from them is made anew when one turns."""

    moments: np.ndarray  # [row, change] of all beginnings, then of all ends
    phase: np.ndarray  # int64[change]: BEFORE, ACTING, OVER
    turned: np.ndarray  # [s] float64[2, change]: when it began and ended, not a number before
    limits: list[tuple[int, np.ndarray, np.ndarray]]  # change, columns of points, speed there
    free: tuple[np.ndarray, np.ndarray]  # columns of points that some limit concerns, and the speed without any


@dataclass
class Detours:
    """Vehicles whose path passes works: which of its paths each has taken (`choice` is state), and all their paths."""

    vehicle: np.ndarray  # int64[m]: columns
    choice: np.ndarray  # int64[m]: bit b is work b
    work: np.ndarray  # int64[MOST_WORKS, m]: change that work b is, -1 for none
    base: np.ndarray  # int64[m]: column of `lines` with choice 0
    lines: np.ndarray  # int64[LINE, line]
    span: np.ndarray  # float64[2 · MOST_WORKS, line]: where work b is entered and left
    held: np.ndarray  # int64[change]: vehicles that are still within it on the usual path
    known: dict[tuple[int, int], np.ndarray]  # zones of pairs of paths, by their first points


@dataclass
class Obstacles:
    """Objects on the road, world after world, and for every vehicle those that it may run into on its path."""

    table: np.ndarray  # [row, object]
    first: np.ndarray  # per world
    count: np.ndarray
    standing: np.ndarray  # int64[object], 1 while it stands there
    sweep: np.ndarray  # [row, object on a line]
    counts: np.ndarray  # of these per line
    sweep_first: np.ndarray  # per vehicle, on the line it is on
    sweep_count: np.ndarray
    names: tuple[str, ...]


@dataclass
class Units:
    """Sensors and radio: what is set, what was sent, what has been received."""

    sensor_set: np.ndarray
    sensors: np.ndarray
    gps_set: np.ndarray
    radio_set: np.ndarray  # per world
    sent: np.ndarray  # [row, slot · n + vehicle]
    link_receiver: np.ndarray
    link_sender: np.ndarray
    inbox: np.ndarray  # [row, link]


@dataclass
class Events:
    """Triggers with their scripts, and the collisions found."""

    trigger_time: np.ndarray
    trigger_vehicle: np.ndarray
    trigger_script: np.ndarray
    fired: np.ndarray
    hits: np.ndarray  # every world has its share of the columns
    found: np.ndarray  # how many collisions each world has had

    @property
    def hits_found(self) -> int:
        """Collisions of all worlds."""
        return int(self.found.sum())

    def hits_of(self, world: int) -> np.ndarray:
        """float64[row, collision] of one world."""
        share = self.hits.shape[1] // self.found.size
        return self.hits[:, world * share : world * share + int(self.found[world])]


@dataclass
class World:
    """Everything that a tick reads and writes. `names` are the vehicles' names, one tuple per world."""

    clock: Clock
    vehicles: Vehicles
    worlds: Worlds
    roads: Roads
    units: Units
    events: Events
    changes: Changes
    detours: Detours
    obstacles: Obstacles
    hosted: list[Hosted]
    names: tuple[tuple[str, ...], ...]
    colours: tuple[str, ...] = field(default=())

    @property
    def size(self) -> int:
        """Number of vehicles in all worlds."""
        return self.vehicles.state.shape[1]

    def column(self, name: str, world: int = 0) -> int:
        """Column of a vehicle; raises ValueError."""
        return int(self.worlds.first[world]) + self.names[world].index(name)

    def name_of(self, number: int, world: int = 0) -> str:
        """Name of the vehicle in a column, or of an object, OBJECT - i."""
        if number <= OBJECT:
            return self.obstacles.names[OBJECT - number]
        return self.names[world][number - int(self.worlds.first[world])]

    def columns(self, world: int = 0) -> slice:
        """Columns of one world."""
        first = int(self.worlds.first[world])
        return slice(first, first + int(self.worlds.count[world]))

    def moving_parts(self) -> list[np.ndarray]:
        """The arrays that change during a run."""
        v, u, e, c, o = self.vehicles, self.units, self.events, self.changes, self.obstacles
        units = [u.sensors, u.sent, u.inbox]
        happened = [e.fired, e.hits, c.phase, c.turned, o.standing, self.detours.choice]
        return [v.state, v.wheels, v.mind, v.script, v.commands, *units, *happened, *(hosted.memory for hosted in self.hosted)]

    def digest(self) -> str:
        """SHA-256 of the moving parts and the clock."""
        digest = hashlib.sha256(str(self.clock.k).encode())
        for part in self.moving_parts():
            digest.update(np.ascontiguousarray(part).tobytes())
        return digest.hexdigest()

    def world_digest(self, world: int) -> str:
        """SHA-256 of the state of one world's vehicles, which does not depend on the batch they ran in."""
        columns = self.columns(world)
        digest = hashlib.sha256(str(self.clock.k).encode())
        digest.update(np.ascontiguousarray(self.vehicles.state[:, columns]).tobytes())
        digest.update(np.ascontiguousarray(self.wheel_columns(columns)).tobytes())
        return digest.hexdigest()

    def wheel_columns(self, columns: slice) -> np.ndarray:
        """Wheel state [row, corner, vehicle] of some vehicles."""
        wheels = self.vehicles.wheels
        return wheels.reshape(wheels.shape[0], 4, self.size)[:, :, columns]
