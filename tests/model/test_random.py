"""Random numbers: known answers, distribution, and that nothing but the counter matters."""

import numpy as np
import pytest

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
