"""Right of way: what holds on each way through a junction, and who goes first where two come at once.

    signal              a light decides; while both show green, the rest of the rules. Between ways that lights right before them keep
                        apart it has decided already
    yield, stop         a sign, or a smaller road: the others go first
    all_way_stop        everybody stops; who came first goes first
    right_before_left   no major road: whoever comes from the right goes first, and from ahead before one who turns across
    left_before_right   the same the other way round (Japan, Thailand)
    roundabout          the ring goes first
    zipper              two lanes become one: in turn
    priority            nobody goes first

Which of two roads is the major one, netconvert tells by their classes. Signs are read from the map. netconvert knows no
junctions of equal roads where one drives on the left; they are found here.
"""

from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import shapely

from studio.road.assembly.alignment import direction_at, turned
from studio.road.formats.osm import Box
from studio.road.formats.way import Way
from studio.road.network import Connection, Net, Pair, curve
from studio.road.network.signals import SIGHT, Signals

LEFT_FIRST = {"Japan", "Thailand"}  # road traffic acts: Japan art. 36, Thailand sec. 71
EQUAL = {"residential", "living_street", "unclassified", "tertiary"}  # classes whose crossings have no major road
CLASSES = ("motorway", "trunk", "primary", "secondary", "tertiary", "unclassified", "residential", "living_street", "service")
SIGN_REACH = 40.0  # [m] a sign stands that near before its junction
BESIDE = 10.0  # [m] and its node that near to the road
ONCOMING = np.radians(135.0)  # [rad]
PRIORITY = {"designated", "yes", "yes_unposted"}
SIGNS = {"give_way": "yield", "stop": "stop"}


@dataclass(frozen=True)
class Law:
    """What a place says about who goes first.

    `yields` are netconvert's answers, `equal` the junctions without major road, `signs` the rules that signs set at the ends of
    roads, `left_first` whether the left goes before the right at equal roads. With `by_side` two of which nothing is said go by side.
    `major` are roads that have priority by sign, `circles` the junctions that are mini-roundabouts.
    """

    yields: dict[Pair, frozenset[Pair]]
    equal: frozenset[str]
    signs: dict[str, str]
    left_hand: bool
    left_first: bool
    by_side: bool = False
    major: frozenset[str] = frozenset()
    circles: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Ground:
    """Connections under a law, and for each those that it meets."""

    net: Net
    law: Law
    connections: tuple[Connection, ...]
    foes: list[frozenset[int]]

    def pair(self, i: int) -> Pair:
        """The roads that a connection leads from and to."""
        connection = self.connections[i]
        return self.net.lanes[connection.from_lane].road, self.net.lanes[connection.to_lane].road

    def coming(self, i: int) -> np.ndarray:
        """The direction in which a connection is entered."""
        return direction_at(self.net.lanes[self.connections[i].from_lane].centre, -1)

    def is_equal(self, i: int) -> bool:
        """Whether the connection's junction has no major road."""
        return self.net.roads[self.pair(i)[0]].to_junction in self.law.equal

    def is_circle(self, i: int) -> bool:
        """Whether the connection leads over a mini-roundabout."""
        return self.net.roads[self.pair(i)[0]].to_junction in self.law.circles


def ruled(net: Net, law: Law, connections: tuple[Connection, ...], lights: Signals) -> tuple[Connection, ...]:
    """The connections with their right of way."""
    ground = Ground(net, law, connections, foes_of(net, connections, lights))
    first = [frozenset(j for j in ground.foes[i] if goes_first(ground, j, i)) for i in range(len(connections))]
    return tuple(replace(c, right_of_way=right_of(ground, i, first[i]), yields=tuple(sorted(first[i]))) for i, c in enumerate(connections))


def foes_of(net: Net, connections: tuple[Connection, ...], lights: Signals) -> list[frozenset[int]]:
    """For each way through a junction those that cross it or end in the same lane, unless lights keep them apart."""
    apart = {(i, j) for a, b in lights.conflicts.T.tolist() for i, j in ((a, b), (b, a))}
    lines = np.array([shapely.LineString(line_of(net, c).T) for c in connections], dtype=object)
    links, found = links_of(net, connections), defaultdict(set)
    for i, j in shapely.STRtree(lines).query(lines, predicate="intersects").T.tolist():
        if connections[i].from_lane != connections[j].from_lane and not apart.issuperset(product(links[i], links[j])):
            found[i].add(j)
    return [frozenset(found[i]) for i in range(len(connections))]


def links_of(net: Net, connections: tuple[Connection, ...]) -> list[frozenset[int]]:
    """For each way the lights by which one comes to it: at its own line, or not farther back than conflicts of lights are looked for.

    -1 is among them where one may come without. Lights go before signs (StVO § 37): whom they have let go is not to wait again, at a
    line right behind, for those whom they hold meanwhile.
    """
    onto = defaultdict(list)
    for connection in connections:
        onto[connection.to_lane].append(connection)
    return [frozenset(links_before(net, onto, each, SIGHT)) for each in connections]


def links_before(net: Net, onto: dict[int, list[Connection]], connection: Connection, left: float) -> Iterator[int]:
    """The lights before a way, no more than `left` [m] back."""
    left -= net.lanes[connection.from_lane].length
    before = onto.get(connection.from_lane, ())
    if connection.link >= 0 or left <= 0.0 or not before:
        yield connection.link
        return
    for each in before:
        yield from links_before(net, onto, each, left - sum(net.lanes[via].length for via in each.via))


def line_of(net: Net, connection: Connection) -> np.ndarray:
    """The way through a junction, from the end of a lane to the start of the next."""
    a, b = net.lanes[connection.from_lane].centre[:, -1:], net.lanes[connection.to_lane].centre[:, :1]
    return np.concatenate([a, *(net.lanes[via].centre for via in connection.via), b], axis=1)


# -- who goes first --------------------------------------------------------------------------------


def goes_first(ground: Ground, j: int, i: int) -> bool:
    """Whether connection j goes before i, which it meets."""
    own, other = ground.pair(i), ground.pair(j)
    signs, rings = ground.law.signs, ground.net.rings
    if own[0] == other[0]:
        return ground.connections[i].to_lane == ground.connections[j].to_lane  # in turn
    if ground.is_circle(i):
        return comes_round(ground, j, i)
    if (own[0] in signs) != (other[0] in signs):
        return own[0] in signs
    if own[0] in ground.law.major or other[0] in ground.law.major:
        return comes_first(ground, j, i) if own[0] in ground.law.major and other[0] in ground.law.major else other[0] in ground.law.major
    if (own[0] in rings) != (other[0] in rings):
        return other[0] in rings
    if ground.is_equal(i) or is_open(ground.law, own, other):
        return comes_first(ground, j, i)
    return other in ground.law.yields.get(own, ())


def is_open(law: Law, own: Pair, other: Pair) -> bool:
    """Whether a law leaves open which of two ways goes first."""
    return law.by_side and other not in law.yields.get(own, ()) and own not in law.yields.get(other, ())


def comes_round(ground: Ground, j: int, i: int) -> bool:
    """Whether j goes before i on a mini-roundabout: who comes from where the circle comes from, and one from ahead who turns across,
    since he comes round it."""
    own, other = ground.coming(i), ground.coming(j)
    if turned(own, other) > ONCOMING:
        return turns_across(ground, j) and not turns_across(ground, i)
    from_right = own[0] * other[1] - own[1] * other[0] > 0.0
    return bool(from_right == ground.law.left_hand)


def comes_first(ground: Ground, j: int, i: int) -> bool:
    """Whether j goes before i where roads are equal: from the right, or from ahead when i turns across its way."""
    own, other = ground.coming(i), ground.coming(j)
    if turned(own, other) > ONCOMING:
        return turns_across(ground, i) and not turns_across(ground, j)
    from_right = own[0] * other[1] - own[1] * other[0] > 0.0
    return bool(from_right != ground.law.left_first)


def turns_across(ground: Ground, i: int) -> bool:
    """Whether a connection turns across the oncoming lanes: to the left where one drives on the right."""
    own = ground.coming(i)
    after = direction_at(ground.net.lanes[ground.connections[i].to_lane].centre, 0)
    left = own[0] * after[1] - own[1] * after[0]
    return turned(own, after) > np.radians(30.0) and bool(left > 0.0) != ground.law.left_hand


# -- what it is called -----------------------------------------------------------------------------


def right_of(ground: Ground, i: int, first: frozenset[int]) -> str:
    """The rule of connection i, before which those of `first` go."""
    start, end = ground.pair(i)
    others = {j for j in ground.foes[i] if ground.pair(j)[0] != start}
    if ground.connections[i].link >= 0:
        return "signal"
    if first and not others & first:
        return "zipper"
    if ground.is_circle(i) and others:
        return "roundabout"
    if start in ground.law.signs and others:
        return ground.law.signs[start]
    if ground.is_equal(i) and others and not ground.law.major & {start, *(ground.pair(j)[0] for j in others)}:
        return "left_before_right" if ground.law.left_first else "right_before_left"
    if not first:
        return "priority"
    return "roundabout" if end in ground.net.rings and start not in ground.net.rings else "yield"


# -- what the map says -----------------------------------------------------------------------------


def mapped_law(net: Net, ways: list[Way], nodes: dict[int, dict[str, str]], box: Box, *, country: str, left_hand: bool) -> Law:
    """The law of a place on OpenStreetMap; `nodes` are the tags of its nodes."""
    equal = net.equal | (equal_junctions(net, ways) if left_hand else frozenset())
    signs, major = signs_of(net, ways, nodes, box), major_roads(net, ways)
    circles = circles_of(net, ways, nodes, box)
    return Law(net.yields, equal, signs, left_hand, country in LEFT_FIRST, major=major, circles=circles)


def major_roads(net: Net, ways: list[Way]) -> frozenset[str]:
    """The roads whose last way is a priority road by its signs."""
    designated = {way.id for way in ways if way.tags.get("priority_road") in PRIORITY}
    return frozenset(road for road, names in net.origins.items() if names and names[-1] in designated)


def circles_of(net: Net, ways: list[Way], nodes: dict[int, dict[str, str]], box: Box) -> frozenset[str]:
    """The junctions that are mini-roundabouts: of those near such a node the one whose roads end nearest to it."""
    found = set()
    for _, _, (longitude, latitude) in nodes_of(ways, nodes, {"mini_roundabout"}):
        at = box.local(latitude, longitude)
        ends = {
            road.to_junction: float(np.hypot(*(np.mean([net.lanes[lane].centre[:, -1] for lane in road.lanes], axis=0) - at)))
            for road in sorted(net.roads.values(), key=lambda road: road.id)
            if not road.internal and road.to_junction
        }
        nearest = min(ends, key=ends.__getitem__, default="")
        if nearest and ends[nearest] < SIGN_REACH:
            found.add(nearest)
    return frozenset(found)


def law_by_limits(net: Net, *, country: str, left_hand: bool, signs: dict[str, str], before: frozenset[tuple[Pair, Pair]]) -> Law:
    """The law of a map that says little of it: who has a sign, then the higher limit. `before` are pairs of which the first goes first."""
    at = defaultdict(set)
    for c in net.connections:
        start, end = net.lanes[c.from_lane].road, net.lanes[c.to_lane].road
        at[net.roads[start].to_junction].add((start, end))
    yields = {own: frozenset(other for other in pairs if is_major(net, signs, other[0], own[0])) for pairs in at.values() for own in pairs}
    for first, second in sorted(before):
        yields[second] |= {first}
        yields[first] -= {second}
    equal = frozenset(name for name, pairs in at.items() if not any(yields[pair] for pair in pairs))
    return Law(yields, equal, stopping(signs, at), left_hand, country in LEFT_FIRST, by_side=True)


def is_major(net: Net, signs: dict[str, str], road: str, other: str) -> bool:
    """Whether a road goes before another: by their signs and as part of a roundabout, else by their limits."""
    ranks = [2 if name in net.rings else {"priority": 2, "yield": 0, "stop": 0}.get(signs.get(name, ""), 1) for name in (road, other)]
    return ranks[0] > ranks[1] or (ranks[0] == ranks[1] and net.roads[road].speed > net.roads[other].speed + 0.1)


def stopping(signs: dict[str, str], at: dict[str, set[Pair]]) -> dict[str, str]:
    """The signs at which one waits; where all that come to a junction of three and more stop, who came first goes first."""
    found = {road: rule for road, rule in signs.items() if rule != "priority"}
    for pairs in at.values():
        roads = {start for start, _ in pairs}
        if len(roads) > 2 and all(signs.get(road) == "stop" for road in roads):
            found |= dict.fromkeys(roads, "all_way_stop")
    return found


def equal_junctions(net: Net, ways: list[Way]) -> frozenset[str]:
    """Junctions of three roads and more, all of one lesser class, with the same limit, without signal or ring."""
    highway = {way.id: way.tags["highway"] for way in ways}
    entering = defaultdict(list)
    for road in net.roads.values():
        if not road.internal:
            entering[road.to_junction].append(road)
    found = set()
    for junction, roads in entering.items():
        kinds = {(highway.get(net.origins[road.id][-1]) if net.origins.get(road.id) else None, round(road.speed, 1)) for road in roads}
        free = not any(road.id in net.rings or net.signalled & set(road.lanes) for road in roads)
        if len(roads) > 2 and len(kinds) == 1 and next(iter(kinds))[0] in EQUAL and free:
            found.add(junction)
    return frozenset(found)


def signs_of(net: Net, ways: list[Way], nodes: dict[int, dict[str, str]], box: Box) -> dict[str, str]:
    """The rule that a sign sets at the end of a road; one that stands there goes before what its way says."""
    by_way = defaultdict(list)
    for road, names in net.origins.items():
        for name in names:
            by_way[name].append(road)
    found = dict(signs_of_ways(net, ways))
    for way, node, (longitude, latitude) in nodes_of(ways, nodes, set(SIGNS)):
        x, y = box.local(latitude, longitude)
        whose = {nodes[node].get("stop"), nodes[node].get("give_way")}
        beside, is_for_minor = SIGN_REACH if whose & {"all", "minor"} else BESIDE, "minor" in whose
        roads = [road for road in by_way[way.id] if faces(net, road, np.array([x, y]), nodes[node], beside)]
        for road in (each for each in roads if not is_for_minor or is_minor(net, each)):
            found[road] = "all_way_stop" if nodes[node].get("stop") == "all" else SIGNS[nodes[node]["highway"]]
    return found


def signs_of_ways(net: Net, ways: list[Way]) -> Iterator[tuple[str, str]]:
    """The rules that ways set at the ends of their roads where several meet: `stop=all` for all of these, `stop=minor` and
    `give_way=minor` for the own road where it is a lesser one."""
    says = {way.id: rule for way in ways if (rule := rule_of_way(way.tags))}
    arms: dict[str, list[str]] = defaultdict(list)
    for road in net.roads.values():
        if says and not road.internal:
            arms[road.to_junction].append(road.id)
    ends = [(road, says[names[-1]]) for road, names in net.origins.items() if names and names[-1] in says and road in net.roads]
    for road, rule in sorted(ends, key=lambda each: each[1] == "all_way_stop"):  # where all stop, that goes before
        others = arms[net.roads[road].to_junction] if not net.roads[road].internal else []
        if len(others) > 2 and (rule == "all_way_stop" or is_minor(net, road)):
            yield from ((each, rule) for each in (others if rule == "all_way_stop" else [road]))


def rule_of_way(tags: dict[str, str]) -> str:
    """The rule that a way sets at its ends.

    >>> rule_of_way({"stop": "all"}), rule_of_way({"stop": "minor"}), rule_of_way({"give_way": "minor"}), rule_of_way({"stop": "no"})
    ('all_way_stop', 'stop', 'yield', '')
    """
    if tags.get("stop") in ("all", "minor"):
        return "all_way_stop" if tags["stop"] == "all" else "stop"
    return "yield" if tags.get("give_way") == "minor" else ""


def is_minor(net: Net, road: str) -> bool:
    """Whether a road is one of the lesser ones of its junction: of a lesser class than others or, where all are alike, one that does not
    go straight on while others do."""
    arms = [each for each in net.roads.values() if not each.internal and each.to_junction == net.roads[road].to_junction]
    ranks = {each.id: rank(each.kind) for each in arms}
    if len(set(ranks.values())) > 1:
        return ranks[road] > min(ranks.values())
    ahead = {net.lanes[each.from_lane].road for each in net.connections if each.direction == "straight"}
    return road not in ahead


def rank(kind: str) -> int:
    """The place of a kind of road among all, the greatest first; ramps have that of their road."""
    name = kind.removesuffix("_link")
    return CLASSES.index(name) if name in CLASSES else len(CLASSES)


def nodes_of(ways: list[Way], nodes: dict[int, dict[str, str]], kinds: set[str]) -> Iterator[tuple[Way, int, tuple[float, float]]]:
    """The nodes of some kinds of `highway` on car ways, each with its way and its longitude and latitude."""
    for way in ways:
        for node, place in zip(way.nodes, way.points, strict=True):
            if nodes.get(node, {}).get("highway") in kinds:
                yield way, node, place


def faces(net: Net, road: str, at: np.ndarray, tags: dict[str, str], beside: float = BESIDE) -> bool:
    """Whether a sign at a place is meant for a road: it stands by its end, no farther away than this [m], and the tag names its direction
    or none. One for several roads stands in the middle of their junction."""
    if road not in net.roads or net.roads[road].internal:
        return False
    wanted = tags.get("direction", tags.get("traffic_sign:direction", ""))
    if wanted in ("forward", "backward") and (wanted == "backward") != road.startswith("-"):
        return False
    line = net.lanes[net.roads[road].lanes[0]].centre
    near = curve.distances(at[:, None], line)[0]
    to_end, to_start = np.hypot(*(at - line[:, -1])), np.hypot(*(at - line[:, 0]))
    return bool(near < beside and to_end < SIGN_REACH and (to_end < to_start or wanted))


def counts(connections: tuple[Connection, ...]) -> dict[str, int]:
    """How many connections have each rule."""
    found = Counter(connection.right_of_way for connection in connections)
    return {right: found[right] for right in sorted(found)}
