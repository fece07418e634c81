"""The network of an OpenDRIVE document: lanes, roads, connections and junctions, and who goes first.

Pieces of connecting roads, and what lies between a stop line and its junction, are ways through the junction.
"""

from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
import shapely

from studio import portable
from studio.errors import MapError
from studio.road.network import Connection, Lane, Net, Pair, Road, curve
from studio.road.network.report import Notes, Spot
from studio.road.opendrive.chain import chains_of
from studio.road.opendrive.document import Document, XRoad
from studio.road.opendrive.graph import Atom, Graph, Limit, graph_of
from studio.road.opendrive.lane import UNUSABLE
from studio.road.opendrive.stop import signed, stop_lines
from studio.road.opendrive.width import NARROWEST

VARYING = 0.3  # [m] by which a lane's width may vary without a word
STRAIGHT, TURN = np.radians(25.0), np.radians(60.0)  # [rad] a way through a junction that turns less goes straight, or is slight
SEAM = 0.3  # [m] gaps narrower than twice this between the ways through a junction are closed

Chain = list[tuple[Atom, ...]]


@dataclass(frozen=True, eq=False)
class Build:
    """A network, where its traffic lights stand [m], the rule that signs set at ends of roads, and pairs of which one goes first."""

    net: Net
    places: list[np.ndarray]
    signs: dict[str, str]
    before: frozenset[tuple[Pair, Pair]]


def build(document: Document, limit: Limit, spot: Callable[[str, float], Spot], notes: Notes) -> Build:
    """The network of a document.

    limit(road, s) gives the speed [m/s] that holds for a road at a station where no lane has its own; spot(road, s) a place.

    Raises:
        MapError: cars can drive nowhere.
    """
    graph = graph_of(document, limit)
    stop_lines(graph, spot, notes)
    chains = [chain for road in document.roads.values() for chain in chains_of(graph, road)]
    if not any(chain[0][0] not in graph.inner for chain in chains):
        left_out = sorted((each.reason for each in document.remarks if each.kind in ("road", "lane")), key=lambda each: each == UNUSABLE)
        why = f"; {left_out[0]}" if left_out else ""
        raise MapError(f"there are no roads for cars in this map: no <lane> of a <road> outside of junctions is for them{why}")
    return built(graph, chains, spot, notes)


def built(graph: Graph, chains: list[Chain], spot, notes: Notes) -> Build:
    """Lanes, roads, connections and junctions."""
    lanes: list[Lane] = []
    roads: dict[str, Road] = {}
    number: dict[Atom, int] = {}
    for chain in chains:
        road = graph.document.roads[chain[0][0][0]]
        internal = road.junction != "-1" or chain[0][0] in graph.inner
        name = free_name(name_of(graph, chain), roads, internal=internal)
        own = []
        for index, atoms in enumerate(chain):
            lane = replace(lane_of(graph, road, atoms, spot, notes), id=len(lanes), road=name, index=index, internal=internal)
            number |= dict.fromkeys(atoms, lane.id)
            lanes.append(lane)
            own.append(lane)
        roads[name] = Road(
            id=name, name=road.name, lanes=tuple(lane.id for lane in own), from_junction=junction_at(graph, chain, 0),
            to_junction=junction_at(graph, chain, -1), speed=max(lane.speed for lane in own),
            length=sum(lane.length for lane in own) / len(own), internal=internal,
        )  # fmt: skip
    onward = {number[atoms[0]]: [number[each] for each in graph.after[atoms[-1]]] for chain in chains for atoms in chain}
    origin = {number[atoms[0]]: atoms[0][0] for chain in chains for atoms in chain}
    made = tuple(connections(lanes, onward, origin))
    signalled = frozenset(number[atom] for atom in graph.stops)
    net = Net(tuple(lanes), roads, made, tuple(junctions(graph, lanes, origin)), signalled, {}, rings=rings(graph, roads))
    signs = {lanes[number[atom]].road: rule for atom, rule in signed(graph).items()}
    return Build(net, graph.places, signs, frozenset(preferred(graph, net, origin)))


def rings(graph: Graph, roads: dict[str, Road]) -> frozenset[str]:
    """The roads of roundabouts: from one of their junctions to another."""
    return frozenset(
        road.id
        for road in roads.values()
        for ring in graph.document.rings
        if not road.internal and {road.from_junction, road.to_junction} <= ring
    )


def preferred(graph: Graph, net: Net, origin: dict[int, str]) -> Iterator[tuple[Pair, Pair]]:
    """The pairs of ways of which a junction says that one goes before the other; it names them by a connecting or an incoming road."""
    over: dict[tuple[str, str], set[Pair]] = defaultdict(set)
    for each in net.connections:
        pair = net.lanes[each.from_lane].road, net.lanes[each.to_lane].road
        for via in each.via:
            junction = graph.document.roads[origin[via]].junction
            over[junction, origin[via]].add(pair)
            over[junction, origin[each.from_lane]].add(pair)
    for name, junction in graph.document.junctions.items():
        for high, low in junction.priorities:
            yield from ((one, other) for one in over[name, high] for other in over[name, low] if one[0] != other[0])


def name_of(graph: Graph, chain: Chain) -> str:
    """The id of a chain: its road's, with "-" where it is driven against the reference line, and the piece if it is not the first."""
    first = min(chain[0], key=lambda atom: atom[1])
    sign = "" if graph.is_forward(first) else "-"
    behind = "" if first[1] == 0 else f"#{first[1]}"
    return f"{sign}{first[0]}{behind}"


def free_name(name: str, roads: dict[str, Road], *, internal: bool) -> str:
    """The name, marked if it is a way through a junction; a document may have a road "-1" besides the way back on "1"."""
    name = f":{name}" if internal else name
    while name in roads:
        name += "'"
    return name


def junction_at(graph: Graph, chain: Chain, end: int) -> str:
    """The junction at the start (0) or the end (-1) of a chain, or ""."""
    joined = graph.before if end == 0 else graph.after
    for atoms in chain:
        for each in joined[atoms[end]]:
            if each in graph.inner:
                onward = joined[each]
                each = onward[0] if onward else each
            junction = graph.document.roads[each[0]].junction
            if junction != "-1":
                return junction
    return ""


def lane_of(graph: Graph, road: XRoad, atoms: tuple[Atom, ...], spot, notes: Notes) -> Lane:
    """The lane of some atoms; its place in the network is not known yet."""
    lines = [graph.pieces[name][k].lines[lane] for name, k, lane in sorted(atoms, key=lambda atom: atom[1])]
    centre, height = np.concatenate([each.centre for each in lines], axis=1), np.concatenate([each.height for each in lines])
    level = np.concatenate([each.level for each in lines])
    if not graph.is_forward(atoms[0]):
        centre, height, level = centre[:, ::-1], height[::-1], level[::-1]
    keep = np.append(True, np.hypot(*np.diff(centre)) > 1e-6)
    centre, height, width = centre[:, keep].copy(), height[keep].copy(), np.concatenate([each.width for each in lines])
    usual, piece = float(np.median(width)), graph.pieces[road.id][atoms[0][1]]
    if np.ptp(width) > VARYING:
        what = f"lane {atoms[0][2]}: {max(usual, NARROWEST):.2f} m throughout"
        at = spot(road.id, piece.start)
        notes.guess("lane width", what, at, source=f"{width.min():.2f} to {width.max():.2f} m wide", sure="medium")
    strip = graph.strip(atoms[0])
    made = Lane(0, "", 0, max(usual, NARROWEST), piece.speeds[strip.id], centre, False, curve.length(centre), strip.open, height)
    return replace(made, level=level[keep].copy()) if level.any() else made


def connections(lanes: list[Lane], onward: dict[int, list[int]], origin: dict[int, str]) -> Iterator[Connection]:
    """The shortest way from every lane outside of junctions to every lane that follows it."""
    for start in lanes:
        if start.internal:
            continue
        found: dict[int, tuple[int, ...]] = {}
        waiting: list[tuple[int, tuple[int, ...]]] = [(each, ()) for each in onward[start.id]]
        while waiting:
            lane, via = waiting.pop(0)
            if not lanes[lane].internal:
                found.setdefault(lane, via)
            elif lane not in via:
                waiting += [(each, (*via, lane)) for each in onward[lane]]
        for end, via in sorted(found.items()):
            yield Connection(start.id, end, via, -1, direction(start, lanes[end], back=bool(via) and origin[start.id] == origin[end]))


def direction(a: Lane, b: Lane, *, back: bool) -> str:
    """Where a connection leads: "straight", "slight_left", "left", …, or "turn" where one comes back on the same road."""
    turn = portable.turn(a.centre[:, -1] - a.centre[:, -2], b.centre[:, 1] - b.centre[:, 0])
    if back and abs(turn) > np.pi / 2.0:
        return "turn"
    if abs(turn) < STRAIGHT:
        return "straight"
    side = "left" if turn > 0.0 else "right"
    return side if abs(turn) >= TURN else f"slight_{side}"


def junctions(graph: Graph, lanes: list[Lane], origin: dict[int, str]) -> Iterator[np.ndarray]:
    """The ground of every junction: its ways, with the gaps between them closed."""
    ways = defaultdict(list)
    for lane in lanes:
        junction = graph.document.roads[origin[lane.id]].junction
        if lane.internal and junction != "-1":
            ways[junction].append(
                shapely.LineString(lane.centre.T).buffer(lane.width / 2.0, cap_style="flat", join_style="mitre", mitre_limit=2.0)
            )
    for junction in sorted(ways):
        form = shapely.union_all(ways[junction]).buffer(SEAM, quad_segs=2).buffer(-SEAM, quad_segs=2)
        for part in shapely.get_parts(form):
            if part.geom_type == "Polygon" and part.area > 0.01:
                yield np.array(part.exterior.coords)[:-1].T.copy()
