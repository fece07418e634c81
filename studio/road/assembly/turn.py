"""Turn lanes: arrows that are mapped win over what netconvert guesses of where lanes lead.

    arrow      one direction of a lane's tag: "left", "through;right" are one and two
    fork       the end of a road from which more than one other road is reached
    wanted     for every lane of a fork with arrows: the roads it must lead to
    allowed    these and the ones it may lead to

Arrows and the roads behind a fork come in the same order from left to right, so they are matched in order, each arrow with
the road whose turn is most like it: that one the lane must lead to. Another road may be reached by the arrow that is most
like it as well: behind one arrow to the left there can be two roads. A way's arrows hold at its end; where a way only goes on
into another one without arrows and with as many lanes, they hold at that one's end.
"""

import itertools
import math
from collections import defaultdict
from dataclasses import dataclass, replace

import numpy as np
import shapely

from studio import portable
from studio.road.assembly.bend import hermite, unit
from studio.road.formats.osm import Box
from studio.road.formats.way import Way, is_one_way, spot_of
from studio.road.network import Connection, Lane, Net, Road, curve
from studio.road.network.report import Notes, TurnCount

# [deg] to the left
ANGLE = {
    "reverse": 180.0,
    "sharp_left": 135.0,
    "left": 90.0,
    "slight_left": 45.0,
    "merge_to_left": 0.0,
    "through": 0.0,
    "merge_to_right": 0.0,
    "slight_right": -45.0,
    "right": -90.0,
    "sharp_right": -135.0,
}
UNLIKE = 75.0  # [deg] an arrow and a turn that differ more do not belong together
SHARED = 40.0  # [deg] what it costs that two arrows lead to one road
RAMPED = {"motorway", "motorway_link", "trunk", "trunk_link"}  # here netconvert adds lanes beside ramps
AT_END = 30.0  # [m] a road that ends that near to its way's end has the way's arrows
DETAIL = 1.0  # [m] between the points of a way through a junction
AHEAD = 15.0  # [m] behind a fork, where a road's direction is taken

Arrows = tuple[frozenset[str], ...]  # of every lane, the kerb lane first; empty: no arrow


@dataclass(frozen=True)
class Fork:
    """The end of a road with arrows: what each of its lanes must and may lead to, the kerb lane first; no arrow, no road.

    `unbuilt` is the number of lanes with arrows where as many lanes are not built: they cannot be matched.
    """

    road: str
    wanted: tuple[frozenset[str], ...]
    allowed: tuple[frozenset[str], ...]
    unbuilt: int = 0


# -- what is mapped --------------------------------------------------------------------------------


def arrows(way: Way, *, forward: bool, left_hand: bool) -> Arrows | None:
    """The arrows of a way in one direction, the kerb lane first; None without a tag.

    >>> arrows(Way(1, [], [], {"oneway": "yes", "turn:lanes": "left|through;right"}), forward=True, left_hand=False)[0] == {
    ...     "through",
    ...     "right",
    ... }
    True
    """
    text = per_lane(way, "turn", forward=forward)
    if text is None:
        return None
    cars = per_lane(way, "vehicle", forward=forward)
    if cars is not None and len(cars) == len(text):  # a lane for bicycles between those for cars
        text = [lane for lane, open_to in zip(text, cars, strict=True) if open_to != "no"]
    lanes = [frozenset(part for part in lane.split(";") if part in ANGLE) for lane in text]
    return tuple(lanes if left_hand else reversed(lanes))


def per_lane(way: Way, key: str, *, forward: bool) -> list[str] | None:
    """The values of `key:lanes` in one direction of a way, from left to right; None without a tag."""
    text = way.tags.get(f"{key}:lanes:{'forward' if forward else 'backward'}")
    if text is None and forward and is_one_way(way):
        text = way.tags.get(f"{key}:lanes")
    return None if text is None else text.split("|")


def arrows_of(net: Net, ways: list[Way], box: Box, *, left_hand: bool) -> dict[str, tuple[Way, Arrows]]:
    """The arrows at the end of every road that has some, and the way that they are mapped on."""
    by_id = {way.id: way for way in ways}
    lines = {way.id: box.local(*np.array(way.points).T[::-1]) for way in ways}
    found = {}
    for road, names in net.origins.items():
        if road not in net.roads or net.roads[road].internal:
            continue
        end = end_of(net, road)
        near = [name for name in names if name in by_id]
        if not near:
            continue
        name = min(near, key=lambda each: float(curve.distances(end[:, :1], lines[each])[0]))
        forward, left = along_way(end, lines[name])
        tags = arrows(by_id[name], forward=forward, left_hand=left_hand)
        if tags is not None and left < AT_END:
            found[road] = by_id[name], tags
    return carried(net, found)


def end_of(net: Net, road: str) -> np.ndarray:
    """Two points in the middle of a road, shortly before its end and at it, float64[2, 2] [m]."""
    lines = [net.lanes[lane].centre for lane in net.roads[road].lanes]
    before = np.mean([curve.along(line, np.array([max(0.0, curve.length(line) - 5.0)]))[:, 0] for line in lines], axis=0)
    return np.column_stack([before, np.mean([line[:, -1] for line in lines], axis=0)])


def along_way(end: np.ndarray, line: np.ndarray) -> tuple[bool, float]:
    """Whether a road runs in its way's direction, and how far the way goes on behind the road's end [m]."""
    way = shapely.LineString(line.T)
    before, at = (way.project(shapely.Point(point)) for point in end.T)
    return at >= before, (way.length - at if at >= before else at)


def carried(net: Net, found: dict[str, tuple[Way, Arrows]]) -> dict[str, tuple[Way, Arrows]]:
    """The arrows, also at the ends of roads without own ones that just continue a road that has some."""
    after, before = successors(net)
    done = dict(found)
    for road in found:
        at = road
        while len(after[at]) == 1:
            (following,) = after[at]
            same = len(net.roads[following].lanes) == len(net.roads[at].lanes)
            if following in done or not same or before[following] != {at}:
                break
            done[following] = done[at]
            at = following
    return done


def successors(net: Net) -> tuple[dict[str, set[str]], dict[str, set[str]]]:
    """For each road those reached from it and those it is reached from; turning back does not count."""
    after, before = defaultdict(set), defaultdict(set)
    for each in net.connections:
        if each.direction != "turn":
            start, end = net.lanes[each.from_lane].road, net.lanes[each.to_lane].road
            after[start].add(end)
            before[end].add(start)
    return after, before


# -- which road an arrow means ---------------------------------------------------------------------


def forks(net: Net, ways: list[Way], box: Box, notes: Notes, *, left_hand: bool) -> list[Fork]:
    """All forks with arrows; what cannot be matched is noted."""
    after, _ = successors(net)
    found = []
    for road, (way, tags) in arrows_of(net, ways, box, left_hand=left_hand).items():
        if len(after[road]) < 2:
            continue
        if len(tags) + 1 == len(net.roads[road].lanes) and way.tags["highway"] in RAMPED:
            source = "a ramp leaves the motorway"
            notes.guess("ramp lane", "one more lane at the kerb", spot_of(way), source=source, sure="low", key="turn:lanes")
            tags = (frozenset(), *tags)
        if len(tags) != len(net.roads[road].lanes):
            what = f"arrows for {len(tags)} lanes, {len(net.roads[road].lanes)} are built"
            notes.skip("turn lanes", what, spot_of(way), "the numbers of lanes differ")
            found.append(Fork(road, (), (), unbuilt=sum(map(bool, tags))))
            continue
        names, turns = set().union(*tags), {each: turn_to(net, road, each) for each in sorted(after[road])}
        meant = matched(names, turns)
        for arrow in sorted(names - set(meant)):
            notes.skip("arrow", arrow, spot_of(way), "no road leads that way")
        also = besides(meant, turns)
        wanted = tuple(frozenset(meant[arrow] for arrow in lane if arrow in meant) for lane in tags)
        allowed = tuple(frozenset(r for arrow in lane for r in also.get(arrow, ())) for lane in tags)
        if any(wanted):
            found.append(Fork(road, wanted, tuple(w | a for w, a in zip(wanted, allowed, strict=True))))
    return found


def besides(meant: dict[str, str], turns: dict[str, float]) -> dict[str, set[str]]:
    """For each arrow the roads that it may mean besides its own: those that no arrow means and that are most like it."""
    also = defaultdict(set)
    for road, turn in turns.items():
        likeness = {arrow: abs(ANGLE[arrow] - turn) for arrow in meant}
        nearest = min(likeness, key=likeness.__getitem__, default=None)
        if road not in meant.values() and nearest is not None and likeness[nearest] < UNLIKE:
            also[nearest].add(road)
    return also


def turn_to(net: Net, road: str, following: str) -> float:
    """How far one turns to the left from the end of a road to the beginning of another one [deg]."""
    before, at = end_of(net, road).T
    lines = [net.lanes[lane].centre for lane in net.roads[following].lanes]
    start = np.mean([line[:, 0] for line in lines], axis=0)
    ahead = np.mean([curve.along(line, np.array([min(AHEAD, curve.length(line))]))[:, 0] for line in lines], axis=0)
    return math.degrees(portable.turn(at - before, ahead - start))


def matched(names: set[str], turns: dict[str, float]) -> dict[str, str]:
    """The road that each arrow means: in order from left to right, with the least difference of angles."""
    arrows = sorted(names, key=lambda name: (-ANGLE[name], name))
    roads = sorted(turns, key=lambda road: -turns[road])
    options = itertools.combinations_with_replacement(range(len(roads)), len(arrows))
    best = min(options, key=lambda option: unlikeness(arrows, [roads[i] for i in option], turns), default=())
    pairs = zip(arrows, (roads[i] for i in best), strict=True)
    return {name: road for name, road in pairs if abs(ANGLE[name] - turns[road]) < UNLIKE}


def unlikeness(names: list[str], roads: list[str], turns: dict[str, float]) -> float:
    """How badly arrows and roads fit together [deg]."""
    apart = sum(min(UNLIKE, abs(ANGLE[name] - turns[road])) for name, road in zip(names, roads, strict=True))
    return apart + SHARED * (len(roads) - len(set(roads)))


def leads_to(net: Net) -> dict[int, set[str]]:
    """For each lane the roads it leads to."""
    leads = defaultdict(set)
    for each in net.connections:
        if each.direction != "turn":
            leads[each.from_lane].add(net.lanes[each.to_lane].road)
    return leads


def count(net: Net, found: list[Fork]) -> TurnCount:
    """How many lanes with arrows there are at forks, and how many lead just where their arrows say."""
    leads = leads_to(net)
    matched_forks = [fork for fork in found if fork.wanted]
    lanes = [lane for fork in matched_forks for lane in zip(net.roads[fork.road].lanes, fork.wanted, fork.allowed, strict=True)]
    right = [wanted <= leads[lane] <= allowed for lane, wanted, allowed in lanes if wanted]
    return TurnCount(len(right) + sum(fork.unbuilt for fork in found), sum(right))


# -- mending ---------------------------------------------------------------------------------------


def mended(net: Net, found: list[Fork], *, left_hand: bool) -> Net:
    """The network with every fork's lanes leading where their arrows say; a road that could be reached still can be."""
    draft = Draft(net)
    for fork in found:
        for target in sorted(draft.targets(fork.road)) if fork.wanted else ():
            draft.settle(fork, target, turn_to(net, fork.road, target), left_hand=left_hand)
    return draft.net()


class Draft:
    """A network whose connections are being changed."""

    def __init__(self, net: Net) -> None:
        self.before = net
        self.lanes, self.roads = list(net.lanes), dict(net.roads)
        self.connections, self.signalled = list(net.connections), set(net.signalled)

    def targets(self, road: str) -> set[str]:
        """The roads reached from a road."""
        lanes = set(self.roads[road].lanes)
        return {self.lanes[c.to_lane].road for c in self.connections if c.from_lane in lanes and c.direction != "turn"}

    def settle(self, fork: Fork, target: str, turn: float, *, left_hand: bool) -> None:
        """Lets just those lanes of a fork lead to a road that shall."""
        lanes = self.roads[fork.road].lanes
        existing = [c for c in self.connections if c.from_lane in lanes and self.lanes[c.to_lane].road == target]
        must = {lane for lane, wanted in zip(lanes, fork.wanted, strict=True) if target in wanted}
        may = {lane for lane, allowed in zip(lanes, fork.allowed, strict=True) if target in allowed or not allowed}
        kept = [c for c in existing if c.from_lane in must | may]
        missing = [lane for lane in lanes if lane in must and lane not in {c.from_lane for c in kept}]
        if not kept and not missing:
            missing = sorted(may)[:1]  # an arrow that may mean this road; without one everything stays
            if not missing:
                return
        gone = {id(c) for c in existing} - {id(c) for c in kept}
        self.connections = [c for c in self.connections if id(c) not in gone]
        inward = turn > 0.0 if not left_hand else turn < 0.0
        self.add(fork.road, target, kept, missing, existing[0].direction, inward=inward)

    def add(self, road: str, target: str, kept: list[Connection], missing: list[int], direction: str, *, inward: bool) -> None:
        """Connects lanes with a road, beside the neighbours that lead there already."""
        onto = {self.lanes[c.from_lane].index: self.lanes[c.to_lane].index for c in kept}
        own, last = self.roads[road].lanes, len(self.roads[target].lanes) - 1
        for lane in missing:
            index = self.lanes[lane].index
            above, below = [i for i in onto if i > index], [i for i in onto if i < index]
            if below:
                to = onto[max(below)] + 1
            elif above:
                to = onto[min(above)] - (min(above) - index)
            else:
                to = last - (len(own) - 1 - index) if inward else index
            onto[index] = int(np.clip(to, 0, last))
            self.connect(lane, self.roads[target].lanes[onto[index]], direction)
        if any(lane in self.signalled for lane in own):
            self.signalled |= set(missing)

    def connect(self, start: int, end: int, direction: str) -> None:
        """Adds a connection with a smooth way through the junction."""
        a, b = self.lanes[start], self.lanes[end]
        line = through(a.centre, b.centre)
        number, road = len(self.lanes), f":turn_{start}_{end}"
        length, speed = curve.length(line), (a.speed + b.speed) / 2.0
        height = np.interp(curve.stations(line), [0.0, length], [a.height[-1], b.height[0]])
        self.lanes.append(Lane(number, road, 0, min(a.width, b.width), speed, line, True, length, height=height))
        junction = self.roads[a.road].to_junction
        self.roads[road] = Road(road, "", (number,), junction, junction, speed, length, True)
        self.connections.append(Connection(start, end, (number,), -1, direction))

    def net(self) -> Net:
        """The network as it is now."""
        return replace(
            self.before, lanes=tuple(self.lanes), roads=self.roads, connections=tuple(self.connections),
            signalled=frozenset(self.signalled),
        )  # fmt: skip


def through(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """A smooth line from the end of one lane to the start of another."""
    a, b = before[:, -1], after[:, 0]
    inner = hermite(a, b, unit(a - before[:, -2]), unit(after[:, 1] - b), spacing=DETAIL)
    return np.column_stack([a, inner, b])
