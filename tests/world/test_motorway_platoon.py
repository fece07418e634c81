"""The motorway sample: a platoon at 30 m/s in bends and through a hard braking."""

import pytest

from studio import job


@pytest.fixture(scope="module")
def run(root):
    """The whole sample."""
    return job.run(job.load(root / "scenarios" / "motorway_platoon.yaml"))


def test_it_ends_with_its_goals_met(run):
    assert run.status == "done" and not run.unmet
    assert run.metrics["collisions"].value == 0 and run.metrics["min_ttc"].value > 1.2
    assert run.metrics["max_lateral_acceleration"].value < 3.0 and run.metrics["max_lateral_offset"].value < 0.5


def test_it_drives_fast_brakes_and_recovers(run):
    speed = run.trace("leader.speed")
    assert speed[run.time < 40.0].min() > 27.0 and speed.max() < 33.0
    assert speed.min() < 15.0 and speed[-1] > 28.0
    last = run.trace("follower_4.speed")
    assert last.min() > speed.min() - 1.0 and last[-1] > 27.0
