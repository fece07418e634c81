"""The estimate of the acceleration ahead: what it knows of cars that accelerate, and that its certainty is that of its errors."""

import numpy as np
import pytest

from studio.model import singer

T = 0.02


def follow(accelerations, own=None, *, noise=0.0, seed=1):
    """Estimates at ticks of T [s] behind a car that drives the accelerations [m/s²], and true gap, rate and acceleration."""
    chance = np.random.default_rng(seed)
    own = np.zeros_like(accelerations) if own is None else own
    d, r, x, found, true = 2000.0, 0.0, singer.NOBODY, [], []
    for a, a_own, before in zip(accelerations, own, np.roll(own, 1), strict=True):
        measured = d + noise * singer.RANGE_NOISE * chance.normal(), r + noise * singer.RATE_NOISE * chance.normal()
        x = singer.followed(x, *measured, before, T)
        found.append(x)
        true.append((d, r, a))
        d, r = d + T * r + 0.5 * T * T * (a - a_own), r + T * (a - a_own)
    return np.array(found), np.array(true)


def test_an_acceleration_is_found():
    """Singer's target forgets its acceleration with alpha, so 8 % of one that lasts are missing (found here: q, noise and alpha alone)."""
    found, _ = follow(np.full(400, -2.0))
    assert found[-1, 2] == pytest.approx(-2.0, rel=0.1) and found[25, 2] < -1.5
    assert np.abs(found[:, 0] - follow(np.full(400, -2.0))[1][:, 0]).max() < 0.01


def test_the_own_acceleration_is_not_taken_for_that_of_the_other():
    own = 3.0 * np.sin(np.arange(1000) * T)
    found, true = follow(np.zeros(1000), own)
    np.testing.assert_allclose(found[:, :2], true[:, :2], atol=1e-6)
    np.testing.assert_allclose(found[:, 2], 0.0, atol=1e-5)


def test_its_covariance_is_that_of_its_errors():
    """Targets that are Singer's, measured with the radar's noise: the mean squared errors are P's diagonal, within 15 %."""
    chance, errors = np.random.default_rng(3), []
    phi = np.exp(-singer.ALPHA * T)
    for seed in range(40):
        a, sigma = np.zeros(400), np.sqrt(singer.VARIANCE)
        a[0] = sigma * chance.normal()
        for k in range(1, 400):
            a[k] = phi * a[k - 1] + sigma * np.sqrt(1.0 - phi * phi) * chance.normal()
        found, true = follow(a, noise=1.0, seed=seed)
        errors.append((found[200:, :3] - true[200:]) ** 2)
    assert np.mean(np.concatenate(errors), axis=0) == pytest.approx(found[-1, [3, 6, 8]], rel=0.15)


def test_another_target_is_begun_anew():
    x = singer.begun(30.0, 0.0)
    assert singer.followed(x, 12.0, -1.0, 0.0, T) == singer.begun(12.0, -1.0)
    assert singer.followed(singer.NOBODY, 12.0, -1.0, 0.0, T) == singer.begun(12.0, -1.0)
