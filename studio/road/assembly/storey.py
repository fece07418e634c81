"""Storeys: how high ways lie that cross others on another level, where no height says it.

A way that crosses others on a bridge lies 5.5 m a level above the ground, 4.5 m of them clear for a truck and 1 m the bridge itself; one in
a tunnel as far below. From its ends on the ways that go on come back to the ground with 6 %, a usual greatest slope of ramps: over all ways
from such a node, each node has the height z of the highest one less 6 % of the way there; but a way that is crossed stays on its level.
A bridge over water or rails alone stays level: nobody for whom it matters passes below.
"""

import heapq
from collections.abc import Iterator

import numpy as np
import shapely

from studio.road.assembly.elevation import Grid, Heights
from studio.road.assembly.level import level_of
from studio.road.formats.way import Way, spot_of
from studio.road.network.report import Notes

STOREY = 5.5  # [m]
RAMP = 0.06  # [1]
APART = 3.0  # [m] known heights that differ by so much at a crossing say it themselves
AT_NODE = 1.0  # [m] ways that meet there do not cross


def storeys(heights: Heights, ways: list[Way], grid: Grid, notes: Notes) -> Heights:
    """How high above the land, or how deep below it, nodes are where ways cross on different levels and the heights do not tell so."""
    level = {way.id: level_of(way.tags) for way in ways}
    crossed = {id(way): way for pair in crossings(ways, level, grid, heights) for way in pair}
    if not crossed:
        return {}
    lying = {node: 0.0 for way in crossed.values() for node in way.nodes}
    for way in sorted(crossed.values(), key=lambda each: abs(level[each.id])):
        lying |= dict.fromkeys(way.nodes, STOREY * level[way.id]) if level[way.id] else {}
    for way in crossed.values():
        if level[way.id]:
            what = f"{STOREY * abs(level[way.id]):g} m {'above' if level[way.id] > 0 else 'below'} the ground, ramps of {RAMP:.0%}"
            notes.guess("storey", what, spot_of(way), source="layer, bridge or tunnel where others cross", sure="low", key="layer")
    return ramps(lying, grid)


def crossings(ways: list[Way], level: dict[int, int], grid: Grid, heights: Heights) -> Iterator[tuple[Way, Way]]:
    """Pairs of ways on different levels that cross, and not just meet at a node."""
    off = [i for i, way in enumerate(ways) if level[way.id] and len(way.nodes) > 1]
    if not off:
        return
    lines = np.array([line_of(way, grid) for way in ways], dtype=object)
    for i, j in shapely.STRtree(lines).query(lines[off], predicate="intersects").T.tolist():
        one, other = ways[off[i]], ways[j]
        if level[one.id] != level[other.id]:
            shared = shapely.MultiPoint([grid.places[node] for node in set(one.nodes) & set(other.nodes)])
            places = shapely.intersection(lines[off[i]], lines[j]).difference(shared.buffer(AT_NODE))
            if not places.is_empty and not is_told(one, other, places, grid, heights):
                yield one, other


def line_of(way: Way, grid: Grid) -> shapely.LineString:
    """A way in local metres; one of a single node is a point, twice."""
    places = [grid.places[node] for node in way.nodes]
    return shapely.LineString(places if len(places) > 1 else places * 2)


def is_told(one: Way, other: Way, places, grid: Grid, heights: Heights) -> bool:
    """Whether known heights tell already that two ways pass above each other."""
    if not heights:
        return False
    at = places.representative_point()
    a, b = (height_at(way, at, grid, heights) for way in (one, other))
    return abs(a - b) >= APART


def height_at(way: Way, at: shapely.Point, grid: Grid, heights: Heights) -> float:
    """The known height of a way at a place on it [m]."""
    line = line_of(way, grid)
    s = [line.project(shapely.Point(grid.places[node])) for node in way.nodes]
    order = np.argsort(s)
    return float(np.interp(line.project(at), np.array(s)[order], np.array([heights.get(node, 0.0) for node in way.nodes])[order]))


def ramps(lying: Heights, grid: Grid) -> Heights:
    """The heights of all nodes to which ramps reach from those that lie above or below the ground."""
    found = dict(lying)
    for sign in (1.0, -1.0):
        waiting = [(-abs(z), node) for node, z in lying.items() if sign * z > 0.0]
        heapq.heapify(waiting)
        done = set()
        while waiting:
            high, node = heapq.heappop(waiting)
            if node in done:
                continue
            done.add(node)
            found[node] = -sign * high
            for other, far in grid.neighbours[node].items():
                if -high > RAMP * far and other not in lying and other not in done:
                    heapq.heappush(waiting, (high + RAMP * far, other))
    return found
