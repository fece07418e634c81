"""Time from request to commitment, by messages of the kind maneuver."""

from dataclasses import replace

import numpy as np
import pytest

from studio import job
from studio.assess.agreement import agreements
from studio.assess.measure import measure_all
from studio.execution.message import none
from tests.assess.drive import record


def talked(*rows):
    """A record of two cars and what they said: time [s], who, step, number of the maneuver."""
    time, sender, step, identity = (np.array(each) for each in zip(*rows, strict=True))
    ones, nobody = np.ones(time.size), np.zeros(time.size, dtype=np.int32)
    said = replace(
        none(("maneuver",), ("a", "b")), time=time, sender=sender, kind=nobody, number=np.arange(time.size), size=300 * ones,
        said_0=step, said_1=identity, count=nobody,
    )  # fmt: skip
    return replace(record(np.linspace(0.0, 10.0, 501)), messages=said)


def test_the_longest_counts():
    """a asks twice for its maneuver 1 and commits 0.06 s after the first time; b's takes 0.4 s; what is rejected takes no time."""
    made = talked(
        (1.00, 0, 1, 1), (1.02, 0, 1, 1), (1.05, 1, 2, 1), (1.06, 0, 4, 1), (1.08, 0, 4, 1),
        (2.00, 1, 1, 1), (2.20, 0, 2, 1), (2.40, 1, 4, 1),
        (3.00, 0, 1, 2), (3.05, 1, 3, 2),
    )  # fmt: skip
    assert [(each.value, each.subject) for each in agreements(made)] == [(pytest.approx(0.06), ("a",)), (pytest.approx(0.4), ("b",))]
    found = measure_all(made)["commit_time"]
    assert (found.value, found.subject, found.time) == (pytest.approx(0.4), ("b",), pytest.approx(2.4))


def test_what_is_taken_back_counts_once():
    """a asks twice and takes its second maneuver back, told thrice; b's abort of what it has not asked for is none."""
    made = talked(
        (1.00, 0, 1, 1), (1.06, 0, 4, 1), (2.00, 0, 1, 2), (2.40, 0, 6, 2), (2.42, 0, 6, 2), (2.44, 0, 6, 2), (3.00, 1, 6, 1),
    )  # fmt: skip
    assert measure_all(made)["maneuvers_aborted"].value == 1.0


def test_nobody_asked():
    found = measure_all(record(np.linspace(0.0, 1.0, 51)))
    assert found["commit_time"].value is None and found["maneuvers_aborted"].value is None


def test_the_log_keeps_what_a_message_says_first(sample):
    """An awareness message begins with the place that its sender has measured: the true one and the error, within the way of a tick."""
    run = job.run(job.load(sample, {"clock.duration": 2}))
    sent = run.record.messages
    own = (sent.sender == sent.units.index("leader")) & (sent.kind == sent.kinds.index("awareness"))
    at = np.searchsorted(run.time, sent.time[own] - 1e-6)
    for said, place, error in ((sent.said_0, "x", "gps_error_east"), (sent.said_1, "y", "gps_error_north")):
        assert said[own] == pytest.approx(run.trace(f"leader.{place}")[at] + run.trace(f"leader.{error}")[at], abs=0.35)
    assert own.sum() >= 19
