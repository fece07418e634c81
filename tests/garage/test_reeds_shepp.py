"""Shortest ways forward and backward: known lengths, symmetries, and a bound around a disc."""

from math import hypot, pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.garage.reeds_shepp import changes, end, length, shortest, words, wrapped

# lengths [m] from two implementations and a search over all words (domain notes, section 3 and O13 of the checks)
KNOWN = [
    (0, 0, pi, 1, pi), (0, 1, 0, 1, 2.63623), (0, 2, 0, 1, 3.64695), (0, 0, pi / 2, 1, pi / 2), (4, 4, pi / 2, 1, 5.81344),
    (10, 5, pi / 2, 5, 5 + 2.5 * pi), (0, 2.5, 0, 5, 9.58192), (-5, 2.5, 0, 5, 7.33548), (6, -6, -pi / 2, 5, 9.26820),
    (8, -5, pi / 2, 4.677, 14.5520), (2, 6, -pi / 2, 4.677, 10.9329), (-6, 3, pi, 3.856, 12.1140), (12, 2.5, 0, 4.677, 12.2730),
]  # fmt: skip
places = st.tuples(st.floats(-8, 8), st.floats(-8, 8), st.floats(-3.1, 3.1))


@pytest.mark.parametrize(("x", "y", "phi", "r", "known"), KNOWN)
def test_known_lengths(x, y, phi, r, known):
    assert r * length(shortest(x, y, phi, r)) == pytest.approx(known, abs=1e-3)


def test_three_changes_where_two_are_longer():
    """(-5, 2.5, 0) with r = 5: R+ .4243 L- 3.2435 R- 3.2435 L+ .4243."""
    word = shortest(-5.0, 2.5, 0.0, 5.0)
    assert changes(word) == 2
    assert sorted(5.0 * abs(piece.length) for piece in word) == pytest.approx([0.4243, 0.4243, 3.2435, 3.2435], abs=1e-3)


@given(places)
def test_every_word_ends_at_the_goal_and_none_is_shorter_than_the_air_line(place):
    x, y, phi = place
    found = list(words(x, y, phi))
    assert found
    for word in found:
        at = end(word)
        assert hypot(at[0] - x, at[1] - y) < 1e-5 and abs(wrapped(at[2] - phi)) < 1e-5
        assert length(word) >= hypot(x, y) - 1e-9


@given(places)
def test_symmetries_leave_the_length(place):
    x, y, phi = place
    lengths = [length(shortest(*each)) for each in ((x, y, phi), (-x, y, -phi), (x, -y, -phi), (-x, -y, phi))]
    assert lengths == pytest.approx([lengths[0]] * 4, abs=1e-6)
