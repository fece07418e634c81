"""Lights and signs of an OpenDRIVE document: where one stops, and what a sign sets at the end of a road."""

from collections.abc import Iterator

import numpy as np

from studio.road.network.report import Notes
from studio.road.opendrive.document import Signal, XRoad
from studio.road.opendrive.graph import AT_END, Atom, Graph, at_end, led_from, place_of

STOP_REACH = 25.0  # [m] before a junction its traffic lights stand
SIGN_REACH = 40.0  # [m] and its signs


def stop_lines(graph: Graph, spot, notes: Notes) -> None:
    """Finds the stop lines of all lights."""
    for road in graph.document.roads.values():
        for signal in road.signals:
            if signal.rule == "light":
                place(graph, road, signal, spot, notes)
    graph.stops -= graph.inner  # a light that is repeated within the junction has one stop line


def place(graph: Graph, road: XRoad, light: Signal, spot, notes: Notes) -> None:
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


def meant(graph: Graph, road: XRoad, k: int, signal: Signal) -> list[Atom]:
    """The lanes of a piece that a signal is for.

    Where it names lanes of one direction these count: programs such as RoadRunner write the orientation as the sign of the lanes.
    """
    lanes = [(road.id, k, lane) for lane in graph.pieces[road.id][k].speeds]
    valid = [atom for atom in lanes if not signal.lanes or any(a <= atom[2] <= b for a, b in signal.lanes)]
    ways = {graph.is_forward(atom) for atom in valid}
    if signal.orientation == "none" or (signal.lanes and len(ways) == 1):
        return valid
    return [atom for atom in valid if graph.is_forward(atom) == (signal.orientation == "+")]


def guarded(graph: Graph, road: XRoad, light: Signal) -> Iterator[Atom]:
    """The atoms that end at a light."""
    for k, piece in enumerate(graph.pieces[road.id]):
        for atom in meant(graph, road, k, light):
            forward = graph.is_forward(atom)
            if road.junction != "-1":
                ends = k == (0 if forward else len(graph.pieces[road.id]) - 1)
            else:
                ends = abs((piece.end if forward else piece.start) - light.s) <= AT_END
            if ends:
                yield atom


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


def signed(graph: Graph) -> dict[Atom, str]:
    """The rule that a sign sets where an atom comes to a junction."""
    found = {}
    for road in graph.document.roads.values():
        for sign in (signal for signal in road.signals if signal.rule != "light"):
            atoms = set(posted(graph, road, sign))
            found |= dict.fromkeys(atoms, sign.rule)
            if not atoms:
                what = f"signal {sign.id}: {sign.rule}"
                graph.document.remark("sign", what, road.id, sign.s, f"no junction is within {SIGN_REACH:g} m of it, for lanes it is for")
    return found


def posted(graph: Graph, road: XRoad, sign: Signal) -> Iterator[Atom]:
    """The atoms that come to the junction that a sign is about; one that gives priority may stand anywhere before it."""
    for end in ("end", "start"):
        k = at_end(graph, road.id, end)
        for atom in meant(graph, road, k, sign):
            if road.junction != "-1":
                if graph.is_forward(atom) == (end == "start"):
                    yield from led_from(graph, atom)
            elif graph.is_forward(atom) == (end == "end") and comes_to_junction(graph, atom) and reaches(graph, road, k, end, sign):
                yield atom


def reaches(graph: Graph, road: XRoad, k: int, end: str, sign: Signal) -> bool:
    """Whether a sign stands near enough to an end of its road, or gives priority up to there."""
    return sign.rule == "priority" or abs(place_of(graph, (road.id, k), end) - sign.s) <= SIGN_REACH


def comes_to_junction(graph: Graph, atom: Atom) -> bool:
    """Whether an atom leads into a junction."""
    return any(graph.document.roads[each[0]].junction != "-1" or each in graph.inner for each in graph.after[atom])
