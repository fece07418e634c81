"""Turn restrictions: what a map forbids between its ways, on the roads that were built of them.

netconvert honours most of them; where it joins nodes into one junction some are lost. So they are looked at again:

    relation    from a way, over a node or ways, to a way: "no_..." forbids it, "only_..." all the others
    turn        the road that ends nearest to that node, and the road that starts nearest to it
    ban         roads that must not be driven one after another; two of them lose their connections, more are left to the
                search for a route
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from studio.road.formats.identity import named
from studio.road.formats.osm import Box
from studio.road.formats.turn_rule import UNCHANGING, conditional, excepts_cars, kind_of, reason, told
from studio.road.formats.way import Way
from studio.road.network import Connection, Net
from studio.road.network.report import Notes, Spot

NEAR = 40.0  # [m] a road ends no farther than this from the node of its restriction: half a large joined junction


@dataclass(frozen=True)
class Restriction:
    """A relation in the part that is kept. `entry` and `exit` are the places where its first way is left and its last one begins."""

    id: int
    kind: str
    start: int
    via: tuple[int, ...]  # ways
    end: int
    entry: np.ndarray
    exit: np.ndarray


def restricted(net: Net, relations, ways: Sequence[Way], box: Box, notes: Notes) -> tuple[Net, tuple[tuple[str, ...], ...]]:
    """The network without the connections that are forbidden, and the bans that span more than two roads."""
    bans = []
    for each in restrictions(relations, ways, box, notes):
        roads = roads_of(each, net)
        why = "its roads are not built" if roads is None else ""
        if roads is not None and len(roads) > 2:
            bans.append(roads)
            why = "a detour over other roads is not forced" if each.kind.startswith("only") else ""
        elif roads is not None:
            net, why = without(net, *roads, only=each.kind.startswith("only"))
        if why:
            notes.skip("turn restriction", each.kind, spot_at(each.id, each.entry, box), why)
    return net, tuple(bans)


def spot_at(relation: int, place: np.ndarray, box: Box) -> Spot:
    """A relation at a place [m]."""
    name = named("relation", relation)
    return Spot(name, *box.degrees(place[:, None])[0][::-1], name)


def restrictions(relations, ways: Sequence[Way], box: Box, notes: Notes) -> Iterator[Restriction]:
    """The turn restrictions for cars in the part that is kept; others there are told."""
    by_id = {way.id: way for way in ways}
    for number, members, tags in relations:
        here = [by_id[ref] for form, ref, _ in members if form == "w" and ref in by_id]
        if not here or excepts_cars(tags):
            continue
        why = reason(tags)
        found = [] if why else list(pairs_of(number, kind_of(tags), members, by_id, box))
        yield from found
        why = why or ("" if found else "its members are not two roads for cars that meet there")
        if why or conditional(tags):
            longitude, latitude = here[0].points[-1]
            spot = spot_at(number, box.local(latitude, longitude), box)
            notes.skip("turn restriction", told(tags)[:80], spot, why or UNCHANGING)


def pairs_of(number: int, kind: str, members, by_id: dict[int, Way], box: Box) -> Iterator[Restriction]:
    """A restriction for each pair of its first and last ways: `no_entry` may have several first, `no_exit` several last ones."""
    roles = {role: [(form, ref) for form, ref, part in members if part == role] for role in ("from", "via", "to")}
    over = tuple(ref for form, ref in roles["via"] if form == "w")
    if not roles["via"] or not all(way in by_id for way in over):
        return
    for (_, start), (_, end) in product(roles["from"], roles["to"]):
        if start in by_id and end in by_id:
            chain = [by_id[start], *(by_id[way] for way in over), by_id[end]]
            nodes = [shared(chain[0], chain[1]), shared(chain[-2], chain[-1])] if over else [ref for _, ref in roles["via"][:1]] * 2
            entry, exit = (place_of(node, chain, box) for node in nodes)
            if entry is not None and exit is not None:
                yield Restriction(number, kind, start, over, end, entry, exit)


def shared(one: Way, other: Way) -> int | None:
    """A node at which two ways meet."""
    return next((node for node in (one.nodes[0], one.nodes[-1]) if node in other.nodes), None)


def place_of(node: int | None, ways: list[Way], box: Box) -> np.ndarray | None:
    """Where a node of these ways lies [m]."""
    found = next((way.points[way.nodes.index(node)] for way in ways if node in way.nodes), None)
    return None if found is None else box.local(found[1], found[0])


def roads_of(each: Restriction, net: Net) -> tuple[str, ...] | None:
    """The roads of a restriction one after another; a way between that disappeared in a junction is left out."""
    start, end = nearest_road(net, each.start, each.entry, -1), nearest_road(net, each.end, each.exit, 0)
    between = [road for way in each.via if (road := nearest_road(net, way, each.entry, 0)) is not None]
    if start is None or end is None or 0 < len(between) < len(each.via):
        return None
    return (start, *between, end)


def nearest_road(net: Net, way: int, place: np.ndarray, at: int) -> str | None:
    """The road of a way whose start (at 0) or end (at -1) is nearest to a place, if it is near."""
    ends = {
        road: float(np.hypot(*(np.mean([net.lanes[lane].centre[:, at] for lane in net.roads[road].lanes], axis=0) - place)))
        for road, names in net.origins.items()
        if way in names and road in net.roads and not net.roads[road].internal
    }
    best = min(ends, key=lambda road: (ends[road], road), default=None)
    return best if best is not None and ends[best] < NEAR else None


def without(net: Net, start: str, end: str, *, only: bool) -> tuple[Net, str]:
    """The network without a turn from road to road, or without all others; and why nothing was done, or nothing."""
    lanes = set(net.roads[start].lanes)
    leaving = [each for each in net.connections if each.from_lane in lanes]
    reached = [each for each in leaving if net.lanes[each.to_lane].road == end]
    gone = [each for each in leaving if each not in reached] if only else reached
    kept = [each for each in leaving if each not in gone]
    if only and not reached:
        return net, "the one way that it leaves is not built"
    if gone and not leads_on(kept) and leads_on(leaving):
        return net, "nothing else leads on from this road"
    dropped = {id(each) for each in gone}
    return replace(net, connections=tuple(each for each in net.connections if id(each) not in dropped)), ""


def leads_on(connections: list[Connection]) -> bool:
    """Whether one of the connections is no turn back."""
    return any(each.direction != "turn" for each in connections)
