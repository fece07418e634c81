"""Queues: who drives on which track, in the order of stations. Once a tick all vehicles are sorted, as `neighbour` does by place.

A track is a row of points that lines of one or several worlds use; a queue is what drives on it in one world. Most vehicles keep
their places from tick to tick, so the order of the last tick is what sorting begins with; its outcome does not depend on it.

Nothing of this is state: it is made anew at every tick.
"""

from dataclasses import dataclass

import numpy as np

from studio.compiled import lean
from studio.vehicle.state import ACTIVE, V_X
from studio.world.table.mind import STATION


@dataclass
class Queues:
    """`first` place per queue; who is where; the speed of the slowest there and beyond, by place."""

    first: np.ndarray
    order: np.ndarray
    before: np.ndarray
    slowest: np.ndarray


def queues(n: int) -> Queues:
    """Room for n vehicles, each perhaps on a track of its own."""
    return Queues(np.zeros(n + 1, np.int64), np.arange(n), np.zeros(n, np.int64), np.zeros(n))


@lean
def sort(state, mind, queue_of, first, order, before, slowest):
    """Sorts all vehicles that take part into their queues; the others stand behind the last."""
    first[:] = 0
    for i in range(order.size):
        before[i] = order[i]
    for v in before:
        if state[ACTIVE, v] > 0.0:
            first[queue_of[v]] += 1
    for queue in range(1, first.size):
        first[queue] += first[queue - 1]
    behind = order.size
    for i in range(before.size - 1, -1, -1):
        v = before[i]
        if state[ACTIVE, v] > 0.0:
            first[queue_of[v]] -= 1
            order[first[queue_of[v]]] = v
        else:
            behind -= 1
            order[behind] = v
    for queue in range(first.size - 1):
        line_up(first[queue], first[queue + 1], state, mind, order, slowest)


@lean
def is_behind(v, other, mind):
    """Whether a vehicle comes before another in their queue: by station, then by number."""
    return mind[STATION, v] < mind[STATION, other] or (mind[STATION, v] == mind[STATION, other] and v < other)


@lean
def line_up(first, last, state, mind, order, slowest):
    """Puts one queue in order, and notes the slowest from each place on."""
    for i in range(first + 1, last):
        v, j = order[i], i
        while j > first and is_behind(v, order[j - 1], mind):
            order[j] = order[j - 1]
            j -= 1
        order[j] = v
    for i in range(last - 1, first - 1, -1):
        slowest[i] = state[V_X, order[i]] if i == last - 1 else min(slowest[i + 1], state[V_X, order[i]])


@lean
def from_station(station, first, last, mind, order):
    """The first place of a queue whose vehicle is at a station [m] or beyond."""
    low, high = first, last
    while low < high:
        middle = (low + high) // 2
        if mind[STATION, order[middle]] < station:
            low = middle + 1
        else:
            high = middle
    return low
