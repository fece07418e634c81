"""The quickest way, against other ways to find it; its prices, against closed forms; what is forbidden, against the map."""

import gc
import itertools
import re
import weakref
from dataclasses import replace

import numpy as np
import pytest

from studio.errors import RouteError
from studio.road import load
from studio.road.assembly import extract
from studio.road.formats import osm
from studio.road.network import Connection
from studio.road.network.graph import (
    CHANGE_EASE,
    CHANGE_TIME,
    CLOSED_TIME,
    NARROW_TIME,
    YIELD_TIME,
    cheapest,
    graph_of,
    lane_times,
    mean_wait,
    mean_waits,
)
from studio.road.network.index import index_of
from studio.road.network.signals import AMBER, GREEN, RED, RED_AMBER
from studio.road.ways.route import connect
from tests.road.conftest import lane, network
from tests.road.test_places import FILES


@pytest.fixture(scope="module", params=FILES)
def here(request):
    return load(FILES[request.param])


def price_of(graph, network, lanes):
    """What the edges of a way cost together; None if it is no way of the graph."""
    total, i = 0.0, 0
    while i < len(lanes) - 1:
        node = lanes[i]
        steps = [e for e in range(graph.first[node], graph.first[node + 1]) if graph.ways[e] == lanes[i + 1 : i + 1 + len(graph.ways[e])]]
        if not steps:
            return None
        best = min(steps, key=lambda e: graph.price[e])
        total, i = total + graph.price[best], i + len(graph.ways[best])
    return total


def relaxed(graph, starts, *, turn_back=False):
    """The price of the quickest way to every node (Bellman 1958, Ford 1956): all edges, again and again."""
    cost = np.full(graph.road.size, np.inf)
    cost[list(starts)] = 0.0
    start = np.repeat(np.arange(graph.road.size), np.diff(graph.first))
    usable = np.flatnonzero(~graph.back | turn_back)
    for _ in range(graph.road.size):
        before = cost.copy()
        np.minimum.at(cost, graph.to[usable], before[start[usable]] + graph.price[usable])
        if (cost == before).all():
            return cost
    raise AssertionError("a ring of negative price")


def test_routes_are_as_quick_as_those_of_bellman_and_ford(here):
    graph = graph_of(here)
    roads = sorted(road.id for road in here.roads.values() if not road.internal)
    rng = np.random.default_rng(7)
    ways = 0
    for start in rng.choice(roads, 12):
        lanes = [each for each in here.roads[start].lanes if here.lanes[each].open] or list(here.roads[start].lanes)
        cost = relaxed(graph, lanes)
        for end in rng.choice([road for road in roads if road != start], 12):
            best = min(cost[node] for node in np.flatnonzero(graph.road == graph.number[end]))
            try:
                found = price_of(graph, here, connect(here, [str(start), str(end)]).lanes)
            except RouteError:
                found = np.inf
            ways += np.isfinite(found)
            assert found == pytest.approx(best, abs=1e-9)
    assert ways > 5


def random_network(rng, count):
    """Roads of one or two lanes with random ends, limits and connections."""
    lanes, number = [], 0
    for road in range(count):
        a, b = rng.uniform(0, 300, (2, 2))
        for index in range(rng.integers(1, 3)):
            lanes.append(lane(number, f"r{road:02d}", index, np.array([a, b]).T + 3.2 * index, speed=rng.uniform(5, 20)))
            number += 1
    pairs = {(int(i), int(j)) for i, j in rng.integers(0, number, (3 * count, 2)) if lanes[i].road != lanes[j].road}
    return network(lanes, sorted(pairs))


def enumerated(graph, start, wanted):
    """The least price over all ways without a ring between two of the wanted roads, found by trying them all."""

    def onward(node, stage, spent, seen):
        if stage == len(wanted):
            yield spent
            return
        for edge in range(graph.first[node], graph.first[node + 1]):
            to = int(graph.to[edge])
            if (to, stage) not in seen:
                further = stage + (graph.road[to] == wanted[stage])
                yield from onward(to, further, spent + graph.price[edge], seen | {(to, stage)})

    return min(onward(start, 1, 0.0, {(start, 1)}), default=np.inf)


@pytest.mark.parametrize("seed", range(12))
def test_routes_over_given_roads_are_the_best_of_all(seed):
    """Through three roads in order, on small random networks where every way can be tried."""
    rng = np.random.default_rng(seed)
    small = random_network(rng, 7)
    graph = graph_of(small)
    for roads in itertools.permutations(sorted(small.roads), 3):
        wanted = [graph.number[road] for road in roads]
        start = small.roads[roads[0]].lanes[0]
        best = enumerated(graph, start, wanted)
        _, node, _ = cheapest(graph.first, graph.to, graph.price, graph.back, graph.road, np.array([start]), np.array(wanted), False)
        assert (node >= 0) == np.isfinite(best)
        if node >= 0:
            assert price_of(graph, small, connect(small, roads, start_lane=0).lanes) == pytest.approx(best, abs=1e-9)


# -- prices ----------------------------------------------------------------------------------------


def test_a_straight_lane_takes_its_length_over_its_limit(straight):
    assert lane_times(index_of(straight)) == pytest.approx([200.0 / 13.9] * 2)


def test_a_bend_takes_what_its_radius_allows():
    """v = sqrt(2.5 m/s² · 20 m) where the limit is 30 m/s."""
    angle = np.linspace(0.0, np.pi, 300)
    arc = lane(0, "arc", 0, [20.0 * np.sin(angle), 20.0 * np.cos(angle)], speed=30.0)
    assert lane_times(index_of(network([arc])))[0] == pytest.approx(np.pi * 20.0 / np.sqrt(2.5 * 20.0), rel=2e-3)


def test_the_quicker_way_wins_over_the_shorter():
    """Round 400 m at 25 m/s, or 250 m at 8 m/s; slowed down, the long way loses."""

    def made(fast):
        x = [0.0, 100.0]
        return network(
            [lane(0, "in", 0, [x, [0, 0]]), lane(1, "slow", 0, [[100, 350], [0, 0]], speed=8.0),
             lane(2, "fast", 0, [[100, 300, 350], [0, 1, 0.5]], speed=fast), lane(3, "out", 0, [[350, 400], [0, 0]])],
            [(0, 1), (0, 2), (1, 3), (2, 3)],
        )  # fmt: skip

    assert connect(made(25.0), ["in", "out"]).lanes == (0, 2, 3)
    assert connect(made(7.0), ["in", "out"]).lanes == (0, 1, 3)


@pytest.mark.parametrize("length", [30.0, 100.0, 400.0])
def test_a_lane_change_has_its_price(length):
    """Only the second lane leads on: driving time and 2 s, more where there is little room."""
    x = [0.0, length]
    two = network([lane(0, "a", 0, [x, [0, 0]]), lane(1, "a", 1, [x, [3, 3]]), lane(2, "b", 0, [[length, 2 * length], [3, 3]])], [(1, 2)])
    graph = graph_of(two)
    edge = graph.first[0]
    assert graph.ways[edge] == (1, 2)
    assert graph.price[edge] == pytest.approx(length / 13.9 + CHANGE_TIME * (1.0 + (CHANGE_EASE / length) ** 2))
    assert graph.price[graph.first[1]] == pytest.approx(length / 13.9)


def test_a_closed_lane_is_driven_only_where_nothing_else_leads_on():
    x = [100.0, 200.0]
    lanes = [lane(0, "in", 0, [[0, 100], [0, 0]]), replace(lane(1, "bus", 0, [x, [0, 0]]), open=False),
             lane(2, "round", 0, [[100, 150, 200], [0, 400, 0]]), lane(3, "out", 0, [[200, 300], [0, 0]])]  # fmt: skip
    both = network(lanes, [(0, 1), (0, 2), (1, 3), (2, 3)])
    assert connect(both, ["in", "out"]).lanes == (0, 2, 3)
    assert connect(network(lanes, [(0, 1), (1, 3)]), ["in", "out"]).lanes == (0, 1, 3)
    assert graph_of(both).price[0] == pytest.approx(100.0 / 13.9 + CLOSED_TIME)


def test_who_lets_others_go_first_waits():
    lanes = [lane(0, "in", 0, [[0, 100], [0, 0]]), lane(1, "on", 0, [[100, 200], [0, 0]]), lane(2, "off", 0, [[100, 100], [0, 80]])]
    made = replace(network(lanes), connections=(Connection(0, 1, (), -1, "straight"), Connection(0, 2, (), -1, "left", yields=(0,))))
    assert np.diff(graph_of(made).price) == pytest.approx([YIELD_TIME])


def test_a_turn_that_no_car_gets_round_is_the_last_resort():
    lanes = [lane(0, "in", 0, [[0, 100], [0, 0]]), lane(1, "on", 0, [[100, 200], [0, 0]]), lane(2, "off", 0, [[100, 100], [0, 80]])]
    made = replace(network(lanes), connections=(Connection(0, 1, (), -1, "straight"), Connection(0, 2, (), -1, "right", sharpest=0.4)))
    assert np.diff(graph_of(made).price) == pytest.approx([NARROW_TIME])


def test_the_mean_wait_at_a_light_is_that_of_many_arrivals(here):
    """Against who comes at each of 6600 moments and looks at the light until it is green."""
    signals = here.signals
    for link in range(0, len(signals), max(1, len(signals) // 6)):
        times = np.linspace(0.0, 2.0 * signals.cycle[link], 13_201)
        green = np.array([signals.state(link, t) == GREEN for t in times])
        waits, ahead = [], np.inf
        for t, free in zip(times[::-1], green[::-1], strict=True):
            ahead = t if free else ahead
            if t < signals.cycle[link]:
                waits.append(ahead - t)
        assert mean_waits(signals)[link] == pytest.approx(np.mean(waits), abs=0.03)


def test_the_mean_wait_in_closed_form():
    """Red 40 s of 60 s: 40²/120. Two reds of 20 s: 2 · 20²/120. Red over the end of the cycle counts as one. Never green."""
    assert mean_wait(np.array([20.0, 60.0]), np.array([GREEN, RED])) == pytest.approx(1600.0 / 120.0)
    assert mean_wait(np.array([10.0, 30.0, 40.0, 60.0]), np.array([GREEN, RED, GREEN, RED])) == pytest.approx(2.0 * 400.0 / 120.0)
    assert mean_wait(np.array([1.0, 21.0, 24.0, 60.0]), np.array([RED_AMBER, GREEN, AMBER, RED])) == pytest.approx(1600.0 / 120.0)
    assert mean_wait(np.array([60.0]), np.array([RED])) == 30.0
    assert mean_wait(np.array([60.0]), np.array([GREEN])) == 0.0


# -- what is forbidden -----------------------------------------------------------------------------


RING = [(0, 1), (1, 2), (2, 3), (1, 4), (4, 5), (5, 2), (0, 4)]


def ring():
    """From a over b to c and on to d; from b and from a also over e and f to c."""
    ends = [
        ([0, 100], [0, 0]),
        ([100, 200], [0, 0]),
        ([200, 300], [0, 0]),
        ([300, 400], [0, 0]),
        ([200, 250], [0, 90]),
        ([250, 200], [90, 0]),
    ]
    return network([lane(i, name, 0, end) for i, (name, end) in enumerate(zip("abcdef", ends, strict=True))], RING)


def test_a_ban_over_several_roads_is_kept():
    """Not from a over b to c, although b leads to c for all others; the way round stays open."""
    made = replace(ring(), bans=(("a", "b", "c"),))
    assert connect(ring(), ["a", "d"]).lanes == (0, 1, 2, 3)
    assert connect(made, ["a", "d"]).lanes == (0, 4, 5, 2, 3)
    assert connect(made, ["b", "d"]).lanes == (1, 2, 3)
    assert connect(made, ["a", "b", "d"]).lanes == (0, 1, 4, 5, 2, 3)


def test_bans_that_overlap_are_all_kept():
    made = replace(ring(), bans=(("a", "b", "c"), ("b", "e", "f"), ("a", "e", "f", "c")))
    with pytest.raises(RouteError, match="no way"):
        connect(made, ["a", "d"])
    assert connect(made, ["e", "d"]).lanes == (4, 5, 2, 3)
    assert connect(made, ["b", "d"]).lanes == (1, 2, 3)


def test_turning_back_only_at_a_dead_end_and_only_if_wanted():
    lanes = [lane(0, "in", 0, [[0, 100], [0, 0]]), lane(1, "out", 0, [[100, 0], [3, 3]]), lane(2, "on", 0, [[100, 200], [0, 0]])]
    back = Connection(0, 1, (), -1, "turn")
    dead_end = replace(network(lanes), connections=(back,))
    with pytest.raises(RouteError):
        connect(dead_end, ["in", "out"])
    assert connect(dead_end, ["in", "out"], turn_back=True).lanes == (0, 1)
    with pytest.raises(RouteError):
        connect(replace(network(lanes), connections=(back, Connection(0, 2, (), -1, "straight"))), ["in", "out"], turn_back=True)


def forbidden(here, file):
    """From the file's relations: for each whose ways are named by roads at its node the road before it, those it must not lead
    to, and those one may be meant to come from: found by names and places only."""
    found = osm.survey(file, osm.read(file))
    box = extract.clipped(file, found, None, None)
    where = {node: box.local(*point[::-1]) for way in found.ways for node, point in zip(way.nodes, way.points, strict=True)}
    named = {}
    for road in here.roads.values():
        if not road.internal:
            named.setdefault(int(re.match(r"-?(\d+)", road.id)[1]), []).append(road.id)

    def near(way, node, at):
        apart = {road: np.hypot(*(here.lanes_of(road)[0].centre[:, at] - where[node])) for road in named.get(way, ())}
        best = min(apart, key=apart.get, default=None)
        return best if best is not None and apart[best] < 25.0 else None

    for _, members, tags in found.restrictions:
        ways = {role: ref for form, ref, role in members if form == "w"}
        nodes = [ref for form, ref, role in members if form == "n" and role == "via"]
        if len(nodes) == 1 and nodes[0] in where and {"from", "to"} <= set(ways) and "via" not in ways:
            start, end = near(ways["from"], nodes[0], -1), near(ways["to"], nodes[0], 0)
            if start and end:
                yield start, end, tags.get("restriction", "")


def follows(here):
    """For each road those that a connection leads to, turning back too."""
    found = {}
    for each in here.connections:
        found.setdefault(here.lanes[each.from_lane].road, set()).add(here.lanes[each.to_lane].road)
    return found


def crossing(draft, target, relation):
    """Two one-way carriageways, eastbound (1 to the west of a link, 2 behind it) and westbound (3, 4), joined by the link 5; a street
    6 goes on south from the eastbound one."""
    points = {
        "a": (0.0, 0.0),
        "b": (0.0, 0.003),
        "c": (0.0, 0.006),
        "d": (0.0006, 0.006),
        "e": (0.0006, 0.003),
        "f": (0.0006, 0.0),
        "g": (-0.002, 0.003),
    }
    node = {name: draft.node(lat, lon) for name, (lat, lon) in points.items()}
    for number, ends in enumerate(("ab", "bc", "de", "ef", "be", "bg"), start=1):
        draft.way(number, [node[end] for end in ends], highway="primary", oneway="yes", lanes="1", maxspeed="50")
    draft.lines.append(relation.format(**node))
    return load(draft.write(target))


RELATION = '<relation id="9" version="1"><member type="way" ref="1" role="from"/>{}<member type="way" ref="{}" role="to"/>' \
    '<tag k="type" v="restriction"/><tag k="restriction" v="{}"/></relation>'  # fmt: skip


def over(way):
    return f'<member type="way" ref="{way}" role="via"/>'


NODE = '<member type="node" ref="{b}" role="via"/>'


def reached(here, start):
    """The mapped ways that can be driven to from one of them."""
    found = set()
    for end in "23456":
        try:
            roads = [next(r for r in here.roads if r.split("#")[0] == way and not here.roads[r].internal) for way in (start, end)]
            connect(here, roads)
            found.add(end)
        except RouteError:
            pass
    return found - {start}


def test_restrictions_over_a_node_and_over_a_way(draft, tmp_path, own_cache):
    """From 1 one may go on to 2, over 5 back on 4, and off to 6."""
    assert reached(crossing(draft, tmp_path / "free.osm", ""), "1") == {"2", "4", "5", "6"}


@pytest.mark.parametrize(
    ("relation", "left"),
    [
        (RELATION.format(NODE, 6, "no_right_turn"), {"2", "4", "5"}),
        (RELATION.format(NODE, 2, "only_straight_on"), {"2"}),
        (RELATION.format(over(5), 4, "no_u_turn"), {"2", "5", "6"}),
    ],
)
def test_a_restriction_closes_its_turn_only(draft, tmp_path, own_cache, relation, left):
    here = crossing(draft, tmp_path / "bound.osm", relation)
    assert reached(here, "1") == left
    assert reached(here, "5") == {"4"}  # who comes from the link is not meant
    assert len(here.bans) == ("no_u_turn" in relation)


@pytest.mark.parametrize("name", ["singapore_bayfront_lht", "manchester_kingsway_lht", "munich_olympiapark", "seattle_i5_exit_ramp"])
def test_no_route_drives_what_the_map_forbids(name):
    """Forbidden turns have no connection, and routes from all roads before a restriction keep to it."""
    here = load(FILES[name])
    onward, told = follows(here), list(forbidden(here, FILES[name]))
    assert told
    rng = np.random.default_rng(3)
    roads = sorted(road.id for road in here.roads.values() if not road.internal)
    for start, end, kind in told:
        leads = onward.get(start, set())
        banned = {end} if kind.startswith("no") else leads - {end} if end in leads else set()
        if not leads - banned:
            continue  # nothing else leads on: the map is taken to be wrong
        assert not leads & banned, (start, end, kind)
        for target in rng.choice(roads, 10):
            try:
                passed = connect(here, [start, str(target)]).roads(here)
            except RouteError:
                continue
            assert not any(a == start and b in banned for a, b in itertools.pairwise(passed))


def test_what_was_made_of_a_map_goes_with_it():
    made = ring()
    graph_of(made), index_of(made)
    gone = weakref.ref(made), weakref.ref(graph_of(made))
    del made
    gc.collect()
    assert gone[0]() is None and gone[1]() is None
