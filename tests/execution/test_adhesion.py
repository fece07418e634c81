"""The use of adhesion in a record."""

import numpy as np

from studio import job
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
