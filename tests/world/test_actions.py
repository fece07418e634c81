"""Actions: each does what it says on a small world, to closed forms with stated tolerances; who overlaps is told."""

from math import cos, sin
from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from studio import job
from studio.cli import main
from studio.errors import ScenarioError
from studio.execution.event import foreseen
from studio.kinds.action import follow_path
from studio.road.drawn.motorway import motorway
from studio.vehicle.command import RING, U_STEER
from studio.vehicle.parameter import FRONT, LENGTH, WIDTH
from studio.vehicle.state import PSI, X, Y
from studio.world.build import build
from studio.world.maneuver import Sees
from studio.world.obstacle import walk
from studio.world.snapshot import restore, snapshot
from studio.world.table.mind import COMMANDS_WHEEL, FOLLOW_GAP, GAP, SCRIPT_HAS
from studio.world.table.street import O_HEADING, O_HEIGHT, O_SPEED, O_X, O_Y, OBSTACLE
from studio.world.tick import tick

TICK = 0.02


def test_pure_pursuit_steers_along_the_arc_through_its_point():
    """atan(2 L sin(alpha)/L_d): 24.784° for a wheelbase of 2.7 m and a point 4 m away, 20° to the left (check 50)."""
    alpha = np.radians(20.0)
    pool = np.array([[0.0, 100.0 * np.cos(alpha)], [0.0, 100.0 * np.sin(alpha)]])
    sees = Sees(0.0, 5.0, *[0.0] * 13, 2.7, pool)
    told = follow_path.act.py_func(SimpleNamespace(line=(0, 2), preview=0.8), sees)
    assert np.degrees(told.steering) == pytest.approx(24.784, abs=1e-3) and told.steers and not told.drives


@pytest.fixture(scope="module")
def road(tmp_path_factory):
    """A straight road of two lanes with a car at 20 m/s."""
    folder = tmp_path_factory.mktemp("actions")
    (folder / "motorway.xodr").write_text(motorway(length=1500.0, lanes=2), encoding="utf-8")
    document = {
        "version": 3, "title": "actions", "map": {"file": "motorway.xodr"}, "clock": {"duration": 10},
        "routes": {"way": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": 20}]}},
        "vehicles": {"own": {"route": "way", "position": {"road": "motorway", "lane": 0, "offset": 100}, "speed": 20.0}},
    }  # fmt: skip
    (folder / "actions.yaml").write_text(yaml.safe_dump(document))
    return folder / "actions.yaml"


def at(time):
    return {"kind": "time", "at": time}


def run(road, script, seconds=10.0, **parts):
    return job.run(job.load(road, {"script": script, "clock.duration": seconds} | parts))


def own(kind, when=1.0, **settings):
    return {"when": at(when), "do": {"kind": kind, "vehicle": "own"} | settings}


def sampled(run, name, time):
    return float(np.interp(time, run.time, run.trace(f"own.{name}")))


def events(run, *kinds):
    return [(each.time, each.text) for each in run.record.happenings if each.kind in kinds]


# -- a vehicle -----------------------------------------------------------------------------------------


def test_a_braked_car_is_held_while_its_maneuver_lasts(road):
    """20 m/s with 8 m/s²: it stands 2.5 s later and the lag of its brakes, and does so until 7 s; then its driver goes on."""
    made = run(road, {"stop": own("brake", deceleration=8, duration=6)})
    speed = made.trace("own.speed")
    stands = (made.time > 4.3) & (made.time < 7.0)
    assert np.abs(speed[stands]).max() < 0.05 and speed[-1] > 2
    assert events(made, "script_begun", "script_ended") == [(1.0, "stop begins: brake with 8 m/s²"), (7.0, "stop ends")]


def test_one_with_a_speed_ends_there(road):
    made = run(road, {"slow": own("brake", deceleration=4, duration=6, to_speed=12)})
    ended = events(made, "script_ended")[0][0]
    assert sampled(made, "speed", ended) == pytest.approx(12, abs=0.1) and 3.0 <= ended < 3.6


def test_a_speed_is_held(road):
    """15 m/s from 20 with 2 m/s² at most; then to a stand, on which it is held."""
    made = run(road, {"hold": own("hold", speed=15, duration=5), "stand": own("hold", when=6, acceleration=6, duration=8)}, 12)
    assert sampled(made, "speed", 5.9) == pytest.approx(15, abs=0.1)
    assert np.abs(made.trace("own.speed")[(made.time > 10.3) & (made.time < 12)]).max() < 0.05


def test_a_profile_of_speeds_is_driven(road):
    """A trapeze and a sine as a leader drives them: behind by the lag of engine and brakes, 0.8 m/s at most, 0.25 m/s rms."""
    t = np.arange(0.0, 40.0, 0.5)
    profile = np.where(t < 16, np.interp(t, [0, 4, 8, 12, 16], [20, 20, 12, 12, 18]), 18 + 2 * np.sin(0.5 * (t - 16)))
    made = run(road, {"lead": own("speed_profile", points=np.column_stack([t, profile]).tolist())}, 40)
    wanted = np.interp(made.time - 1.0, t, profile)
    inside = (made.time > 1.0) & (made.time < 40.0)
    error = (made.trace("own.speed") - wanted)[inside]
    assert np.abs(error).max() < 0.8 and np.sqrt(np.mean(error**2)) < 0.25


def test_a_profile_that_stands_still_is_held(road):
    points = [[0, 20], [5, 0], [9, 0], [12, 6]]
    made = run(road, {"lead": own("speed_profile", when=0.0, points=points)}, 12)
    assert np.abs(made.trace("own.speed")[(made.time > 6.5) & (made.time < 9)]).max() < 0.1
    assert sampled(made, "speed", 11.9) == pytest.approx(5.8, abs=0.8)


def test_steering_is_an_angle_or_a_sine(road):
    """What is asked of the road wheels, to the tick; then the wheel is the driver's."""
    script = {"left": own("steer", angle=0.01, duration=1.0), "wave": own("steer", when=4, angle=0.02, frequency=0.5, duration=2)}
    world = build([job.prepare(job.load(road, {"script": script}))])
    asked, who = np.zeros(350), np.zeros(350)
    for k in range(350):
        tick(world)
        asked[k], who[k] = world.vehicles.commands[U_STEER, k % RING], world.vehicles.mind[COMMANDS_WHEEL, 0]
    assert asked[50:100] == pytest.approx(0.01)
    assert asked[200:300] == pytest.approx(0.02 * np.sin(np.pi * TICK * np.arange(100)))
    assert np.flatnonzero(who == SCRIPT_HAS).tolist() == [*range(50, 100), *range(200, 300)]


@pytest.mark.parametrize("offset", [3.5, -1.0])
def test_a_lane_is_changed(road, offset):
    """Over by the offset within 0.25 m of the quintic, less than 0.15 m beside the line afterwards, and back as it came."""
    made = run(road, {"over": own("change_lane", offset=offset, time=4, duration=13)}, 16)
    u, w = (np.clip((made.time - begin) / 4.0, 0.0, 1.0) for begin in (1.0, 10.0))
    out, back = (10 * s**3 - 15 * s**4 + 6 * s**5 for s in (u, w))
    wanted, beside = offset * (out - back), made.trace("own.lateral_offset")
    during = (made.time > 1) & (made.time < 14)
    assert np.abs(beside - wanted)[during].max() < 0.25
    assert np.abs(beside - offset)[(made.time > 6) & (made.time < 9.9)].max() < 0.15
    assert abs(sampled(made, "lateral_offset", 15.9)) < 0.15


def test_a_line_is_followed(road):
    """A corner of 0.1 rad to the left of the way it drives: within 0.6 m of the line, and over at its end."""
    state = build([job.prepare(job.load(road))]).vehicles.state
    x, y, psi = (float(state[row, 0]) for row in (X, Y, PSI))

    def ahead(distance, turned=0.0):
        return np.array([distance * cos(psi + turned), distance * sin(psi + turned)])

    corner = np.array([x, y]) + ahead(60.0)
    line = [[x, y], corner.tolist(), (corner + ahead(60.0, 0.1)).tolist()]
    made = run(road, {"line": own("follow_path", when=0.0, line=line)}, 8)
    place = np.array([made.trace("own.x"), made.trace("own.y")]).T
    ended = events(made, "script_ended")[0][0]
    inside = made.time < ended
    along = (place - corner) @ ahead(1.0, 0.1)
    across = (place - corner) @ ahead(1.0, 0.1 + np.pi / 2)
    assert np.abs(across[inside & (along > 5)]).max() < 0.6 and along[inside].max() > 55


def test_pedals_and_wheel_are_two_maneuvers(road):
    """Both at once; each of them ends only one that has what it takes, and that is told with its reason."""
    script = {
        "slow": own("brake", deceleration=1, duration=6), "over": own("change_lane", when=2, offset=1.0, duration=3),
        "hard": own("brake", when=3, deceleration=2, duration=1),
    }  # fmt: skip
    made = run(road, script)
    assert events(made, "script_ended", "script_cut_short") == [(3.0, "slow ends: hard begins"), (4.0, "hard ends"), (5.0, "over ends")]
    wheel, brake = made.trace("own.commands_wheel"), made.trace("own.commands_brake")
    assert set(wheel[(made.time >= 2) & (made.time < 4.98)]) == {1.0} and set(brake[(made.time >= 1) & (made.time < 3.98)]) == {1.0}
    assert set(brake[(made.time > 4) & (made.time < 5)]) == {0.0}


@pytest.mark.parametrize(
    ("settings", "word"),
    [
        ({"kind": "speed_profile", "vehicle": "own", "points": [[0, 3], [0, 4]]}, "must begin at 0 s or later, and rise"),
        ({"kind": "speed_profile", "vehicle": "own", "points": [[0, 3], [1, 400]]}, "between 0 and 70 m/s"),
        ({"kind": "mover", "line": [[1, 2], [1, 2]]}, "must not be one"),
        ({"kind": "mover", "speed": -1}, "≥ 0"),
        ({"kind": "mover", "route": "wya"}, "did you mean 'way'?"),
    ],
)
def test_what_is_wrong_is_told(road, settings, word):
    with pytest.raises(ScenarioError, match=r"script\.x\.do") as caught:
        job.prepare(job.load(road, {"script": {"x": {"do": settings}}}))
    assert word in str(caught.value)


def test_two_maneuvers_at_once_are_refused(road):
    """Of the same hands of one vehicle at one time; pedals and wheel, or another time, are fine."""
    script = {"slow": own("brake"), "fast": own("set_speed", speed=30)}
    with pytest.raises(ScenarioError) as caught:
        job.prepare(job.load(road, {"script": script}))
    (problem,) = caught.value.problems
    assert problem.where.endswith("script.fast.do") and "takes the pedals of 'own' at the same time as 'slow'" in str(problem)
    job.prepare(
        job.load(road, {"script": {"slow": own("brake"), "over": own("change_lane"), "fast": own("set_speed", when=1.02, speed=30)}})
    )


# -- who moves -----------------------------------------------------------------------------------------


def child(along=200.0, speed=1.5, when=1.0, line=None, **settings):
    """Somebody who crosses the way of the car from the right, 8 m before the middle of its lane to 8 m behind."""
    line = line or [[along, -8.0], [along, 8.0]]
    return {"when": at(when), "do": {"kind": "mover", "route": "way", "line": line, "speed": speed} | settings}


def test_it_is_where_it_has_walked_to(road):
    """Around a corner: station by station speed times time, heading of each leg, and gone or there at the end."""
    corner = np.array([[0.0, 4.0, 4.0], [0.0, 0.0, 3.0], [0.0, 4.0, 7.0], [0.0, np.pi / 2, np.pi / 2]])
    table, standing = np.zeros((len_of_table(), 1)), np.ones(1, dtype=np.int64)
    one = np.zeros(1, dtype=np.int64)
    ramp = np.array([[0.0, 7.0], [1.0, 1.7], [0.0, 1.0], [1.0, 1.7]])  # station, height, level, lift of what is under its line

    def place(time, stays):
        standing[0] = 1
        steps = (np.array([3]), corner, np.array([2.0]), np.array([stays]), ramp, one, np.array([2]))
        walk(time, np.zeros((2, 1)), one, one, *steps, table, standing)
        assert table[O_HEIGHT, 0] == pytest.approx(1.0 + 0.1 * min(2.0 * time, 7.0))
        return table[[O_X, O_Y, O_HEADING, O_SPEED], 0].tolist(), standing[0]

    assert place(0.0, 1) == ([0.0, 0.0, 0.0, 2.0], 1)
    assert place(1.5, 1) == ([3.0, 0.0, 0.0, 2.0], 1)
    assert place(2.5, 1) == ([pytest.approx(4.0), pytest.approx(1.0), np.pi / 2, 2.0], 1)
    assert place(9.0, 1) == ([4.0, 3.0, np.pi / 2, 0.0], 1) and place(9.0, 0)[1] == 0


def len_of_table():
    return len(OBSTACLE)


def test_a_driver_brakes_once_it_is_in_his_way(road):
    """It comes into the car's strip and elbow room with 2 m/s: followed from then on, ahead once the body is before it."""
    setting = job.prepare(job.load(road, {"script": {"child": child(along=320.0, speed=2.0, when=0.0)}}))
    world = build([setting])
    p = world.vehicles.parameter[:, 0]
    first = {}
    for _ in range(400):
        tick(world)
        for row in (FOLLOW_GAP, GAP):
            if row not in first and np.isfinite(world.vehicles.mind[row, 0]):
                first[row] = (world.clock.time - TICK, float(world.vehicles.mind[row, 0]))
    came_in = (8.0 - 0.5 * p[WIDTH] - 0.2 - 0.3) / 2.0  # half the car, elbow room, half of its 0.6 m along its way
    for row, when in ((FOLLOW_GAP, came_in), (GAP, came_in + 0.2 / 2.0)):
        assert first[row][0] == pytest.approx(when, abs=1.5 * TICK)
        assert first[row][1] == pytest.approx(220.0 - 20.0 * first[row][0] - p[FRONT] - 0.25, abs=0.6)
    assert world.events.hits_found == 0


def test_one_who_comes_too_late_is_hit(road):
    """Running out 20 m before the car: a collision, with its name and both speeds."""
    made = run(road, {"child": child(along=200.0, speed=3.0, when=2.4)}, 8)
    (hit,) = [each for each in made.record.happenings if each.kind == "collision"]
    assert hit.units == ("own", "child")
    speed = sampled(made, "speed", hit.time)
    assert hit.numbers["impact_speed"].value == pytest.approx(np.hypot(speed, 3.0), abs=0.5)


def test_it_is_gone_with_until(road):
    """A box stands on the lane, and is taken away before the car comes: nobody is hit, and who brakes is the driver."""
    box = {"do": {"kind": "mover", "who": "box", "route": "way", "line": [[300.0, 0.0]], "length": 1.0, "width": 2.0}, "until": at(3)}
    made = run(road, {"box": box}, 9)
    assert not events(made, "collision") and sampled(made, "speed", 8.9) > 15
    gap = made.trace("own.gap")
    assert np.isfinite(gap[(made.time > 0.1) & (made.time < 2.9)]).all() and np.isnan(gap[made.time > 3.1]).all()


def test_conditions_look_at_it(road):
    """The distance to somebody; and what he does when the car is near: he begins to run."""
    script = {
        "child": {"when": at(0), "do": {"kind": "mover", "route": "way", "line": [[260.0, -6.0]]}},
        "near": {"when": {"kind": "distance", "vehicle": "own", "other": "child", "distance": 50}, "do": {"kind": "mark"}},
        "inside": {"when": {"kind": "in_area", "vehicle": "child", "area": {"road": "motorway", "lane": 0}}, "do": {"kind": "mark"}},
    }
    setting = job.prepare(job.load(road, {"script": script}))
    p = build([setting]).vehicles.parameter[:, 0]
    made = run(road, script, 8)
    (near,) = [when for when, text in events(made, "script_begun") if text.startswith("near")]
    ahead = made.trace("own.station") + p[FRONT]
    aside = 6.0 - 0.5 * p[WIDTH] - 0.25
    gap = np.hypot(np.maximum(260.0 - 0.3 - ahead, 0.0), aside)
    assert near == pytest.approx(made.time[np.argmax(gap < 50)], abs=1.01 * TICK)
    assert not [text for _, text in events(made, "script_begun") if text.startswith("inside")]
    assert p[LENGTH] > 4


def test_worlds_and_snapshots(road):
    """Movers have the bits that they have alone, and go on from a snapshot."""
    some = [{"child": child(speed=speed, when=0.5)} for speed in (1.0, 2.0)]
    variants = [job.prepare(job.load(road, {"script": each})) for each in (*some, {})]

    def ticks(settings, count):
        world = build(settings)
        for _ in range(count):
            tick(world)
        return world

    alone = [ticks([each], 200).digest(0) for each in variants]
    assert [ticks(variants, 200).digest(w) for w in range(3)] == alone and len(set(alone)) == 3
    kept, anew = snapshot(ticks(variants[:1], 100)), build(variants[:1])
    restore(anew, kept)
    for _ in range(100):
        tick(anew)
    assert anew.digest(0) == alone[0]


# -- what a vehicle cannot do ----------------------------------------------------------------------------


def test_speeds_that_a_vehicle_cannot_reach_are_told(road, capsys):
    """Before the run, with its top speed, by the run's events and by the check; a speed that it can reach is not spoken of."""
    script = {
        "fast": own("set_speed", speed=70), "held": own("hold", when=2, speed=60), "put": own("place", when=3, along=200, speed=65),
        "drawn": own("speed_profile", when=4, points=[[0, 20], [5, 58]]), "slow": own("set_speed", when=5, speed=50),
        "stop": own("brake", when=6),
    }  # fmt: skip
    parts = {"script": script, "vehicles.own.speed": 69, "clock.duration": 0.1}
    told = events(job.run(job.load(road, parts)), "speed_out_of_reach")
    assert [time for time, _ in told] == 5 * [0.0]
    wanted = [("69.0", "at its start"), ("70.0", "script.fast"), ("60.0", "script.held"), ("65.0", "script.put"), ("58.0", "script.drawn")]
    assert [text for _, text in told] == [
        f"own cannot drive {speed} m/s ({what}): its top speed in the flat is 56.6 m/s" for speed, what in wanted
    ]
    assert not events(run(road, {"slow": own("hold", speed=56)}, 0.1), "speed_out_of_reach")
    with pytest.raises(SystemExit):
        main(["check", str(road), "--set", "vehicles.own.model=truck", "--set", "vehicles.own.speed=40"])
    assert "note: own cannot drive 40.0 m/s (at its start): its top speed in the flat is 33.8 m/s" in capsys.readouterr().out


@pytest.mark.parametrize("name", ["grosser_stern_platoon", "motorway_platoon", "urban_grid"])
def test_the_samples_ask_for_nothing_that_cannot_be(sample, name):
    assert not list(foreseen(job.prepare(job.load(sample.with_name(f"{name}.yaml")))))
