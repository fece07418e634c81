"""The alignment of lanes: what a map draws as a polyline becomes the curve that a road is built as.

    continuation   the connection by which a lane simply goes on: of all its own, and of all into the next lane, the straightest
    chain          lanes and ways through junctions joined by continuations; one smooth curve
    turn           every other connection: a curve from the end of one lane to the start of another, with both's
                   direction and curvature
    setback        what is taken off the ends of a road so that its turns have the room that a car needs

A chain is the curve with the least change of curvature near the mapped line. Where a corner of it would ask for more than
`COMFORT` at the speed limit, the curve may cut it by up to `CUT`, if that helps: no map is truer than that. What is still
sharper is a bend of the road, and drivers slow down for it.
"""

import itertools
import math
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import shapely

from studio import portable
from studio.portable import arctan2, cross, dot, resolved
from studio.road.assembly.bend import unit
from studio.road.network import Connection, Lane, Net, curve

SPACING = 1.0  # [m] of the points of a lane
CORRIDOR = 0.3  # [m] how far a curve may leave the mapped line
CUT = 1.5  # [m] the same in bends that are too sharp for the speed limit
ROUNDED = 2.5  # [m] the same in corners that no car gets round
THROUGH = 1.0  # [m] the same in a junction, where the line is netconvert's guess
WAVELENGTH = 30.0  # [m] shorter waves are corners of the map, not bends of the road
COMFORT = 3.0  # [m/s²] across, at the speed limit
CORNER = np.radians(40.0)  # [rad] a connection that turns more is no continuation
SHARPEST = 0.15  # [1/m] of a turn
SET_BACKS = 2  # times that ends are set back
EASED = 0.3  # of a turn's length, over which its curvature grows; the same share at its end
STEADY = 0.03  # [1/m²] how fast curvature may grow: at 5 m/s the front wheels turn by 0.4 rad/s
MOST_SETBACK = 9.0  # [m]
AT_SIGNAL = 0.5  # [m] a stop line stays near the signal that is mapped
MOST_SHARE = 0.4  # of a road's length, set back at either end
LEAST = 0.5  # [m] of a way through a junction
REACH = 20.0  # [m] how far the point where two lanes meet is looked for
DIRECTION_OVER = 3.0  # [m] of a lane's end give its direction
REACHES = np.array([0.5, 0.7, 0.9, 1.1, 1.4, 1.8, 2.3])  # of the ends' tangents, over the distance between them


def aligned(net: Net) -> Net:
    """The network with all lanes as smooth curves."""
    onward = continuations(net)
    net = set_back(net, onward)
    chained = {lane: line for chain in chains(net, onward) for lane, line in smooth_chain(net, chain)}
    net = redrawn(net, chained)
    through = {id(connection) for connection in onward.values()}
    turns = [c for c in net.connections if c.via and id(c) not in through]
    return redrawn(net, {lane: line for turn in turns for lane, line in turn_lines(net, turn)})


def sharpest(net: Net, connection: Connection) -> float:
    """Curvature of the sharpest bend on the way through a junction [1/m]."""
    lines = [net.lanes[via].centre for via in connection.via]
    return max((float(curve.curvature(line)[1:-1].max()) for line in lines if line.shape[1] > 3), default=0.0)


def redrawn(net: Net, lines: dict[int, np.ndarray]) -> Net:
    """The network with other centre lines."""
    lanes = tuple(replace(lane, centre=lines[lane.id], length=curve.length(lines[lane.id])) if lane.id in lines else lane
                  for lane in net.lanes)  # fmt: skip
    roads = {name: replace(road, length=sum(lanes[lane].length for lane in road.lanes) / len(road.lanes))
             for name, road in net.roads.items()}  # fmt: skip
    return replace(net, lanes=lanes, roads=roads)


# -- what goes on where ----------------------------------------------------------------------------


def continuations(net: Net) -> dict[int, Connection]:
    """For each lane that simply goes on, the connection by which it does; no lane is the continuation of two."""
    found, taken = {}, set()
    for _, _, connection in sorted((bent(net, c), i, c) for i, c in enumerate(net.connections) if c.direction != "turn"):
        if bent(net, connection) > CORNER:
            break
        if connection.from_lane not in found and connection.to_lane not in taken:
            found[connection.from_lane] = connection
            taken.add(connection.to_lane)
    return found


def bent(net: Net, connection: Connection) -> float:
    """How much a connection turns and steps aside [rad]."""
    start, direction, end, after = ends(net, connection)
    apart = end - start
    aside = abs(cross(direction, apart))
    return turned(direction, after) + math.atan2(aside, 1.0 + np.hypot(*apart))


def ends(net: Net, connection: Connection) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Where a connection starts and in which direction, where it ends and in which direction."""
    a, b = net.lanes[connection.from_lane].centre, net.lanes[connection.to_lane].centre
    return a[:, -1], direction_at(a, -1), b[:, 0], direction_at(b, 0)


def direction_at(line: np.ndarray, end: int) -> np.ndarray:
    """Direction of a lane at its start (0) or end (-1), a unit vector."""
    far = curve.length(line)
    s = min(far, DIRECTION_OVER)
    other = curve.along(line, np.array([s if end == 0 else far - s]))[:, 0]
    return unit(other - line[:, 0] if end == 0 else line[:, -1] - other)


def turned(a: np.ndarray, b: np.ndarray) -> float:
    """The angle between two directions [rad]."""
    return abs(portable.turn(a, b))


# -- room for turns --------------------------------------------------------------------------------


def set_back(net: Net, onward: dict[int, Connection]) -> Net:
    """The network with the ends of its roads set back where a turn needs room; in a bend a lane's new end has another direction."""
    for _ in range(SET_BACKS):
        net = set_back_once(net, onward)
    return net


def set_back_once(net: Net, onward: dict[int, Connection]) -> Net:
    """The same, by the directions that the lanes have now. A stop line stays by its signal unless no car could turn there."""
    through = {(connection.from_lane, connection.to_lane) for connection in onward.values()}
    eased, tight = defaultdict(float), defaultdict(float)
    for connection in net.connections:
        if (connection.from_lane, connection.to_lane) in through or connection.direction == "turn":
            continue
        start, end = (net.lanes[lane].road for lane in (connection.from_lane, connection.to_lane))
        for needed, curvature in ((eased, None), (tight, curve.LOCK)):
            before, behind = lacking(*ends(net, connection), curvature=curvature)
            needed[start, -1] = max(needed[start, -1], before)
            needed[end, 0] = max(needed[end, 0], behind)
    lines = {}
    for road in net.roads.values():
        most = min(MOST_SETBACK, MOST_SHARE * min(net.lanes[lane].length for lane in road.lanes))
        wanted = eased[road.id, -1]
        if net.signalled & set(road.lanes):
            wanted = max(min(wanted, AT_SIGNAL), tight[road.id, -1])
        first, last = min(most, eased[road.id, 0]), min(most, wanted)
        if first > 0.0 or last > 0.0:
            lines |= {lane: shortened(net.lanes[lane].centre, first, last) for lane in road.lanes}
    return redrawn(net, lines)


def lacking(
    start: np.ndarray, direction: np.ndarray, end: np.ndarray, after: np.ndarray, *, curvature: float | None = None
) -> tuple[float, float]:
    """How much room a turn lacks before it and behind it [m], for this curvature [1/m] or the gentlest that suits it.

    Aside by d within a length L along 10 u³ - 15 u⁴ + 6 u⁵, the curvature reaches 5.77 d / L² and grows by 60 d / L³.
    """
    theta, apart = turned(direction, after), end - start
    if theta < np.radians(20.0):
        aside = abs(cross(direction, apart))
        room = np.sqrt(5.77 * aside / (curvature or SHARPEST)) - dot(apart, direction)
        steady = 0.0 if curvature else math.cbrt(60.0 * aside / STEADY) - dot(apart, direction)
        return (max(0.0, room / 2.0, steady / 2.0),) * 2
    if theta > np.radians(150.0):
        return 0.0, 0.0  # turning back needs width, not length
    needs = legs(bow(theta)) / (curvature or gentlest(theta))
    before, behind = resolved(direction, after, apart)
    return max(0.0, needs - before), max(0.0, needs - behind)


def shortened(line: np.ndarray, first: float, last: float) -> np.ndarray:
    """A line without its first and last metres."""
    return between(line, first, curve.length(line) - last)


def between(line: np.ndarray, first: float, last: float) -> np.ndarray:
    """The part of a line between two arc lengths [m]."""
    own = curve.stations(line)
    inside = line[:, (own > first + 1e-6) & (own < last - 1e-6)]
    return np.column_stack([curve.along(line, np.array([first])), inside, curve.along(line, np.array([last]))])


# -- lanes that go on ------------------------------------------------------------------------------


def chains(net: Net, onward: dict[int, Connection]) -> Iterator[list[tuple[int, bool]]]:
    """The lanes of each chain in order, and whether they are counted: a ring also runs on a little beyond its seam."""
    before = {connection.to_lane for connection in onward.values()}
    roads = [lane.id for lane in net.lanes if not lane.internal]
    left = set(roads)
    for start in [lane for lane in roads if lane not in before] + roads:
        if start not in left:
            continue
        chain, lane = [], start
        while lane in left:
            left.remove(lane)
            chain.append((lane, True))
            if lane not in onward:
                break
            chain += [(via, True) for via in onward[lane].via]
            lane = onward[lane].to_lane
        else:
            chain = [(each, False) for each, _ in chain[-3:]] + chain + [(each, False) for each, _ in chain[:3]]
        yield chain


def smooth_chain(net: Net, chain: list[tuple[int, bool]]) -> Iterator[tuple[int, np.ndarray]]:
    """Every counted lane of a chain, as its piece of the chain's curve."""
    lanes = [net.lanes[lane] for lane, _ in chain]
    rough = rough_line(lanes)
    cuts = seams(rough, lanes)
    fine, corridor, limit = sampled(rough, lanes, cuts)
    if fine.shape[1] < 5:
        line = rough
    else:
        line = drawn(fine, corridor, limit)
        cuts = np.interp(cuts, np.linspace(0.0, curve.length(rough), fine.shape[1]), curve.stations(line))
    for (lane, counted), first, last in zip(chain, cuts[:-1], cuts[1:], strict=True):
        if counted:
            yield lane, between(line, first, last)


def rough_line(lanes: list[Lane]) -> np.ndarray:
    """One polyline of all lanes that never turns back."""
    points = without_doubles(np.concatenate([lane.centre for lane in lanes], axis=1))
    return points[:, curve.forward(points)]


def seams(rough: np.ndarray, lanes: list[Lane]) -> np.ndarray:
    """Arc lengths at which the lanes meet [m], at least a little apart."""
    far = curve.length(rough)
    found, at, apart = [0.0], 0.0, min(LEAST, 0.5 * far / len(lanes))
    for lane, following in itertools.pairwise(lanes):
        at += lane.length
        meeting = following.centre[:, 0] if lane.internal else lane.centre[:, -1]  # the road's own end, which may be set back
        low, high = max(0.0, at - REACH), min(far, at + REACH)
        near = shapely.LineString(between(rough, low, high).T)
        at = max(found[-1] + apart, low + near.project(shapely.Point(meeting)))
        found.append(at)
    room = far - apart * np.arange(len(lanes))[::-1]  # what must be left for the lanes that come
    return np.array([*np.minimum(found, room - apart), far])


def sampled(rough: np.ndarray, lanes: list[Lane], cuts: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points of the rough line, how far each may be left [m], and its speed limit [m/s]."""
    fine = curve.resampled(rough, SPACING)
    s = np.linspace(0.0, curve.length(rough), fine.shape[1])
    which = np.clip(np.searchsorted(cuts, s, side="right") - 1, 0, len(lanes) - 1)
    corridor = np.array([THROUGH if lane.internal else CORRIDOR for lane in lanes])[which]
    return fine, corridor, np.array([lane.speed for lane in lanes])[which]


def drawn(fine: np.ndarray, corridor: np.ndarray, limit: np.ndarray) -> np.ndarray:
    """The curve near these points; corners are cut as far as that makes them easy enough for the limit, or drivable at all."""
    spacing = curve.length(fine) / (fine.shape[1] - 1)

    def smooth(corridor: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        line = curve.smoothed(fine, spacing=spacing, wavelength=WAVELENGTH, corridor=corridor)
        return line, curve.curvature(line)

    def around(places: np.ndarray) -> np.ndarray:
        return curve.widened(places, round(WAVELENGTH / spacing))

    line, kappa = smooth(corridor)
    hard = kappa * limit**2 > COMFORT
    if not hard.any():
        return line
    _, eased = smooth(np.where(around(hard), CUT, corridor))
    bends = around(eased * limit**2 > COMFORT)  # here cutting does not help: the road itself bends
    corridor = np.where(around(hard) & ~bends, CUT, corridor)
    return smooth(np.where(around(kappa > SHARPEST), ROUNDED, corridor))[0]


# -- turns -----------------------------------------------------------------------------------------


def turn_lines(net: Net, turn: Connection) -> Iterator[tuple[int, np.ndarray]]:
    """The lanes of a turn, as pieces of its curve."""
    line = turn_curve(net.lanes[turn.from_lane].centre, net.lanes[turn.to_lane].centre)
    lengths = np.array([net.lanes[lane].length for lane in turn.via])
    cuts = np.concatenate([[0.0], np.cumsum(lengths) / lengths.sum()]) * curve.length(line)
    for lane, first, last in zip(turn.via, cuts[:-1], cuts[1:], strict=True):
        yield lane, between(line, first, last)


def turn_curve(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """From the end of one lane to the start of another: of some curves the one with the gentlest bend.

    They are a bow with straights, which turns best, and quintic Hermite curves, which also take over the curvature at both
    ends and can step aside; these differ in the lengths m and n of their end tangents.
    """
    p, q = before[:, -1], after[:, 0]
    far = max(np.hypot(*(q - p)), SPACING)
    u = np.linspace(0.0, 1.0, max(9, round(1.5 * far / SPACING)))
    start, end = end_of(before, -1), end_of(after, 0)
    family = quintics(u, p, start, q, end, REACHES * far)
    lines = [family[badness(family, far).argmin()], *bowed(p, start[0], q, end[0])]
    return min(lines, key=lambda line: badness(line[None], far)[0])


def badness(lines: np.ndarray, far: float) -> np.ndarray:
    """How little one wants to drive each of these lines, float64[k, 2, n]: its sharpest bend, and a little its length."""
    return curve.curvature(lines)[:, 1:-1].max(axis=1) + 0.01 * np.hypot(*np.diff(lines).swapaxes(0, 1)).sum(axis=1) / far


def bow(theta: float) -> np.ndarray:
    """A clothoid, an arc of radius 1 and a clothoid, from (0, 0) along x, that turn to the left by theta [rad].

    With transitions of the share c of the length L, theta = L (1 - c).
    """
    far = theta / (1.0 - EASED)
    s = np.linspace(0.0, far, 61)
    kappa = np.minimum(1.0, np.minimum(s, far - s) / (EASED * far))
    heading = cumulated(kappa, s)
    heading *= theta / heading[-1]
    return np.array([cumulated(np.cos(heading), s), cumulated(np.sin(heading), s)])


def gentlest(theta: float) -> float:
    """The curvature [1/m] of the tightest bow by theta [rad] whose curvature grows steadily enough.

    Curvature k is reached over the share c of L = theta / (k (1 - c)), so it grows by k² (1 - c) / (c theta).
    """
    return min(SHARPEST, float(np.sqrt(STEADY * EASED * theta / (1.0 - EASED))))


def cumulated(values: np.ndarray, s: np.ndarray) -> np.ndarray:
    """The integral over s from its start, by trapezoids."""
    return np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(s))])


def legs(bowed: np.ndarray) -> float:
    """How far a bow starts before the point where its end tangents cross."""
    x, y = bowed[:, -1]
    dx, dy = bowed[:, -1] - bowed[:, -2]
    return float(x - y * dx / dy)


def bowed(p, direction, q, after) -> list[np.ndarray]:
    """The bow from p to q with a straight before or behind it, if there is one."""
    theta = turned(direction, after)
    if not np.radians(5.0) < theta < np.radians(170.0):
        return []
    before, behind = resolved(direction, after, q - p)
    if min(before, behind) < SPACING:
        return []
    line = bow(theta) * (min(before, behind) / legs(bow(theta)))
    left = np.array([-direction[1], direction[0]]) * np.sign(cross(direction, after))
    first = p + max(0.0, before - behind) * direction
    placed = first[:, None] + direction[:, None] * line[0] + left[:, None] * line[1]
    whole = np.column_stack([p, placed, q]) if before > behind else np.column_stack([placed, q])
    return [curve.resampled(without_doubles(whole), 0.5 * SPACING)]


def without_doubles(line: np.ndarray) -> np.ndarray:
    """A line without points that repeat the one before."""
    return line[:, np.append(True, np.hypot(*np.diff(line)) > 1e-3)]


def end_of(line: np.ndarray, end: int) -> tuple[np.ndarray, float]:
    """Direction and signed curvature [1/m] of a smooth lane at its start (0) or end (-1)."""
    if line.shape[1] < 4:
        return direction_at(line, end), 0.0
    heading = np.unwrap(arctan2(*np.diff(line)[::-1]))
    middle = curve.stations(line)[:-1] + np.hypot(*np.diff(line)) / 2.0
    i, j = (0, 1) if end == 0 else (-2, -1)
    kappa = (heading[j] - heading[i]) / (middle[j] - middle[i])
    at = heading[i] - kappa * middle[i] if end == 0 else heading[j] + kappa * (curve.length(line) - middle[j])
    return np.array([np.cos(at), np.sin(at)]), float(np.clip(kappa, -SHARPEST, SHARPEST))


def quintics(u: np.ndarray, p, start, q, end, reaches: np.ndarray) -> np.ndarray:
    """Quintic Hermite curves from p to q, float64[k, 2, n]; their end tangents have all pairs of the `reaches` [m]."""
    (t, kappa), (w, after) = start, end
    m, n = (each.ravel()[:, None] for each in np.meshgrid(reaches, reaches))
    vectors = [
        np.broadcast_to(p, (m.size, 2)), m * t, kappa * m * m * np.array([-t[1], t[0]]),
        np.broadcast_to(q, (m.size, 2)), n * w, after * n * n * np.array([-w[1], w[0]]),
    ]  # fmt: skip
    u2, u3, u4, u5 = u * u, u * u * u, u * u * u * u, u * u * u * u * u
    weights = [
        1 - 10 * u3 + 15 * u4 - 6 * u5, u - 6 * u3 + 8 * u4 - 3 * u5, (u2 - 3 * u3 + 3 * u4 - u5) / 2,
        10 * u3 - 15 * u4 + 6 * u5, -4 * u3 + 7 * u4 - 3 * u5, (u3 - 2 * u4 + u5) / 2,
    ]  # fmt: skip
    return np.einsum("vkc,vn->kcn", np.array(vectors), np.array(weights))
