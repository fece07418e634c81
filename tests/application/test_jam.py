"""Traffic-jam warning over the cellular network, on the sample: how hard who comes has to brake, with and without it."""

from math import sqrt

import numpy as np
import pytest

from studio import job
from studio.kinds.application import jam_warning

COVERED = {"kind": "cellular", "coverage": "circle", "x": -2330.0, "y": -160.0, "radius": 1000.0}  # [m] around where the platoon starts


def sample(root, **changes):
    """The sample, with changes by path."""
    return job.run(job.load(root / "scenarios" / "jam_warning.yaml", changes))


def test_the_warning_is_what_keeps_the_goals(root):
    """With it nobody brakes by much more than the comfortable 2 m/s²; without, as hard as an ACC where its radar's reach ends."""
    warned, blind = sample(root), sample(root, **{"applications.first.parameters.minds": False})
    assert warned.status == "done" and not warned.unmet, warned.unmet
    assert warned.metrics["max_deceleration"].value < 2.3 and blind.metrics["max_deceleration"].value > 5.0
    assert {each.split()[0] for each in blind.unmet} == {"max_deceleration", "min_ttc"}


def test_it_slows_down_along_its_law(root):
    """While it comes to the jam it is nowhere faster than sqrt(v_j² + 2 b (d - MARGIN)) allows, and begins where that meets its speed."""
    record = sample(root).record
    distance, speed = record.probes["first.first.distance"].values, record.trace("first.speed")
    far = distance > jam_warning.MARGIN + 5.0
    law = np.sqrt(3.0**2 + 2.0 * 2.0 * (distance[far] - jam_warning.MARGIN))
    assert np.all(speed[far] <= law + 1.0)
    begins = record.time[np.argmax(speed < 0.97 * 33.3)]
    told = np.interp(begins, record.time, distance)
    assert told == pytest.approx(jam_warning.MARGIN + (33.3**2 - 3.0**2) / 4.0, rel=0.1)


def test_most_messages_may_be_lost_but_not_all_of_them(root):
    """A warning counts for 10 s and comes every second: nine of ten may be lost. Where the network ends before the jam, none comes."""
    assert not sample(root, **{"radio.loss": 0.9}).unmet
    uncovered = sample(root, radio=COVERED)
    assert uncovered.metrics["max_deceleration"].value > 4.0
    assert np.all(uncovered.record.probes["first.first.distance"].values == 0.0)


def test_the_law():
    """10 m/s at 60 m and nearer; 100 m farther with 2 m/s²: sqrt(100 + 400)."""
    assert jam_warning.allowed(10.0, jam_warning.MARGIN, 2.0) == 10.0 and jam_warning.allowed(10.0, 0.0, 2.0) == 10.0
    assert jam_warning.allowed(10.0, jam_warning.MARGIN + 100.0, 2.0) == pytest.approx(sqrt(500.0))
