"""What probes have read is kept as what has changed, and comes back as it was."""

import numpy as np
import pytest

from studio.crowd import equipped, motorway_crowd
from studio.execution import trail
from studio.execution.simulation import simulation


@pytest.mark.parametrize(("numbers", "samples"), [(1 << 20, 1024), (1, 1024), (1 << 20, 7)])
def test_it_comes_back_as_it_was(monkeypatch, numbers, samples):
    """To the last bit, however many parts it is kept in; and less is kept than was read."""
    monkeypatch.setattr(trail, "NUMBERS", numbers)
    monkeypatch.setattr(trail, "SAMPLES", samples)
    run = simulation(motorway_crowd(10, equipped))
    kept, read = run.recorder.trail, {}
    every = slice(0, len(kept.reader.probes))
    for _ in range(60):
        run.advance(1)
        now = np.full(every.stop, np.nan)
        kept.reader.read(now)
        read[kept.count - 1] = now
    assert (len(kept.parts.first) > 1) == (numbers == 1 or samples == 7)
    found = kept.parts.at(np.array(list(read)), every)
    np.testing.assert_array_equal(found, np.array(list(read.values())))
    assert np.isnan(found).any() and np.isfinite(found).any() and len(read) == 60
    np.testing.assert_array_equal(kept.parts.at(np.array([50, 3]), slice(5, 40)), np.array([read[50][5:40], read[3][5:40]]))


def test_what_does_not_change_is_kept_once():
    run = simulation(motorway_crowd(10, equipped))
    run.advance(100)
    kept = run.recorder.trail
    assert kept.used < 0.5 * kept.count * len(kept.reader.probes)
