"""From an OpenDRIVE document to lanes, roads, connections and junctions.

    piece   a stretch of a road in which nothing begins or ends: from one lane section, limit or stop line to the next
    atom    one lane of one piece: (road, number of the piece, number of the lane)
    chain   atoms of one direction that go on into each other alike; it becomes a road of the network, its lanes our lanes

Links of the document say where atoms touch; which of two touching atoms leads to the other follows from the sides on which
one drives. Pieces of connecting roads, and what lies between a stop line and its junction, are ways through the junction.
"""

import math
from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
import shapely

from studio import portable
from studio.errors import MapError
from studio.road.formats.xodr import DRIVABLE, KEPT_FOR_OTHERS, Document, Light, Section, Strip, XRoad
from studio.road.network import Connection, Lane, Net, Road, curve
from studio.road.network.report import Notes, Spot

NARROWEST = 1.8  # [m] a narrower lane holds no car
VARYING = 0.3  # [m] by which a lane's width may vary without a word
STOP_REACH = 25.0  # [m] before a junction its traffic lights stand
TORN, STRETCHED = 2.0, 3.0  # [m] and [1]: a reference line may leap that far, and be so much longer than its stations say
HIGHEST = 10_000.0  # [m]
FARTHEST = 1000.0  # [m] of a lane from its reference line
AT_END = 0.5  # [m] a stop line nearer to the end of its lane stands at it
STRAIGHT, TURN = np.radians(25.0), np.radians(60.0)  # [rad] a way through a junction that turns less goes straight, or is slight
SEAM = 0.3  # [m] gaps narrower than twice this between the ways through a junction are closed
EVEN = 0.01  # [m/s] limits that differ less are one

Atom = tuple[str, int, int]


@dataclass(frozen=True, eq=False)
class Piece:
    """A stretch of a road from `start` to `end` [m]; `speeds` [m/s] by lane; `inner` lie between a stop line and a junction."""

    start: float
    end: float
    section: Section
    speeds: dict[int, float]


@dataclass
class Graph:
    """What is known while the network is put together."""

    document: Document
    pieces: dict[str, list[Piece]] = field(default_factory=dict)
    after: dict[Atom, list[Atom]] = field(default_factory=lambda: defaultdict(list))
    before: dict[Atom, list[Atom]] = field(default_factory=lambda: defaultdict(list))
    stops: set[Atom] = field(default_factory=set)  # atoms that end at a stop line
    inner: set[Atom] = field(default_factory=set)  # atoms that are ways through a junction
    places: list[np.ndarray] = field(default_factory=list)  # of the lights [m]


Limit = Callable[[XRoad, float], float]


def net(document: Document, limit: Limit, spot: Callable[[str, float], Spot], notes: Notes) -> tuple[Net, list[np.ndarray]]:
    """The network of a document, and where its traffic lights stand [m].

    limit(road, s) gives the speed [m/s] that holds for a road at a station where no lane has its own; spot(road, s) a place.

    Raises:
        MapError: cars can drive nowhere.
    """
    graph = Graph(document)
    for road in document.roads.values():
        graph.pieces[road.id] = list(cut(road, limit))
    join(graph, spot, notes)
    for road in document.roads.values():
        for light in road.lights:
            place(graph, road, light, spot, notes)
    graph.stops -= graph.inner  # a light that is repeated within the junction has one stop line
    chains = [chain for road in document.roads.values() for chain in chains_of(graph, road)]
    if not any(chain[0][0] not in graph.inner for chain in chains):
        raise MapError("there are no roads for cars in this map: no <lane> of a <road> outside of junctions is for them")
    return built(graph, chains, spot, notes), graph.places


# -- pieces ----------------------------------------------------------------------------------------


def cut(road: XRoad, limit: Limit) -> Iterator[Piece]:
    """The pieces of a road: cut where a section begins, a limit changes, or a light of its own stands before the road's end."""
    ends = [*(section.s for section in road.sections[1:]), road.length]
    for section, end in zip(road.sections, ends, strict=True):
        cuts = {section.s, *(s for s, *_ in road.kinds), *(light.s for light in road.lights)}
        cuts |= {section.s + s for strip in section.strips.values() for s, _ in strip.speeds}
        inside = sorted(s for s in cuts if s == section.s or section.s + AT_END < s < end - AT_END)
        for a, b in zip(inside, [*inside[1:], end], strict=True):
            speeds = {
                name: speed_of(road, section, strip, a, limit) for name, strip in section.strips.items() if is_used(section, strip, end)
            }
            yield Piece(a, b, section, speeds)


def speed_of(road: XRoad, section: Section, strip: Strip, s: float, limit: Limit) -> float:
    """The limit of a lane at a station: its own, else the road's [m/s]."""
    own = [value for at, value in strip.speeds if section.s + at <= s + AT_END]
    return own[-1] if own and math.isfinite(own[-1]) else limit(road, s)


def is_used(section: Section, strip: Strip, end: float) -> bool:
    """Whether a lane becomes one of ours: it is for vehicles, and a car fits into it."""
    if strip.type not in DRIVABLE | KEPT_FOR_OTHERS:
        return False
    return float(strip.width.at(np.linspace(0.0, end - section.s, 33)).max()) >= NARROWEST


def is_forward(road: XRoad, lane: int) -> bool:
    """Whether one drives along the reference line on a lane, and not against it."""
    return (lane < 0) != road.left_hand


# -- which atom leads to which ---------------------------------------------------------------------


def join(graph: Graph, spot, notes: Notes) -> None:
    """Finds every pair of atoms of which one leads to the other."""
    for road in graph.document.roads.values():
        join_pieces(graph, road)
        for link, end in ((road.before, "start"), (road.after, "end")):
            if link is not None and link.kind == "road":
                join_roads(graph, road, end, link.id, link.contact)
    for name, joins in graph.document.junctions.items():
        for each in joins:
            join_junction(graph, name, each, spot, notes)


def join_pieces(graph: Graph, road: XRoad) -> None:
    """The lanes of a road from piece to piece."""
    pieces = graph.pieces[road.id]
    for k, (a, b) in enumerate(pairwise(pieces)):
        if a.section is b.section:
            pairs = {(lane, lane) for lane in a.speeds}
        else:
            pairs = {(lane, other) for lane in a.speeds for other in a.section.strips[lane].after}
            pairs |= {(other, lane) for lane in b.speeds for other in b.section.strips[lane].before}
        for lane, other in sorted(pairs):
            touch(graph, (road.id, k, lane), "end", (road.id, k + 1, other), "start")


def join_roads(graph: Graph, road: XRoad, end: str, other: str, contact: str) -> None:
    """The lanes of a road from its end to another road."""
    if other not in graph.document.roads:
        graph.document.remark("link", f"to road {other}", road.id, station(road, end), "there is no such road")
        return
    k, there = at_end(graph, road.id, end), at_end(graph, other, contact)
    piece = graph.pieces[road.id][k]
    for lane in piece.speeds:
        strip = piece.section.strips[lane]
        for to in strip.after if end == "end" else strip.before:
            touch(graph, (road.id, k, lane), end, (other, there, to), contact)


def join_junction(graph: Graph, name: str, each, spot, notes: Notes) -> None:
    """The lanes of one `<connection>`: from the end of the incoming road that lies at the connecting one."""
    incoming, connecting = graph.document.roads[each.incoming], graph.document.roads[each.connecting]
    ends = [end for link, end in ((incoming.before, "start"), (incoming.after, "end")) if link is not None and link.id == name]
    x, y = end_point(connecting, each.contact)
    far = {end: float(np.hypot(*(end_point(incoming, end) - (x, y)))) for end in ends or ("start", "end")}
    end = min(far, key=far.__getitem__)
    k, there = at_end(graph, incoming.id, end), at_end(graph, connecting.id, each.contact)
    links = each.lanes
    if not links and not (connecting.before if each.contact == "start" else connecting.after):
        same = sorted(set(graph.pieces[incoming.id][k].speeds) & set(graph.pieces[connecting.id][there].speeds))
        links = tuple((lane, lane) for lane in same)
        at = spot(connecting.id, 0.0)
        notes.guess("lane links", f"road {incoming.id} to road {connecting.id}", at, source="no <laneLink>: equal numbers", sure="medium")
    for lane, other in links:
        touch(graph, (incoming.id, k, lane), end, (connecting.id, there, other), each.contact)


def station(road: XRoad, end: str) -> float:
    """The station of an end of a road [m]."""
    return 0.0 if end == "start" else road.length


def end_point(road: XRoad, end: str) -> np.ndarray:
    """Where the reference line starts or ends [m]."""
    return road.line.at(np.array([station(road, end)]))[:2, 0]


def at_end(graph: Graph, road: str, end: str) -> int:
    """The number of the piece at an end of a road."""
    return 0 if end == "start" else len(graph.pieces[road]) - 1


def touch(graph: Graph, a: Atom, a_end: str, b: Atom, b_end: str) -> None:
    """Two atoms touch at these ends of their roads; the one that is left there leads to the one that is entered there."""
    roads = graph.document.roads
    if any(lane not in graph.pieces[road][k].speeds for road, k, lane in (a, b)):
        return
    a_leaves = is_forward(roads[a[0]], a[2]) == (a_end == "end")
    b_leaves = is_forward(roads[b[0]], b[2]) == (b_end == "end")
    if a_leaves == b_leaves:
        what = f"lane {a[2]} with lane {b[2]} of road {b[0]}"
        graph.document.remark("link", what, a[0], station(roads[a[0]], a_end), "they are driven in opposite directions")
        return
    start, goal = (a, b) if a_leaves else (b, a)
    if goal not in graph.after[start]:
        graph.after[start].append(goal)
        graph.before[goal].append(start)


# -- traffic lights --------------------------------------------------------------------------------


def place(graph: Graph, road: XRoad, light: Light, spot, notes: Notes) -> None:
    """The stop lines of one light: where it stands, or, within a junction, before it."""
    x, y, _ = road.line.at(np.array([light.s]))[:, 0]
    graph.places.append(np.array([x, y]))
    stopped = set(guarded(graph, road, light))
    if road.junction != "-1":
        stopped = {atom for lane in stopped for atom in led_from(graph, lane)}
    graph.stops |= stopped
    if road.junction == "-1":
        for atom in stopped:
            graph.inner |= rest(graph, road, atom)
    if not stopped:
        notes.skip("signal", f"traffic light {light.id}", spot(road.id, light.s), "no lane for cars leads to it")


def guarded(graph: Graph, road: XRoad, light: Light) -> Iterator[Atom]:
    """The atoms that end at a light."""
    for k, piece in enumerate(graph.pieces[road.id]):
        for lane in piece.speeds:
            forward = is_forward(road, lane)
            valid = not light.lanes or any(a <= lane <= b for a, b in light.lanes)
            meant = light.orientation == "none" or (light.orientation == "+") == forward
            if road.junction != "-1":
                ends = k == (0 if forward else len(graph.pieces[road.id]) - 1)
            else:
                ends = abs((piece.end if forward else piece.start) - light.s) <= AT_END
            if valid and meant and ends:
                yield road.id, k, lane


def led_from(graph: Graph, atom: Atom) -> Iterator[Atom]:
    """The atoms outside of junctions from which one comes to an atom within one."""
    waiting, seen = [atom], set()
    while waiting:
        for each in graph.before[waiting.pop()]:
            if graph.document.roads[each[0]].junction == "-1":
                yield each
            elif each not in seen:
                seen.add(each)
                waiting.append(each)


def rest(graph: Graph, road: XRoad, atom: Atom) -> set[Atom]:
    """What lies between a stop line and the junction behind it, if that is near."""
    found, waiting, length = set(), list(graph.after[atom]), 0.0
    while waiting:
        each = waiting.pop()
        if each[0] != road.id:
            return found if graph.document.roads[each[0]].junction != "-1" else set()
        piece = graph.pieces[road.id][each[1]]
        length += piece.end - piece.start
        if each in found or length > STOP_REACH:
            return set()
        found.add(each)
        waiting = list(graph.after[each])
    return set()


# -- chains ----------------------------------------------------------------------------------------


def chains_of(graph: Graph, road: XRoad) -> Iterator[list[tuple[Atom, ...]]]:
    """The chains of a road: lanes from the kerb inwards, each the atoms along it in the direction of driving."""
    for forward in (True, False):
        order = range(len(graph.pieces[road.id])) if forward else range(len(graph.pieces[road.id]) - 1, -1, -1)
        rows = [atoms_of(graph, road, k, forward=forward) for k in order]
        chain: list[tuple[Atom, ...]] = []
        for row in rows:
            if chain and goes_on(graph, [lane[-1] for lane in chain], row):
                chain = [(*lane, atom) for lane, atom in zip(chain, row, strict=True)]
                continue
            if chain:
                yield chain
            chain = [(atom,) for atom in row]
        if chain:
            yield chain


def atoms_of(graph: Graph, road: XRoad, k: int, *, forward: bool) -> list[Atom]:
    """The atoms of a piece in one direction, the kerb lane first."""
    lanes = [lane for lane in graph.pieces[road.id][k].speeds if is_forward(road, lane) == forward]
    return [(road.id, k, lane) for lane in sorted(lanes, key=abs, reverse=True)]


def goes_on(graph: Graph, row: list[Atom], following: list[Atom]) -> bool:
    """Whether lanes just go on, each into one, with the limit that they have, and no stop line between."""
    if len(row) != len(following) or any(atom in graph.stops for atom in row):
        return False
    return all(is_same(graph, a, b) for a, b in zip(row, following, strict=True))


def is_same(graph: Graph, a: Atom, b: Atom) -> bool:
    """Whether two atoms are one lane."""
    if graph.after[a] != [b] or graph.before[b] != [a] or (a in graph.inner) != (b in graph.inner):
        return False
    (road, i, lane), (_, j, other) = a, b
    first, second = graph.pieces[road][i], graph.pieces[road][j]
    alike = first.section.strips[lane].open == second.section.strips[other].open
    return alike and abs(first.speeds[lane] - second.speeds[other]) < EVEN


# -- the network -----------------------------------------------------------------------------------


def built(graph: Graph, chains: list[list[tuple[Atom, ...]]], spot, notes: Notes) -> Net:
    """Lanes, roads, connections and junctions."""
    lanes: list[Lane] = []
    roads: dict[str, Road] = {}
    number: dict[Atom, int] = {}
    sampled = {road.id: samples(road, graph.pieces[road.id]) for road in graph.document.roads.values()}
    for chain in chains:
        first = chain[0][0]
        road = graph.document.roads[first[0]]
        internal = road.junction != "-1" or first in graph.inner
        name = free_name(name_of(graph, road, chain), roads, internal=internal)
        own = []
        for index, atoms in enumerate(chain):
            lane = lane_of(graph, road, atoms, sampled[road.id], spot, notes)
            lane = replace(lane, id=len(lanes), road=name, index=index, internal=internal)
            number |= dict.fromkeys(atoms, lane.id)
            lanes.append(lane)
            own.append(lane)
        roads[name] = Road(
            id=name, name=road.name, lanes=tuple(lane.id for lane in own), from_junction=junction_at(graph, chain, 0),
            to_junction=junction_at(graph, chain, -1), speed=max(lane.speed for lane in own),
            length=sum(lane.length for lane in own) / len(own), internal=internal,
        )  # fmt: skip
    onward = {}
    for chain in chains:
        for atoms in chain:
            onward[number[atoms[0]]] = [number[each] for each in graph.after[atoms[-1]]]
    signalled = frozenset(number[atom] for atom in graph.stops)
    origin = {number[atoms[0]]: atoms[0][0] for chain in chains for atoms in chain}
    return Net(tuple(lanes), roads, tuple(connections(lanes, onward, origin)), tuple(junctions(graph, lanes, origin)), signalled, {})


def name_of(graph: Graph, road: XRoad, chain: list[tuple[Atom, ...]]) -> str:
    """The id of a chain: its road's, with "-" where it is driven against the reference line, and the piece if it is not the first."""
    first = min(chain[0], key=lambda atom: atom[1])
    others = {k for _, k, lane in chain[0]}
    sign = "" if is_forward(road, first[2]) else "-"
    behind = "" if min(others) == 0 else f"#{min(others)}"
    return f"{sign}{road.id}{behind}"


def free_name(name: str, roads: dict[str, Road], *, internal: bool) -> str:
    """The name, marked if it is a way through a junction; a document may have a road "-1" besides the way back on "1"."""
    name = f":{name}" if internal else name
    while name in roads:
        name += "'"
    return name


def junction_at(graph: Graph, chain: list[tuple[Atom, ...]], end: int) -> str:
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


@dataclass(frozen=True, eq=False)
class Samples:
    """The reference line at stations s [m]: x, y, heading, height, lane offset."""

    s: np.ndarray
    line: np.ndarray
    height: np.ndarray
    offset: np.ndarray


def samples(road: XRoad, pieces: list[Piece]) -> Samples:
    """A road at all stations that its pieces need."""
    s = np.union1d(road.line.stations(road.length), [at for piece in pieces for at in (piece.start, piece.end)])
    found = Samples(s, road.line.at(s), road.elevation.at(s), road.offset.at(s))
    steps = np.hypot(*np.diff(found.line[:2]))
    if not (steps <= TORN + STRETCHED * np.diff(s)).all():
        at = s[int(np.argmax(~(steps <= TORN + STRETCHED * np.diff(s))))]
        raise MapError(f"road {road.id}, <geometry> at s = {at:.6g}: its curve is far longer than its length")
    if not (np.abs(found.height) <= HIGHEST).all():
        raise MapError(f"road {road.id}: <elevation> leaves the heights of roads; allowed: up to {HIGHEST:g} m")
    return found


def lane_of(graph: Graph, road: XRoad, atoms: tuple[Atom, ...], along: Samples, spot, notes: Notes) -> Lane:
    """The lane of some atoms; its place in the network is not known yet."""
    lines, heights, widths = [], [], []
    for _, k, lane in sorted(atoms, key=lambda atom: atom[1]):
        line, height, width = strip_line(road.id, graph.pieces[road.id][k], lane, along)
        lines.append(line)
        heights.append(height)
        widths.append(width)
    centre, height = np.concatenate(lines, axis=1), np.concatenate(heights)
    if not is_forward(road, atoms[0][2]):
        centre, height = centre[:, ::-1], height[::-1]
    keep = np.append(True, np.hypot(*np.diff(centre)) > 1e-6)
    if keep.sum() < 2:
        raise MapError(f"road {road.id}: <lane> {atoms[0][2]} is a point")
    centre, height, width = centre[:, keep].copy(), height[keep].copy(), np.concatenate(widths)
    usual = float(np.median(width))
    if np.ptp(width) > VARYING:
        piece = graph.pieces[road.id][atoms[0][1]]
        what = f"lane {atoms[0][2]}: {max(usual, NARROWEST):.2f} m throughout"
        at = spot(road.id, piece.start)
        notes.guess("lane width", what, at, source=f"{width.min():.2f} to {width.max():.2f} m wide", sure="medium")
    strip = graph.pieces[road.id][atoms[0][1]].section.strips[atoms[0][2]]
    speed = graph.pieces[road.id][atoms[0][1]].speeds[atoms[0][2]]
    return Lane(0, "", 0, max(usual, NARROWEST), speed, centre, False, curve.length(centre), strip.open, height)


def strip_line(road: str, piece: Piece, lane: int, along: Samples) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Centre line float64[2, n], height and width [m] of a lane in one piece, along the reference line."""
    within = (piece.start - 1e-9 <= along.s) & (along.s <= piece.end + 1e-9)
    s, (x, y, heading) = along.s[within] - piece.section.s, along.line[:, within]
    sign = 1 if lane > 0 else -1
    inner = sum((piece.section.strips[sign * i].width.at(s) for i in range(1, abs(lane))), np.zeros_like(s))
    width = np.maximum(piece.section.strips[lane].width.at(s), 0.0)
    t = along.offset[within] + sign * (inner + 0.5 * width)
    if not (np.abs(t) <= FARTHEST).all():
        raise MapError(
            f"road {road}: <lane> {lane} of the <laneSection> at s = {piece.section.s:g} lies more than {FARTHEST:g} m beside its road"
        )
    return np.array([x - t * np.sin(heading), y + t * np.cos(heading)]), along.height[within], width


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
