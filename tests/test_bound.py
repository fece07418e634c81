"""Functions with their first arguments given: they do what the function does, on the arrays themselves."""

from typing import NamedTuple

import numpy as np
import pytest

from studio.bound import Chain, Link, bound, laid_out, step
from studio.compiled import compiled, lean


class Pair(NamedTuple):
    """Arrays that belong together."""

    whole: np.ndarray
    flags: np.ndarray


@compiled
def mixed(table, pair, scale, number, k, time):
    """Of every kind of argument something; raises before the start."""
    if time < 0.0:
        raise ValueError("before the start")
    table[1, k] += scale * time
    return table[1, k] + pair.whole[k] + number + (10.0 if pair.flags[k] else 0.0)


@lean
def doubled(values):
    """Gives nothing."""
    for i in range(values.size):
        values[i] *= 2.0


def given():
    """Arguments for `mixed`: a part of an array, whose rows stand apart, is one too."""
    return np.arange(12.0).reshape(3, 4)[:, ::2], Pair(np.array([3, 4]), np.array([True, False])), 0.5, 7


def test_it_is_the_function_on_the_arrays_themselves():
    one, other = given(), given()
    call = bound(mixed, *one, then=(0, 0.0))
    for k, time in ((0, 1.0), (1, 4.0), (1, 2.5)):
        assert call(k, time) == mixed(*other, k, time)
    np.testing.assert_array_equal(one[0], other[0])
    one[0][:] = 0.0
    assert call(0, 2.0) == 1.0 + 3 + 7 + 10.0


def test_what_it_raises_is_raised():
    call = bound(mixed, *given(), then=(0, 0.0))
    with pytest.raises(ValueError, match="before the start"):
        call(0, -1.0)
    assert call(1, 0.0) == 6.0 + 4 + 7


def test_nothing_may_follow_and_nothing_be_given_back():
    values = np.array([1.0, 2.0])
    assert bound(doubled, values)() is None
    assert values.tolist() == [2.0, 4.0]


def test_its_arrays_live_as_long_as_it():
    call = bound(mixed, *given(), then=(0, 0.0))
    others = [np.full((3, 4), -1.0) for _ in range(100)]
    assert call(0, 0.0) == 4.0 + 3 + 7 + 10.0 and len(others) == 100


def test_an_ordinary_function_stays_one():
    assert bound(lambda a, b, c: (a, b, c), 1, 2)(3) == (1, 2, 3)


def test_a_layout_tells_every_word():
    assert [str(each) for each in laid_out("w2r1w1")] == ["int64", "int64", "float64", "int64"] and laid_out("") == []


def test_a_chain_comes_back_for_what_is_told_and_goes_on():
    values, told, (table, pair, scale, number) = np.array([1.0, 2.0]), [], given()
    first, last = (Link(step(doubled, values), lambda what, to: to.append("nothing")) for _ in range(2))
    middle = Link(step(mixed, table, pair, scale, number, takes=("k", "time")), lambda what, to: to.append(what))
    Chain([first, middle, last])(1, 4.0, told)
    assert values.tolist() == [4.0, 8.0] and told == [int(mixed(*given(), 1, 4.0))]
    Chain([first, middle, last])(1, -1.0, told)
    assert values.tolist() == [16.0, 32.0] and isinstance(told[1], ValueError)
