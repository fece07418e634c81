"""What is recorded: everything of a sample belongs to one instant; who has left has no values."""

from dataclasses import replace

import numpy as np
import pytest

from studio import job
from studio.execution.loop import as_fast_as_possible
from studio.execution.simulation import simulation
from studio.road.ways.path import PATH_SPEED
from tests.changing import scenario


def result(sample, **changes):
    changes = {path.replace("__", "."): value for path, value in changes.items()}
    return job.run(job.load(sample, {"clock__duration".replace("__", "."): 3} | changes))


def test_a_start_is_where_the_file_says(sample):
    """345.2 m is 345.2 m, and the gaps of the platoon are those of the file: 14.8 m less a car's length."""
    run = result(sample)
    assert run.trace("leader.station")[0] == pytest.approx(360.0, abs=0.01)
    assert run.trace("follower_1.station")[0] == pytest.approx(345.2, abs=0.01)
    assert run.trace("follower_1.gap")[0] == pytest.approx(14.8 - 4.508, abs=0.01)


def test_a_sample_is_of_one_instant(sample):
    """Station and position move together, from the first interval on; the last sample is the end."""
    run = result(sample)
    moved = np.hypot(np.diff(run.trace("leader.x")), np.diff(run.trace("leader.y")))
    np.testing.assert_allclose(np.diff(run.trace("leader.station")), moved, atol=2e-3)
    assert run.time[0] == 0 and run.time[-1] == 3 and run.time.size == 151


def test_acceleration_is_the_derivative_of_speed(sample):
    """Once the start has settled; within a tick the acceleration is that of its end, so it is off by no more than it changed."""
    run = result(sample)
    speed, acceleration = run.trace("leader.speed"), run.trace("leader.acceleration")
    off = np.abs(np.diff(speed)[25:] / 0.02 - acceleration[26:])
    assert (off <= 0.02 + np.abs(np.diff(acceleration)[25:])).all()


def test_silence_is_not_freshness(sample):
    """Nothing received: the age grows with the run. Everything received: about delay + half a period + half a tick."""
    assert result(sample, radio__loss=1).metrics["information_age"].value == pytest.approx(1.5, abs=0.02)
    heard = result(sample, radio__loss=0, clock__duration=20).metrics["information_age"].value
    assert heard == pytest.approx(0.02 + 0.05 + 0.01, abs=0.015)


def test_who_has_left_has_no_values(sample):
    """The leader arrives; its last values do not count for ever after."""
    near_the_end = float(int(job.prepare(job.load(sample)).cars[0].path.length)) - 60
    changes = {"vehicles.leader.position.along": near_the_end, "clock.duration": 10, "traffic.count": 0}
    run = job.run(job.load(sample, changes))
    speed = run.trace("leader.speed")
    assert np.isnan(speed[-1]) and speed[0] == 13.0
    assert any(event.text.startswith("arrived") and event.vehicle == "leader" for event in run.record.happenings)
    assert run.metrics["mean_speed"].value == pytest.approx(np.nanmean(run.record.channel("speed")))


def test_an_annotated_speed_stands_where_the_route_has_it(sample):
    """At 1000 m along the route 5 m/s, whether a car starts along the route or on its second road."""
    changes = {"routes.east_to_west.speeds": [{"at": 1000, "speed": 5.0}]}
    along = job.prepare(job.load(sample, changes)).cars[0].path
    by_road = {"vehicles.leader.position": {"road": "206170873#1", "lane": 2, "offset": 10}}
    other = next(car for car in job.prepare(job.load(sample, changes | by_road)).cars if car.name == "leader").path

    def place(path):
        return path.points[:2, np.argmax(path.points[PATH_SPEED] <= 5.0)]

    assert np.hypot(*(place(along) - place(other))) < 6.0


def test_an_entry_of_the_script_may_have_any_name(sample):
    loaded = job.load(sample, {"clock.duration": 1, "script.hard_brake.when.at": 0.5})
    renamed = loaded.scenario.model_copy(update={"script": {"hits": loaded.scenario.script["hard_brake"]}})
    run = simulation(job.prepare(replace(loaded, scenario=renamed)))
    as_fast_as_possible(run)
    assert [event.time for event in run.cases[0].happenings if event.kind == "script_begun"] == [0.5]


def test_who_is_between_is_told(sample):
    """Somebody drives between a car and the one that it listens to, and is taken away at 3 s."""
    vehicles = {
        name: {"route": "east_to_west", "position": {"along": along}, "speed": 8.0}
        for name, along in {"leader": 150, "stranger": 130, "follower_1": 100}.items()
    }
    platoon = {"platoon": {"application": "cacc", "units": ["follower_1"], "listens_to": ["leader"]}}
    script = {"gone": {"when": {"kind": "time", "at": 3}, "do": {"kind": "remove", "vehicle": "stranger"}}}
    run = simulation(
        scenario(sample, script, alone=False, vehicles=vehicles, applications=platoon, traffic={"count": 0}, clock={"duration": 4})
    )
    as_fast_as_possible(run)
    told = {event.text: (event.vehicle, event.time) for event in run.cases[0].happenings if "between" in event.text}
    assert told == {
        "stranger is between it and leader": ("follower_1", pytest.approx(0.0, abs=0.1)),
        "nobody is between it and leader any more": ("follower_1", pytest.approx(3.0, abs=0.1)),
    }


def test_what_happens_to_the_platoon_is_told(sample):
    """A driver minds a light, and takes over; a car waits at red: at the times at which the traces say so."""
    minding = {"reasons": ["red_light", "right_of_way"], "reaction_time": 0.5}
    run = job.run(job.load(sample, {"vehicles.follower_4.intervention": minding}))
    told = {(event.vehicle, event.text): event.time for event in run.record.happenings}
    waits = told["follower_4", "waits at a red light"]
    assert np.interp(waits, run.time, run.trace("follower_4.speed")) < 0.15
    takes_over = told["follower_4", "driver takes over: red light"]
    acting = run.trace("follower_4.intervening")
    assert run.time[acting == 1.0][0] == pytest.approx(takes_over)
    assert told["leader", "hard_brake begins: brake with 6 m/s²"] == 20
