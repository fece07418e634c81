"""What is drawn over the scene: of a run that is over and of one that goes on, by what was recorded."""

from dataclasses import replace

import numpy as np
import pytest

from studio import job
from studio.execution.message import lately
from studio.execution.simulation import simulation
from studio.kind import registry
from studio.scene import pose
from studio.server import layer
from studio.server.layer import Layers, missing
from studio.server.replay import replay
from studio.store.runs import open_runs
from studio.world.table.cause import RECEIVED

CHANGES = {"clock.duration": 22.0, "recording.traffic": True}
NOTICED = '''"""Warns from 1 s on."""
from typing import NamedTuple
from studio.application.contract import Clock, Notice
from studio.kind.settings import Part
KIND = "application"
TITLE = "Warner"
NOTICES = ("Look out!", "Brake!")
class Parameters(Part):
    pass
class Memory(NamedTuple):
    said: float = 0.0
class Sees(NamedTuple):
    clock: Clock
class Does(NamedTuple):
    notice: Notice
def decide(parameters, memory, sees):
    return memory, Does(Notice(2.0 if sees.clock.time > 1.0 else 0.0))
'''


@pytest.fixture(scope="module")
def played(tmp_path_factory, sample):
    """The sample, whose leader brakes hard at 20 s, played back."""
    runs = open_runs(tmp_path_factory.mktemp("layers") / "runs.db")
    yield replay(runs, job.run(job.load(sample, CHANGES), runs=runs).row.run, sample)
    runs.close()


def car(layers, name, played):
    """What is known of a car."""
    return next(each for each in layers.cars if played.setting.names[each.car] == name)


def test_brake_lights_gaps_and_speeds_are_those_of_the_run(played):
    before, braking = played.layers(19.0), played.layers(20.9)
    assert not car(before, "leader", played).brakes and car(braking, "leader", played).brakes
    follower = car(braking, "follower_1", played)
    assert played.setting.names[follower.ahead] == "leader"
    at = int(np.searchsorted(played.record.time, 20.9 + 1e-6, side="right")) - 1
    assert follower.gap == pytest.approx(played.record.trace("follower_1.gap")[at], abs=1e-3)
    assert follower.speed == pytest.approx(played.record.trace("follower_1.speed")[at], abs=1e-3)


def test_the_gap_is_the_distance_between_the_two_bodies(played):
    """On the straight road: against the places in the picture and the bodies' lengths."""
    frame, bodies = played.frame(15.0).poses, played.record.bodies
    for each in played.layers(15.0).cars:
        if each.ahead is None or each.gap is None or each.car > 4:
            continue
        one, other = (bodies[played.setting.names[i]] for i in (each.car, each.ahead))
        away = np.hypot(*(frame[[pose.X, pose.Y], each.ahead] - frame[[pose.X, pose.Y], each.car]))
        assert away == pytest.approx(each.gap + one.front + other.length - other.front, abs=0.1)


def test_a_sensor_sees_the_car_ahead_where_that_is(played):
    """Its target, from the frame of the car to the map: at the rear of the car ahead, as far as noise and delay allow."""
    layers, frame, seen = played.layers(15.0), played.frame(15.0).poses, 0
    for field in layers.fields:
        ahead = next(each.ahead for each in layers.cars if each.car == field.car)
        for x, y in field.seen if ahead is not None else []:
            yaw = frame[pose.YAW, field.car]
            at = frame[[pose.X, pose.Y], field.car] + [x * np.cos(yaw) - y * np.sin(yaw), x * np.sin(yaw) + y * np.cos(yaw)]
            body = played.record.bodies[played.setting.names[ahead]]
            back = body.front - body.length
            heading = frame[pose.YAW, ahead]
            rear = frame[[pose.X, pose.Y], ahead] + back * np.array([np.cos(heading), np.sin(heading)])
            assert np.hypot(*(at - rear)) < 1.5
            seen += 1
    assert seen >= 4


def test_messages_are_those_that_were_sent_a_moment_ago_and_lost_ones_say_so(played):
    log, lost = played.record.messages, 0
    for time in np.arange(1.0, 21.0, 0.25):
        for each in played.layers(time).messages:
            sender, receiver = (played.setting.names[end.car] for end in (each.sender, each.receiver))
            entries = log.link(sender, receiver, each.kind)
            sent = log.time[log.of[entries]]
            newest = entries[np.flatnonzero((sent <= time) & (sent > time - layer.SHOWN))[-1]]
            assert each.lost == (log.cause[newest] != RECEIVED)
            lost += each.lost
    assert lost > 0  # the sample's radio loses some


def test_trails_end_where_cars_are_and_ways_begin_there(played):
    frame, layers = played.frame(15.0).poses, played.layers(15.0)
    for line in layers.trails:
        away = np.hypot(*(frame[[pose.X, pose.Y], line.car] - line.points[-1]))
        assert away < layer.TRAIL_STEP * 20.0
    for line in (each for each in layers.paths if each.car < 5):
        assert np.hypot(*(frame[[pose.X, pose.Y], line.car] - line.points[0])) < 1.0
    assert len(layers.trails) == len(layers.paths) == len(layers.cars) == 25


def test_a_run_that_goes_on_has_the_same_layers(played, sample):
    """From its last samples and from what has been sent lately, as the process of a live run makes them."""
    running = simulation(job.prepare(job.load(sample, CHANGES)))
    running.advance(750)
    over = Layers(running.cases[0].setting, running.bodies(0))
    step = round(layer.TRAIL_STEP / 0.02)
    samples = sorted(range(running.recorder.count - 1, -1, -step)[: round(layer.TRAIL / layer.TRAIL_STEP)])
    record = replace(running.record_of(samples), called=running.called(0), messages=lately(running.world, running.time - 1.0))
    live, then = over.at(record, len(samples) - 1), played.layers(float(record.time[-1]))
    assert live.cars == then.cars
    assert live.fields == then.fields
    assert live.paths == then.paths
    assert {(m.sender.car, m.receiver.car, m.lost) for m in live.messages} == {
        (m.sender.car, m.receiver.car, m.lost) for m in then.messages
    }
    assert {line.car for line in live.trails} == {line.car for line in then.trails}


def test_what_was_not_recorded_is_told(sample, tmp_path, played):
    assert played.missing == {}
    runs = open_runs(tmp_path / "runs.db")
    kept = {"clock.duration": 1.0, "recording.channels": ["x", "y", "heading"]}
    poor = replay(runs, job.run(job.load(sample, kept), runs=runs).row.run, sample)
    assert {"gaps", "paths", "speed", "lamps"} <= poor.missing.keys() and "trails" not in poor.missing
    assert "recording.channels" in poor.missing["gaps"]
    assert poor.layers(0.5).paths == []
    nobody = replace(played.record, values=np.full_like(played.record.values, np.nan))
    assert missing(nobody, played.kept) == {}  # a gap that is none is not one that was not kept
    runs.close()


def test_what_applications_show_to_the_driver_is_a_notice(sample, tmp_path):
    (tmp_path / "warner.py").write_text(NOTICED)
    registry.load_folder(tmp_path)
    (tmp_path / "maps").symlink_to(sample.parent / "maps")
    path = tmp_path / sample.name
    warning = "applications:\n  warning: {application: warner, units: [follower_2]}\n"
    path.write_text(sample.read_text(encoding="utf-8").replace("applications:\n", warning), encoding="utf-8")
    runs = open_runs(tmp_path / "runs.db")
    warned = replay(runs, job.run(job.load(path, {"clock.duration": 2.0}), runs=runs).row.run, path)
    assert car(warned.layers(0.5), "follower_2", warned).notice == ""
    assert car(warned.layers(1.9), "follower_2", warned).notice == "Brake!"
    assert car(warned.layers(1.9), "follower_1", warned).notice == ""
    runs.close()
