"""Reservation: every interleaving of small decks, counted; no deadlock where it grants, and everybody arrives."""

from itertools import product

import pytest

from studio.garage.reservation import grants, is_free, is_safe


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
    assert granted == free - doomed(ways, free), "what need not be refused is granted"
    ends = tuple(len(each) for each in ways)
    assert all(state == ends or any(grants(ways, state, car) for car in range(len(ways))) for state in granted), "somebody can always go on"


def together(ways, state):
    """All states that one step of any of the cars at once leads to: a tile that is left in a step is free in the next one."""
    held = [way[place] if 0 <= place < len(way) else frozenset() for way, place in zip(ways, state, strict=True)]
    for moves in product((0, 1), repeat=len(ways)):
        wanted = [ways[i][state[i] + 1] if state[i] + 1 < len(ways[i]) else frozenset() for i, moved in enumerate(moves) if moved]
        others = [held[j] for i, moved in enumerate(moves) if moved for j in range(len(ways)) if j != i]
        may = all(state[i] < len(ways[i]) for i, moved in enumerate(moves) if moved) and len(frozenset().union(*wanted)) == sum(
            map(len, wanted)
        )
        if may and not any(tiles & other for tiles, other in pairs(wanted, others, len(ways) - 1)):
            yield tuple(place + moved for place, moved in zip(state, moves, strict=True))


def pairs(wanted, others, each):
    """Every tile that is wanted with what each of the others holds."""
    return [(tiles, others[k * each + j]) for k, tiles in enumerate(wanted) for j in range(each)]


def least_steps(ways, may=lambda ways, state: True):
    """The fewest steps in which all can arrive through states that may be, by search."""
    seen = now = {(-1,) * len(ways)}
    count, ends = 0, tuple(len(way) for way in ways)
    while ends not in now:
        now = {after for state in now for after in together(ways, state) if may(ways, after)} - seen
        seen, count = seen | now, count + 1
    return count


def steps(ways):
    """Steps that it takes when every car that is granted a step makes it, the first one first."""
    places, count = [-1] * len(ways), 0
    while any(place < len(way) for place, way in zip(places, ways, strict=True)):
        before = list(places)
        for car, way in enumerate(ways):
            left = {tile for i, old in enumerate(before) if i != car and 0 <= old < len(ways[i]) for tile in ways[i][old]}
            wanted = way[places[car] + 1] if places[car] + 1 < len(way) else frozenset()
            places[car] += not wanted & left and grants(ways, tuple(places), car)
        count += 1
    return count


@pytest.mark.parametrize(("ways", "least", "eager"), [(ring(3), 7, 8), (ring(4), 7, 11), (LANE, 8, 8), (CASES[3][0], 12, 12)])
def test_how_many_steps_it_takes(ways, least, eager):
    """O14: nothing that is granted takes more than is possible; cars that always drive when they may need more, in a circle."""
    assert least_steps(ways) == least_steps(ways, is_safe) == least and steps(ways) == eager


def test_what_would_take_too_long_to_find_is_refused(monkeypatch):
    """With three states to look at, from every state that was granted somebody can still go on, and all arrive."""
    monkeypatch.setattr("studio.garage.reservation.SEARCHED", 3)
    ways = ring(4)
    granted, ends = reached(ways, (-1,) * 4, grants), (3,) * 4
    assert 100 < len(granted) < 374 and ends in granted
    assert all(state == ends or any(grants(ways, state, car) for car in range(4)) for state in granted)


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
