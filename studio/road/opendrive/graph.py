"""From an OpenDRIVE document to lanes that lead to each other.

    piece   a stretch of a road in which nothing begins or ends: from one lane section, limit or stop line to the next
    atom    one lane of one piece: (road, number of the piece, number of the lane)

Links of the document say where atoms touch; which of two touching atoms leads to the other follows from the directions in which they
are driven. Where the lanes of two sections or roads that follow each other have no links at all, equal numbers of them are joined.
"""

import math
from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from studio.errors import MapError
from studio.road.opendrive.document import DRIVABLE, KEPT_FOR_OTHERS, Document, Join, Link, Section, Strip, XRoad
from studio.road.opendrive.file import leave_out
from studio.road.opendrive.sample import Line, samples, strip_line
from studio.road.opendrive.width import NARROWEST, is_wide

AT_END = 0.5  # [m] a stop line nearer to the end of its lane stands at it
SIDES = (-1, 1)

Atom = tuple[str, int, int]
Limit = Callable[[XRoad, float], float]


@dataclass(frozen=True, eq=False)
class Piece:
    """A stretch of a road from `start` to `end` [m]; `speeds` [m/s] and `lines` by lane, of those that cars or buses drive."""

    start: float
    end: float
    section: Section
    speeds: dict[int, float]
    lines: dict[int, Line] = field(default_factory=dict)


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
    told: set[frozenset[tuple[str, int, str]]] = field(default_factory=set)  # seams of which something is told

    def strip(self, atom: Atom) -> Strip:
        """The lane of an atom."""
        road, k, lane = atom
        return self.pieces[road][k].section.strips[lane]

    def is_forward(self, atom: Atom) -> bool:
        """Whether one drives along the reference line on an atom, and not against it."""
        return is_forward(self.document.roads[atom[0]], self.strip(atom))


def is_forward(road: XRoad, strip: Strip) -> bool:
    """Whether one drives along the reference line on a lane, and not against it."""
    return ((strip.id < 0) != road.left_hand) != (strip.direction == "reversed")


def graph_of(document: Document, limit: Limit) -> Graph:
    """The lanes of a document, joined; limit(road, s) is the speed [m/s] that holds where no lane has its own."""
    graph = Graph(document)
    for road in list(document.roads.values()):
        lay(graph, road, limit)
    join(graph)
    note_ends(graph)
    return graph


# -- pieces ----------------------------------------------------------------------------------------


def lay(graph: Graph, road: XRoad, limit: Limit) -> None:
    """Lays out a road; one whose curve or height cannot be is left out, and so is a lane that lies nowhere near its road."""
    pieces = list(cut(road, limit, graph.document))
    try:
        along = samples(road, [at for piece in pieces for at in (piece.start, piece.end)])
    except MapError as error:
        leave_out(graph.document, road.id, error.message)
        return
    for piece in pieces:
        for lane in list(piece.speeds):
            try:
                piece.lines[lane] = strip_line(road.id, piece.section, lane, along.within(piece.start, piece.end))
            except MapError as error:
                del piece.speeds[lane]
                graph.document.remark("lane", f"lane {lane}", road.id, piece.start, error.message)
    graph.pieces[road.id] = pieces


def cut(road: XRoad, limit: Limit, document: Document) -> Iterator[Piece]:
    """The pieces of a road: cut where a section begins, a limit changes, or a light of its own stands before the road's end."""
    ends = [*(section.s for section in road.sections[1:]), road.length]
    for section, end in zip(road.sections, ends, strict=True):
        used = [strip for strip in section.strips.values() if is_used(road, section, strip, end, document)]
        used = list(one_way(road, section, used, document))
        cuts = {section.s, *(s for s, *_ in road.kinds), *(each.s for each in road.signals if each.rule == "light")}
        cuts |= {section.s + s for strip in section.strips.values() for s, _ in strip.speeds}
        inside = sorted(s for s in cuts if s == section.s or section.s + AT_END < s < end - AT_END)
        for a, b in zip(inside, [*inside[1:], end], strict=True):
            yield Piece(a, b, section, {strip.id: speed_of(road, section, strip, a, limit) for strip in used})


def speed_of(road: XRoad, section: Section, strip: Strip, s: float, limit: Limit) -> float:
    """The limit of a lane at a station: its own, else the road's [m/s]."""
    own = [value for at, value in strip.speeds if section.s + at <= s + AT_END]
    return own[-1] if own and math.isfinite(own[-1]) else limit(road, s)


def is_used(road: XRoad, section: Section, strip: Strip, end: float, document: Document) -> bool:
    """Whether a lane becomes one of ours: it is for vehicles, and a car fits into it."""
    return is_wide(road, section, strip, end, document) and strip.type in DRIVABLE | KEPT_FOR_OTHERS


def one_way(road: XRoad, section: Section, used: list[Strip], document: Document) -> Iterator[Strip]:
    """The lanes that cars drive: one for both directions is kept free between others, or driven in the direction of its side alone."""
    ways = {is_forward(road, strip) for strip in used if strip.direction != "both"}
    for strip in used:
        if strip.direction != "both":
            yield strip
            continue
        free = len(ways) == 2
        reason = (
            "is kept free between the two directions" if free else "cars drive it in the direction of its side only, so none meet on it"
        )
        document.remark("lane direction", f"lane {strip.id} for both directions", road.id, section.s, reason)
        if not free:
            yield strip


# -- which atom leads to which ---------------------------------------------------------------------


def join(graph: Graph) -> None:
    """Finds every pair of atoms of which one leads to the other."""
    roads = graph.document.roads
    for name, junction in graph.document.junctions.items():
        for each in junction.joins:
            if each.incoming in roads and each.connecting in roads:
                join_junction(graph, name, each)
    for road in roads.values():
        join_pieces(graph, road)
        for link, end in ((road.before, "start"), (road.after, "end")):
            if link is not None and link.kind == "road":
                join_roads(graph, road, end, link)


def join_pieces(graph: Graph, road: XRoad) -> None:
    """The lanes of a road from piece to piece."""
    for k, (a, b) in enumerate(pairwise(graph.pieces[road.id])):
        if a.section is b.section:
            pairs = {(lane, lane) for lane in a.speeds}
        else:
            pairs = {(lane, other) for lane in a.speeds for other in a.section.strips[lane].after}
            pairs |= {(other, lane) for lane in b.speeds for other in b.section.strips[lane].before}
        for lane, other in sorted(pairs):
            touch(graph, (road.id, k, lane), "end", (road.id, k + 1, other), "start")
        if a.section is not b.section:
            meet(graph, (road.id, k), "end", (road.id, k + 1), "start")


def join_roads(graph: Graph, road: XRoad, end: str, link: Link) -> None:
    """The lanes of a road from its end to another road."""
    other = graph.document.roads.get(link.id)
    if other is None:
        graph.document.remark("link", f"to road {link.id}", road.id, station(road, end), "there is no such road")
        return
    contact = link.contact or nearest_end(graph, road, end, other)
    k, there = at_end(graph, road.id, end), at_end(graph, other.id, contact)
    piece = graph.pieces[road.id][k]
    for lane in piece.speeds:
        strip = piece.section.strips[lane]
        for to in strip.after if end == "end" else strip.before:
            touch(graph, (road.id, k, lane), end, (other.id, there, to), contact)
    meet(graph, (road.id, k), end, (other.id, there), contact)


def nearest_end(graph: Graph, road: XRoad, end: str, other: XRoad) -> str:
    """The end of another road that lies nearest to an end of this one; noted as a guess."""
    here = end_point(road, end)
    contact = min(("start", "end"), key=lambda each: float(np.hypot(*(end_point(other, each) - here))))
    graph.document.derive("contact", f"the {contact} of road {other.id}", road.id, station(road, end), "the nearest end: no contactPoint")
    return contact


def join_junction(graph: Graph, name: str, each: Join) -> None:
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
        what = f"road {incoming.id} to road {connecting.id}"
        graph.document.derive("lane links", what, connecting.id, 0.0, "no <laneLink>: equal numbers")
    for lane, other in links:
        touch(graph, (incoming.id, k, lane), end, (connecting.id, there, other), each.contact)


def meet(graph: Graph, one: tuple[str, int], end: str, other: tuple[str, int], contact: str) -> None:
    """Joins the lanes of two pieces that meet, where no lane of a side has a link there: side by side, if they are as many."""
    seam = frozenset({(*one, end), (*other, contact)})
    if seam in graph.told:
        return
    graph.told.add(seam)
    for side in SIDES:
        mine, theirs = side_of(graph, one, side), side_of(graph, other, side if end != contact else -side)
        if any(is_linked(graph, atom, end) for atom in mine) or any(is_linked(graph, atom, contact) for atom in theirs):
            continue
        if mine and len(mine) == len(theirs):
            for a, b in zip(mine, theirs, strict=True):
                touch(graph, a, end, b, contact)
            tell_joined(graph, mine, end, other[0])
        elif mine and theirs:
            reason = f"its lanes have no links; {len(mine)} meet {len(theirs)} of road {other[0]}, so it ends there"
            graph.document.remark("lane links", f"{len(mine)} lanes", one[0], place_of(graph, one, end), reason)


def tell_joined(graph: Graph, lanes: list[Atom], end: str, other: str) -> None:
    """Notes lanes that were joined by their order."""
    road, k, _ = lanes[0]
    what = f"lanes {', '.join(str(lane) for _, _, lane in lanes)} go on in road {other}"
    graph.document.derive("lane links", what, road, place_of(graph, (road, k), end), "no lane has a <link> there: as many lanes meet")


def side_of(graph: Graph, of: tuple[str, int], side: int) -> list[Atom]:
    """The lanes of one side of a piece, from the middle outwards."""
    road, k = of
    return [(road, k, lane) for lane in sorted(graph.pieces[road][k].speeds, key=abs) if lane * side > 0]


def is_linked(graph: Graph, atom: Atom, end: str) -> bool:
    """Whether something is said of what a lane joins at an end of its piece."""
    strip = graph.strip(atom)
    named = strip.after if end == "end" else strip.before
    joined = graph.after if graph.is_forward(atom) == (end == "end") else graph.before
    return bool(named or joined.get(atom))


def place_of(graph: Graph, of: tuple[str, int], end: str) -> float:
    """The station of an end of a piece [m]."""
    piece = graph.pieces[of[0]][of[1]]
    return piece.end if end == "end" else piece.start


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
    if any(lane not in graph.pieces[road][k].speeds for road, k, lane in (a, b)):
        return
    a_leaves = graph.is_forward(a) == (a_end == "end")
    b_leaves = graph.is_forward(b) == (b_end == "end")
    if a_leaves == b_leaves:
        what = f"lane {a[2]} with lane {b[2]} of road {b[0]}"
        graph.document.remark("link", what, a[0], place_of(graph, a[:2], a_end), "they are driven in opposite directions")
        return
    start, goal = (a, b) if a_leaves else (b, a)
    if goal not in graph.after[start]:
        graph.after[start].append(goal)
        graph.before[goal].append(start)


# -- lanes that lead nowhere -----------------------------------------------------------------------


def note_ends(graph: Graph) -> None:
    """Tells of lanes that end although their road goes on; one that has run out of width may."""
    for road in graph.document.roads.values():
        for k, piece in enumerate(graph.pieces[road.id]):
            for lane in piece.speeds:
                atom = (road.id, k, lane)
                if not graph.after.get(atom) and goes_on(graph, road, k, forward=graph.is_forward(atom)) and ends_wide(graph, atom):
                    end = "end" if graph.is_forward(atom) else "start"
                    what, reason = f"lane {lane} ends", "no <link> or <laneLink> leads on from it"
                    graph.document.remark("lane end", what, road.id, place_of(graph, (road.id, k), end), reason)


def goes_on(graph: Graph, road: XRoad, k: int, *, forward: bool) -> bool:
    """Whether something follows a piece of a road."""
    last = k == (len(graph.pieces[road.id]) - 1 if forward else 0)
    return not last or (road.after if forward else road.before) is not None


def ends_wide(graph: Graph, atom: Atom) -> bool:
    """Whether a car still fits into a lane at its end."""
    widths = graph.pieces[atom[0]][atom[1]].lines[atom[2]].width
    return bool(widths[-1 if graph.is_forward(atom) else 0] >= NARROWEST)


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
