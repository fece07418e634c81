"""Perceived objects: who is told of, how often, and how large that makes a message."""

import numpy as np

from studio.kind import registry
from studio.workshop.stage import stage

CPM = registry.find("message", "cpm").module
NOISE = ("range_noise", "rate_noise", "azimuth_noise", "range_growth", "missed", "delay")
EXACT = dict.fromkeys(NOISE, 0.0) | {"opening_angle": 0.6}


def run(seconds, **changes):
    """`own` at 25 m/s tells what it sees of `ahead`, 35 m before it, which drives as fast."""
    current = stage(
        vehicles={"own": {"sensors": {"around": {"kind": "object_sensor"} | EXACT}, **changes}},
        applications={"shares": {"application": "perception", "units": ["own"]}},
        radio={"range": 5000.0},
    )
    current.advance(round(50 * seconds))
    assert current.cases[0].error is None
    return current.record()


def test_an_object_is_told_of_when_it_has_moved():
    """25 m/s: 4 m are moved after 0.16 s, so at looks every 0.1 s it is told of every 0.2 s. A message with n has 150 + 45 n bytes."""
    record = run(6.0)
    found = record.messages
    told = record.probes["own.shares.told"].values
    gaps = np.diff(found.time)
    assert found.kinds == ("cpm",) and np.mean(np.isclose(gaps, 0.2) | np.isclose(gaps, 0.1)) > 0.9
    counts = np.interp(found.time, record.time, told)
    np.testing.assert_array_equal(found.size, CPM.HEAD + CPM.OBJECT * counts)
    assert counts.max() >= 1.0
