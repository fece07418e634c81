"""Streets with one lane for both directions: their two lanes lie on one ground, but for the ends, where two cars have room to meet.

netconvert makes two narrow lanes side by side. From each end on both go to the middle between them, by half a wave of the cosine, whose
curvature is greatest where it begins, a π²/(2 T²) for a shift of a over a length of T: 1.25 m over 12 m make a radius of 23 m. Who comes
while the ground is taken waits before it begins. A street too short for that stays as it is: there one meets side by side.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from studio.road.formats.way import Way, is_one_way, spot_of
from studio.road.network import Lane, Net, Road, curve
from studio.road.network.report import Notes

NARROWEST = 2.5  # [m] of a lane (RASt 06: 2.75 to 3.50 m)
LEAST_END, MOST_END = 8.0, 16.0  # [m] on which two lanes lie side by side: for one car to wait, for a truck or two cars
PART = 0.15  # of a street is such an end
TAPER = 12.0  # [m]
LEAST = 8.0  # [m] of ground that is shared is worth it
GRAIN = 1.0  # [m]
SOURCE = "lanes=1 for both directions"
FIRST = {"forward": (1, -1), "backward": (-1, 1)}  # priority of a way: who goes first in its own direction, and against it


def is_shared(way: Way) -> bool:
    """Whether a way has one lane, on which two cannot pass each other."""
    if is_one_way(way) or way.tags["highway"].startswith("motorway") or way.tags.get("lanes") != "1":
        return False
    width = way.tags.get("width", "0").strip().removesuffix("m").strip().replace(",", ".")
    return not (width.replace(".", "", 1).isdecimal() and float(width) >= 2.0 * NARROWEST)


def brought_together(net: Net, ways: Iterable[Way], notes: Notes) -> Net:
    """The network in which both directions of streets with one lane share it; what becomes of each way is told."""
    shared = {way.id: way for way in ways if is_shared(way)}
    if not shared:
        return net
    lanes, drawn, total = list(net.lanes), dict.fromkeys(shared, 0.0), dict.fromkeys(shared, 0.0)
    for there, back in pairs(net, shared):
        own = net.origins[there.id]
        one, other = (net.lanes[road.lanes[0]] for road in (there, back))
        stretch = max(0.0, one.length - 2.0 * (end_of(one) + TAPER))
        for way in own:
            total[way] += one.length / len(own)
            drawn[way] += stretch / len(own) if stretch >= LEAST else 0.0
        if stretch >= LEAST:
            first = FIRST.get(shared[own[0]].tags.get("priority", ""), (0, 0))[:: 1 if is_along(one, shared[own[0]]) else -1]
            lanes[one.id] = together(one, other, first[0])
            lanes[other.id] = together(other, one, first[1])
    for name, way in shared.items():
        tell(way, drawn[name], total[name], notes)
    return replace(net, lanes=tuple(lanes), roads={name: with_length(road, lanes) for name, road in net.roads.items()})


def pairs(net: Net, shared: dict[int, Way]) -> Iterator[tuple[Road, Road]]:
    """Both directions of every road that has one lane each and is made of such ways alone."""
    waiting: dict[tuple[str, str, frozenset[int]], Road] = {}
    for road in net.roads.values():
        own = net.origins.get(road.id, ())
        if road.internal or len(road.lanes) != 1 or not own or not all(way in shared for way in own):
            continue
        back = waiting.pop((road.to_junction, road.from_junction, frozenset(own)), None)
        if back is not None:
            yield back, road
        else:
            waiting[road.from_junction, road.to_junction, frozenset(own)] = road


def end_of(lane: Lane) -> float:
    """Length [m] of the ends on which there is room to meet."""
    return min(max(PART * lane.length, LEAST_END), MOST_END)


def together(lane: Lane, other: Lane, first: int) -> Lane:
    """The lane, drawn to the middle between it and the other one. Its ends, and how it leaves them, stay."""
    line = curve.resampled(lane.centre, GRAIN)
    s = curve.stations(line)
    inside = np.clip((np.minimum(s, s[-1] - s) - end_of(lane)) / TAPER, 0.0, 1.0)
    share = 0.25 * (1.0 - np.cos(np.pi * inside))  # half of the way to the other lane
    moved = line + share * (nearest(line, curve.resampled(other.centre, 0.5 * GRAIN)) - line)
    return replace(lane, centre=moved, length=curve.length(moved), facing=other.id, goes_first=first)


def nearest(points: np.ndarray, line: np.ndarray) -> np.ndarray:
    """The places of a line that are nearest to points, by its own points."""
    apart = np.hypot(*(points[:, :, None] - line[:, None, :]))
    return line[:, apart.argmin(axis=1)]


def is_along(lane: Lane, way: Way) -> bool:
    """Whether a lane is driven in the direction in which its way is drawn."""
    (x_0, y_0), (x_1, y_1) = way.points[0], way.points[-1]
    dx, dy = lane.centre[:, -1] - lane.centre[:, 0]
    return dx * (x_1 - x_0) * np.cos(np.radians(y_0)) + dy * (y_1 - y_0) >= 0.0


def with_length(road: Road, lanes: list[Lane]) -> Road:
    """The road, as long as its lane is now."""
    return replace(road, length=lanes[road.lanes[0]].length) if lanes[road.lanes[0]].facing >= 0 else road


def tell(way: Way, drawn: float, total: float, notes: Notes) -> None:
    """What becomes of one lane for both directions."""
    ends = f"two lanes of {NARROWEST:g} m"
    if drawn > 0.0:
        what = f"passed one after the other on {drawn:.0f} of {total:.0f} m; {ends} at the ends, for those who wait"
        notes.guess("one lane", what, spot_of(way), source=SOURCE, sure="medium", key="lanes")
    else:
        short = 2.0 * (LEAST_END + TAPER) + LEAST
        notes.guess(
            "one lane", ends, spot_of(way), source=f"{SOURCE}, on less than {short:g} m: cars pass each other", sure="low", key="lanes"
        )
