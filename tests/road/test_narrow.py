"""Turns narrower than a car's lock are told, with what is driven; those that no car gets round are left out."""

from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from studio.errors import RouteError
from studio.road import load
from studio.road.assembly.narrow import drivable
from studio.road.network import Connection, Lane, Net, Road, curve
from studio.road.network.report import Notes, Spot
from studio.road.ways.approach import Approaches
from studio.road.ways.lock import MOST_ASIDE, bend_over
from studio.road.ways.path import PATH_CURVATURE, PATH_HEADING, path
from studio.road.ways.route import arms, away, connect
from studio.road.ways.strand import strands_of
from studio.scenario import catalogue, figures
from tests.road.plot import BERLIN, LONDON, plot

ROOT = Path(__file__).parents[2]
MAPS = {
    each.name.split(".")[0]: each
    for folder in (ROOT / "tests" / "reference" / "maps", ROOT / "scenarios" / "maps")
    for each in sorted(folder.iterdir())
    if each.suffix != ".md"
}
TRUCK = figures.lock(catalogue.find_vehicle("truck").values)


def net_of(radius, turn=90.0, *, others=True):
    """East on `in`, then to the left by a turn [deg] with this radius [m] onto `up`; with others, straight on to `on`, and from `by`
    straight onto `up`."""
    angle = np.linspace(0.0, np.radians(turn), 60)
    bend = np.array([100.0 + radius * np.sin(angle), radius * (1.0 - np.cos(angle))])
    end, ahead = bend[:, -1], np.array([np.cos(angle[-1]), np.sin(angle[-1])])

    def along(start, stop):
        return np.column_stack([end + start * ahead, end + stop * ahead])

    lines = {
        "in": np.array([[0.0, 100.0], [0.0, 0.0]]), ":turn": bend, "up": along(0.0, 80.0), "on": np.array([[120.0, 200.0], [0.0, 0.0]]),
        ":on": np.array([[100.0, 120.0], [0.0, 0.0]]), "by": along(-100.0, -20.0), ":by": along(-20.0, 0.0),
    }  # fmt: skip
    lanes = tuple(Lane(i, name, 0, 3.2, 10.0, line, name[0] == ":", curve.length(line)) for i, (name, line) in enumerate(lines.items()))
    roads = {each.road: Road(each.road, "", (each.id,), "", "", 10.0, each.length, each.internal) for each in lanes}
    made = [Connection(0, 2, (1,), -1, "left")]
    made += [Connection(0, 3, (4,), -1, "straight"), Connection(5, 2, (6,), -1, "straight")] if others else []
    return Net(lanes, roads, tuple(made), (), frozenset(), {})


def looked_at(net):
    notes = Notes()
    return drivable(net, lambda each: Spot("here", 0.0, 0.0), notes), notes


@pytest.mark.parametrize(("radius", "turn"), [(0.8, 90.0), (2.0, 90.0), (4.5, 90.0), (5.0, 60.0), (1.2, 120.0)])
def test_a_turn_that_is_driven_wider_is_told(radius, turn):
    """Drawn narrower than the lock's radius of 5.3 m; the line that is driven uses the room beside it."""
    made = net_of(radius, turn)
    kept, notes = looked_at(made)
    (entry,) = notes.guesses
    assert len(kept.connections) == len(made.connections) and not notes.skipped
    assert "from road in to road up, drawn with a radius of" in entry.what and "driven with" in entry.what
    assert bend_over(Approaches(made), made.connections[0], curve.LOCK).is_within(curve.LOCK)


@pytest.mark.parametrize("turn", [172.0, 178.0])
def test_a_turn_that_no_car_gets_round_is_left_out_and_told(turn):
    """Back beside the own lane, 2 m apart, where half a circle needs 10.5 m: more than 3 m to each side."""
    kept, notes = looked_at(net_of(1.0, turn))
    (entry,) = notes.skipped
    assert entry.kind == "turn" and "no car gets round" in entry.reason and "from road in to road up" in entry.what
    assert [(each.from_lane, each.to_lane) for each in kept.connections] == [(0, 3), (5, 2)]


@pytest.mark.parametrize("radius", [6.0, 12.0, 40.0])
def test_of_a_turn_with_room_nobody_speaks(radius):
    _, notes = looked_at(net_of(radius))
    assert not notes.guesses and not notes.skipped


# -- on maps ---------------------------------------------------------------------------------------


@pytest.fixture(scope="module", params=MAPS)
def place(request):
    return load(MAPS[request.param])


def test_every_way_through_a_junction_is_driven_within_a_cars_lock(place):
    strands, over = strands_of(place), []
    for i, connection in enumerate(place.connections):
        first, count = strands.first[strands.lanes + i], strands.count[strands.lanes + i]
        if connection.direction != "turn" and count > 2:
            heading = strands.points[PATH_HEADING, first : first + count]
            sharpest = float(np.abs(np.diff(heading)).max() / strands.spacing[strands.lanes + i])
            over += [(connection, sharpest)] if sharpest > curve.LOCK else []
    assert not over


def test_every_turn_that_was_drawn_too_narrow_is_in_the_report(place):
    narrow = [each for each in place.connections if each.direction != "turn" and each.sharpest > curve.LOCK]
    told = [each for each in place.report.guesses if each.kind == "wider turn"]
    assert len(narrow) == len(told)
    assert all(bend_over(Approaches(place), each, curve.LOCK).aside <= MOST_ASIDE for each in narrow)


# -- trucks ----------------------------------------------------------------------------------------


def test_the_lock_is_what_the_wheels_allow():
    """sin(0.75)/5.1 m with a reserve of 8 % for the truck; every car of the catalogue drives what the maps offer."""
    assert pytest.approx(0.92 * np.sin(0.75) / 5.1) == TRUCK
    cars = set(catalogue.vehicle_names()) - {"truck"}
    assert all(figures.lock(catalogue.find_vehicle(name).values) >= curve.LOCK for name in cars)


@pytest.fixture(scope="module")
def mitte():
    return load(MAPS["berlin_mitte"])


def test_a_truck_is_not_sent_over_a_turn_that_only_cars_can_take(mitte):
    """By 154° onto a road beside the own one: a car swings round, a truck finds no other way, and is told so."""
    roads = ["24243052#1", "465376243#0"]
    car = connect(mitte, roads)
    assert len(car.roads(mitte)) == 2
    with pytest.raises(RouteError) as refused:
        connect(mitte, roads, lock=TRUCK)
    assert "radius of 8.1 m" in str(refused.value) and "too narrow: '24243052#1' to '465376243#0'" in str(refused.value)


def test_a_trucks_line_is_wider(mitte):
    """Where it does get round, its line bends no more than its wheels allow; a car's line over the same lanes does."""
    roads = ["4611694", "251884680#1", "339201217"]
    way = connect(mitte, roads, lock=TRUCK)
    car, truck = (float(np.abs(path(mitte, way, lock=lock).points[PATH_CURVATURE]).max()) for lock in (curve.LOCK, TRUCK))
    assert truck <= TRUCK < car <= curve.LOCK


def test_bends_on_hand_made_maps_need_no_import():
    net = net_of(2.0)
    assert bend_over(Approaches(replace(net)), net.connections[0], TRUCK).curvature <= TRUCK


# -- turns that follow each other closely ----------------------------------------------------------

STREET = {"highway": "residential", "maxspeed": "50"}
CIRCLE = STREET | {"junction": "roundabout", "oneway": "yes", "lanes": "1"}


def rings_in_a_ring(target, *, rings, radius, small, clockwise, centre):
    """Small roundabouts on a circle, each joined with the next one and with a street from outside: the ring junctions of Swindon."""
    nodes, ways, count = {}, {}, 12
    for k in range(rings):
        angle, own = 2 * np.pi * k / rings, []
        for i in range(count):
            turn = angle + (-1 if clockwise else 1) * 2 * np.pi * i / count
            name = 1000 * (k + 1) + i
            nodes[name] = (radius * np.cos(angle) + small * np.cos(turn), radius * np.sin(angle) + small * np.sin(turn))
            own.append(name)
        nodes[100 + k] = ((radius + small + 100) * np.cos(angle), (radius + small + 100) * np.sin(angle))
        ways |= {100 + k: ([*own, own[0]], CIRCLE), 300 + k: ([own[0], 100 + k], STREET)}
    for k in range(rings):
        here, there = ([1000 * (j + 1) + i for i in range(count)] for j in (k, (k + 1) % rings))
        closest = min(((a, b) for a in here for b in there), key=lambda pair: np.hypot(*np.subtract(*map(nodes.get, pair))))
        ways[200 + k] = (list(closest), STREET)
    return plot(target, nodes, ways, centre=centre)


def given_way(network, start, end, lock):
    """The way from a street to another; None for a truck that is told which turns are too narrow for it."""
    if lock == curve.LOCK:
        return connect(network, [start, end])
    with suppress(RouteError):
        return connect(network, [start, end], lock=lock)
    with pytest.raises(RouteError, match="turns no sharper than with a radius of 8"):
        connect(network, [start, end], lock=lock)
    return None


@pytest.mark.parametrize(
    ("rings", "radius", "small", "clockwise", "centre"),
    [(4, 20, 6, False, BERLIN), (4, 24, 7, True, LONDON)],
)
def test_in_rings_within_a_ring_every_way_that_is_given_is_driven_near_its_lanes(tmp_path, rings, radius, small, clockwise, centre):
    """From every street to every other, cars and trucks: within 3 m of the lanes and their lock, or refused with the turns."""
    network = load(rings_in_a_ring(tmp_path / "map.osm", rings=rings, radius=radius, small=small, clockwise=clockwise, centre=centre))
    entries, exits = arms(network)
    assert len(entries) == len(exits) == rings
    given = {curve.LOCK: 0, TRUCK: 0}
    for lock in given:
        for start, end in ((start, end) for start in entries for end in exits if start.lstrip("-") != end.lstrip("-")):
            way = given_way(network, start, end, lock)
            if way is None:
                continue
            given[lock] += 1
            line = path(network, way, lock=lock).points
            assert np.abs(line[PATH_CURVATURE]).max() <= 1.05 * lock
            assert away(line[:2], [network.lanes[lane].centre for lane in way.lanes]).max() <= MOST_ASIDE
    assert given[curve.LOCK] == rings * (rings - 1)
