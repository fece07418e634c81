"""The use of adhesion in a record."""

import numpy as np

from studio import job
from studio.assess.adhesion import used
from studio.assess.cause import at_limit
from tests.conftest import ROOT

SAMPLE = ROOT / "scenarios" / "motorway_platoon.yaml"


def test_nobody_uses_more_than_there_is():
    """A car that brakes when the road turns to ice: from then on all of what is left, and never more."""
    script = {
        "brake": {"when": {"kind": "time", "at": 0.5}, "do": {"kind": "brake", "vehicle": "leader", "deceleration": 6, "duration": 3}},
        "ice": {"when": {"kind": "time", "at": 2}, "do": {"kind": "weather", "friction": 0.1}},
    }
    found = job.run(job.load(SAMPLE, {"clock.duration": 3, "traffic.count": 0, "applications": {}, "script": script}))
    assert found.status == "done", found.error
    use = np.array([found.trace(f"leader.adhesion_{wheel}") for wheel in ("front_left", "front_right", "rear_left", "rear_right")])
    before, at = use[:, found.record.time < 1.99], use[:, np.isclose(found.record.time, 2.0)]
    assert 0.4 < before.max() < 0.9 and np.nanmax(use) <= 1.0
    assert (at == 1.0).all()


def test_a_locked_wheel_is_told_at_its_limit():
    """Wheels that lock on wet leaves: past their peaks they use ever less of the adhesion, and are told at their limits all the same."""
    script = {
        "ice": {"when": {"kind": "time", "at": 0}, "do": {"kind": "weather", "friction": 0.6}},
        "brake": {"when": {"kind": "time", "at": 0.5}, "do": {"kind": "brake", "vehicle": "leader", "deceleration": 9, "duration": 9}},
    }
    found = job.run(job.load(SAMPLE, {"clock.duration": 4, "traffic.count": 0, "applications": {}, "script": script}))
    slide = found.trace("leader.tyres_sliding")
    assert (slide[found.record.time < 0.5] == 0.0).all() and set(np.unique(slide)) <= set(range(16))
    late = int(np.searchsorted(found.record.time, 3.5))
    (wheels,) = {tuple(each.wheel for each in at_limit(found.record, "leader", late, late))}
    assert len(wheels) == 4 and used(found.record)[:, found.record.vehicles.index("leader"), late - 60 : late].max() < 0.95
    assert all(each.slides and "past its peak of slip" in each.text for each in at_limit(found.record, "leader", late, late))
