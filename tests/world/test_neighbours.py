"""Neighbours and queues against brute force: the same vehicles in the same order, in whatever batch a world runs."""

from itertools import product
from math import cos, sin
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.vehicle.parameter import FRONT, LENGTH, PARAMETER
from studio.vehicle.state import ACTIVE, PSI, V_X, VEHICLE, X, Y
from studio.world.passes import neighbour, queue
from studio.world.passes.neighbour import AT_X, AT_Y, REAR_X, REAR_Y, neighbours, within
from studio.world.table.mind import MIND, STATION
from studio.world.table.web import Web

WORLDS = 3


def fleet(n, seed, *, worlds=WORLDS, spread=400.0):
    """Vehicles strewn over a square around the origin, some at the edges of cells, some that take no part."""
    random = np.random.default_rng(seed)
    state = np.zeros((len(VEHICLE), n))
    state[[X, Y]] = random.uniform(-spread, spread, (2, n))
    state[[X, Y], : n // 4] = np.round(state[[X, Y], : n // 4] / neighbour.CELL) * neighbour.CELL
    state[PSI], state[ACTIVE] = random.uniform(-4.0, 4.0, n), random.uniform(size=n) < 0.8
    parameter = np.zeros((len(PARAMETER), n))
    parameter[LENGTH], parameter[FRONT] = random.uniform(3.0, 12.0, n), random.uniform(1.0, 3.0, n)
    return SimpleNamespace(n=n, state=state, parameter=parameter, world_of=np.sort(random.integers(0, worlds, n)))


def sorted_in(f):
    """Neighbours of a fleet."""
    made = neighbours(f.parameter)
    neighbour.sort(f.state, f.parameter, f.world_of, made.grid, made.places)
    return made


def ask(made, world, box):
    """Who is in a box: x, y, heading, back, ahead, right, left."""
    x, y, heading, *sides = box
    count = within(world, x, y, cos(heading), sin(heading), *sides, made.grid, made.places, made.found)
    return made.found[:count].tolist()


def brute(f, world, box):
    """The same by looking at everybody."""
    x, y, heading, back, ahead, right, left = box
    dx, dy = f.state[X] - x, f.state[Y] - y
    forward, aside = dx * cos(heading) + dy * sin(heading), dy * cos(heading) - dx * sin(heading)
    inside = (back <= forward) & (forward <= ahead) & (right <= aside) & (aside <= left)
    return np.flatnonzero(inside & (f.world_of == world) & (f.state[ACTIVE] > 0.0)).tolist()


BOXES = st.tuples(
    st.floats(-300, 300), st.floats(-300, 300), st.floats(-7, 7),
    st.floats(-80, -0.5), st.floats(0.5, 250), st.floats(-120, -0.5), st.floats(0.5, 120),
)  # fmt: skip


@settings(max_examples=150, deadline=None)
@given(n=st.integers(1, 300), seed=st.integers(0, 10_000), box=BOXES, world=st.integers(0, WORLDS - 1))
def test_a_box_holds_whom_brute_force_finds(n, seed, box, world):
    f = fleet(n, seed)
    assert ask(sorted_in(f), world, box) == brute(f, world, box)


@settings(max_examples=50, deadline=None)
@given(seed=st.integers(0, 10_000), box=BOXES)
def test_an_answer_does_not_depend_on_the_batch(seed, box):
    """A world alone, among others, and behind them: the same vehicles in the same order."""
    f = fleet(200, seed)
    among = [v - int(np.argmax(f.world_of == 1)) for v in ask(sorted_in(f), 1, box)]
    own = f.world_of == 1
    alone = SimpleNamespace(n=int(own.sum()), state=f.state[:, own], parameter=f.parameter[:, own], world_of=f.world_of[own] * 0)
    assert ask(sorted_in(alone), 0, box) == among


@pytest.mark.parametrize("far", [1e4, 1e6])
def test_a_box_over_more_cells_than_there_are_buckets(far):
    f = fleet(40, 3)
    box = (0.0, 0.0, 0.3, -far, far, -far, far)
    assert ask(sorted_in(f), 2, box) == brute(f, 2, box)


def test_a_map_may_be_large():
    """Cells begin again after 84 000 km only: cars 500 km from the origin are found, and nobody else."""
    f = fleet(60, 5)
    f.state[X] += 500_000.0
    made = sorted_in(f)
    box = (500_000.0, 0.0, 0.0, -150.0, 150.0, -150.0, 150.0)
    assert ask(made, 1, box) == brute(f, 1, box) != []
    assert ask(made, 1, (0.0, *box[1:])) == []


def test_where_the_rear_is():
    """Behind the centre of gravity by what is left of the length."""
    f = fleet(50, 1)
    places, back = sorted_in(f).places, f.parameter[LENGTH] - f.parameter[FRONT]
    assert places[[AT_X, AT_Y]].tobytes() == f.state[[X, Y]].tobytes()
    np.testing.assert_allclose(places[REAR_X], f.state[X] - back * np.cos(f.state[PSI]), atol=1e-12)
    np.testing.assert_allclose(places[REAR_Y], f.state[Y] - back * np.sin(f.state[PSI]), atol=1e-12)


def test_how_far_one_has_moved():
    f = fleet(50, 2)
    made = sorted_in(f)
    f.state[[X, Y], 7] += [3.0, 4.0]
    assert neighbour.moved(f.state, made.places) == pytest.approx(5.0)


@settings(max_examples=100, deadline=None)
@given(n=st.integers(1, 120), seed=st.integers(0, 10_000))
def test_a_queue_is_in_the_order_of_stations(n, seed):
    """Everybody stands in the queue of each strand under his body, and there only; in order, whoever has the lower number by lot first."""
    random = np.random.default_rng(seed)
    f, mind, worlds, strands = fleet(n, seed), np.zeros((len(MIND), n)), random.integers(0, 3, n), 5
    mind[STATION], f.state[V_X] = np.round(random.uniform(0.0, 290.0, n)), 0.0
    enter = np.tile(np.arange(strands) * 60.0, n)
    drive = np.array([enter, enter + 60.0, np.zeros(enter.size), np.full(enter.size, 60.0)])
    web = bare_web(drive, np.tile(np.arange(strands), n), strands)
    made, entity = queue.queues(n), random.permutation(n)
    queue.sort(
        f.state, f.parameter, mind, worlds, entity, np.arange(n) * strands, np.full(n, strands), *np.zeros((2, n), np.int64), web,
        made.first, made.place, made.at, made.wanted, made.wanted_at, made.there, made.count,
    )  # fmt: skip
    nose = mind[STATION] + f.parameter[FRONT]
    tail = nose - f.parameter[LENGTH]
    for world, strand in product(range(3), range(strands)):
        key, low = world * strands + strand, strand * 60.0
        there = [v for v in range(n) if worlds[v] == world and f.state[ACTIVE, v] > 0.0 and nose[v] >= low and tail[v] < low + 60.0]
        place, end = queue.from_station(key, -np.inf, made.first, made.place, made.at)
        found = [int(v) for number, v in made.place[[0, 1], place:end].T if number == key]
        assert found == sorted(there, key=lambda v: (mind[STATION, v], entity[v]))
        assert made.at[place : place + len(found)] == pytest.approx(mind[STATION, found] - low)


def bare_web(drive, strand, count):
    """Strands on which nobody meets others."""
    none = np.zeros(0, np.int64)
    by_strand = np.zeros(count), np.zeros(count, np.int64), np.zeros(count + 1, np.int64)
    by_meeting = none, np.zeros((4, 0)), none, none, np.zeros((1, 0)), np.zeros(0)
    return Web(drive, strand, np.full(count, -1), *by_strand, *by_meeting)
