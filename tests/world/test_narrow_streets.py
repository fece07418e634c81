"""Streets with one lane for both directions are passed one after the other: nobody meets anybody on it, and everybody gets through."""

import numpy as np
import pytest
import yaml

from studio import job
from studio.assess.measure import measure_all
from studio.errors import ScenarioError
from studio.execution.simulation import simulation
from studio.vehicle.parameter import FRONT, LENGTH
from studio.vehicle.state import ACTIVE, V_X
from studio.world.build import build
from studio.world.table.mind import STATION
from studio.world.table.web import ENTER, OWN_ENTER, OWN_LEAVE
from studio.world.tick import tick
from tests.road.plot import LONDON, plot
from tests.road.test_shared import NARROW, street

EAST, WEST = ["11", "12", "13"], ["-13", "-12", "-11"]


def written(folder, routes, vehicles, **more):
    """The scenario on the map of a folder."""
    (folder / "case.yaml").write_text(
        yaml.safe_dump(
            {"version": 3, "title": "Narrow", "map": {"file": "map.osm"}, "routes": {k: {"roads": r} for k, r in routes.items()},
             "vehicles": vehicles} | more
        ), encoding="utf-8",
    )  # fmt: skip
    return job.prepare(job.load(folder / "case.yaml"))


class Run:
    """Cars from both sides, tick by tick: who is on the ground, and how slowly everybody has been."""

    def __init__(self, folder, east, west, *, seconds=120.0):
        """`east` and `west` are where the cars of either side begin [m]."""
        starts = [("east", each) for each in east] + [("west", each) for each in west]
        vehicles = {f"{way}_{i}": {"route": way, "position": {"along": at}, "speed": 8.0} for i, (way, at) in enumerate(starts)}
        self.world = world = build([written(folder, {"east": EAST, "west": WEST}, vehicles)])
        self.way = np.array([way == "east" for way, _ in starts])
        self.on_it, self.slowest, self.slowest_at = [], np.full(world.size, np.inf), np.zeros(world.size)
        enter, leave = self.ground()
        while world.vehicles.state[ACTIVE].any() and world.clock.time < seconds:
            tick(world)
            nose = world.vehicles.mind[STATION] + world.vehicles.parameter[FRONT]
            self.on_it.append((nose > enter) & (nose - world.vehicles.parameter[LENGTH] < leave) & (world.vehicles.state[ACTIVE] > 0))
            slower = world.vehicles.state[V_X] < self.slowest
            slower &= nose < leave
            self.slowest_at[slower], self.slowest[slower] = (enter - nose)[slower], world.vehicles.state[V_X, slower]

    def ground(self):
        """Where the ground begins and ends on the line of every car [m]."""
        web, first = self.world.roads.web, self.world.roads.drive_first
        found = []
        for at, count in zip(first, self.world.roads.drive_count, strict=True):
            for d in range(at, at + count):
                met = range(web.first[web.strand[d]], web.first[web.strand[d] + 1])
                found += [web.drive[ENTER, d] + web.span[[OWN_ENTER, OWN_LEAVE], m] for m in met if web.turn[m] >= 4]
        return np.array(found).T

    def is_fine(self):
        """Nobody was hit, all have arrived, and never were both directions on the ground at once."""
        on_it = np.array(self.on_it)
        both = on_it[:, self.way].any(axis=1) & on_it[:, ~self.way].any(axis=1)
        return self.world.events.hits_found == 0 and not self.world.vehicles.state[ACTIVE].any() and not both.any()


@pytest.mark.parametrize("length", [60.0, 120.0, 200.0])
@pytest.mark.parametrize("centre", [None, LONDON])
def test_of_two_who_meet_one_waits_outside(tmp_path, length, centre):
    """As far from it both: one passes without standing, the other stands before the ground begins."""
    street(tmp_path / "map.osm", length, centre=centre)
    run = Run(tmp_path, [200.0], [200.0])
    assert run.is_fine()
    waiting = int(run.slowest.argmin())
    assert run.slowest[waiting] < 0.1 and 0.0 < run.slowest_at[waiting] < 5.0
    assert run.slowest[1 - waiting] > 5.0


@pytest.mark.parametrize(("east", "west", "waits"), [([210.0], [130.0], 1), ([130.0], [210.0], 0)])
def test_who_is_nearer_goes_first(tmp_path, east, west, waits):
    street(tmp_path / "map.osm", 150.0)
    run = Run(tmp_path, east, west)
    assert run.is_fine() and run.slowest.argmin() == waits


@pytest.mark.parametrize(("priority", "waits"), [("forward", 1), ("backward", 0)])
@pytest.mark.parametrize("ahead", [0.0, 15.0])
def test_a_sign_gives_the_right(tmp_path, priority, waits, ahead):
    """Though the other is a little nearer."""
    street(tmp_path / "map.osm", 100.0, {"priority": priority})
    starts = [[190.0], [190.0]]
    starts[waits][0] += ahead
    run = Run(tmp_path, *starts)
    assert run.is_fine() and run.slowest.argmin() == waits


def test_nobody_waits_for_nobody(tmp_path):
    street(tmp_path / "map.osm", 100.0)
    run = Run(tmp_path, [200.0, 170.0], [])
    assert run.is_fine() and run.slowest.min() > 5.0


def test_three_against_three(tmp_path):
    street(tmp_path / "map.osm", 120.0)
    assert Run(tmp_path, [200.0, 175.0, 150.0], [200.0, 175.0, 150.0]).is_fine()


# -- much traffic ----------------------------------------------------------------------------------


def measured(folder, routes, rate, seconds):
    """What is measured when cars come in from all sides."""
    flows = {name: {"route": name, "rate": rate} for name in routes}
    vehicles = {"first": {"route": next(iter(routes)), "position": {"along": 30.0}, "speed": 8.0}}
    running = simulation(written(folder, routes, vehicles, traffic={"count": 0, "flows": flows}, clock={"duration": seconds}))
    while not running.is_over:
        running.advance(500)
    return {name: each.value for name, each in measure_all(running.record(), None, print).items()}


def is_alive(found, least):
    """Nobody was hit, no ring of waiting cars, and cars arrive up to the end."""
    return found["collisions"] == 0 and found["longest_deadlock"] < 30.0 and found["left_road"] == 0 and found["arrivals"] >= least


@pytest.mark.parametrize("length", [60.0, 200.0])
def test_twenty_cars_from_both_sides(tmp_path, length):
    """150 cars an hour from either side for four minutes are twenty."""
    street(tmp_path / "map.osm", length)
    assert is_alive(measured(tmp_path, {"east": EAST, "west": WEST}, 150.0, 300.0), 12)


def test_three_such_streets_one_behind_the_other(tmp_path):
    """Between them there is room for one car of either side to wait: who would stand on the ground of one street stays before it."""
    nodes = {1: (-400, 0), 2: (-150, 0), 3: (-50, 0), 4: (50, 0), 5: (150, 0), 6: (400, 0)}
    parts = {12: "30", 13: "20", 14: "30"}
    ways = {
        11: ([1, 2], {}),
        **{way: ([way - 10, way - 9], NARROW | {"maxspeed": speed}) for way, speed in parts.items()},
        15: ([5, 6], {}),
    }
    plot(tmp_path / "map.osm", nodes, ways)
    roads = ["11", "12", "13", "14", "15"]
    found = measured(tmp_path, {"east": roads, "west": [f"-{road}" for road in reversed(roads)]}, 150.0, 400.0)
    assert is_alive(found, 12)


def test_four_such_streets_that_meet(tmp_path):
    nodes = {1: (0, 0), 2: (-100, 0), 3: (100, 0), 4: (0, -100), 5: (0, 100), 6: (-300, 0), 7: (300, 0), 8: (0, -300), 9: (0, 300)}
    narrow = {11: [2, 1], 12: [1, 3], 13: [4, 1], 14: [1, 5]}
    wide = {21: [6, 2], 22: [3, 7], 23: [8, 4], 24: [5, 9]}
    plot(tmp_path / "map.osm", nodes, {k: (line, NARROW) for k, line in narrow.items()} | {k: (line, {}) for k, line in wide.items()})
    routes = {
        "east": ["21", "11", "12", "22"], "west": ["-22", "-12", "-11", "-21"], "north": ["23", "13", "14", "24"],
        "south": ["-24", "-14", "-13", "-23"], "left": ["21", "11", "14", "24"], "right": ["-22", "-12", "14", "24"],
    }  # fmt: skip
    assert is_alive(measured(tmp_path, routes, 60.0, 400.0), 15)


@pytest.mark.parametrize(("east", "west", "refused"), [
    (330, 330, True), (300, 340, True), (345, 320, True),
    (200, 330, False), (330, 150, False), (120, 120, False),  # one of them, or both, before the street
    (380, 380, False),  # each behind the other
])  # fmt: skip
def test_two_that_start_face_to_face_are_refused(tmp_path, east, west, refused):
    """250 m of street, 200 m with one lane, 250 m of street: from either end the ground begins some 20 m behind the first."""
    street(tmp_path / "map.osm", 200.0)
    cars = {name: {"route": name, "position": {"along": at}, "speed": 0} for name, at in (("east", east), ("west", west))}
    routes = {"east": EAST, "west": WEST}
    if refused:
        with pytest.raises(ScenarioError) as told:
            written(tmp_path, routes, cars)
        (problem,) = told.value.problems
        assert "vehicles.east.position" in problem.where and "face to face with 'west'" in problem.what
        assert "before that street" in problem.remedy
    else:
        written(tmp_path, routes, cars)


def test_three_in_a_row_are_not_face_to_face(tmp_path):
    street(tmp_path / "map.osm", 200.0)
    written(tmp_path, {"east": EAST}, {f"car_{i}": {"route": "east", "position": {"along": 300 + 20 * i}, "speed": 0} for i in range(3)})
