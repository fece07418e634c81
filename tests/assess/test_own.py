"""Metrics and channels of one's own: measured, recorded and kept like those that come with the studio."""

import numpy as np
import pytest

from studio import job
from studio.errors import ScenarioError
from studio.execution.record import Record
from studio.kind import registry
from studio.store.runs import open_runs
from studio.world.channel import CHANNELS, catalogue

METRIC = '''"""Least speed of any vehicle."""
KIND = "metric"
TITLE = "Least speed"
UNIT = "m/s"
BETTER = "higher"
from .factor import FACTOR
def measure(record):
    return FACTOR * record.channel("kinetic").min()
'''
CHANNEL = '''"""Kinetic energy per mass: v²/2."""
KIND = "channel"
TITLE = "Kinetic energy per mass"
UNIT = "J/kg"
def trace(read):
    return read("speed") ** 2 / 2
'''


@pytest.fixture
def folder(tmp_path):
    """A folder with a metric that reads a channel, and a helper."""
    (tmp_path / "least_speed.py").write_text(METRIC)
    (tmp_path / "kinetic.py").write_text(CHANNEL)
    (tmp_path / "factor.py").write_text("FACTOR = 2.0\n")
    return tmp_path


def record(speed):
    """A record of one car with speeds [m/s] at 0, 1, 2 ... s."""
    values = np.zeros((len(CHANNELS), 1, len(speed)))
    values[[each.name for each in CHANNELS].index("speed"), 0] = speed
    return Record(np.arange(float(len(speed))), values, ("a",), ())


def test_they_are_recorded_measured_and_kept(folder, own_kinds, sample, tmp_path):
    own_kinds(folder)
    runs = open_runs(tmp_path / "runs.db")
    loaded = job.load(sample, {"clock.duration": 1, "goals": {"least_speed": {"least": 1e6}}, "recording.channels": ["kinetic", "speed"]})
    made = job.run(loaded, runs=runs)
    kept = runs.trace(1, ["leader.kinetic", "leader.speed"])
    assert np.array_equal(kept["leader.kinetic"], kept["leader.speed"] ** 2 / 2)
    assert {"name": "leader.kinetic", "unit": "J/kg", "label": "Kinetic energy per mass"} in runs.channels(1)
    assert runs.find(1).metrics["least_speed"] == made.metrics["least_speed"] and made.metrics["least_speed"].unit == "m/s"
    assert made.unmet[0].startswith("least_speed is ") and made.error is None


def test_one_that_raises_is_told_and_the_run_is_kept(folder, own_kinds, sample):
    (folder / "kinetic.py").write_text(CHANNEL.replace('read("speed")', 'read("sped")'))
    (folder / "factor.py").write_text("FACTOR = None\n")
    own_kinds(folder)
    made = job.run(job.load(sample, {"clock.duration": 0.1}))
    assert made.status == "done" and made.metrics["least_speed"].value is None and made.metrics["min_gap"].value > 0
    assert "The channel 'kinetic' raised" in made.error and "did you mean 'speed'" in made.error and "kinetic.py" in made.error
    assert "The metric 'least_speed' raised" in made.error and np.isnan(made.trace("leader.kinetic")).all()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('return read("speed")[0]', "returned the shape (3,), not (1, 3)"),
        ('return read("speed") + read("speed").sort()', "read-only"),
        ('return read("kinetic") + ()', "could not be broadcast"),
    ],
)
def test_what_a_channel_must_not_do(folder, own_kinds, text, words):
    (folder / "kinetic.py").write_text(CHANNEL.replace('return read("speed") ** 2 / 2', text))
    own_kinds(folder)
    made, told = record([1.0, 2.0, 3.0]), []
    made.derived.make(told.append)
    assert any(words in each for each in told), told
    assert made.channel("speed").tolist() == [[1.0, 2.0, 3.0]]


def test_time_can_be_read(folder, own_kinds):
    (folder / "kinetic.py").write_text(CHANNEL.replace('read("speed") ** 2 / 2', 'read("speed") * read("time")'))
    own_kinds(folder)
    assert record([1.0, 2.0, 3.0]).trace("a.kinetic").tolist() == [0.0, 2.0, 6.0]


def test_a_name_that_is_recorded_anyway_is_taken(folder, own_kinds):
    (folder / "speed.py").write_text(CHANNEL)
    own_kinds(folder)
    (broken,) = registry.broken()
    assert broken.name == "speed" and "taken" in str(broken.error) and "row of the world" in str(broken.error)
    assert catalogue()["speed"].row >= 0 and "kinetic" in catalogue()


def test_a_goal_about_a_metric_that_does_not_load_says_why(folder, own_kinds, sample):
    (folder / "factor.py").unlink()
    own_kinds(folder)
    with pytest.raises(ScenarioError, match=r"goals\.least_speed: .*cannot be used(.|\n)*No module named"):
        job.load(sample, {"goals": {"least_speed": {"least": 1}}})
