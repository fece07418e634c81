"""Allocation: matrices whose optimum is known, and a queue that is sent off in waves."""

from itertools import pairwise

import numpy as np
import pytest

from studio.garage.allocation import ZONE, first_come, optimal, queued

# sums by hand: domain notes, section 3, and O14 of the checks
MATRICES = [
    ([[4, 1, 3], [2, 0, 5], [3, 2, 2]], 5, 5),
    ([[10, 12, 30], [11, 25, 28], [12, 14, 13]], 36, 48),
    ([[5, 7, 16, 20, 12], [6, 15, 18, 22, 14], [9, 8, 10, 25, 11], [14, 12, 13, 15, 30], [7, 9, 17, 24, 13]], 51, 64),
]


@pytest.mark.parametrize(("matrix", "least", "in_turn"), MATRICES)
def test_known_sums(matrix, least, in_turn):
    cost = np.array(matrix)
    rows = np.arange(len(cost))
    assert cost[rows, optimal(cost)].sum() == least
    assert cost[rows, first_come(cost)].sum() == in_turn


def test_a_wave_turns_in_side_by_side_the_deepest_first():
    depth = np.arange(14.0, 60.0, 2.5)
    for first in range(6):
        chosen = depth[optimal(queued(3, depth, first, 3))]
        wave = chosen[: 3 - first % 3]
        assert all(a - b >= ZONE - 2.5 for a, b in pairwise(wave))


def test_one_zone_gives_the_nearest_spaces():
    depth = np.array([40.0, 14.0, 30.0, 16.5])
    assert sorted(depth[optimal(queued(2, depth, 0, 1))]) == [14.0, 16.5]
