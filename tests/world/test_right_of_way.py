"""Drivers go first as the map says: on a crossing of four streets, with equal streets, signs, and a gap in a stream."""

import numpy as np
import pytest
import yaml

from studio import job
from studio.road import load
from studio.vehicle.parameter import FRONT
from studio.vehicle.state import ACTIVE, V_X, X, Y
from studio.world.build import build
from studio.world.table.mind import MINDED, STATION, WAY_STATION
from studio.world.table.web import ITS_ENTER, OWN_ENTER, START
from studio.world.tick import tick
from tests.road.conftest import Draft
from tests.road.test_priority import AHEAD, BERLIN, PERTH, RIGHT_OF, TOKYO, arms_of, crossing, place_at

MAJOR = {"west": "secondary", "east": "secondary"}
LEFT_OF = {there: here for here, there in RIGHT_OF.items()}


class Run:
    """Cars on a crossing, tick by tick: noses, speeds, and when each passed the middle and came to its line."""

    def __init__(self, folder, ways, *, centre=BERLIN, starts=None, seconds=40.0, speeds=None, houses=(), **drawn):
        """`ways` are the arms that each car comes from and goes to; `starts` and `speeds` where and how each begins, else all the same.

        `houses` are the corners of some [m], from the middle of the crossing.
        """
        draft = crossing(Draft(), centre, **drawn)
        for number, house in enumerate(houses, start=10):
            corners = [draft.node(*place_at(centre, *corner)) for corner in house]
            draft.way(number, [*corners, corners[0]], building="yes")
        self.network = network = load(draft.write(folder / "cross.osm"))
        roads = {arms_of(network, c): (network.lanes[c.from_lane].road, network.lanes[c.to_lane].road) for c in network.connections}
        named = {f"car_{i}_{a}_{b}": list(roads[a, b]) for i, (a, b) in enumerate(ways)}
        starts, speeds = starts or [40.0] * len(ways), speeds or [8.0] * len(ways)
        scenario = {
            "version": 3, "title": "Crossing", "map": {"file": "cross.osm"}, "clock": {"duration": seconds},
            "routes": {name: {"roads": road} for name, road in named.items()},
            "vehicles": {
                name: {"route": name, "position": {"along": start}, "speed": speed}
                for name, start, speed in zip(named, starts, speeds, strict=True)
            },
        }  # fmt: skip
        (folder / "cross.yaml").write_text(yaml.safe_dump(scenario), encoding="utf-8")
        self.world = world = build([job.prepare(job.load(folder / "cross.yaml"))])
        nose, speed, held, active, minded, place = [], [], [], [], [], []
        for _ in range(round(seconds / world.clock.tick)):
            tick(world)
            nose.append(world.vehicles.mind[STATION] + world.vehicles.parameter[FRONT])
            speed.append(world.vehicles.state[V_X].copy())
            held.append(np.isfinite(world.vehicles.mind[WAY_STATION]))
            active.append(world.vehicles.state[ACTIVE] > 0)
            minded.append(world.vehicles.mind[MINDED].copy())
            place.append(world.vehicles.state[[X, Y]].copy())
        made = (np.array(each).T for each in (nose, speed, held, active, minded, place))
        self.nose, self.speed, self.held, self.active, self.minded, self.place = made
        r = world.roads
        self.line = np.array([r.web.drive[0, d + 1] for d in r.drive_first])  # where the way through the junction begins
        self.time = np.arange(self.nose.shape[1]) * world.clock.tick

    def passes(self, i, beyond=5.0):
        """When car i's nose is so far [m] behind its line; infinite when never."""
        there = np.flatnonzero((self.nose[i] > self.line[i] + beyond) | ~self.active[i])
        return self.time[there[0]] if there.size else np.inf

    def slowest(self, i, before=15.0):
        """The least speed [m/s] that car i has within some metres before its line."""
        near = (self.nose[i] > self.line[i] - before) & (self.nose[i] < self.line[i] + 1.0)
        return self.speed[i, near].min()

    def is_fine(self):
        """Everybody has passed, and nobody has been hit."""
        return self.world.events.hits_found == 0 and all(np.isfinite(self.passes(i)) for i in range(len(self.line)))


PLACES = [pytest.param(BERLIN, RIGHT_OF, id="Berlin"), pytest.param(PERTH, RIGHT_OF, id="Perth"), pytest.param(TOKYO, LEFT_OF, id="Tokyo")]


@pytest.mark.parametrize(("centre", "first_from"), PLACES)
@pytest.mark.parametrize("arm", ["south", "east", "north", "west"])
def test_equal_streets(tmp_path, centre, first_from, arm):
    """Both come at once: who comes from the right, in Japan from the left, does not slow down for the other, who waits."""
    other = first_from[arm]
    run = Run(tmp_path, [(arm, AHEAD[arm]), (other, AHEAD[other])], centre=centre)
    assert run.is_fine() and run.passes(0) > run.passes(1) + 1.0
    assert not run.held[1].any() and run.held[0].any() and run.slowest(0) < run.slowest(1)
    assert {1.0} <= set(run.minded[0, run.held[0]]) <= {1.0, -1.0}  # he minds the other, or nobody while he need not brake


def test_four_at_once(tmp_path):
    """Everybody would have to wait for the one on the right; all get through, one after the other, without a collision."""
    run = Run(tmp_path, [(arm, AHEAD[arm]) for arm in RIGHT_OF])
    assert run.is_fine() and max(run.passes(i) for i in range(4)) < 35.0


@pytest.mark.parametrize(("one", "other"), [(0.1, 0.4), (0.4, 0.1), (0.2, 0.2), (0.1, 0.9)])
def test_of_two_who_have_come_onto_a_place_at_once_one_leaves_first(tmp_path, one, other):
    """Both stand with so many metres of their noses where their ways meet: who has come less far lets the other leave."""
    ways = [("south", "north"), ("west", "east")]
    run = Run(tmp_path, ways, seconds=0.1)
    enter, front = places_where_they_meet(run), run.world.vehicles.parameter[FRONT]
    run = Run(tmp_path, ways, starts=[float(each) for each in enter + [one, other] - front], speeds=[0.0, 0.0])
    assert run.is_fine()
    first, last = sorted((run.passes(i, beyond=20.0), i) for i in range(2))
    assert first[0] + 0.5 < last[0] < np.inf and (one == other or first[1] == int(other > one))


@pytest.mark.parametrize(("away", "waits"), [(26.0, True), (90.0, False)])
def test_who_stands_beyond_his_line_gives_way_there(tmp_path, away, waits):
    """As one stands who has followed somebody over the line and stopped behind him, two metres before the greater street, clear of it.

    Somebody on it comes with 8 m/s and is there in 2.9 s. He himself would be there in 1.7 s, but gone only after 3.7 s: he waits, and the
    other need not slow down. Of one who is 90 m away he makes nothing.
    """
    ways = [("south", "north"), ("west", "east")]
    run = Run(tmp_path, ways, classes=MAJOR, seconds=0.1)
    enter, front = places_where_they_meet(run), run.world.vehicles.parameter[FRONT]
    assert enter[0] - 2.0 > run.line[0] + 0.5
    starts = [float(each) for each in enter - [2.0, away] - front]
    run = Run(tmp_path, ways, classes=MAJOR, starts=starts, speeds=[0.0, 8.0], seconds=20.0)
    assert run.is_fine()
    first, second = sorted(range(2), key=lambda i: float(run.time[np.flatnonzero(run.nose[i] > enter[i])[0]]))
    assert (first, second) == ((1, 0) if waits else (0, 1))
    assert run.speed[1, run.nose[1] < enter[1]].min() > 7.5


def places_where_they_meet(run):
    """On the line of either car [m], where it comes in the way of the other one."""
    web, drives = run.world.roads.web, run.world.roads.drive_first + 1
    (m,) = (m for m in range(*web.first[web.strand[drives[0]] + [0, 1]]) if web.partner[m] == web.strand[drives[1]])
    return run.line + web.span[[OWN_ENTER, ITS_ENTER], m] - web.drive[START, drives]


def test_who_turns_across_waits_for_who_comes_from_ahead(tmp_path):
    run = Run(tmp_path, [("south", LEFT_OF["south"]), ("north", "south")])
    assert run.is_fine() and run.passes(0) > run.passes(1) + 1.0 and not run.held[1].any()


def test_who_comes_from_a_smaller_street_waits(tmp_path):
    """The major street passes without slowing; with nobody on it one does not wait for anyone."""
    met = Run(tmp_path, [("south", "north"), ("west", "east")], classes=MAJOR, starts=[60.0, 40.0])
    assert met.is_fine() and met.passes(0) > met.passes(1) + 1.0 and not met.held[1].any()
    alone = Run(tmp_path, [("south", "north")], classes=MAJOR, starts=[60.0])
    assert alone.is_fine() and not alone.held[0].any() and alone.passes(0) < met.passes(0) - 1.0


def test_at_a_stop_sign_one_halts_with_nobody_there(tmp_path):
    """With a stop sign the speed is nought before the line; with a yield sign one rolls on."""
    speeds = {}
    for sign in ("stop", "give_way"):
        run = Run(tmp_path, [("south", "north")], classes=MAJOR, sign={"highway": sign})
        assert run.is_fine()
        speeds[sign] = run.slowest(0)
        assert (run.minded == -1.0).all()  # there is nobody
    assert speeds["stop"] < 0.1 and speeds["give_way"] > 3.0


def test_who_comes_fast_is_waited_for_from_afar(tmp_path):
    """At 100 km/h 155 m are 5.6 s, and 6.5 s are wanted: who stands at the line does not begin to go."""
    drawn = {"classes": MAJOR, "reach": 330, "maxspeed": "100"}
    starts, speeds = [312.0, 165.0], [0.0, 27.8]
    run = Run(tmp_path, [("south", "north"), ("west", "east")], starts=starts, speeds=speeds, **drawn)
    assert run.line[1] - run.nose[1, 0] == pytest.approx(155.0, abs=12.0) and run.line[0] - run.nose[0, 0] < 6.0
    assert run.is_fine() and run.held[0, 0] and not run.held[1].any() and run.passes(0) > run.passes(1)


@pytest.mark.parametrize(("apart", "goes_between"), [(25.0, False), (96.0, True)])
def test_a_gap_in_a_stream_is_taken_when_it_is_long_enough(tmp_path, apart, goes_between):
    """Two cars on the major street, so many metres apart at 8 m/s and more; 6.5 s are wanted for crossing from rest, less when rolling."""
    run = Run(tmp_path, [("south", "north"), ("west", "east"), ("west", "east")], classes=MAJOR, starts=[60.0, 100.0, 100.0 - apart])
    assert run.is_fine() and run.passes(1) < run.passes(0)
    assert (run.passes(0) < run.passes(2)) == goes_between
    if goes_between:
        assert not run.held[2].any() and run.slowest(2) > 7.0  # and nobody had to brake for it
