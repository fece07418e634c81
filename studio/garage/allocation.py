"""Which car gets which space.

optimal(cost)       the assignment of least cost in sum (the Hungarian method; D. F. Crouse, On implementing 2D rectangular assignment
                    algorithms, IEEE Trans. Aerospace and Electronic Systems 52 (2016) 1679, is what scipy does)
first_come(cost)    row by row the cheapest that is left
queued(...)         cost of sending the cars of a queue to spaces along a one-way aisle

Who turns into a space stops all behind it that go farther, for as long as that takes. So the queue is sent off in waves: the first car of a
wave to the last zone of the aisle, the next to the zone before it, so that they turn in side by side and nobody waits for who is ahead. A
zone is as long as the ground that turning in takes (ZONE). A space costs its depth d_j [m], and MISSED more in another zone than its car's.
"""

import numpy as np
from scipy.optimize import linear_sum_assignment

ZONE, NEAREST = 15.0, 13.0  # [m] of a zone, and depth at which the first begins
MISSED = 40.0  # [m] that driving on is worth against waiting for one who turns in: 16 s at 2.5 m/s


def optimal(cost: np.ndarray) -> np.ndarray:
    """Column of each row, float64[row, column] with no fewer columns than rows."""
    return linear_sum_assignment(cost)[1]


def first_come(cost: np.ndarray) -> np.ndarray:
    """Column of each row, the first row choosing first."""
    left, taken = np.array(cost, dtype=float), []
    for row in left:
        taken.append(int(np.argmin(row)))
        left[:, taken[-1]] = np.inf
    return np.array(taken, dtype=int)


def queued(cars: int, depth: np.ndarray, first: int, zones: int) -> np.ndarray:
    """Cost [m], float64[car, space], of a queue whose first car is the one of number `first` of all that have come.

    depth [m] of each space along the aisle; so many zones, from the one of the nearest space of all on.
    """
    zone = np.minimum((depth - NEAREST) // ZONE, zones)
    wanted = zones - 1 - (first + np.arange(cars)) % zones
    return depth + MISSED * (zone != wanted[:, None])
