"""Which car gets which space.

optimal(cost)       the assignment of least cost in sum (the Hungarian method; D. F. Crouse, On implementing 2D rectangular assignment
                    algorithms, IEEE Trans. Aerospace and Electronic Systems 52 (2016) 1679, is what scipy does)
first_come(cost)    row by row the cheapest that is left
queued(depth)       cost of sending the i-th of a queue to a space: it blocks whoever comes behind it and goes deeper

A queue on a one-way aisle: who turns into a space stops all behind it that go farther. With `depth` d_j [m] along the aisle the cost
(i + 1) d_j of the i-th car is least, in sum, when the first ones go deepest (rearrangement inequality), and nobody waits for anybody.
"""

import numpy as np
from scipy.optimize import linear_sum_assignment


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


def queued(cars: int, depth: np.ndarray) -> np.ndarray:
    """Cost [m], float64[car, space]; spaces that nobody needs, the deepest, are not worth a thing: they cost as much as all others."""
    cost = np.outer(np.arange(1.0, cars + 1.0), depth)
    beyond = np.argsort(depth, kind="stable")[cars:]
    cost[:, beyond] += float(cars * (cars + 1)) * float(depth.max(initial=1.0))
    return cost
