"""Routes run over lanes that really follow one another."""

import itertools

import pytest

from studio.errors import MapError, RouteError
from studio.road import load
from studio.road.ways.path import path
from studio.road.ways.route import all_routes, arms, connect
from studio.road.ways.trip import trip
from tests.road.conftest import lane, network
from tests.road.plot import plot


def test_every_step_is_a_connection_or_a_lane_change(place, routes):
    follows = {
        pair for connection in place.connections for pair in itertools.pairwise((connection.from_lane, *connection.via, connection.to_lane))
    }
    for route in routes:
        for a, b in itertools.pairwise(route.lanes):
            one, other = place.lanes[a], place.lanes[b]
            beside = one.road == other.road and abs(one.index - other.index) == 1 and not one.internal
            assert (a, b) in follows or beside


def test_routes_go_where_they_are_sent(place):
    entries, exits = arms(place)
    for entry, end in itertools.product(entries, exits):
        roads = connect(place, [entry, end]).roads(place)
        assert roads[0] == entry and roads[-1] == end
        assert len(set(roads)) == len(roads)


def test_roads_between_are_passed_in_order(place):
    entries, exits = arms(place)
    around = [road.id for road in place.roads.values() if road.name == "Großer Stern" and not road.internal]
    for road in around:
        roads = connect(place, [entries[0], road, exits[0]]).roads(place)
        assert road in roads[1:-1]


def test_a_route_may_start_on_any_lane(place):
    entries, exits = arms(place)
    for number in range(len(place.roads[entries[0]].lanes)):
        route = connect(place, [entries[0], exits[2]], start_lane=number)
        assert place.lanes[route.lanes[0]].index == number


def test_one_road_is_a_route(place):
    entry = arms(place).entries[0]
    route = connect(place, [entry], start_lane=1)
    assert [place.lanes[lane].index for lane in route.lanes] == [1]


def test_a_lane_change_is_taken_only_where_needed(straight):
    assert connect(straight, ["a"], start_lane=1).lanes == (1,)


def test_unknown_road_names_the_nearest(place):
    entry = arms(place).entries[0]
    with pytest.raises(RouteError, match=f"did you mean '{entry}'") as error:
        connect(place, [entry + "x", arms(place).exits[0]])
    assert error.value.problems[0].where == "roads[0]"


def test_a_pair_without_a_way_is_named(place):
    entries, exits = arms(place)
    with pytest.raises(RouteError) as error:
        connect(place, [exits[0], entries[0]])
    assert exits[0] in error.value.message and entries[0] in error.value.message
    assert "leads out of the map" in str(error.value)
    with pytest.raises(RouteError, match="after"):
        connect(place, [entries[0], entries[1]])


def test_the_second_pair_without_a_way_is_named(place):
    entries, exits = arms(place)
    with pytest.raises(RouteError) as error:
        connect(place, [entries[0], exits[0], exits[1]])
    assert error.value.problems[0].where == "roads[2]"


@pytest.mark.parametrize("lane", [-1, 17])
def test_a_lane_that_is_not_there(place, lane):
    with pytest.raises(RouteError, match="0 to 2"):
        connect(place, [arms(place).entries[0]], start_lane=lane)


def test_an_empty_route(place):
    with pytest.raises(RouteError, match="at least one"):
        connect(place, [])


# -- roads that are hardly there -------------------------------------------------------------------


@pytest.mark.parametrize("length", [0.02, 0.3, 0.9, 1.5, 1.99])
def test_a_way_of_a_metre_is_none(length):
    short = network([lane(0, "a", 0, [[0.0, length], [0.0, 0.0]])])
    with pytest.raises(RouteError, match=f"{length:.2f} m of 'a'.*at least 2 m"):
        connect(short, ["a"])
    assert all_routes(short) == ()
    with pytest.raises(MapError, match="no way to drive along"):
        trip(short)


@pytest.mark.parametrize("length", [2.0, 2.3, 3.1, 7.0])
def test_a_way_of_some_metres_is_one(own_cache, length):
    short = network([lane(0, "a", 0, [[0.0, length], [0.0, 0.0]])])
    assert path(short, connect(short, ["a"])).length == pytest.approx(length, abs=1.0)


def test_between_two_ways_of_a_metre_one_drives(own_cache):
    """A road may well lead over another that is hardly there."""
    lanes = [lane(0, "a", 0, [[0.0, 90.0], [0.0, 0.0]]), lane(1, "b", 0, [[90.0, 90.02], [0.0, 0.0]]),
             lane(2, "c", 0, [[90.02, 200.0], [0.0, 0.0]])]  # fmt: skip
    three = network(lanes, [(0, 1), (1, 2)])
    line = path(three, connect(three, ["a", "b", "c"]))
    assert line.length == 200.0 and [each.road for each in line.stations] == ["a", "b", "c"]


@pytest.mark.parametrize("apart", [6, 10, 15, 25])
def test_trips_where_a_link_is_swallowed_by_its_junctions(tmp_path, own_cache, apart):
    """Two carriageways and a link between them, of which the junctions leave nothing, or centimetres."""
    nodes = {1: (-200, 0), 2: (0, 0), 3: (200, 0), 4: (-200, apart), 5: (0, apart), 6: (200, apart)}
    both = {"highway": "primary", "oneway": "yes", "lanes": "2"}
    ways = {11: ([1, 2], both), 12: ([2, 3], both), 13: ([6, 5], both), 14: ([5, 4], both)}
    link = {15: ([2, 5], {"highway": "primary_link", "oneway": "yes", "lanes": "1"})}
    town = load(plot(tmp_path / "dual.osm", nodes, ways | link))
    for seed in range(1, 25):
        assert trip(town, seed=seed).length > 60.0
    length = town.lanes_of("15")[0].length
    told = [each.where for each in town.report.guesses if each.kind == "short road"]
    assert told == (["way 15"] if length < 1.0 else []) and (apart < 25 or length > 1.0)
