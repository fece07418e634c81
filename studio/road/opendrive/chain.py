"""Chains: atoms of one direction side by side that go on into each other alike. Each becomes a road of the network, its lanes our lanes."""

from collections.abc import Iterator

from studio.road.opendrive.document import XRoad
from studio.road.opendrive.graph import Atom, Graph

EVEN = 0.01  # [m/s] limits that differ less are one


def chains_of(graph: Graph, road: XRoad) -> Iterator[list[tuple[Atom, ...]]]:
    """The chains of a road: lanes from the kerb inwards, each the atoms along it in the direction of driving."""
    for forward in (True, False):
        order = range(len(graph.pieces[road.id])) if forward else range(len(graph.pieces[road.id]) - 1, -1, -1)
        begun: list[list[tuple[Atom, ...]]] = []
        for k in order:
            rows = list(blocks(graph, road, k, forward=forward))
            ended = [chain for chain in begun if not any(goes_on(graph, last(chain), row) for row in rows)]
            yield from ended
            begun = [extended(graph, begun, row) for row in rows]
        yield from begun


def extended(graph: Graph, begun: list[list[tuple[Atom, ...]]], row: list[Atom]) -> list[tuple[Atom, ...]]:
    """The chain that goes on into a row of atoms, with it; a new one where none does."""
    chain = next((each for each in begun if goes_on(graph, last(each), row)), None)
    return [(atom,) for atom in row] if chain is None else [(*lane, atom) for lane, atom in zip(chain, row, strict=True)]


def last(chain: list[tuple[Atom, ...]]) -> list[Atom]:
    """The last atoms of a chain."""
    return [lane[-1] for lane in chain]


def blocks(graph: Graph, road: XRoad, k: int, *, forward: bool) -> Iterator[list[Atom]]:
    """The atoms of a piece in one direction, the kerb lane first; a lane of the other direction between them parts them."""
    block: list[Atom] = []
    for lane in sorted(graph.pieces[road.id][k].speeds, reverse=forward == road.left_hand):
        atom = (road.id, k, lane)
        if graph.is_forward(atom) == forward:
            block.append(atom)
        elif block:
            yield block
            block = []
    if block:
        yield block


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
