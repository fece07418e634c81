"""The map as plain data: lanes, roads, connections, signals, scenery.

Coordinates are local metres, x east, y north, from the centre of the clipped map; headings are counter-clockwise from x.

    Road        a stretch of carriageway in one direction between two junctions; its lanes count from the kerb
    Lane        one lane of a road, or the way through a junction (`internal`)
    Connection  how one leaves a lane at its end: over the lanes `via` onto the lane `to_lane`
"""

from dataclasses import dataclass, field

import numpy as np

from studio.road.network.report import Report, Side
from studio.road.network.signals import Signals

RIGHTS = ("signal", "priority", "yield", "stop", "all_way_stop", "right_before_left", "left_before_right", "roundabout", "zipper")
SPACE_X, SPACE_Y, SPACE_HEADING, SPACE_LENGTH, SPACE_WIDTH = range(5)
SPACE_ROWS = 5


@dataclass(frozen=True, eq=False)
class Lane:
    """One lane. `index` 0 is the lane at the kerb; `centre` is its centre line, float64[2, n] [m].

    `height` float64[n] [m] is that of the road at the points of `centre`; zeros where nothing is known. `level` float64[n] tells of
    one that is not all on the ground on which level it is there, `lift` float64[n] [m] how high above the land it lies, or how deep below
    it, where a storey was laid for it; see ways/relief.py for all lanes.
    """

    id: int
    road: str
    index: int
    width: float  # [m]
    speed: float  # [m/s] what is allowed
    centre: np.ndarray
    internal: bool
    length: float  # [m]
    open: bool = True  # to cars; a bus lane is not
    height: np.ndarray = field(default_factory=lambda: np.zeros(0))
    level: np.ndarray = field(default_factory=lambda: np.zeros(0))
    lift: np.ndarray = field(default_factory=lambda: np.zeros(0))
    facing: int = -1  # the lane of the other direction on whose ground it lies, -1 for none
    goes_first: int = 0  # on such ground, 1 who comes on this lane, -1 who comes on the other, 0 none by sign

    def __post_init__(self) -> None:
        if self.height.size != self.centre.shape[1]:
            object.__setattr__(self, "height", np.zeros(self.centre.shape[1]))


@dataclass(frozen=True)
class Road:
    """Parallel lanes in one direction from one junction to the next; `lanes` are lane ids, the kerb lane first.

    `ways` are the ids of the mapped ways that it is made of, along it.
    """

    id: str
    name: str
    lanes: tuple[int, ...]
    from_junction: str
    to_junction: str
    speed: float  # [m/s]
    length: float  # [m]
    internal: bool
    kind: str = ""  # as mapped, such as "residential"
    ways: tuple[int, ...] = ()


@dataclass(frozen=True)
class Connection:
    """The way from the end of one lane to the start of another; `link` is the signal at its start, or -1.

    `right_of_way` is one of `RIGHTS`, `yields` are the connections (by their number) that go first where both come at once.
    """

    from_lane: int
    to_lane: int
    via: tuple[int, ...]
    link: int
    direction: str
    right_of_way: str = "priority"
    yields: tuple[int, ...] = ()
    sharpest: float = 0.0  # [1/m] curvature of its sharpest bend


Pair = tuple[str, str]  # the roads that a connection leads from and to


@dataclass(frozen=True)
class Net:
    """Lanes and junctions before signals and scenery.

    `signalled` are the lanes that end at a mapped signal, `origins` the ids of the ways that a road is made of.
    `yields` tells whom one lets go first on the way from a road to another, `equal` names the junctions without major road,
    `rings` the roads of roundabouts.
    """

    lanes: tuple[Lane, ...]
    roads: dict[str, Road]
    connections: tuple[Connection, ...]
    junctions: tuple[np.ndarray, ...]
    signalled: frozenset[int]
    origins: dict[str, tuple[int, ...]]
    yields: dict[Pair, frozenset[Pair]] = field(default_factory=dict)
    equal: frozenset[str] = frozenset()
    rings: frozenset[str] = frozenset()


@dataclass(frozen=True, eq=False)
class Building:
    """A prism: outline and holes float64[2, n] (open, outline counter-clockwise), from `base` up to `height` [m]."""

    outline: np.ndarray
    holes: tuple[np.ndarray, ...]
    height: float
    base: float
    colour: str  # "#rrggbb" as mapped, or ""


@dataclass(frozen=True, eq=False)
class Area:
    """A patch of ground: kind is "green", "water", "sand", "square" or "parking"; outline and holes float64[2, n]."""

    kind: str
    outline: np.ndarray
    holes: tuple[np.ndarray, ...]


@dataclass(frozen=True, eq=False)
class Crossing:
    """Where walkers cross a carriageway: a strip of this width [m] along `line` from edge to edge, float64[2, 2].

    `marking` is "zebra", "lines" (two, as at lights) or "none"; `signalled` tells whether walkers have lights.
    """

    line: np.ndarray
    width: float
    marking: str
    signalled: bool


@dataclass(frozen=True, eq=False)
class Wall:
    """Something upright along a line, float64[2, n]: kind is a "wall", "fence", "hedge" or another barrier."""

    kind: str
    line: np.ndarray
    height: float  # [m]
    thickness: float  # [m]


@dataclass(frozen=True)
class Post:
    """Something slim and upright: kind is "bollard", "block", "lamp", "flagpole", "mast" or "pole"."""

    kind: str
    x: float  # [m]
    y: float  # [m]
    height: float  # [m]
    thickness: float  # [m]


@dataclass(frozen=True, eq=False)
class Scenery:
    """What stands beside the road. `trees` are positions, float64[2, n].

    `spaces` are single parking spaces, float64[SPACE_ROWS, n]: centre, heading in which one drives in from the aisle,
    length and width. Along a kerb the heading is that of the traffic; the last `along_kerbs` of them are not mapped one
    by one but laid there because the street allows parking.
    """

    buildings: tuple[Building, ...]
    areas: tuple[Area, ...]
    trees: np.ndarray
    spaces: np.ndarray = field(default_factory=lambda: np.empty((SPACE_ROWS, 0)))
    along_kerbs: int = 0
    crossings: tuple[Crossing, ...] = ()
    walls: tuple[Wall, ...] = ()
    posts: tuple[Post, ...] = ()


@dataclass(frozen=True, eq=False)
class Network:
    """A place: `origin` is the latitude and longitude [deg] of (0, 0), `bounds` x0, y0, x1, y1 [m].

    `digest` tells which file, which options and which importer made it, `report` what was found, guessed and left out,
    `bans` roads that must not be driven one after another although each leads to the next.
    `datum` is where (0, 0) lies in the file's own plane coordinates [m], for a kind of map that has some.
    """

    name: str
    attribution: str
    origin: tuple[float, float]
    bounds: tuple[float, float, float, float]
    digest: str
    lanes: tuple[Lane, ...]
    roads: dict[str, Road]
    connections: tuple[Connection, ...]
    junctions: tuple[np.ndarray, ...]
    signals: Signals
    scenery: Scenery
    report: Report = field(default_factory=Report)
    licence: str = ""
    datum: tuple[float, float] = (0.0, 0.0)
    bans: tuple[tuple[str, ...], ...] = ()

    @property
    def drive_side(self) -> Side:
        """The side that is driven on."""
        return self.report.drive_side.side

    @property
    def middle(self) -> float:
        """Where the middle of the road lies, seen along a lane: 1 on the left, -1 on the right."""
        return 1.0 if self.drive_side == "right" else -1.0

    def lanes_of(self, road: str) -> tuple[Lane, ...]:
        """The lanes of a road, the kerb lane first."""
        return tuple(self.lanes[lane] for lane in self.roads[road].lanes)
