"""What an import found, placed, guessed and left out.

guess      what the map does not say and a road needs all the same: what was taken, where, from what, how sure it is
skipped    what the map says and the network does not have, with the reason
corrected  what a user knew better than the map (correction.py), and what the map says
"""

from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import Any, Literal


@dataclass(frozen=True)
class Guess:
    """Something taken without being mapped; `kind` groups guesses, `sure` is "high", "medium" or "low".

    The tag `key` of the map's `element` would settle it; both are "" where there is none.
    """

    kind: str
    what: str
    where: str
    latitude: float  # [deg]
    longitude: float  # [deg]
    source: str
    sure: str
    key: str = ""
    element: str = ""


@dataclass(frozen=True)
class Skipped:
    """Something mapped that is not in the network, and why."""

    kind: str
    what: str
    where: str
    latitude: float  # [deg]
    longitude: float  # [deg]
    reason: str
    element: str = ""


@dataclass(frozen=True)
class Corrected:
    """A correction that was applied: tags set and taken away, and what the map says of them ("" where it says nothing)."""

    element: str
    where: str
    latitude: float  # [deg]
    longitude: float  # [deg]
    tags: dict[str, str]
    removed: tuple[str, ...]
    before: dict[str, str]


Side = Literal["left", "right"]


@dataclass(frozen=True)
class DriveSide:
    """The side of the road that is driven on, and what tells so."""

    side: Side
    why: str


RIGHT = DriveSide("right", "nothing was asked")


@dataclass(frozen=True)
class SignalCount:
    """Signals on car roads: mapped in the part kept, of these with a stop line near, programmes."""

    in_map: int = 0
    placed: int = 0
    groups: int = 0


@dataclass(frozen=True)
class TurnCount:
    """Lanes whose turn:lanes are mapped where ways part, and how many lead just where the tag says."""

    tagged_lanes: int = 0
    matching: int = 0


@dataclass(frozen=True)
class LimitCount:
    """Car ways with and without a limit that can be read, and lane kilometres by limit [km/h]."""

    mapped_ways: int = 0
    guessed_ways: int = 0
    lane_km: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class BuildingCount:
    """Buildings and parts in the part kept; of the mapped ones those whose height is mapped and guessed."""

    placed: int = 0
    height_mapped: int = 0
    height_guessed: int = 0


@dataclass(frozen=True)
class ParkingCount:
    """Parking areas and single spaces mapped in the part kept; spaces laid along kerbs because tags of streets tell of them."""

    areas: int = 0
    spaces: int = 0
    along_kerbs: int = 0


@dataclass(frozen=True)
class CrossingCount:
    """Pedestrian crossings over built roads: all, with stripes, with lights, and without any paint."""

    placed: int = 0
    zebra: int = 0
    signalled: int = 0
    unmarked: int = 0


@dataclass(frozen=True)
class UprightCount:
    """Stretches of walls, fences and hedges, posts and poles, and mapped trees."""

    walls: int = 0
    posts: int = 0
    trees: int = 0


@dataclass(frozen=True)
class Report:
    """What became of a map; counts are of the part that was kept."""

    drive_side: DriveSide = RIGHT
    country: str = ""
    lane_km: float = 0.0
    junctions: int = 0
    signals: SignalCount = SignalCount()
    right_of_way: dict[str, int] = field(default_factory=dict)  # connections by their rule
    turn_lanes: TurnCount = TurnCount()
    speed_limits: LimitCount = LimitCount()
    buildings: BuildingCount = BuildingCount()
    parking: ParkingCount = ParkingCount()
    crossings: CrossingCount = CrossingCount()
    uprights: UprightCount = UprightCount()
    guesses: tuple[Guess, ...] = ()
    skipped: tuple[Skipped, ...] = ()
    corrected: tuple[Corrected, ...] = ()
    seconds: float = 0.0

    def as_json(self) -> dict[str, Any]:
        """The report as plain values."""
        return {**asdict(self), "drive_side": self.drive_side.side, "drive_side_why": self.drive_side.why}


@dataclass
class Notes:
    """What is noted while a map is read and built, in the order in which it comes up."""

    guesses: list[Guess] = field(default_factory=list)
    skipped: list[Skipped] = field(default_factory=list)
    corrected: list[Corrected] = field(default_factory=list)

    def guess(self, kind: str, what: str, at: "Spot", *, source: str, sure: str, key: str = "") -> None:
        """Notes a guess; `key` is the tag that would settle it."""
        element = at.element if key else ""
        self.guesses.append(Guess(kind, what, at.name, at.latitude, at.longitude, source, sure, key if element else "", element))

    def skip(self, kind: str, what: str, at: "Spot", reason: str) -> None:
        """Notes something that is left out."""
        self.skipped.append(Skipped(kind, what, at.name, at.latitude, at.longitude, reason, at.element))

    def correct(self, at: "Spot", *, tags: dict[str, str], removed: tuple[str, ...], before: dict[str, str]) -> None:
        """Notes a correction that was applied."""
        self.corrected.append(Corrected(at.element, at.name, at.latitude, at.longitude, tags, removed, before))


@dataclass(frozen=True)
class Spot:
    """A thing of the map with a position that one can point at [deg]; `element` is its name there, "way 4711"."""

    name: str
    latitude: float
    longitude: float
    element: str = ""


def rows(report: Report) -> list[list[str]]:
    """The report for people: what, how many, remarks."""
    signals, turns, limits = report.signals, report.turn_lanes, report.speed_limits
    crossings, uprights = report.crossings, report.uprights
    return [
        ["drive side", report.drive_side.side, report.drive_side.why],
        ["lanes", f"{report.lane_km:.3f} km", ""],
        ["junctions", str(report.junctions), ""],
        ["signals", f"{signals.placed} of {signals.in_map}", f"have a stop line; {signals.groups} programmes"],
        [
            "right of way",
            f"{sum(report.right_of_way.values())} ways",
            ", ".join(f"{right} {count}" for right, count in report.right_of_way.items()),
        ],
        ["turn lanes", f"{turns.matching} of {turns.tagged_lanes}", "lanes lead where their tag says"],
        ["speed limits", f"{limits.mapped_ways} ways", f"{limits.guessed_ways} more guessed; {by_limit(limits)}"],
        ["buildings", str(report.buildings.placed), f"{report.buildings.height_guessed} heights guessed"],
        [
            "parking",
            f"{report.parking.areas} areas",
            f"{report.parking.spaces} single spaces; {report.parking.along_kerbs} more along kerbs",
        ],
        ["crossings", str(crossings.placed), f"{crossings.zebra} zebra, {crossings.signalled} with lights, {crossings.unmarked} unmarked"],
        ["upright", f"{uprights.walls} walls", f"{uprights.posts} posts and poles, {uprights.trees} trees"],
        *counted("guessed", report.guesses, lambda guess: f"from {guess.source}"),
        *counted("skipped", report.skipped, lambda skipped: skipped.reason),
        *corrections(report.corrected),
        ["time", f"{report.seconds:.1f} s", ""],
    ]


def by_limit(limits: LimitCount) -> str:
    """Lane kilometres by limit in one line."""
    return ", ".join(f"{limit} km/h: {length:.1f} km" for limit, length in limits.lane_km.items())


def counted(word: str, things: tuple, remark: Callable[[Any], str]) -> list[list[str]]:
    """A row for every kind: how many, and the remark of the first."""
    kinds = {thing.kind: thing for thing in reversed(things)}
    return [
        [f"{word}: {kind}", str(sum(thing.kind == kind for thing in things)), f"e.g. {first.where}: {first.what}; {remark(first)}"]
        for kind, first in sorted(kinds.items())
    ]


def corrections(things: tuple[Corrected, ...]) -> list[list[str]]:
    """A row for the corrections, with the first one and what the map says instead."""
    if not things:
        return []
    first = things[0]
    now = [*(f"{key}={value}" for key, value in first.tags.items()), *(f"no {key}" for key in first.removed)]
    before = ", ".join(f"{key}={value}" if value else f"no {key}" for key, value in first.before.items())
    return [["corrected", str(len(things)), f"e.g. {first.where}: {', '.join(now)}; the map says {before}"]]
