"""Heights of the roads of an OpenStreetMap from the `ele` tags of their nodes.

Few nodes have one, and it is rounded to a metre or so. Between and around them the ways bend as little as they can: over all
heights z of the ways' nodes is least

    sum over tagged nodes (z - ele)²/sigma²  +  bend · integral z''² ds  +  slack · integral z'² ds

a smoothing spline (Reinsch 1967) on the network of ways. With a tag every d metres it flattens waves shorter than
2 pi (bend sigma² d)^(1/4): 100 m for d = 50 m. The last term levels out what hangs over beyond the last tag, within some 100 m.
"""

import heapq
import itertools
import math
import re
from collections import defaultdict
from dataclasses import dataclass, replace

import numpy as np
import shapely

from studio.road.formats.identity import named
from studio.road.formats.osm import Box, Survey
from studio.road.formats.way import Way
from studio.road.network import Lane, Net, curve
from studio.road.network.report import Notes, Spot

LOWEST, HIGHEST = -450.0, 6000.0  # [m] of roads: the Dead Sea, the Andes and the Himalayas
SIGMA = 0.5  # [m] of a tag
BEND = 5000.0  # [m]
SLACK = 0.5  # [1/m]
STEEPEST = 0.35  # [1] the steepest streets there are
ROUNDING = 2.0  # [m] that two tags may be wrong together
FEET = 0.3048  # [m]
PLACES = 3  # decimals of a height [m]: the digits behind them depend on how a processor sums

Heights = dict[int, float]  # by node [m]


@dataclass(frozen=True)
class Grid:
    """The nodes of ways in local metres, and how far each is from its neighbours along the ways [m]."""

    places: dict[int, np.ndarray]
    neighbours: dict[int, dict[int, float]]


def mapped_heights(found: Survey, grid: Grid, ways: list[Way], box: Box) -> Heights:
    """The heights that the map has, of the nodes near which it has any."""
    tags = {node: height for node in grid.places if (height := metres(found.nodes.get(node, {}).get("ele", ""))) is not None}
    tags = without_slips(tags, grid, box, found.notes)
    return heights_of(tags, grid, ways, box, found.notes)


def metres(text: str) -> float | None:
    """A mapped height above the sea [m], or None for what cannot be one.

    >>> metres("34.5"), metres("112 m"), metres("100 ft"), metres("high"), metres("99999")
    (34.5, 112.0, 30.48, None, None)
    """
    match = re.fullmatch(r"\s*(-?\d+(?:[.,]\d+)?)\s*(m|ft)?\s*", text)
    if not match:
        return None
    value = float(match[1].replace(",", ".")) * (FEET if match[2] == "ft" else 1.0)
    return round(value, 6) if LOWEST <= value <= HIGHEST else None


def grid_of(ways: list[Way], box: Box) -> Grid:
    """The grid of some ways."""
    nodes = {node: point for way in ways for node, point in zip(way.nodes, way.points, strict=True)}
    longitude, latitude = np.array(list(nodes.values())).T
    places = dict(zip(nodes, box.local(latitude, longitude).T, strict=True))
    neighbours: dict[int, dict[int, float]] = defaultdict(dict)
    for way in ways:
        for a, b in itertools.pairwise(way.nodes):
            if a != b:
                far = max(0.1, float(np.hypot(*(places[a] - places[b]))))
                neighbours[a][b] = neighbours[b][a] = far
    return Grid(places, neighbours)


# -- tags that can be meant ------------------------------------------------------------------------


def without_slips(tags: Heights, grid: Grid, box: Box, notes: Notes) -> Heights:
    """The tags without those that would make a cliff: the one in most cliffs goes first."""
    near = {node: tagged_neighbours(node, tags, grid) for node in tags}
    left = dict(tags)
    while True:
        cliffs = {node: sum(is_cliff(left[node] - left[other], far) for other, far in near[node] if other in left) for node in left}
        worst = max(cliffs, key=lambda node: (cliffs[node], deviation(node, left, near), node), default=None)
        if worst is None or not cliffs[worst]:
            return left
        notes.skip(
            "elevation", f"ele={left[worst]:g}", spot(worst, grid, box), f"the road to its neighbours would be steeper than {STEEPEST:.0%}"
        )
        del left[worst]


def is_cliff(rise: float, far: float) -> bool:
    """Whether no road rises so much on such a way."""
    return abs(rise) > STEEPEST * far + ROUNDING


def deviation(node: int, heights: Heights, near) -> float:
    """How far a height is from the middle one of its neighbours [m]."""
    others = [heights[other] for other, _ in near[node] if other in heights]
    return abs(heights[node] - float(np.median(others))) if others else 0.0


def tagged_neighbours(start: int, tags: Heights, grid: Grid) -> list[tuple[int, float]]:
    """The tagged nodes that one comes to first on the ways from a node, with the distance [m]."""
    waiting, done, found = [(0.0, start)], set(), []
    while waiting:
        far, node = heapq.heappop(waiting)
        if node in done:
            continue
        done.add(node)
        if node != start and node in tags:
            found.append((node, far))
            continue
        for other, step in grid.neighbours[node].items():
            heapq.heappush(waiting, (far + step, other))
    return found


# -- heights of all nodes --------------------------------------------------------------------------


def heights_of(tags: Heights, grid: Grid, ways: list[Way], box: Box, notes: Notes) -> Heights:
    """The heights of all nodes that hang together with at least two tagged ones; a lone tag tells no slope."""
    found: Heights = {}
    for part in parts(grid):
        own = {node: tags[node] for node in part if node in tags}
        if len(own) == 1:
            (node,) = own
            notes.guess("elevation", "level, at height 0", spot(node, grid, box), source=f"ele={own[node]:g} at one node alone", sure="low")
        elif own:
            found |= spline(own, part, grid, ways)
            what = f"of {len(part)} nodes, from {min(own.values()):g} to {max(own.values()):g} m"
            notes.guess("elevation", what, spot(min(own), grid, box), source=f"ele at {len(own)} nodes", sure="medium")
    return found


def parts(grid: Grid) -> list[list[int]]:
    """Nodes that hang together."""
    left, found = dict.fromkeys(grid.places), []
    while left:
        part, waiting = [], [next(iter(left))]
        while waiting:
            node = waiting.pop()
            if node in left:
                del left[node]
                part.append(node)
                waiting += grid.neighbours[node]
        found.append(part)
    return found


def spline(tags: Heights, part: list[int], grid: Grid, ways: list[Way]) -> Heights:
    """The heights that bend least, by least squares."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.linalg import spsolve

    number = {node: i for i, node in enumerate(part)}
    rows: list[tuple[list[int], list[float]]] = []
    for a, others in grid.neighbours.items():
        rows += [
            ([number[a], number[b]], [math.sqrt(SLACK / far), -math.sqrt(SLACK / far)])
            for b, far in others.items()
            if a in number and a < b
        ]
    for a, b, c in triples(grid, ways):
        if b in number:
            before, behind = grid.neighbours[a][b], grid.neighbours[b][c]
            w = math.sqrt(BEND / (0.5 * (before + behind)))
            rows.append(([number[a], number[b], number[c]], [w / before, -w / before - w / behind, w / behind]))
    rows += [([number[node]], [1.0 / SIGMA]) for node in tags]
    mean = sum(tags.values()) / len(tags)
    wanted = np.zeros(len(rows))
    wanted[len(rows) - len(tags) :] = (np.array(list(tags.values())) - mean) / SIGMA
    i = [k for k, (columns, _) in enumerate(rows) for _ in columns]
    j, v = ([each for row in rows for each in row[side]] for side in (0, 1))
    A = coo_matrix((v, (i, j)), shape=(len(rows), len(part))).tocsc()
    z = np.atleast_1d(spsolve((A.T @ A).tocsc(), A.T @ wanted)) + mean
    return dict(zip(part, z.round(PLACES).tolist(), strict=True))


def triples(grid: Grid, ways: list[Way]) -> set[tuple[int, int, int]]:
    """Three nodes in a row along a way, and where just two ways meet; each once."""
    found = {(a, b, c) for way in ways for a, b, c in zip(way.nodes, way.nodes[1:], way.nodes[2:], strict=False)}
    found |= {(a, b, c) for b, others in grid.neighbours.items() if len(others) == 2 for a, c in [tuple(others)]}
    kept = {(min(a, c), b, max(a, c)) for a, b, c in found if a != c and a != b != c}
    return {(a, b, c) for a, b, c in kept if b in grid.neighbours[a] and c in grid.neighbours[b]}


def spot(node: int, grid: Grid, box: Box) -> Spot:
    """A node as something that one can point at."""
    longitude, latitude = box.degrees(grid.places[node][:, None])[0]
    return Spot(named("node", node), latitude, longitude)


# -- heights of the lanes --------------------------------------------------------------------------


def with_heights(net: Net, ways: list[Way], grid: Grid, land: Heights, storeys: Heights) -> Net:
    """Lanes of roads have the height of the ways that they are made of, that of the land and of the storeys above or below it."""
    lifts = laid(net, ways, grid, storeys)
    whole = laid(net, ways, grid, {node: land.get(node, 0.0) + storeys.get(node, 0.0) for node in land | storeys}) if land else lifts
    lanes = [replace(lane, height=z) if (z := whole.get(lane.id)) is not None else lane for lane in net.lanes]
    lanes = [replace(lane, lift=z) if (z := lifts.get(lane.id)) is not None and z.any() else lane for lane in lanes]
    return replace(net, lanes=tuple(lanes))


def laid(net: Net, ways: list[Way], grid: Grid, heights: Heights) -> dict[int, np.ndarray]:
    """The heights along those lanes that are not all at height 0, by the nodes' [m]; ways through junctions rise evenly."""
    if not heights:
        return {}
    lines = {
        way.id: (np.array([grid.places[node] for node in way.nodes]).T, np.array([heights.get(node, 0.0) for node in way.nodes]))
        for way in ways
    }
    found: dict[int, np.ndarray] = {}
    for lane in net.lanes:
        own = [lines[name] for name in net.origins.get(lane.road, ()) if name in lines]
        if not lane.internal and (not own or any(z.any() for _, z in own)):
            found[lane.id] = height_along(lane.centre, own or list(lines.values()))
    for each in net.connections:
        ends = [float(found[lane][at]) if lane in found else 0.0 for lane, at in ((each.from_lane, -1), (each.to_lane, 0))]
        if any(ends):
            found |= risen([net.lanes[lane] for lane in each.via], *ends)
    return found


def height_along(centre: np.ndarray, lines: list[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """Height [m] at points: that of the nearest place on the nearest of some lines."""
    points = shapely.points(centre.T)
    forms = [shapely.LineString(line.T) for line, _ in lines]
    away = np.array([shapely.distance(form, points) for form in forms])
    at = np.array(
        [np.interp(shapely.line_locate_point(form, points), curve.stations(line), z) for form, (line, z) in zip(forms, lines, strict=True)]
    )
    return at[away.argmin(axis=0), np.arange(centre.shape[1])]


def risen(via: list[Lane], a: float, b: float) -> dict[int, np.ndarray]:
    """The heights along the ways through a junction, which rise evenly from one lane's end to the next one's start."""
    total, done, found = sum(lane.length for lane in via), 0.0, {}
    for lane in via:
        found[lane.id] = np.interp(done + curve.stations(lane.centre), [0.0, max(total, 1e-6)], [a, b])
        done += lane.length
    return found
