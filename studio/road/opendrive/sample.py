"""Where the lanes of an OpenDRIVE road lie: its reference line at stations, and lanes beside it."""

from dataclasses import dataclass

import numpy as np

from studio.errors import MapError
from studio.road.opendrive.document import Section, XRoad

TORN, STRETCHED = 2.0, 3.0  # [m] and [1]: a reference line may leap that far, and be so much longer than its stations say
HIGHEST = 10_000.0  # [m]
FARTHEST = 1000.0  # [m] of a lane from its reference line
EDGE = 0.5  # [m] before a bridge its road is on the ground
POINT = 1e-3  # [m] a lane that is shorter is drawn so long


@dataclass(frozen=True, eq=False)
class Samples:
    """The reference line at stations s [m]: x, y, heading, height, lane offset, and the level of bridges and tunnels."""

    s: np.ndarray
    line: np.ndarray
    height: np.ndarray
    offset: np.ndarray
    level: np.ndarray

    def within(self, start: float, end: float) -> "Samples":
        """The part between two stations [m]."""
        inside = (start - 1e-9 <= self.s) & (self.s <= end + 1e-9)
        return Samples(self.s[inside], self.line[:, inside], self.height[inside], self.offset[inside], self.level[inside])


@dataclass(frozen=True, eq=False)
class Line:
    """A lane in one piece, along the reference line: its centre float64[2, n], height and width [m], and its level."""

    centre: np.ndarray
    height: np.ndarray
    width: np.ndarray
    level: np.ndarray


def samples(road: XRoad, stations: list[float]) -> Samples:
    """A road at these stations [m] and all that its curve needs; raises MapError where it is no curve that a road has."""
    edges = [each for deck in road.decks for each in (deck.start - EDGE, deck.start, deck.end, deck.end + EDGE)]
    s = np.union1d(road.line.stations(road.length), [*stations, *(each for each in edges if 0.0 < each < road.length)])
    found = Samples(s, road.line.at(s), road.elevation.at(s), road.offset.at(s), levels_at(road, s))
    steps = np.hypot(*np.diff(found.line[:2]))
    if not (steps <= TORN + STRETCHED * np.diff(s)).all():
        at = s[int(np.argmax(~(steps <= TORN + STRETCHED * np.diff(s))))]
        raise MapError(f"<geometry> at s = {at:.6g}: its curve is far longer than its length")
    if not (np.abs(found.height) <= HIGHEST).all():
        raise MapError(f"<elevation> leaves the heights of roads; allowed: up to {HIGHEST:g} m")
    return found


def levels_at(road: XRoad, s: np.ndarray) -> np.ndarray:
    """The level of a road at stations [m]."""
    found = np.zeros(s.size)
    for deck in road.decks:
        found[(deck.start - 1e-9 <= s) & (s <= deck.end + 1e-9)] = deck.level
    return found


def strip_line(road: str, section: Section, lane: int, along: Samples) -> Line:
    """A lane beside the reference line; raises MapError where it lies too far from it."""
    s, (x, y, heading) = np.maximum(along.s - section.s, 0.0), along.line
    inner = sum((strip.width.at(s) for strip in section.inside(lane)), np.zeros_like(s))
    width = np.maximum(section.strips[lane].width.at(s), 0.0)
    t = along.offset + (1 if lane > 0 else -1) * (inner + 0.5 * width)
    if not (np.abs(t) <= FARTHEST).all():
        raise MapError(
            f"road {road}: <lane> {lane} of the <laneSection> at s = {section.s:g} lies more than {FARTHEST:g} m beside its road"
        )
    return Line(drawn_out(np.array([x - t * np.sin(heading), y + t * np.cos(heading)]), heading), along.height, width, along.level)


def drawn_out(centre: np.ndarray, heading: np.ndarray) -> np.ndarray:
    """A lane that is a point, as that of a road without length, drawn out so that it has a direction."""
    if np.hypot(*np.diff(centre)).sum() > POINT:
        return centre
    on = np.linspace(0.0, POINT, centre.shape[1])
    return centre[:, :1] + on * np.array([[np.cos(heading[0])], [np.sin(heading[0])]])
