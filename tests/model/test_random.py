"""Random numbers: known answers, distribution, and that nothing but the counter matters."""

from statistics import NormalDist

import numpy as np
import pytest

from studio.model import random
from studio.model.random import normal, philox, uniform

# Published with Random123 (kat_vectors, philox4x32 with 10 rounds).
KNOWN = [
    ((0, 0, 0, 0), (0, 0), (0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8)),
    ((0xFFFFFFFF,) * 4, (0xFFFFFFFF,) * 2, (0x408F276D, 0x41C83B0E, 0xA20BC7C6, 0x6D5451FD)),
    (
        (0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344),
        (0xA4093822, 0x299F31D0),
        (0xD16CFE09, 0x94FDCCEB, 0x5001E420, 0x24126EA1),
    ),
]


@pytest.mark.parametrize(("counter", "key", "answer"), KNOWN)
def test_known_answers(counter, key, answer):
    assert tuple(int(word) for word in philox(*counter, *key)) == answer


def test_moments():
    """Mean and variance of 100 000 numbers within four standard errors."""
    n = 100_000
    u = np.array([uniform(7, 3, 1, k) for k in range(n)])
    z = np.array([normal(7, 3, 1, k) for k in range(n)])
    assert abs(u.mean() - 0.5) < 4 * (1 / 12) ** 0.5 / n**0.5
    assert abs(z.mean()) < 4 / n**0.5
    assert abs(z.var() - 1) < 4 * (2 / n) ** 0.5
    assert (u > 0).all() and (u < 1).all()


def test_every_part_of_the_counter_matters():
    base = uniform(1, 2, 3, 4)
    others = [uniform(9, 2, 3, 4), uniform(1, 9, 3, 4), uniform(1, 2, 9, 4), uniform(1, 2, 3, 9)]
    assert len({base, *others}) == 5
    assert base == uniform(1, 2, 3, 4)


def test_seeds_beyond_32_bits_differ():
    assert uniform(1, 0, 0, 0) != uniform(1 + 2**32, 0, 0, 0)


def test_the_quantile_of_the_normal_distribution():
    """Against the standard library, to 1e-7 of its value or of 1e-7."""
    for p in (2.0**-33, 1e-9, 1e-6, 0.001, 0.0749, 0.0751, 0.3, 0.4999, 0.5, 0.7, 0.9251, 0.99, 1.0 - 1e-9):
        assert random.quantile(p) == pytest.approx(NormalDist().inv_cdf(p), rel=3e-7, abs=1e-7)


def test_four_numbers_at_once_are_normal_and_independent():
    """100 000 draws of four: moments and correlations within four standard errors; another thing that they are about gives others."""
    found = np.array([random.normals(7, 3, 20, k) for k in range(100_000)]).T
    n = found.shape[1]
    assert np.abs(found.mean(axis=1)).max() < 4.0 / n**0.5
    assert np.abs(found.var(axis=1) - 1.0).max() < 4.0 * (2.0 / n) ** 0.5
    assert np.abs((found**4).mean(axis=1) - 3.0).max() < 4.0 * (96.0 / n) ** 0.5
    assert np.abs(np.corrcoef(found) - np.eye(4)).max() < 4.0 / n**0.5
    assert random.normals(7, 3, 20, 0, 1) != random.normals(7, 3, 20, 0)
