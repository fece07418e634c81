"""Queues: who drives on which strand, in the order of stations. Once a tick all vehicles are sorted, as `neighbour` does by place.

A vehicle stands in the queue of every strand under its body. It is announced in that of every way ahead where it may meet others, with
a station below zero, and of a lane that it will change to, where it drives beside it. Who changes lanes where nothing asks for it stands on
the lane that he leaves as well, until he has left it.

A queue belongs to one strand in one world; its number decides its bucket, of which there are more than vehicles, so that neither the
size of the map nor the number of worlds costs anything.

Nothing of this is state: it is made anew at every tick.
"""

from dataclasses import dataclass

import numpy as np

from studio.compiled import inlined, lean
from studio.vehicle.parameter import FRONT, LENGTH
from studio.vehicle.state import ACTIVE, V_X
from studio.world.passes.neighbour import HALF, SCATTER
from studio.world.table.mind import LEFT_BY, STATION
from studio.world.table.web import END, ENTER, LEAVE, START

MOST = 12  # queues that a vehicle stands in
EARLY, NEAR = 8.0, 30.0  # [s], [m] ahead a driver lets others know that he comes
SIGNAL_NEAR, SIGNAL_EARLY = 4.0, 3.0  # [m], [s] before a lane change one shows it
OVERLAPS = 4  # drives that may begin before one that is over
KEY, WHO, THERE = range(3)  # rows of a list: number of the queue, vehicle, 1 where it drives there and is not only announced


@dataclass
class Queues:
    """First place per bucket; by place the queue's number and the vehicle, and its station there [m]; by vehicle what it asks for."""

    first: np.ndarray  # int64[bucket + 1]
    place: np.ndarray  # int64[3, place]
    at: np.ndarray  # float64[place]: of the centre of gravity
    wanted: np.ndarray  # int64[MOST, vehicle]
    wanted_at: np.ndarray  # float64[MOST, vehicle]
    there: np.ndarray  # int64[MOST, vehicle]
    count: np.ndarray  # int64[vehicle]


def queues(n: int) -> Queues:
    """Room for n vehicles."""
    buckets = 2 ** int(np.ceil(np.log2(4 * n + 4)))
    return Queues(
        first=np.zeros(buckets + 1, np.int64),
        place=np.zeros((3, n * MOST), np.int64),
        at=np.zeros(n * MOST),
        wanted=np.zeros((MOST, n), np.int64),
        wanted_at=np.zeros((MOST, n)),
        there=np.zeros((MOST, n), np.int64),
        count=np.zeros(n, np.int64),
    )


@inlined
def bucket_of(number, buckets):
    """The bucket of a queue."""
    return int(np.uint64(number) * SCATTER >> HALF & np.uint64(buckets - 1))


@inlined
def station_on(d, station, web):
    """Station [m] on a strand of a place on the line: before it begins below zero, behind its end beyond it."""
    enter, leave, start, end = web.drive[ENTER, d], web.drive[LEAVE, d], web.drive[START, d], web.drive[END, d]
    if station <= enter:
        return start + station - enter
    if station >= leave:
        return end + station - leave
    return start + (station - enter) * (end - start) / (leave - enter)


@inlined
def first_drive(rear, first, count, web):
    """The first drive of a line that may reach beyond a station [m]."""
    low, high = first, first + count
    while low < high:
        middle = (low + high) // 2
        if web.drive[ENTER, middle] <= rear:
            low = middle + 1
        else:
            high = middle
    return max(first, low - OVERLAPS)


@inlined
def is_met(strand, web):
    """Whether others may come in one's way on a strand."""
    return web.first[strand + 1] > web.first[strand]


@inlined
def is_changed_to(d, bumper, speed, web):
    """Whether one comes onto a strand from the side, and will soon."""
    enter = web.drive[ENTER, d]
    return web.drive[START, d] > 0.0 and 0.0 < enter < bumper + SIGNAL_NEAR + SIGNAL_EARLY * speed


@lean
def sort(state, parameter, mind, world_of, entity, drive_first, drive_count, left_first, left_count, web, first, place, at, wanted,
         wanted_at, there, count):  # fmt: skip
    """Sorts all vehicles that take part, by counting: how many are in each bucket, then each into its place."""
    first[:] = 0
    buckets = first.size - 1
    for v in range(state.shape[1]):
        count[v] = 0
        if state[ACTIVE, v] > 0.0:
            ask(v, state, parameter, mind, world_of[v], drive_first[v], drive_count[v], web, wanted, wanted_at, there, count)
            stay(v, parameter, mind, world_of[v], left_first[v], left_count[v], web, wanted, wanted_at, there, count)
        for i in range(count[v]):
            first[bucket_of(wanted[i, v], buckets)] += 1
    for bucket in range(1, buckets + 1):
        first[bucket] += first[bucket - 1]
    for v in range(state.shape[1]):
        for i in range(count[v]):
            bucket = bucket_of(wanted[i, v], buckets)
            first[bucket] -= 1
            place[KEY, first[bucket]], place[WHO, first[bucket]], at[first[bucket]] = wanted[i, v], v, wanted_at[i, v]
            place[THERE, first[bucket]] = there[i, v]
    for bucket in range(buckets):
        line_up(first[bucket], first[bucket + 1], place, at, entity)


@inlined
def ask(v, state, parameter, mind, world, drive_first, drive_count, web, wanted, wanted_at, there, count):
    """The queues of a vehicle, by its place on its line."""
    station = mind[STATION, v]
    bumper = station + parameter[FRONT, v]
    speed = max(state[V_X, v], 0.0)
    rear, ahead = bumper - parameter[LENGTH, v], bumper + NEAR + EARLY * speed
    for d in range(first_drive(rear, drive_first, drive_count, web), drive_first + drive_count):
        if web.drive[ENTER, d] > ahead or count[v] == MOST:
            return
        strand = web.strand[d]
        is_there = web.drive[ENTER, d] <= bumper
        if web.drive[LEAVE, d] > rear and (is_there or is_met(strand, web) or is_changed_to(d, bumper, speed, web)):
            there[count[v], v] = 1 if is_there else 0
            wanted[count[v], v] = world * web.right.size + strand
            wanted_at[count[v], v] = station_on(d, station, web)
            count[v] += 1


@inlined
def stay(v, parameter, mind, world, left_first, left_count, web, wanted, wanted_at, there, count):
    """The queues of the line that a vehicle is leaving, under its body."""
    if left_count == 0:
        return
    station = mind[STATION, v] + mind[LEFT_BY, v]
    bumper = station + parameter[FRONT, v]
    rear = bumper - parameter[LENGTH, v]
    for d in range(first_drive(rear, left_first, left_count, web), left_first + left_count):
        if web.drive[ENTER, d] > bumper or count[v] == MOST:
            return
        queue = world * web.right.size + web.strand[d]
        if web.drive[LEAVE, d] > rear and not is_wanted(v, queue, wanted, count):
            there[count[v], v], wanted[count[v], v], wanted_at[count[v], v] = 1, queue, station_on(d, station, web)
            count[v] += 1


@inlined
def is_wanted(v, queue, wanted, count):
    """Whether a vehicle stands in a queue already."""
    for i in range(count[v]):
        if wanted[i, v] == queue:
            return True
    return False


@lean
def line_up(first, last, place, at, entity):
    """Puts one bucket in order: queue by queue, by station, then as chance tells vehicles apart."""
    for i in range(first + 1, last):
        key, who, there, station, j = place[KEY, i], place[WHO, i], place[THERE, i], at[i], i
        while j > first and is_before(key, who, station, j - 1, place, at, entity):
            place[KEY, j], place[WHO, j], place[THERE, j], at[j] = place[KEY, j - 1], place[WHO, j - 1], place[THERE, j - 1], at[j - 1]
            j -= 1
        place[KEY, j], place[WHO, j], place[THERE, j], at[j] = key, who, there, station


@inlined
def is_before(key, who, station, j, place, at, entity):
    """Whether an entry comes before that in place j."""
    if key != place[KEY, j]:
        return key < place[KEY, j]
    if station != at[j]:
        return station < at[j]
    return entity[who] < entity[place[WHO, j]]


@inlined
def from_station(key, station, first, place, at):
    """The first place of a queue whose vehicle is at a station [m] or beyond; and the end of its bucket."""
    bucket = bucket_of(key, first.size - 1)
    low, high = first[bucket], first[bucket + 1]
    while low < high:
        middle = (low + high) // 2
        if place[KEY, middle] < key or (place[KEY, middle] == key and at[middle] < station):
            low = middle + 1
        else:
            high = middle
    return low, first[bucket + 1]
