"""The playback of a run: what the scene shows of it is what it showed when the run went on."""

import numpy as np
import pytest

from studio import job
from studio.errors import UnknownError
from studio.execution.simulation import simulation
from studio.road.assembly.storey import STOREY
from studio.road.ways.relief import relief_of
from studio.scene import pose
from studio.server.frame import frame, poses
from studio.server.replay import replay
from studio.store.runs import open_runs
from tests.road.plot import plot

SAMPLES = ("grosser_stern_platoon", "stepping_out", "grosser_stern_roadworks")
CHANGES = {"clock.duration": 6.0, "recording.traffic": True}
SEEN = [pose.X, pose.Y, pose.YAW, pose.ROLL, pose.PITCH, pose.STEER]


@pytest.fixture
def runs(tmp_path):
    """A database."""
    kept = open_runs(tmp_path / "runs.db")
    yield kept
    kept.close()


def pictures(loaded):
    """Time [s] and picture of every tick of a run but the first, and when lights and objects in it were looked at: a tick ago, but
    for the last."""
    running = simulation(job.prepare(loaded))
    relief = relief_of(running.cases[0].setting.network)
    while not running.is_over:
        seen = running.time
        running.advance()
        yield running.time, running.time if running.is_over else seen, frame(running.world, poses(running.world.vehicles, relief))


@pytest.mark.parametrize("name", SAMPLES)
def test_everybody_is_seen_where_he_was(name, sample, runs):
    """Against the pictures of the simulation itself, tick by tick: poses, lights and objects."""
    path = sample.with_stem(name)
    played, looked = replay(runs, job.run(job.load(path, CHANGES), runs=runs).row.run, path), 0
    assert not played.notes
    for time, seen, now in pictures(job.load(path, CHANGES)):
        if not np.isclose(played.time, time).any():
            continue
        then, around, there = played.frame(time), played.frame(seen), now.poses[pose.VISIBLE] > 0.0
        np.testing.assert_array_equal(then.poses[pose.VISIBLE] > 0.0, there)
        np.testing.assert_allclose(then.poses[SEEN][:, there], now.poses[SEEN][:, there], atol=2e-3)
        np.testing.assert_array_equal(around.lights, now.lights)
        np.testing.assert_array_equal(around.standing, now.standing)
        stands = now.standing > 0
        np.testing.assert_allclose(around.objects[:, stands], now.objects[:, stands], atol=0.05)
        looked += 1
    assert looked > 100


def test_between_two_samples_everybody_is_on_the_way(sample, runs):
    changes = CHANGES | {"recording.period": 0.1, "clock.duration": 2.0}
    played = replay(runs, job.run(job.load(sample, changes), runs=runs).row.run, sample)
    before, between, after = (played.frame(time).poses for time in (1.0, 1.05, 1.1))
    np.testing.assert_allclose(between[pose.X], 0.5 * (before[pose.X] + after[pose.X]), atol=1e-3)
    assert (played.frame(-1.0).poses == played.frame(played.time[0]).poses).all()
    assert (played.frame(99.0).poses == played.frame(played.time[-1]).poses).all()


def test_who_was_not_recorded_is_not_shown_and_told(sample, runs):
    played = replay(runs, job.run(job.load(sample, {"clock.duration": 1.0, "recording.traffic": False}), runs=runs).row.run, sample)
    named = len(job.load(sample).scenario.vehicles)
    assert played.frame(0.5).poses[pose.VISIBLE].sum() == named
    assert "were not recorded" in played.notes[0] and "recording.traffic" in played.notes[0]


def test_a_run_that_did_not_keep_where_anybody_was_cannot_be_played_back(sample, runs):
    run = job.run(job.load(sample, {"clock.duration": 0.5, "recording.channels": ["speed"]}), runs=runs).row.run
    with pytest.raises(UnknownError, match="cannot be played back") as refused:
        replay(runs, run, sample)
    assert refused.value.problems[0].where == "recording.channels"


FLYOVER = """
version: 1
title: Over and under
map: {file: map.osm, radius: 900}
clock: {duration: 8}
routes: {over: {roads: ["11"]}, under: {roads: ["14"]}}
vehicles:
  up: {route: over, position: {along: 200}, speed: 12}
  down: {route: under, position: {along: 180}, speed: 12}
  above: {route: over, position: {along: 380}, speed: 12}
"""


def test_who_drives_on_a_bridge_is_seen_there(tmp_path, runs, monkeypatch):
    """On its ramp and on its deck as high as the road is drawn, tilted as it is, and under it on the ground; played back as live."""
    monkeypatch.setenv("STUDIO_CACHE", str(tmp_path / "cache"))
    nodes = {1: (-400, 0), 2: (-50, 0), 3: (50, 0), 4: (400, 0), 5: (0, -300), 6: (0, 300)}
    plot(tmp_path / "map.osm", nodes, {11: ([1, 2], {}), 12: ([2, 3], {"bridge": "yes"}), 13: ([3, 4], {}), 14: ([5, 6], {})})
    path = tmp_path / "flyover.yaml"
    path.write_text(FLYOVER, encoding="utf-8")
    played = replay(runs, job.run(job.load(path), runs=runs).row.run, path)
    relief = relief_of(played.setting.network)
    highest = np.zeros(3)
    for time, _, now in pictures(job.load(path)):
        if np.isclose(played.time, time).any():
            then = played.frame(time).poses
            np.testing.assert_allclose(then[[pose.Z, pose.TILT]], now.poses[[pose.Z, pose.TILT]], atol=0.15)
            highest = np.maximum(highest, now.poses[pose.Z])
            lift, _ = relief.at(*now.poses[[pose.X, pose.Y]], [0.0, 0.0, STOREY])
            assert now.poses[pose.Z, 1] == pytest.approx(0.0, abs=0.1) and now.poses[pose.Z, 2] == pytest.approx(lift[2], abs=0.15)
    assert highest[0] > 3.0 and highest[1] < 0.1 and highest[2] == pytest.approx(STOREY, abs=0.15)
