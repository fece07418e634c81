"""The map as plain data: lanes, roads, connections, signals, scenery.

Coordinates are local metres, x east, y north, from the centre of the clipped map; headings are counter-clockwise from x.

    Road        a stretch of carriageway in one direction between two junctions; its lanes count from the kerb
    Lane        one lane of a road, or the way through a junction (`internal`)
    Connection  how one leaves a lane at its end: over the lanes `via` onto the lane `to_lane`
"""

from dataclasses import dataclass

import numpy as np

from studio.road.report import Report
from studio.road.signals import Signals

ATTRIBUTION = "© OpenStreetMap contributors"


@dataclass(frozen=True, eq=False)
class Lane:
    """One lane. `index` 0 is the lane at the kerb; `centre` is its centre line, float64[2, n] [m]."""

    id: int
    road: str
    index: int
    width: float  # [m]
    speed: float  # [m/s] what is allowed
    centre: np.ndarray
    internal: bool
    length: float  # [m]
    open: bool = True  # to cars; a bus lane is not


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
    ways: tuple[int, ...] = ()


@dataclass(frozen=True)
class Connection:
    """The way from the end of one lane to the start of another; `link` is the signal at its start, or -1."""

    from_lane: int
    to_lane: int
    via: tuple[int, ...]
    link: int
    direction: str


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
    """A patch of ground: kind is "green" or "water"; outline and holes float64[2, n]."""

    kind: str
    outline: np.ndarray
    holes: tuple[np.ndarray, ...]


@dataclass(frozen=True, eq=False)
class Scenery:
    """What stands beside the road. `trees` are positions, float64[2, n]."""

    buildings: tuple[Building, ...]
    areas: tuple[Area, ...]
    trees: np.ndarray


@dataclass(frozen=True, eq=False)
class Network:
    """A place: `origin` is the latitude and longitude [deg] of (0, 0), `bounds` x0, y0, x1, y1 [m].

    `digest` tells which file, which options and which importer made it, `report` what was found, guessed and left out.
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
    report: Report = Report()

    @property
    def drive_side(self) -> str:
        """The side that is driven on: "left" or "right"."""
        return self.report.drive_side.side

    @property
    def middle(self) -> float:
        """Where the middle of the road lies, seen along a lane: 1 on the left, -1 on the right."""
        return 1.0 if self.drive_side == "right" else -1.0

    def lanes_of(self, road: str) -> tuple[Lane, ...]:
        """The lanes of a road, the kerb lane first."""
        return tuple(self.lanes[lane] for lane in self.roads[road].lanes)
