"""Corners: how much a driver sees, past buildings, of a strand on which others come to where his own meets it.

At every meeting of two ways the eye is moved up to the place where they meet, and from there the partner is looked along against its
direction, until a building hides it. Beyond its own beginning a way is followed along the lanes from which one comes to it most straightly.
What a map knows nothing of, and bridges and tunnels, hide nothing.
"""

import numpy as np

from studio.compiled import compiled
from studio.road import kept
from studio.road.network import Connection, Network
from studio.road.network.index import once
from studio.road.network.shadow import EYE, content, shadow_of, walls_between
from studio.road.ways.conflict import NONE
from studio.road.ways.meeting import Meetings, level, meetings_of
from studio.road.ways.path import PATH_HEADING, PATH_X, PATH_Y
from studio.road.ways.strand import Strands, strands_of

APART, SAMPLES = 4, 8  # [m] apart are the places from which one looks, the first where strands meet
BEHIND = 2  # [m] behind the front bumper are the eyes
STEP, FAR = 2, 120  # [m] in which a strand is looked along; who sees so far sees enough
REACH = FAR + APART * SAMPLES + BEHIND  # [m]


@once
def sights_of(network: Network) -> np.ndarray:
    """How far one sees along the partner of each meeting from where they meet [m], float64[SAMPLES, meeting]; kept on disk."""
    found = content(network.scenery.buildings)
    return kept.of_map(network.digest, "corners", np.ndarray, lambda: made(network), *found, maker=__file__)


def made(network: Network) -> np.ndarray:
    """The same, made anew."""
    met, shadow = meetings_of(network), shadow_of(network)
    sights = np.full((SAMPLES, met.partner.size), float(FAR))
    if not network.scenery.buildings:
        return sights
    strands, own = strands_of(network), np.repeat(np.arange(met.first.size - 1), np.diff(met.first))
    lines = Lines(network, strands)
    for m in np.flatnonzero(met.turn != NONE).tolist():
        a, b = int(own[m]), int(met.partner[m])
        if min(a, b) >= strands.lanes and is_on_ground(network, strands, met, a, b, m):
            look(shadow, *lines.before(a, met.span[0, m]), *lines.before(b, met.span[2, m]), sights[:, m])
    return sights


def is_on_ground(network: Network, strands: Strands, met: Meetings, a: int, b: int, m: int) -> bool:
    """Whether neither of two who meet comes over a bridge or through a tunnel."""
    return not any(level(network, strands, strand, span) for strand, span in ((a, met.span[:2, m]), (b, met.span[2:, m])))


class Lines:
    """Lines against the direction of travel, points a metre apart, from the end of a way to what is driven before it."""

    def __init__(self, network: Network, strands: Strands) -> None:
        self.network, self.strands = network, strands
        self.to: dict[int, list[int]] = {}
        for number, each in enumerate(network.connections):
            self.to.setdefault(each.to_lane, []).append(number)
        self.known: dict[int, np.ndarray] = {}

    def before(self, way: int, station: float) -> tuple[np.ndarray, int]:
        """The line of a way, and the number of its point at a station [m]."""
        if way not in self.known:
            self.known[way] = self.line(way)
        return self.known[way], max(round(self.strands.length[way] - station), 0)

    def line(self, way: int) -> np.ndarray:
        """float64[2, n] of a way and what leads to it, as far back as REACH [m]."""
        pieces, strand, left, passed = [], way, REACH + self.strands.length[way], set()
        while strand >= 0 and strand not in passed and left > 0.0:
            passed.add(strand)
            pieces.append(self.points(strand)[[PATH_X, PATH_Y]][:, ::-1])
            left -= self.strands.length[strand]
            strand = self.leads_to(strand)
        flat = np.concatenate(pieces, axis=1)
        s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(flat)))])
        at = np.arange(min(int(s[-1]), int(REACH + self.strands.length[way])) + 1)
        return np.array([np.interp(at, s, row) for row in flat])

    def leads_to(self, strand: int) -> int:
        """From which strand one comes onto another, the straightest of several; -1 where the map begins."""
        connections, lanes = self.network.connections, self.strands.lanes
        if strand >= lanes:
            return connections[strand - lanes].from_lane
        ways = [number for number in self.to.get(strand, []) if self.strands.count[lanes + number] > 1]
        return lanes + min(ways, key=lambda number: self.turned(connections[number])) if ways else -1

    def turned(self, connection: Connection) -> float:
        """How far a way turns [rad]."""
        end, start = (self.points(lane)[PATH_HEADING] for lane in (connection.from_lane, connection.to_lane))
        return abs((start[0] - end[-1] + np.pi) % (2.0 * np.pi) - np.pi) if end.size and start.size else np.pi

    def points(self, strand: int) -> np.ndarray:
        """The points of a strand."""
        first = self.strands.first[strand]
        return self.strands.points[:, first : first + self.strands.count[strand]]


@compiled
def look(shadow, own, meet, its, there, sight):
    """How far [m] one sees along a line from its point `there` on, from places every APART metres before the own point `meet`."""
    for i in range(sight.size):
        eye = min(meet + i * APART + BEHIND, own.shape[1] - 1)
        sight[i] = seen(shadow, own[0, eye], own[1, eye], its, there)


@compiled
def seen(shadow, x, y, line, there):
    """How far [m] a line is seen from a place, from a point of it on."""
    for k in range(there, min(there + FAR, line.shape[1]), STEP):
        if walls_between(shadow, 0, x, y, EYE, line[0, k], line[1, k], EYE)[0] > 0:
            return float(k - there)
    return float(FAR)
