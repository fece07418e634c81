"""Rounds mapped ways: a mapper draws a bend as a few straight pieces, a road is built as a curve.

The mapped nodes stay where they are; between them points of a cubic curve are put in. Real corners stay corners.
"""

import itertools
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from studio import portable
from studio.road.formats.osm import Box
from studio.road.formats.way import Way, is_one_way

CORNER = np.radians(40.0)  # [rad] a sharper turn is a corner
STRAIGHT = np.radians(1.5)  # [rad] a lesser turn needs no curve
SPACING = 3.0  # [m] of the points put in
EASE = 20.0  # [m] on which a long straight may bend at its ends; between them it stays as mapped

Point = np.ndarray


def rounded(ways: list[Way], box: Box, new_id: Iterator[int]) -> list[Way]:
    """The ways with curves in their bends; bends also run on from one way into the next."""
    ways = [staked(way, box, new_id) for way in ways]
    places = local_places(ways, box)
    ahead, behind = neighbours(ways)
    return [bent(way, places, ahead, behind, box, new_id) for way in ways]


def staked(way: Way, box: Box, new_id: Iterator[int]) -> Way:
    """The way with nodes `EASE` from both ends of its long straights."""
    line = box.local(*np.array(way.points).T[::-1])
    nodes, points = [way.nodes[0]], [way.points[0]]
    for i, (a, b) in enumerate(itertools.pairwise(line.T)):
        far = np.hypot(*(b - a))
        if far > 3.0 * EASE:
            nodes += [next(new_id), next(new_id)]
            points += box.degrees(np.column_stack([a + (b - a) * EASE / far, b - (b - a) * EASE / far]))
        nodes.append(way.nodes[i + 1])
        points.append(way.points[i + 1])
    return replace(way, nodes=nodes, points=points)


def local_places(ways: list[Way], box: Box) -> dict[int, Point]:
    """Every node of the ways in local metres."""
    nodes = {node: point for way in ways for node, point in zip(way.nodes, way.points, strict=True)}
    longitude, latitude = np.array(list(nodes.values())).T
    return dict(zip(nodes, box.local(latitude, longitude).T, strict=True))


def neighbours(ways: list[Way]) -> tuple[dict[int, set[int]], dict[int, set[int]]]:
    """For every node the nodes that come after it and before it; a two-way street has both on either side."""
    ahead, behind = defaultdict(set), defaultdict(set)
    for way in ways:
        pairs = list(itertools.pairwise(way.nodes))
        for a, b in pairs if is_one_way(way) else [*pairs, *((b, a) for a, b in pairs)]:
            ahead[a].add(b)
            behind[b].add(a)
    return ahead, behind


def bent(way: Way, places, ahead, behind, box: Box, new_id: Iterator[int]) -> Way:
    """One way with curves in its bends."""
    line = [places[node] for node in way.nodes]
    before = straightest(places, behind[way.nodes[0]], way.nodes[1], way.nodes[0])
    after = straightest(places, ahead[way.nodes[-1]], way.nodes[-2], way.nodes[-1])
    tangents = tangents_of(line, before, after)
    nodes, points = [way.nodes[0]], [way.points[0]]
    for i in range(len(line) - 1):
        inner = hermite(line[i], line[i + 1], tangents[i][1], tangents[i + 1][0])
        nodes += itertools.islice(new_id, inner.shape[1])
        points += box.degrees(inner)
        nodes.append(way.nodes[i + 1])
        points.append(way.points[i + 1])
    return replace(way, nodes=nodes, points=points)


def straightest(places, candidates: set[int], beside: int, node: int) -> Point | None:
    """The neighbour on the other side of the end node that goes on most nearly straight, if none is a corner."""
    others = [places[other] for other in candidates if other != beside]
    best = min(others, key=lambda other: turn(places[beside], places[node], other), default=None)
    return best if best is not None and turn(places[beside], places[node], best) < CORNER else None


def turn(a: Point, b: Point, c: Point) -> float:
    """How much one turns at b on the way from a to c [rad], 0 for straight on."""
    return abs(portable.turn(b - a, c - b))


def tangents_of(line: list[Point], before: Point | None, after: Point | None) -> list[tuple[Point, Point]]:
    """At every point the directions of the curve that arrives and of the one that leaves; they differ at corners."""
    found = [tangent(a, b, c) for a, b, c in zip([before, *line[:-1]], line, [*line[1:], after], strict=True)]
    lone = [is_straight(line, i - 1) and is_straight(line, i + 1) for i in range(len(line))]
    return [edge(line, i) if alone and 0 < i < len(line) - 1 else both for i, (both, alone) in enumerate(zip(found, lone, strict=True))]


def is_straight(line: list[Point], i: int) -> bool:
    """Whether a line does not turn at a point; at its ends it does, as far as it knows."""
    return 0 < i < len(line) - 1 and turn(*line[i - 1 : i + 2]) < STRAIGHT


def edge(line: list[Point], i: int) -> tuple[Point, Point]:
    """The directions at a turn between two straights: no node says how it is rounded, and a curve through it would bulge."""
    return unit(line[i] - line[i - 1]), unit(line[i + 1] - line[i])


def tangent(a: Point | None, b: Point, c: Point | None) -> tuple[Point, Point]:
    """Directions in which the curve arrives at b and leaves it."""
    if a is None or c is None:
        only = unit(b - a) if a is not None else unit(c - b)
        return only, only
    arriving, leaving = unit(b - a), unit(c - b)
    if turn(a, b, c) >= CORNER:
        return arriving, leaving
    # the circle through three points: the shorter side bends away from the tangent less, so it counts more
    before, behind = np.hypot(*(b - a)), np.hypot(*(c - b))
    middle = unit(behind * arriving + before * leaving)
    return middle, middle


def unit(direction: Point) -> Point:
    """The direction with length 1."""
    return direction / max(1e-9, float(np.hypot(*direction)))


def hermite(a: Point, b: Point, start: Point, end: Point, *, spacing: float = SPACING) -> np.ndarray:
    """Points of the cubic curve from a to b between its ends, about `spacing` [m] apart, float64[2, n]; none where it is straight."""
    chord = b - a
    far = np.hypot(*chord)
    straight = max(angle(chord, start), angle(chord, end)) < STRAIGHT
    count = 0 if straight else int(far / spacing)
    u = np.linspace(0.0, 1.0, count + 2)[1:-1]
    p, q, s, t = (vector[:, None] for vector in (a, b, start * far, end * far))
    u2, u3 = u * u, u * u * u
    return (2 * u3 - 3 * u2 + 1) * p + (u3 - 2 * u2 + u) * s + (3 * u2 - 2 * u3) * q + (u3 - u2) * t


def angle(a: Point, b: Point) -> float:
    """The angle between two directions [rad]."""
    return abs(portable.turn(a, b))
