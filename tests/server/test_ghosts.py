"""Ghosts: other runs on the clock of the one that is played back; and what a stretch of a run measures."""

import numpy as np
import pytest

from studio import job
from studio.errors import UnknownError
from studio.scene import pose
from studio.server.ghost import haunting
from studio.server.replay import replay
from studio.store.runs import open_runs
from studio.store.stretch import COUNTED, stretch

SHORT = {"clock.duration": 4.0}


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    kept = open_runs(tmp_path_factory.mktemp("ghosts") / "runs.db")
    yield kept
    kept.close()


def played(runs, path, **changes):
    return replay(
        runs, job.run(job.load(path, SHORT | {key.replace("__", "."): value for key, value in changes.items()}), runs=runs).row.run, path
    )


def test_a_ghost_is_where_its_run_was_and_traffic_is_none(sample, runs):
    one, other = played(runs, sample), played(runs, sample, applications__platoon__parameters__headway=1.2)
    (ghost,) = haunting(one, [other], "")
    assert ghost.offset == 0.0
    assert len(ghost.looks) == 5 and {look.color for look in ghost.looks} == {ghost.color}
    np.testing.assert_array_equal(ghost.poses(2.0), other.frame(2.0).poses[:, :5])
    assert np.abs(ghost.poses(4.0)[pose.X] - one.frame(4.0).poses[pose.X, :5]).max() > 0.5


def test_every_car_is_joined_with_the_same_one_of_the_other_run(sample, runs):
    """By name, at the distance between the two places; nobody with who is not there."""
    one, other = played(runs, sample), played(runs, sample, applications__platoon__parameters__headway=1.2)
    (ghost,) = haunting(one, [other], "")
    own, theirs = one.frame(3.0).poses, other.frame(3.0).poses
    links = list(ghost.links(one, 3.0))
    assert [one.setting.names[each.car] for each in links] == list(one.setting.scenario.vehicles)
    for each in links:
        there = other.setting.names.index(one.setting.names[each.car])
        assert (each.x, each.y) == (theirs[pose.X, there], theirs[pose.Y, there])
        apart = np.linalg.norm(own[[pose.X, pose.Y], each.car].astype(float) - theirs[[pose.X, pose.Y], there].astype(float))
        assert each.distance == pytest.approx(apart, abs=1e-6)
        assert (each.run, each.color) == (other.run, ghost.color)
    assert max(each.distance for each in links) > 0.1
    (itself,) = haunting(one, [one], "")
    assert all(each.distance == 0.0 for each in itself.links(one, 3.0))
    (short,) = haunting(one, [played(runs, sample, clock__duration=2.0)], "")
    assert list(short.links(one, 3.0)) == []


def test_a_ghost_within_its_own_car_does_not_hide_the_colour_of_that(sample, runs):
    one, other = played(runs, sample), played(runs, sample, applications__platoon__parameters__headway=1.2)
    (itself,), (ghost,) = haunting(one, [one], ""), haunting(one, [other], "")
    assert itself.poses(2.0)[pose.VISIBLE].all() and not itself.seen(one, 2.0)[pose.VISIBLE].any()
    apart = np.array([each.distance for each in ghost.links(one, 4.0)])
    assert (apart > 0.3).any()
    np.testing.assert_array_equal(ghost.seen(one, 4.0)[pose.VISIBLE] > 0, apart > 0.3)


def test_a_ghost_whose_run_is_over_is_not_there(sample, runs):
    one, short = played(runs, sample), played(runs, sample, clock__duration=2.0)
    (ghost,) = haunting(one, [short], "")
    assert ghost.poses(2.0)[pose.VISIBLE].all() and not ghost.poses(2.1)[pose.VISIBLE].any() and not ghost.poses(-0.1)[pose.VISIBLE].any()


def test_runs_are_aligned_by_the_first_event_of_a_kind(sample, runs):
    one = played(runs, sample, script__hard_brake__when__at=1.0)
    late = played(runs, sample, script__hard_brake__when__at=2.5)
    (ghost,) = haunting(one, [late], "script_begun")
    assert ghost.offset == pytest.approx(1.5)
    np.testing.assert_array_equal(ghost.poses(2.0), late.frame(3.5).poses[:, :5])
    with pytest.raises(UnknownError, match="has no such event"):
        haunting(one, [late], "collision")


def test_a_run_on_another_map_is_no_ghost(sample, runs):
    one, other = played(runs, sample), played(runs, sample.with_stem("motorway_platoon"))
    with pytest.raises(UnknownError, match="cannot be shown beside"):
        haunting(one, [other], "")


def test_a_stretch_measures_what_lies_in_it(sample, runs):
    run = job.run(job.load(sample, {"clock.duration": 6.0, "script.hard_brake.when.at": 3.0}), runs=runs).row.run
    record = runs.record(run)
    first, last, found = stretch(runs, run, 1.0, 2.0)
    inside = (record.time >= 1.0 - 1e-6) & (record.time <= 2.0 + 1e-6)
    assert (first, last) == (pytest.approx(1.0), pytest.approx(2.0))
    assert found["min_gap"].value == pytest.approx(np.nanmin(record.channel("gap")[:, inside]))
    assert found["max_deceleration"].value < stretch(runs, run, 3.0, 5.0)[2]["max_deceleration"].value
    whole, stored = stretch(runs, run, -1.0, 99.0)[2], runs.find(run).metrics
    assert whole["min_gap"].value == stored["min_gap"].value and whole["mean_speed"].value == stored["mean_speed"].value
    assert whole["arrivals"].value is None and whole["arrivals"].about == COUNTED


def test_a_stretch_without_samples_is_refused_and_says_what_there_is(sample, runs):
    run = job.run(job.load(sample, SHORT), runs=runs).row.run
    with pytest.raises(UnknownError, match="between these times") as refused:
        stretch(runs, run, 3.0, 1.0)
    assert "0 to 4 s" in refused.value.problems[0].allowed
