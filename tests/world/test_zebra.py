"""Zebra crossings: who wants to cross is let; without anybody nobody slows down; where lights stand they decide."""

import numpy as np
import pytest
import shapely
import yaml

from studio import job
from studio.road import load
from studio.vehicle.parameter import FRONT
from studio.vehicle.state import ACTIVE, V_X, X, Y
from studio.world.build import build
from studio.world.passes.zebra import is_hidden
from studio.world.table.mind import MINDED, STATION
from studio.world.table.street import O_X, O_Y, OBJECT, Z_FROM, Z_HEADING, Z_LENGTH, Z_TO, Z_WIDTH
from studio.world.tick import tick
from tests.road.conftest import Draft
from tests.road.test_priority import BERLIN, place_at

SPEED, WALKS = 12.0, 1.4  # [m/s], [m/s]
STREET = {"highway": "residential", "lanes": "2", "maxspeed": "50"}


class Street:
    """A straight street from west to east with a crossing in its middle, one car on it, and somebody on foot, tick by tick."""

    def __init__(self, folder, walker, tags, *, seconds=25.0, along=40.0, house=None, things=None, ahead=None):
        """The walker's line is given on the map, from the middle of the street, as the corners of a house are; None for nobody."""
        draft = Draft()
        west, middle, east = (draft.node(*place_at(BERLIN, x, 0), **(tags if x == 0 else {})) for x in (-150, 0, 150))
        draft.way(1, [west, middle, east], **STREET)
        if house:
            corners = [draft.node(*place_at(BERLIN, *corner)) for corner in house]
            draft.way(2, [*corners, corners[0]], building="yes")
        self.network = network = load(draft.write(folder / "street.osm"))
        lane = max(network.lanes, key=lambda each: each.centre[0, -1] - each.centre[0, 0])
        (self.x, self.y), *_ = [each.line.mean(axis=1) for each in network.scenery.crossings]
        document = {
            "version": 3, "title": "Zebra", "map": {"file": "street.osm"}, "clock": {"duration": seconds},
            "routes": {"way": {"roads": [lane.road], "speeds": [{"at": 0, "speed": SPEED}]}},
            "vehicles": {
                name: {"route": "way", "position": {"along": at}, "speed": SPEED} for name, at in (("car", along), ("other", ahead)) if at
            },
        }  # fmt: skip
        document["script"] = {
            name: {"do": {"kind": "mover", "speed": WALKS, **each, "line": [self.place(*corner) for corner in each["line"]]}}
            for name, each in {"walker": walker, **(things or {})}.items()
            if each
        }
        (folder / "street.yaml").write_text(yaml.safe_dump(document), encoding="utf-8")
        self.world = world = build([job.prepare(job.load(folder / "street.yaml"))])
        rows = []
        for _ in range(round(seconds / world.clock.tick)):
            tick(world)
            m = world.vehicles.mind
            state, table = world.vehicles.state, world.obstacles.table
            walker_at = table[[O_X, O_Y], 0] if walker else np.zeros(2)
            rows.append((m[STATION, 0] + world.vehicles.parameter[FRONT, 0], state[V_X, 0], m[MINDED, 0], *state[[X, Y], 0], *walker_at))
        self.nose, self.speed, self.minded, *places = np.array(rows).T
        self.eye, self.walker = np.array(places[:2]), np.array(places[2:])
        self.time = np.arange(len(rows)) * world.clock.tick
        self.edge = float(self.x - lane.centre[0, 0]) - 2.0  # [m] the near edge of the 4 m wide stripes on the path

    def place(self, x, y):
        """A place on the map [m], given from the middle of the street."""
        return [float(self.x + x), float(self.y + y)]

    @property
    def hits(self):
        return self.world.events.hits_found


ZEBRA = {"highway": "crossing", "crossing": "uncontrolled", "crossing_ref": "zebra"}
ACROSS = [[0, -10], [0, 10]]


@pytest.mark.parametrize("line", [[[0, -6], [0, 8]], [[0, 6], [0, -8]]])
def test_who_crosses_slowly_is_waited_for_before_the_stripes(tmp_path, line):
    """From either side, from before his first step until he has left the car's own strip; then it goes on."""
    street = Street(tmp_path, {"line": line, "speed": 0.4}, ZEBRA, seconds=32)
    waits = street.minded == OBJECT
    assert street.speed[waits].min() < 0.1 and (street.nose[waits] < street.edge).all()
    assert street.time[waits][0] == pytest.approx(2.8 / 0.4 - 4.0, abs=0.05)  # his line meets the 6.4 m wide street after 2.8 m
    assert street.hits == 0 and street.nose[-1] > street.edge + 20
    braked = np.diff(street.speed).min() / (street.time[1] - street.time[0])
    assert braked > -4.0  # [m/s²] nobody is made to brake hard


def test_what_a_zebra_is_on_his_line(tmp_path):
    street = Street(tmp_path, {"line": ACROSS}, ZEBRA, seconds=0.1)
    (row,) = street.world.obstacles.movers.zebra.T
    assert row[[Z_FROM, Z_TO, Z_LENGTH, Z_WIDTH]] == pytest.approx([6.8, 13.2, 6.4, 4.0], abs=0.01)
    assert abs(np.sin(row[Z_HEADING])) == pytest.approx(1.0)


@pytest.mark.parametrize(
    "walker",
    [
        None,
        {"line": [[-20, -6], [20, -6]]},  # along the street, past the stripes
        {"line": [[0, -20], [0, -8]], "speed": 0.5},  # to the street, but not onto it
        {"line": [[0, 9], [0, 3.5]], "who": "cyclist"},  # rides: he has to wait (StVO § 26 is for people on foot)
    ],
)
def test_for_nobody_who_wants_to_cross_nobody_slows_down(tmp_path, walker):
    street = Street(tmp_path, walker, ZEBRA, seconds=12)
    assert street.speed.min() > SPEED - 0.05 and (street.minded == -1).all() and street.nose[-1] > street.edge + 10


def test_who_comes_too_late_to_be_let_is_passed(tmp_path):
    """He steps on at the far side when the car is 7 m before the stripes with 12 m/s: to stop there takes 10 m/s²."""
    street = Street(tmp_path, {"line": [[0, 3.3], [0, -10]], "speed": 1.0}, ZEBRA, along=139.0, seconds=4)
    assert street.speed.min() > SPEED - 0.5 and street.hits == 0


def test_where_walkers_have_lights_these_decide(tmp_path):
    street = Street(tmp_path, {"line": ACROSS}, {"highway": "crossing", "crossing": "traffic_signals"}, seconds=0.1)
    assert not street.world.obstacles.movers.zebra.size


HIDES = [(-9.0, -9.0), (-3.0, -9.0), (-3.0, -4.0), (-9.0, -4.0)]
VAN = {"things": {"white_van": {"who": "box", "line": [[-6.0, -6.5]], "length": 6.0, "width": 5.0}}}


@pytest.mark.parametrize("more", [{"house": HIDES}, VAN])
def test_whom_a_house_or_a_van_hides_is_seen_as_soon_as_nothing_is_between(tmp_path, more):
    """Here geometry from another hand: the first tick at which the line from the car to him is clear, while he wants to cross."""
    street = Street(tmp_path, {"line": [[0, -8], [0, 8]], "speed": 0.5}, ZEBRA, seconds=10, along=20, **more)
    hides, first = shapely.Polygon([street.place(*corner) for corner in HIDES]), np.flatnonzero(street.minded == OBJECT)[0]
    lines = shapely.linestrings(np.stack([street.eye, street.walker], axis=1).transpose(2, 1, 0))
    wants = street.time >= 4.8 / 0.5 - 4.0
    seen = np.flatnonzero(wants & ~shapely.intersects(lines, hides))[0]
    assert seen > np.flatnonzero(wants)[0] + 20
    assert first == pytest.approx(seen, abs=2)


def test_a_car_ahead_hides_who_is_before_it(tmp_path):
    """Somebody on foot in the middle of the lane, another car between; without that car he is seen."""
    street = Street(tmp_path, {"line": [[0, -1.6], [0, 8]], "speed": 0.5}, ZEBRA, seconds=0.02, ahead=70.0)
    w = street.world
    asked = (w.vehicles.parameter, w.neighbours.places, w.worlds.of, 0, w.roads.shadow, w.obstacles.table, w.obstacles.standing, 0, 1)
    assert is_hidden(0, 0, w.vehicles.state, *asked)
    w.vehicles.state[ACTIVE, 1] = 0.0
    assert not is_hidden(0, 0, w.vehicles.state, *asked)
