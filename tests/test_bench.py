"""The benchmark measures what it says; how fast is not a matter of tests."""

import numpy as np
import pytest

from studio import bench
from studio.world import motion


def test_a_fleet_drives(monkeypatch):
    """Cars of the benchmark move, each on its own way, and none stands out by its place in the fleet."""
    arrays = bench.fleet(9)
    for k in range(50):
        motion.integrate(*arrays, k, bench.DEFAULT_TICK, bench.DEFAULT_STEP)
    x, y = arrays[0][:2]
    assert (x > 15).all() and np.isfinite(arrays[0]).all()
    np.testing.assert_allclose(y, -y[::-1], atol=1e-9)


def test_the_report_has_all_figures(monkeypatch, sample):
    monkeypatch.setattr(bench, "SPAN", 0.001)
    monkeypatch.setattr(bench, "FLEETS", (1, 8))
    monkeypatch.setattr(bench, "all_cores", lambda: bench.dynamics(8))
    seen = []
    figures = bench.run(sample, seen.append)
    assert set(figures["dynamics"]["one_core"]) == {"1", "8"}
    assert figures["tick"]["one_core"] > 0 and figures["dynamics"]["all_cores"] > 0
    assert figures["machine"] and figures["versions"]["numba"]
    assert seen == sorted(seen) and seen[-1] < 1


@pytest.mark.parametrize("count", [1, 7])
def test_a_rate_counts_units(monkeypatch, count):
    monkeypatch.setattr(bench, "SPAN", 0.01)
    calls = []
    assert bench.rate(lambda: calls.append(1), count) > 0
    assert len(calls) > bench.REPEATS
