"""What of an OpenDRIVE document is used.

s       station along a road's reference line [m]
lanes   are numbered from the middle: 1, 2, … to the left of the reference line, -1, -2, … to its right
"""

from dataclasses import dataclass, field
from typing import NamedTuple

from studio.road.opendrive.reference_line import Profile, ReferenceLine

DRIVABLE = {
    *("driving", "entry", "exit", "onRamp", "offRamp", "connectingRamp", "slipLane", "bidirectional"),
    *("mwyEntry", "mwyExit"),  # as they were called before 1.4
}
KEPT_FOR_OTHERS = {"bus", "taxi", "HOV"}


@dataclass(frozen=True)
class Remark:
    """Something that is not used, where on which road, and why; `at` is its place [m] where that road is not used either."""

    kind: str
    what: str
    road: str
    s: float  # [m]
    reason: str
    at: tuple[float, float] | None = None


@dataclass(frozen=True)
class Strip:
    """A lane of a section: `width` [m] in the distance from the section's start; links name lanes before and after it.

    `direction` is "standard" where it is driven as its side of the road is, "reversed" against that, "both" for both.
    """

    id: int
    type: str
    width: Profile
    before: tuple[int, ...]
    after: tuple[int, ...]
    speeds: tuple[tuple[float, float], ...]  # distance [m] from the section's start, limit [m/s]; not a number: none
    open: bool = True  # to cars
    direction: str = "standard"


@dataclass(frozen=True)
class Section:
    """Lanes from station s [m] on; `strips` by their number."""

    s: float
    strips: dict[int, Strip]

    def inside(self, lane: int) -> list[Strip]:
        """The lanes between the middle and a lane."""
        return [strip for strip in self.strips.values() if strip.id * lane > 0 and abs(strip.id) < abs(lane)]


@dataclass(frozen=True)
class Link:
    """What a road is joined to at one of its ends: a road, there "start", "end" or, where that is not said, "", or a junction."""

    kind: str
    id: str
    contact: str = ""


@dataclass(frozen=True)
class Signal:
    """A light or sign at station s [m] for the lanes of one direction: "+" along the reference line, "-" against it, "none" both.

    `rule` is "light", "yield", "stop" or "priority".
    """

    id: str
    s: float
    orientation: str
    lanes: tuple[tuple[int, int], ...]  # from, to; none: all
    rule: str = "light"


class Deck(NamedTuple):
    """A bridge or a tunnel: from where to where it is along its road [m], and on which level it lies."""

    start: float
    end: float
    level: int


@dataclass(frozen=True)
class XRoad:
    """A road of the document. `kinds` are (s [m], type, country, limit [m/s] or not a number)."""

    id: str
    name: str
    junction: str
    left_hand: bool
    line: ReferenceLine
    length: float
    before: Link | None
    after: Link | None
    kinds: tuple[tuple[float, str, str, float], ...]
    elevation: Profile
    offset: Profile
    sections: tuple[Section, ...]
    signals: tuple[Signal, ...]
    decks: tuple[Deck, ...] = ()


@dataclass(frozen=True)
class Join:
    """One `<connection>` of a junction: lanes of an incoming road go on over a connecting road from its `contact`."""

    incoming: str
    connecting: str
    contact: str
    lanes: tuple[tuple[int, int], ...]  # none: as the connecting road's own links say


@dataclass(frozen=True)
class Junction:
    """A junction, and the pairs of roads of which the first goes before the second."""

    joins: tuple[Join, ...]
    priorities: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class Header:
    """Who made the document, under which licence, and how its plane lies on the earth ("" where it does not say)."""

    name: str
    vendor: str
    licence: str
    projection: str
    shift: tuple[float, float] = (0.0, 0.0)  # [m] that are to be added before the projection holds


@dataclass
class Document:
    """What of the file is used; `rings` are the junctions of each roundabout."""

    header: Header
    roads: dict[str, XRoad] = field(default_factory=dict)
    junctions: dict[str, Junction] = field(default_factory=dict)
    rings: list[frozenset[str]] = field(default_factory=list)
    remarks: list[Remark] = field(default_factory=list)
    guesses: list[Remark] = field(default_factory=list)
    rules: dict[str, str] = field(default_factory=dict)  # of the signals that other roads may refer to

    def remark(self, kind: str, what: str, road: str, s: float, reason: str, at: tuple[float, float] | None = None) -> None:
        """Notes what is not used."""
        self.remarks.append(Remark(kind, what, road, s, reason, at))

    def derive(self, kind: str, what: str, road: str, s: float, source: str) -> None:
        """Notes what the document does not say, and from what it was taken."""
        self.guesses.append(Remark(kind, what, road, s, source))
