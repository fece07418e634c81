"""Banded systems against LAPACK's, and against themselves."""

import numpy as np
import pytest
from scipy.linalg import solveh_banded

from studio.road.network.band import solve


def smoothing(n, seed):
    """A system as smoothing makes it: third differences with great stiffness, weights of all sizes."""
    rng = np.random.default_rng(seed)
    differences = np.diff(np.eye(n), 3, axis=0)
    full = 1e4 * differences.T @ differences + np.diag(10.0 ** rng.uniform(-3, 6, n))
    band = np.zeros((4, n))
    for m in range(4):
        band[3 - m, m:] = np.diagonal(full, m)
    return full, band, rng.normal(size=(2, n))


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 9, 500])
def test_the_solution_solves_the_system(n):
    full, band, right = smoothing(n, n)
    found = solve(band, right)
    np.testing.assert_allclose(found @ full, right, atol=1e-6)
    if n > 3:
        np.testing.assert_allclose(found, solveh_banded(band, right.T).T, rtol=1e-6, atol=1e-9)


def test_what_it_is_given_stays_as_it_is():
    _, band, right = smoothing(20, 0)
    kept = band.copy(), right.copy()
    solve(band, right)
    assert (band == kept[0]).all() and (right == kept[1]).all()
