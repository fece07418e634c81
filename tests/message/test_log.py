"""The log of messages: nothing is forgotten, late is what was overtaken, and the database gives it back."""

import numpy as np
import pytest

from studio import job
from studio.errors import UnknownError
from studio.execution.message import OF_ENTRIES
from studio.store.runs import open_runs
from studio.world.board import log
from studio.world.table.cause import CHANCE, OUT_OF_RANGE, RECEIVED


def run(sample, seconds=10.0, runs=None, **radio):
    """The sample with another radio."""
    changes = {"clock.duration": seconds, "traffic.count": 0} | {f"radio.{name}": value for name, value in radio.items()}
    found = job.run(job.load(sample, changes), runs=runs)
    assert found.status == "done", found.error
    return found


def test_every_message_is_in_it_once(sample):
    """Five cars, ten messages a second: as many as beacons, four links in a row; what becomes of each is said, with its distance."""
    found = run(sample, loss=0.2, range=5000.0).record.messages
    assert found.time.size == 5 * 100 and found.cause.size == 4 * 100 and np.all(np.diff(found.time) >= 0)
    assert set(found.cause) == {RECEIVED, CHANCE} and OUT_OF_RANGE not in found.cause
    assert np.mean(found.cause == CHANCE) == pytest.approx(0.2, abs=3 * 0.02)
    np.testing.assert_array_equal(np.isnan(found.delay), found.cause != RECEIVED)
    assert found.distance.min() > 5.0 and found.distance.max() < 200.0
    for entries in found.links():
        np.testing.assert_array_equal(np.diff(found.number[found.of[entries]]), 1)


def test_out_of_range_has_no_entry(sample):
    found = run(sample, 2.0, range=10.0).record.messages
    assert found.time.size == 100 and found.cause.size == 0 and found.of.size == 0


def test_late_is_what_was_overtaken(sample):
    """Delays of 0 to 0.4 s at a message every 0.1 s: one is late where a later one came before it; by hand, entry by entry."""
    found = run(sample, loss=0.1, delay=0.2, delay_variation=0.2).record.messages
    expected = np.zeros(found.of.size, dtype=bool)
    for entries in found.links():
        for i, e in enumerate(entries):
            later = [f for f in entries[i + 1 :] if found.is_received[f]]
            expected[e] = found.is_received[e] and any(found.came[f] < found.came[e] for f in later)
    np.testing.assert_array_equal(found.is_late, expected)
    assert 0.1 < expected.mean() < 0.9


def test_small_chunks_are_joined(sample, monkeypatch):
    """However little room is made at a time, the log is the same."""
    whole = run(sample, 4.0).record.messages
    monkeypatch.setattr(log, "ROOM", 8)
    parts = run(sample, 4.0).record.messages
    for name in ("time", "sender", "number", "count", *OF_ENTRIES):
        np.testing.assert_array_equal(getattr(whole, name), getattr(parts, name))


def test_the_database_keeps_it(sample, tmp_path):
    runs = open_runs(tmp_path / "runs.db")
    found = run(sample, 4.0, runs, loss=0.3)
    kept, own = runs.messages(found.row.run), found.record.messages
    assert (kept.kinds, kept.units) == (own.kinds, own.units)
    for name in ("time", "sender", "kind", "number", "size", "count", *OF_ENTRIES):
        assert getattr(kept, name).tobytes() == getattr(own, name).tobytes() and getattr(kept, name).dtype == getattr(own, name).dtype
    runs.database.execute("delete from messages")
    with pytest.raises(UnknownError, match="has no log of messages"):
        runs.messages(found.row.run)
