"""The world: all arrays of a batch of runs, in one place. What moves is one buffer; a copy of it is a snapshot."""

import hashlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple, Protocol

import numpy as np

from studio.errors import ApplicationError
from studio.kind.registry import Kind
from studio.road.network.shadow import Shadow
from studio.rows import Moving
from studio.vehicle.command import RING
from studio.vehicle.fleet import Fleet
from studio.vehicle.parameter import FRONT, LENGTH, MASS, RADIUS, WIDTH
from studio.vehicle.state import ACTIVE
from studio.world.board.air import Air
from studio.world.board.host import Fault, Group, Hosted
from studio.world.board.post import Open, Post
from studio.world.board.sensing import Mounted
from studio.world.passes.neighbour import Neighbours
from studio.world.passes.queue import Queues
from studio.world.seat import Seats
from studio.world.table.lane import Beside
from studio.world.table.mind import STEER_WISH, WISH
from studio.world.table.oncoming import Facing
from studio.world.table.street import OBJECT
from studio.world.table.unit import PRESENT
from studio.world.table.web import Web


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
    """A fleet with drivers: what they want and know, [row, vehicle]."""

    drivers: np.ndarray
    mind: Moving
    intents: Moving  # accelerations that drivers have decided on, [place in a ring, vehicle]
    returns: np.ndarray  # 1 for traffic, which comes in again after it has arrived
    any_returns: bool  # at the start; or comes in from outside
    removed: Moving  # 1 for one that the script has taken away
    app_command: Moving  # [actuator, vehicle] of applications, not a number where there is none; then who commands each


@dataclass
class Worlds:
    """Which vehicles belong to which world, and which number they have there: in order, and by chance's order of names."""

    of: np.ndarray  # per vehicle
    number: np.ndarray  # per vehicle, in the order of columns
    entity: np.ndarray  # per vehicle, as chance tells them apart
    first: np.ndarray  # per world
    count: np.ndarray  # per world
    seed: np.ndarray  # per world, of sensors
    driver_seed: np.ndarray  # per world
    satellite_seed: np.ndarray  # per world
    radio_seed: np.ndarray  # per world


@dataclass
class Roads:
    """Paths as one array of points with a first point and a count per vehicle; strands; stop lines; signals."""

    points: np.ndarray
    chart: np.ndarray  # of the roads under them
    path_first: Moving
    path_count: Moving
    raised: np.ndarray  # 1 for a vehicle whose path has height
    any_raised: bool
    stop_first: Moving
    stop_count: Moving
    stop_station: np.ndarray
    stop_link: np.ndarray
    web: Web
    drive_first: Moving  # per vehicle, on the line it is on
    drive_count: Moving
    signal_time: np.ndarray  # [cycle, offset] per link
    signal_first: np.ndarray
    signal_count: np.ndarray
    phase_end: np.ndarray
    phase_state: np.ndarray
    shown: Moving
    forced: np.ndarray  # what the script has each light show, -1 where it does not
    light_first: np.ndarray  # the first light, per world
    weather: np.ndarray  # friction [1] per world
    pieces: np.ndarray  # of slippery stretches, [row, piece]
    near: np.ndarray  # scratch: pieces around one vehicle
    place_of: np.ndarray  # number of the map, per world
    shadow: Shadow  # the buildings of all maps


class Reader(Protocol):
    """Reads values of sensors, applications and vehicles at once."""

    def read(self, values: np.ndarray) -> None: ...


@dataclass
class Asked:
    """Everybody who waits for one kind of condition: which turn of which entry, and the settings, [field, who]."""

    kind: Kind
    node: np.ndarray  # number of each among all conditions
    entry: np.ndarray
    turn: np.ndarray  # 0 to begin, 1 to end
    settings: Moving  # stations move with the paths that they lie on
    part_first: np.ndarray  # of the conditions that it is about, where they begin in `part`
    part_count: np.ndarray
    part: np.ndarray  # their nodes
    stations: list[tuple[int, int]]  # which fields are stations of which vehicles
    run: Callable


@dataclass
class Maneuvers:
    """All maneuvers of one kind: their entries, vehicles and settings, [field, maneuver]."""

    kind: Kind
    entry: np.ndarray
    vehicle: np.ndarray  # columns
    settings: np.ndarray
    run: Callable


class Held(NamedTuple):
    """Cells of an array that have a value while an entry acts, and what they are by themselves."""

    entry: int
    owner: Any
    field: str
    index: Any
    value: Any
    base: np.ndarray


class Once(NamedTuple):
    """What is done once when an entry begins."""

    entry: int
    do: Callable[["World"], None]


class Region(NamedTuple):
    """Where the units of a world hear nothing while an entry acts: a circle [m], or corners."""

    entry: int
    units: np.ndarray
    x: float
    y: float
    radius: float
    corners: list[tuple[float, float]]


@dataclass
class Deeds:
    """What actions do besides to the road."""

    held: list[Held] = field(default_factory=list)
    once: list[Once] = field(default_factory=list)
    regions: list[Region] = field(default_factory=list)
    weathers: list[int] = field(default_factory=list)  # numbers of the worlds in which some of them change the weather


@dataclass
class Script:
    """What happens. The phases of the entries and since when are state; what follows from them is made anew when one turns."""

    world: np.ndarray  # number of the world, per entry
    vehicle: np.ndarray  # column of the vehicle whose maneuver it is, -1 for none
    takes: np.ndarray  # int64[entry]: what it takes of it, PEDALS, WHEEL or both
    again: np.ndarray  # int64[entry]: 1 when it may begin again
    momentary: np.ndarray  # int64[entry]: 1 when it is over as it begins
    ends: np.ndarray  # int64[entry]: 1 when it ends the run of its world
    phase: Moving  # int64[entry]: BEFORE, ACTING, OVER
    turned: Moving  # [s] float64[2, entry]: when it began and ended last, not a number before
    cut: Moving  # int64[entry]: the entry that has ended it, -1 for none
    come: np.ndarray  # scratch, int64[entry]: 1 when its turn has come
    unfit: np.ndarray  # scratch, int64[entry]: 1 when its maneuver commands what is no number
    commands: Moving  # [row, vehicle] of maneuvers
    root: np.ndarray  # int64[2, entry]: the condition that its beginning and its end wait for, -1 for none
    node_entry: np.ndarray  # per condition, the entry that it belongs to
    held: np.ndarray  # scratch, int64[condition]: 1 when it holds
    since: Moving  # [s] per condition about others: when these began to hold all at once; infinite while they do not
    met: Moving  # [s] when they did so for the first time
    asked: list[Asked]
    maneuvers: list[Maneuvers]
    pool: np.ndarray  # float64[2, pair]: the lists of pairs in settings
    watched: list[tuple[int, str]]  # values that conditions look at: number of the world, name
    values: np.ndarray  # scratch: these now
    reader: Reader | None  # of these; None when there are none
    limits: list[tuple[int, np.ndarray, np.ndarray]]  # entry, columns of points, speed there
    free: tuple[np.ndarray, np.ndarray]  # columns of points that some limit concerns, and the speed without any
    mail: np.ndarray  # scratch, [row, sender or link]: what was sent, received and lost since the tick before
    reads_mail: bool  # whether a condition looks at it
    deeds: Deeds
    waiting: np.ndarray  # places in `asked` of what somebody waits for now
    acting: np.ndarray  # places in `maneuvers` of kinds of which one lasts now


@dataclass
class Detours:
    """Vehicles whose path passes works: which of its paths each has taken (`choice` is state), and all their paths."""

    vehicle: np.ndarray  # int64[m]: columns
    choice: Moving  # int64[m]: bit b is work b
    work: Moving  # int64[MOST_WORKS, m]: entry of the script that work b belongs to, -1 for none
    base: Moving  # int64[m]: column of `lines` with choice 0
    lines: np.ndarray  # int64[LINE, line]
    span: np.ndarray  # float64[2 · MOST_WORKS, line]: where work b is entered and left
    held: Moving  # int64[entry]: vehicles that are still within it on the usual path


@dataclass
class Lanes:
    """Who drives on which block of lines, and who changes from one to another."""

    block: Moving  # int64[vehicle]
    asked: Moving  # int64[vehicle]: the gate through which it will change, -1 for none
    left_first: Moving  # int64[vehicle]: drives of the line that it is leaving
    left_count: Moving  # 0 of one that leaves none
    beside: Beside
    any_beside: bool  # whether there are other lanes for anybody
    facing: Facing
    any_facing: bool  # whether anybody passes on the lane of those who come

    def apart(self) -> np.ndarray:
        """How many blocks behind the usual one everybody is, whatever else is in the batch."""
        return np.where(self.beside.home < 0, 0, self.block - self.beside.home)


@dataclass
class Demand:
    """Who comes in from outside: the sources of flows, each with cars of its own and the times at which they are due."""

    column: np.ndarray  # int64[source]: the first of its cars
    cars: np.ndarray  # int64[source]: how many it has
    first: np.ndarray  # int64[source + 1]: the first of its times, and behind the last
    due: np.ndarray  # [s] all times, source after source
    gone: Moving  # int64[source]: how many have come in
    world: np.ndarray  # per source
    came: Moving  # [s] per vehicle: how late it came in; below zero until it has


@dataclass
class Movers:
    """Objects that move: which they are, where the corners of their lines begin and how many there are, speeds [m/s]."""

    object: np.ndarray
    first: np.ndarray
    count: np.ndarray
    corner: np.ndarray  # [row, corner], as obstacle.py names the rows
    speed: np.ndarray
    stays: np.ndarray  # 1 for one who stays at the end of his line
    tread: np.ndarray  # [row, place along a line]: its station [m], then height [m], level and lift [m] of the floor there
    tread_first: np.ndarray
    tread_count: np.ndarray
    zebra: np.ndarray  # [row, zebra crossing on somebody's line]
    zebra_first: np.ndarray
    zebra_count: np.ndarray  # 0 of one who does not walk


@dataclass
class Obstacles:
    """Objects on the road, world after world, and for every vehicle those that it may run into on its path."""

    table: Moving  # [row, object]
    first: np.ndarray  # per world
    count: np.ndarray
    standing: Moving  # int64[object], 1 while it stands there
    sweep: np.ndarray  # [row, object on a line]
    counts: np.ndarray  # of these per line
    sweep_first: Moving  # per vehicle, on the line it is on
    sweep_count: Moving
    movers: Movers
    names: tuple[str, ...]

    @property
    def swept(self) -> tuple[np.ndarray, np.ndarray]:
        """First and number of those that every vehicle may run into."""
        return self.sweep_first, self.sweep_count


@dataclass
class Units:
    """Who senses, talks and decides: the named vehicles of a world, then its stations, world after world."""

    names: tuple[tuple[str, ...], ...]  # per world
    first: np.ndarray  # per world
    vehicle: np.ndarray  # column of the vehicle that each is mounted on, -1 for a station
    world: np.ndarray  # of each
    entity: np.ndarray  # as chance tells them apart
    fixed: np.ndarray  # clock and antenna, [row, unit]
    now: Moving  # where they are and what they know of themselves, [row, unit]
    gps_set: np.ndarray  # per vehicle
    satellite: Moving  # errors of the satellite position, [row, vehicle]
    trouble: Moving  # what the script does to their radio, [row, unit]
    sight: np.ndarray  # room for what one sensor sees, [row, body]
    mounted: list[Mounted]
    posts: list[Post]
    airs: list[Air]

    def number(self, name: str, world: int = 0) -> int:
        """A unit by its name; raises ValueError."""
        return int(self.first[world]) + self.names[world].index(name)

    def blame(self, of: Mounted, i: int, what: str) -> Fault:
        """What sensor i of a kind did wrong."""
        text = f"The sensor {of.kind.name!r} ({of.names[i]} of {self.name_of(int(of.unit[i]))}) {what}"
        return Fault((int(self.world[of.unit[i]]),), ApplicationError(text))

    def name_of(self, unit: int) -> str:
        """Its name."""
        world = int(self.world[unit])
        return self.names[world][unit - int(self.first[world])]


@dataclass
class Events:
    """The collisions found. Every world has its share of the columns, which all grow when one of them is full."""

    hits: np.ndarray  # [row, collision]; moves, and grows, so that a snapshot keeps it for itself
    found: Moving  # how many collisions each world has had

    @property
    def hits_found(self) -> int:
        """Collisions of all worlds."""
        return int(self.found.sum())

    def of(self, number: int) -> np.ndarray:
        """Those of one world, [row, collision]."""
        first = number * (self.hits.shape[1] // self.found.size)
        return self.hits[:, first : first + int(self.found[number])]

    def grow(self) -> None:
        """Twice the room for every world."""
        shares = self.hits.reshape(self.hits.shape[0], self.found.size, -1)
        self.hits = np.concatenate([shares, np.zeros_like(shares)], axis=2).reshape(self.hits.shape[0], -1)


@dataclass
class World:
    """Everything that a tick reads and writes. `names` are the vehicles' names, one tuple per world."""

    clock: Clock
    vehicles: Vehicles
    worlds: Worlds
    roads: Roads
    units: Units
    events: Events
    script: Script
    detours: Detours
    lanes: Lanes
    demand: Demand
    obstacles: Obstacles
    neighbours: Neighbours
    queues: Queues
    seats: list[Seats]
    hosted: list[Hosted]
    open_inboxes: list[Open]  # of applications that hear everybody
    names: tuple[tuple[str, ...], ...]
    colours: tuple[str, ...] = field(default=())
    origin: str = ""  # digest of what it was built from
    ready: dict[Any, Any] = field(default_factory=dict)  # passes with their arrays; empty again when one stands elsewhere
    unfit: int = 0  # wishes of drivers and maneuvers at this tick that are no numbers
    arena: np.ndarray = field(default_factory=lambda: np.zeros(0, np.uint8))  # the bytes of everything that moves

    @cached_property
    def view(self) -> tuple:
        """What sensors see besides the time, as `View` names it, once the world is in one piece: arrays stay where they are."""
        v, u, w, o, r, g, tick = self.vehicles, self.units, self.worlds, self.obstacles, self.roads, self.neighbours, self.clock.tick
        return (
            tick, g.longest, v.state, v.parameter, w.of, w.number, u.now, u.world, u.vehicle, u.entity, w.seed, g.grid, g.places, g.found,
            o.table, o.first, o.count, o.standing, r.place_of, r.shadow, v.mind, r.points, r.chart, r.path_first, r.path_count,
            r.stop_first, r.stop_count, r.stop_station, r.stop_link, r.shown, u.sight, u.gps_set, u.satellite, r.weather, r.pieces,
        )  # fmt: skip

    @cached_property
    def air(self) -> tuple:
        """What radios see of the world, likewise."""
        u, w, r = self.units, self.worlds, self.roads
        return u.world, u.first, u.entity, w.radio_seed, r.place_of, r.shadow, u.fixed, u.now, u.trouble

    @property
    def size(self) -> int:
        """Number of vehicles in all worlds."""
        return self.vehicles.state.shape[1]

    def column(self, name: str, world: int = 0) -> int:
        """Column of a vehicle; raises ValueError."""
        return int(self.worlds.first[world]) + self.names[world].index(name)

    def name_of(self, number: int, world: int = 0) -> str:
        """Name of a vehicle by its number in its world, or of an object, OBJECT - i."""
        if number <= OBJECT:
            return self.obstacles.names[self.objects(world)][OBJECT - number]
        return self.names[world][number]

    def bodies(self, world: int = 0) -> np.ndarray:
        """Length, width, centre of gravity to front [m], mass [kg] and wheel radius [m] of one world's vehicles, float64[5, vehicle]."""
        return self.vehicles.parameter[[LENGTH, WIDTH, FRONT, MASS, RADIUS], self.columns(world)]

    def object_numbers(self, world: int = 0) -> list[int]:
        """The numbers that stand for the objects of one world where those of vehicles may."""
        return [OBJECT - i for i in range(int(self.obstacles.count[world]))]

    def columns(self, world: int = 0) -> slice:
        """Columns of one world."""
        first = int(self.worlds.first[world])
        return slice(first, first + int(self.worlds.count[world]))

    def objects(self, world: int = 0) -> slice:
        """Columns of the objects of one world."""
        first = int(self.obstacles.first[world])
        return slice(first, first + int(self.obstacles.count[world]))

    def hashed_parts(self) -> list[np.ndarray]:
        """What the hash of a run is made of: all that moves, but for what follows from it at the next tick."""
        v, u, e, s, o = self.vehicles, self.units, self.events, self.script, self.obstacles
        radio = [part for post in u.posts for part in (post.ring, post.inbox, post.memory, post.kept)]
        sensed = [part for each in u.mounted for part in (each.out, each.ring, each.output)]
        units = [u.satellite, u.now, *sensed, *radio, *(part for air in u.airs for part in air.state)]
        happened = [
            *(e.of(w) for w in range(e.found.size)),
            s.phase,
            s.turned,
            s.since,
            s.met,
            o.standing,
            self.detours.choice,
            self.lanes.block,
            self.demand.gone,
        ]
        return [v.state, v.wheels, v.mind, v.intents, v.commands, *units, *happened, *(memory for _, memory in self.memories())]

    def digest(self, number: int | None = None) -> str:
        """SHA-256 of these parts and the clock; of those of one world, which do not depend on the batch that it runs in."""
        digest = hashlib.sha256(str(self.clock.k).encode())
        for part in self.hashed_parts() if number is None else self.parts_of(number):
            digest.update(np.ascontiguousarray(part).tobytes())
        return digest.hexdigest()

    def parts_of(self, number: int) -> Iterator[np.ndarray]:
        """The shares of one world in the moving parts."""
        v, u, e, s, o, d = self.vehicles, self.units, self.events, self.script, self.obstacles, self.detours
        columns, of = self.columns(number), self.worlds.of
        per_vehicle = (v.state, 1), (v.wheels, 4), (v.mind, 1), (v.intents, 1), (v.commands, RING), (u.satellite, 1)
        for part, groups in per_vehicle:
            yield part.reshape(part.shape[0], groups, self.size)[:, :, columns]
        yield u.now[:, u.world == number]
        for each in u.mounted:
            mine = u.world[each.unit] == number
            yield from (each.out[mine], each.ring[mine[each.slots]], each.output[:, mine[each.slots]])
        for post in u.posts:
            yield post.newest(number, u.world)
            yield from (part[:, u.world[post.link_receiver] == number] for part in (post.inbox, post.memory))
            yield post.kept[:, u.world[post.sender] == number]
        for air in (each for each in u.airs if number in each.worlds):
            of_units, cells = air.state[:-1], air.state[-1]
            yield from (part[..., u.world == number] for part in of_units)
            yield cells[:, number]
        yield e.of(number)
        yield s.phase[s.world == number]
        yield s.turned[:, s.world == number]
        mine = s.world[s.node_entry] == number
        yield from (s.since[mine], s.met[mine])
        yield o.standing[self.objects(number)]
        yield d.choice[of[d.vehicle] == number]
        yield self.lanes.apart()[columns]
        yield self.demand.gone[self.demand.world == number]
        yield from (memory for group, memory in self.memories() if group.world == number)

    def memories(self) -> list[tuple[Group, np.ndarray]]:
        """What each application group remembers, group by group."""
        found = [(group, hosted.memory[:, group.cars]) for hosted in self.hosted for group in hosted.groups]
        return sorted(found, key=lambda each: each[0].place)

    def unfit_wishes(self) -> Iterator[tuple[int, str]]:
        """Columns of the vehicles whose drivers or maneuvers want what is no number, with the kind of these."""
        wishes = self.vehicles.mind[[WISH, STEER_WISH]]
        for seats in self.seats:
            driver = f"driver {seats.kind.name!r}"
            yield from ((int(column), driver) for column in seats.columns if not np.isfinite(wishes[:, column]).all())
        for each in self.script.maneuvers:
            unfit = each.vehicle[self.script.unfit[each.entry] != 0]
            yield from ((int(column), f"action {each.kind.name!r}") for column in unfit)

    def leave(self, number: int) -> None:
        """The vehicles of a world take no part any more, nor do its applications."""
        columns = self.columns(number)
        self.units.now[PRESENT, self.units.world == number] = 0.0
        self.vehicles.state[ACTIVE, columns] = 0.0
        self.vehicles.returns[columns] = 0
        mine, d = self.demand.world == number, self.demand
        d.gone[mine] = np.diff(d.first)[mine]  # nobody is due any more
        self.ready.clear()
        self.hosted = [hosted for hosted in self.hosted if {group.world for group in hosted.groups} != {number}]
