"""Reservation: every interleaving of small decks, counted; no deadlock where it grants, and everybody arrives."""

import pytest

from studio.garage.reservation import grants, is_free


def reached(ways, start, may):
    """All states that can be reached from one."""
    seen, left = {start}, [start]
    while left:
        state = left.pop()
        for car in range(len(ways)):
            if may(ways, state, car):
                after = tuple(place + (i == car) for i, place in enumerate(state))
                left += [after] if after not in seen else []
                seen.add(after)
    return seen


def doomed(ways, states):
    """Those from which not everybody can arrive any more."""
    ends = tuple(len(way) for way in ways)
    return {state for state in states if ends not in reached(ways, state, is_free)}


def stuck(ways, states):
    """Those in which nobody can go on, and somebody has not arrived."""
    ends = tuple(len(way) for way in ways)
    return {state for state in states if state != ends and not any(is_free(ways, state, car) for car in range(len(ways)))}


def way(*tiles):
    return [frozenset([tile]) for tile in tiles]


def ring(cars):
    """Four tiles in a circle; each car drives three of them."""
    return [way(*((i + k) % 4 for k in range(3))) for i in range(cars)]


LANE = [way(0, 1, 2), way(2, 1, 0)]
# reachable, doomed and stuck states by O14 of the checks
CASES = [(ring(3), 97, 0, 0), (ring(4), 375, 1, 1), (LANE, 19, 3, 2), ([LANE[0], LANE[0], LANE[1], LANE[1]], 224, 64, 32)]


@pytest.mark.parametrize(("ways", "states", "lost", "stand"), CASES)
def test_it_never_comes_into_a_doomed_state(ways, states, lost, stand):
    start = (-1,) * len(ways)
    free = reached(ways, start, is_free)
    assert (len(free), len(doomed(ways, free)), len(stuck(ways, free))) == (states, lost, stand)
    granted = reached(ways, start, grants)
    assert not granted & doomed(ways, free)
    ends = tuple(len(each) for each in ways)
    assert all(state == ends or any(grants(ways, state, car) for car in range(len(ways))) for state in granted), "somebody can always go on"


def test_four_cars_in_a_circle_the_fourth_is_refused():
    """Each holds a tile and wants the next one: the fourth tile is not given, and all arrive one after the other."""
    ways = [way(i, (i + 1) % 4) for i in range(4)]
    state = (0, 0, 0, -1)
    assert is_free(ways, state, 3) and not grants(ways, state, 3)
    for car in (2, 1, 0):
        while state[car] < 2:
            assert grants(ways, state, car)
            state = tuple(place + (i == car) for i, place in enumerate(state))
    assert grants(ways, state, 3)


def test_opposing_cars_in_a_single_lane():
    """One waits before it until the other is through."""
    state = (0, -1)
    assert not grants(LANE, state, 1)
    assert grants(LANE, (3, -1), 1)
