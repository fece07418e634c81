"""Routes run over lanes that really follow one another."""

import itertools

import pytest

from studio.errors import RouteError
from studio.road.ways.route import arms, connect


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
