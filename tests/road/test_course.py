"""Where lanes lead, against the map's own connections."""

import numpy as np
import pytest

from studio.road import load
from studio.road.network.index import KERB_SIDE, LIGHT, MIDDLE_SIDE, NONE, index_of, joined
from studio.road.ways.course import ahead, follow, light, light_at_end, successors
from studio.road.ways.frenet import Place, to_world
from tests.road.conftest import lane, network
from tests.road.test_places import FILES


@pytest.fixture(scope="module", params=FILES)
def here(request):
    return load(FILES[request.param])


def test_successors_are_the_maps_connections(here):
    told = {(c.from_lane, c.to_lane, c.via, c.direction == "turn") for c in here.connections}
    found = {(each.id, step.to, step.via, step.back) for each in here.lanes if not each.internal for step in successors(here, each.id)}
    assert found == told


def test_ways_through_junctions_lead_on_as_their_connection_does(here):
    for c in here.connections:
        for i, via in enumerate(c.via):
            assert (c.to_lane, c.via[i + 1 :]) in {(step.to, step.via) for step in successors(here, via)}


def test_turning_back_comes_last(here):
    for each in here.lanes:
        backs = [step.back for step in successors(here, each.id)]
        assert backs == sorted(backs)


def test_lanes_beside(here):
    spans = index_of(here).spans
    for road in here.roads.values():
        if not road.internal:
            assert [spans[KERB_SIDE, each] for each in road.lanes] == [NONE, *road.lanes[:-1]]
            assert [spans[MIDDLE_SIDE, each] for each in road.lanes] == [*road.lanes[1:], NONE]


def walked(here, place, distance):
    """The same as `ahead`, by the map's own connections and lengths."""
    number, s = place.lane, place.s
    while distance > here.lanes[number].length - s:
        onward = [step for step in successors(here, number) if not step.back]
        if not onward:
            return number, here.lanes[number].length, distance - (here.lanes[number].length - s)
        distance -= here.lanes[number].length - s
        number, s = (*onward[0].via, onward[0].to)[0], 0.0
    return number, s + distance, 0.0


def test_following_adds_up(here):
    """A hundred metres at once or in ten pieces is the same place, and the one that the connections lead to."""
    for each in here.lanes[:: max(1, len(here.lanes) // 60)]:
        start = Place(each.id, 0.3 * each.length, 0.0)
        once, left = ahead(here, start, 100.0)
        place, rest = start, 0.0
        for _ in range(10):
            place, more = ahead(here, place, 10.0)
            rest += more
        assert (once.lane, once.s, left) == pytest.approx(walked(here, start, 100.0), abs=1e-4)
        assert left == pytest.approx(rest, abs=1e-6)
        a, b = to_world(here, once), to_world(here, place)
        assert np.hypot(a.x - b.x, a.y - b.y) < 1e-6


def test_straight_on_at_a_fork():
    """From the end of a lane one way goes on east, one turns off to the north."""
    lanes = [lane(0, "in", 0, [[0, 100], [0, 0]]), lane(1, "left", 0, [[100, 100], [0, 80]]), lane(2, "on", 0, [[100, 180], [0, 5]])]
    fork = network(lanes, [(0, 1), (0, 2)])
    assert [step.to for step in successors(fork, 0)] == [2, 1]
    assert ahead(fork, Place(0, 90.0, 1.5), 20.0) == (Place(2, pytest.approx(10.0), 1.5), 0.0)
    assert ahead(fork, Place(0, 90.0, 0.0), 100.0)[1] == pytest.approx(100.0 - 10.0 - fork.lanes[2].length)


def test_a_ring_of_lanes_without_length_ends():
    dots = network([lane(0, "a", 0, [[0, 0], [0, 0]]), lane(1, "b", 0, [[0, 0], [0, 0]])], [(0, 1), (1, 0)])
    _, left = ahead(dots, Place(0, 0.0, 0.0), 1.0)
    assert left > 0.9


def test_lights_are_those_of_the_signals(here):
    signals = here.signals
    for link, number in enumerate(signals.link_lane.tolist()):
        for t in np.arange(0.0, 140.0, 3.7):
            assert light(here, number, t) == signals.state(link, t)
    dark = set(range(len(here.lanes))) - set(signals.link_lane.tolist())
    assert all(light(here, number, 1.0) is None for number in sorted(dark)[:20])


def test_maps_side_by_side_lead_on_as_each_alone():
    maps = [load(FILES[name]) for name in ("munich_olympiapark", "seattle_i5_exit_ramp")]
    both, base = joined([index_of(each) for each in maps]), len(maps[0].lanes)
    for each, shift in zip(maps, (0, base), strict=True):
        index = index_of(each)
        for number in range(0, len(each.lanes), 7):
            lane_alone, s, left = follow(index, number, 0.0, 150.0)
            assert follow(both, number + shift, 0.0, 150.0) == (lane_alone + shift, s, left)
            assert light_at_end(both, number + shift, 11.0) == light_at_end(index, number, 11.0)
            assert (both.spans[LIGHT, number + shift] == NONE) == (index.spans[LIGHT, number] == NONE)
