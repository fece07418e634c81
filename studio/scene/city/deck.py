"""Roads off the land: decks of bridges on piers, ramps between walls, cuttings, and tunnels under ground that one sees through.

Along every lane that is off the land there is a place every few metres. Between two of them lie, as quads,

    road and lines          where the lane is
    shoulder and parapet    beside it, where no other lane of that height is
    deck                    1.1 m thick where it is a bridge by the map or a lane passes below; it stands on piers that keep off all lanes
    walls                   from the ground up to a ramp, or down to a cutting

Sizes as of German bridges: a deck of 1.1 m for spans of some 20 m (slabs of 1/18 of it), parapets of 0.9 m (ZTV-ING, RPS 2009: 0.8 to
1.1 m). They are drawn and nothing more: nobody drives against a wall in the simulation.
"""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from studio.road.network import Network
from studio.road.ways.relief import Relief
from studio.scene.city.mesh import Mesh, flat
from studio.scene.city.stretch import Neighbours, off_land
from studio.scene.city.verge import FAST, SHOULDER
from studio.scene.colour import linear
from studio.scene.light import SUN, on_level_ground
from studio.scene.shape import Surface, cylinder, edged, joined, surface

THICK = 1.1  # [m] of a deck
PARAPET, PARAPET_WIDTH, KERB_WALL = 0.9, 0.25, 0.35  # [m] height beside a deck, thickness, height around a cutting
MARGIN = 0.6  # [m] of ground between a lane and its parapet where there is no shoulder
SPAN = 20.0  # [m] between piers
PIER_RADIUS, PIER_CLEAR, LEAST_PIER = 0.45, 1.2, 2.4  # [m] of a pier, from any lane below, height of what stands on piers
CLEARANCE = 2.5  # [m] of height between lanes that pass above each other
REACH = 3.0  # [m] beside a lane that a deck spans too
ABUTMENT = 2  # places by which a deck reaches beyond what it spans
FOOT = -0.2  # [m] where walls begin: in the ground
SUNK = 0.05  # [m] that walls begin below the road, so that there is no slit
PROBE = 0.3  # [m] beyond an edge, where one looks for another lane
SAME = 1.5  # [m] of height between lanes that are one ground
LINE, INSET, PAINT = 0.12, 0.1, 0.03  # [m] width of a line, from the edge of the lane, above the road
DASHES = 3  # of three quads along a line between lanes one is painted
HEADROOM = 4.7  # [m] of a tunnel
CONCRETE, UNDERSIDE, PIER, PORTAL = "#b3afa7", "#a9a59d", "#a5a199", "#3a3b3d"
DEEP = 0.3  # [m] below the land, from which on the ground is open


@dataclass(frozen=True, eq=False)
class Places:
    """All places off the land, stretch after stretch: where, lift [m], what is left of it, half its lane's width [m]."""

    lane: np.ndarray
    at: np.ndarray
    z: np.ndarray
    left: np.ndarray
    half: np.ndarray
    station: np.ndarray
    level: np.ndarray
    margin: np.ndarray
    follows: np.ndarray  # whether the next place is of the same stretch

    def edge(self, side: float, beyond: float | np.ndarray = 0.0) -> np.ndarray:
        """The edge to the left (1) or right (-1), float64[2, n], or so far beyond it [m]."""
        return self.at + side * (self.half + beyond) * self.left


@dataclass(frozen=True, eq=False)
class Aloft:
    """What is drawn: the roads and what stands around them, the shadow, open ground and covered ground as plane shapes."""

    roads: Surface
    solids: Surface
    shadow: Mesh
    opened: BaseGeometry
    covered: BaseGeometry


def aloft(network: Network, relief: Relief) -> Aloft:
    """All roads off the land."""
    p, others = places(network, relief), Neighbours(network, relief)
    open_sides = {side: is_free(p, others, side, PROBE) for side in (1.0, -1.0)}
    walled = {side: open_sides[side] & is_free(p, others, side, p.margin + PROBE) for side in (1.0, -1.0)}
    outer = {side: p.edge(side, np.where(open_sides[side], p.margin, 0.0)) for side in (1.0, -1.0)}
    spans, under = passes(p, others)
    deck = p.follows & (p.z > 0.0) & widened((p.level > 0.0) | spans, p)
    covered = p.follows & (p.z < -DEEP) & ((p.level < 0.0) | under) & (p.z < -HEADROOM + THICK)
    stands = [*walls(p, walled, outer, deck, covered), *undersides(p, outer, deck), *piers(p, others, deck), *ends(p, outer, deck, covered)]
    return Aloft(
        roads=joined([*carriageway(p, open_sides, outer), *lines(network, p, open_sides)]),
        solids=joined(stands),
        shadow=shadow(p, outer),
        opened=ground(p, outer, p.follows & (p.z < 0.0)),
        covered=ground(p, outer, covered),
    )


def places(network: Network, relief: Relief) -> Places:
    """The places of all stretches off the land."""
    rows: list[list[np.ndarray]] = []
    for lane, a, b in off_land(network, relief):
        one, n = network.lanes[lane], b - a + 1
        station, at, lift = (each[..., a : b + 1] for each in relief.of_lane(lane))
        step = np.gradient(at, axis=1)
        step = step / np.maximum(np.hypot(*step), 1e-9)
        margin = SHOULDER if network.roads[one.road].speed >= FAST else MARGIN
        level = relief.level[relief.first[lane] + a : relief.first[lane] + b + 1]
        own = [np.full(n, lane), at, lift, np.array([-step[1], step[0]]), np.full(n, one.width / 2.0), station, level]
        rows.append([*own, np.full(n, margin), np.arange(n) < n - 1])
    return Places(*(np.concatenate(column, axis=-1) for column in zip(*rows, strict=True)))


# -- what lies where -------------------------------------------------------------------------------


def is_free(p: Places, others: Neighbours, side: float, beyond: float | np.ndarray) -> np.ndarray:
    """Where no other lane of about the same height lies so far beyond an edge."""
    place, lane, lift = others.near(p.edge(side, beyond), 0.05)
    blocked = (lane != p.lane[place]) & (np.abs(lift - p.z[place]) < SAME)
    free = np.ones(p.z.size, dtype=bool)
    free[place[blocked]] = False
    return free


def passes(p: Places, others: Neighbours) -> tuple[np.ndarray, np.ndarray]:
    """Where another lane passes below, and where one passes above."""
    below, above = np.zeros((2, p.z.size), dtype=bool)
    for side in (-1.0, 0.0, 1.0):
        place, _, lift = others.near(p.at + side * p.half * p.left, REACH)
        below[place[lift < p.z[place] - CLEARANCE]] = True
        above[place[lift > p.z[place] + CLEARANCE]] = True
    return below, above


def widened(spans: np.ndarray, p: Places) -> np.ndarray:
    """The same and some places before and behind, on the same stretch."""
    for _ in range(ABUTMENT):
        onward, back = np.append(False, (spans & p.follows)[:-1]), np.append((spans[1:] & p.follows[:-1]), False)
        spans = spans | onward | back
    return spans


# -- quads -----------------------------------------------------------------------------------------


def quads(a: np.ndarray, z_a: np.ndarray, b: np.ndarray, z_b: np.ndarray, where: np.ndarray, colour: np.ndarray) -> Surface:
    """Quads between two lines float64[2, n] at these heights, from each place of `where` to the next; seen from the right of the way if `a`
    is above `b`, from above if it is to the left of it."""
    i = np.flatnonzero(where)
    corners = [np.column_stack([line[0, k], line[1, k], np.broadcast_to(z, line.shape[1])[k]])
               for line, z, k in ((a, z_a, i), (b, z_b, i), (b, z_b, i + 1), (a, z_a, i + 1))]  # fmt: skip
    vertices = np.stack(corners, axis=1).reshape(-1, 3)
    faces = (4 * np.arange(i.size)[:, None, None] + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3)
    return surface(vertices, faces, colour)


def carriageway(p: Places, open_sides: dict, outer: dict) -> list[Surface]:
    """Asphalt, and the ground beside it a little lower, so that it flickers nowhere through another lane."""
    found = [quads(p.edge(1.0), p.z, p.edge(-1.0), p.z, p.follows, on_level_ground("#55585c"))]
    for side in (1.0, -1.0):
        lines = (p.edge(1.0), outer[1.0]) if side > 0.0 else (outer[-1.0], p.edge(-1.0))
        inner, beyond = (lines[0], lines[1]) if side > 0.0 else (lines[1], lines[0])
        a, b = (beyond, inner) if side > 0.0 else (inner, beyond)
        found.append(quads(a, p.z - 0.02, b, p.z - 0.02, p.follows & open_sides[side], on_level_ground("#686b6e")))
    return found


def lines(network: Network, p: Places, open_sides: dict) -> list[Surface]:
    """Edge lines where a carriageway ends, one between directions, and broken ones between lanes."""
    white, found = on_level_ground("#eceae3"), []
    for side in (1.0, -1.0):
        a, b = sorted((-INSET, -INSET - LINE), reverse=side > 0.0)
        found.append(quads(p.edge(side, a), p.z + PAINT, p.edge(side, b), p.z + PAINT, p.follows & open_sides[side], white))
    side = network.middle
    inner = np.array([lane.internal or network.lanes_of(lane.road)[-1].id == lane.id for lane in network.lanes])
    broken = (np.floor(p.station / 4.0).astype(int) % DASHES == 0) & ~inner[p.lane] & ~open_sides[side]
    a, b = sorted((LINE / 2.0, -LINE / 2.0), reverse=side > 0.0)
    middle = inner[p.lane] & ~np.array([lane.internal for lane in network.lanes])[p.lane] & ~open_sides[side]
    return [*found, quads(p.edge(side, a), p.z + PAINT, p.edge(side, b), p.z + PAINT, p.follows & (broken | middle), white)]


def walls(p: Places, walled: dict, outer: dict, deck: np.ndarray, covered: np.ndarray) -> list[Surface]:
    """Parapets with the side of the deck or the wall of the ramp below them, and the walls of cuttings and tunnels."""
    found, colour = [], linear(CONCRETE)
    for side in (1.0, -1.0):
        inside, outside = outer[side], outer[side] + side * PARAPET_WIDTH * p.left
        here = p.follows & walled[side] & np.append(walled[side][1:], False)
        up = here & (p.z >= 0.0) & ~covered
        top, below = p.z + PARAPET, p.z - SUNK
        found += [face(inside, top, below, up, colour, -side), lid(inside, outside, top, up, colour, side)]
        # the foot of the outer side may step where a deck begins: each quad has its own
        for part, low in ((up & deck, np.maximum(p.z - THICK, FOOT)), (up & ~deck, np.full(p.z.size, FOOT))):
            found.append(face(outside, top, low, part, colour * 0.92, side))
        down = here & (p.z < 0.0) & ~covered
        rim = np.full(p.z.size, KERB_WALL)
        found += [face(inside, rim, below, down, colour * 0.85, -side), lid(inside, outside, rim, down, colour, side),
                  face(outside, rim, np.full(p.z.size, FOOT), down, colour * 0.92, side)]  # fmt: skip
        found.append(face(inside, np.full(p.z.size, FOOT), below, here & covered, linear(PORTAL) * 1.6, -side))
    return found


def face(line: np.ndarray, top: np.ndarray, low: np.ndarray, where: np.ndarray, colour: np.ndarray, side: float) -> Surface:
    """An upright band along a line, seen from its left (1) or right (-1)."""
    return quads(line, low, line, top, where, colour) if side > 0.0 else quads(line, top, line, low, where, colour)


def lid(inside: np.ndarray, outside: np.ndarray, z: np.ndarray, where: np.ndarray, colour: np.ndarray, side: float) -> Surface:
    """The top of a wall."""
    return quads(outside, z, inside, z, where, colour) if side > 0.0 else quads(inside, z, outside, z, where, colour)


def undersides(p: Places, outer: dict, deck: np.ndarray) -> list[Surface]:
    """What one sees of a deck from below."""
    low = np.maximum(p.z - THICK, FOOT)
    return [quads(outer[-1.0] - PARAPET_WIDTH * p.left, low, outer[1.0] + PARAPET_WIDTH * p.left, low, deck, linear(UNDERSIDE))]


def ends(p: Places, outer: dict, deck: np.ndarray, covered: np.ndarray) -> list[Surface]:
    """Abutments, where a deck begins and ends, and the portals of tunnels, as slabs across."""
    found = []
    for inside, colour in ((deck, CONCRETE), (covered, PORTAL)):
        begins, stops = np.flatnonzero(inside & ~np.append(False, inside[:-1])), np.flatnonzero(inside & ~np.append(inside[1:], False)) + 1
        for i in np.concatenate([begins, stops]).tolist():
            low, high = (FOOT, p.z[i] - 0.05) if inside is deck else (min(p.z[i] + HEADROOM, FOOT), KERB_WALL)
            if high - low > THICK or inside is covered:
                found.append(slab(outer[1.0][:, i], outer[-1.0][:, i], low, high, colour))
    return found


def slab(a: np.ndarray, b: np.ndarray, low: float, high: float, colour: str) -> Surface:
    """An upright slab from one place to another, seen from both sides."""
    corners = np.array([(*a, low), (*b, low), (*b, high), (*a, high)])
    return edged(surface(corners, [[0, 1, 2], [0, 2, 3], [2, 1, 0], [3, 2, 0]], colour))


def piers(p: Places, others: Neighbours, deck: np.ndarray) -> list[Surface]:
    """Piers under decks, some metres apart and clear of every lane below."""
    may = deck & (p.z - THICK > LEAST_PIER)
    place, _, lift = others.near(p.at, PIER_RADIUS + PIER_CLEAR)
    may[place[lift < p.z[place] - CLEARANCE]] = False
    found, lane, wanted = [], -1, 0.0
    for i in np.flatnonzero(may).tolist():
        if p.lane[i] != lane:
            lane, wanted = p.lane[i], SPAN / 2.0
        if p.station[i] >= wanted:
            found.append(cylinder(PIER_RADIUS, p.z[i] - THICK - FOOT, PIER).moved(x=p.at[0, i], y=p.at[1, i], z=FOOT))
            wanted = (np.floor(p.station[i] / SPAN) + 1.0) * SPAN
    return found


# -- on the ground ---------------------------------------------------------------------------------


def ground(p: Places, outer: dict, where: np.ndarray, shift: np.ndarray | None = None) -> BaseGeometry:
    """The ground below some quads as a plane shape."""
    i = np.flatnonzero(where)
    a, b = (line if shift is None else line + shift for line in (outer[1.0], outer[-1.0]))
    corners = np.stack([a[:, i], b[:, i], b[:, i + 1], a[:, i + 1]], axis=-1).transpose(1, 2, 0)
    return shapely.union_all(shapely.make_valid(shapely.polygons(corners))) if i.size else shapely.Polygon()


def shadow(p: Places, outer: dict) -> Mesh:
    """The shadow of all decks and ramps on the land."""
    return flat(ground(p, outer, p.follows & (p.z > LEAST_PIER), -SUN[:2, None] / SUN[2] * p.z))
