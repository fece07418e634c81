"""Arrival times solve their equation; gaps are accepted as the critical gap says."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.model.passage import PATIENT, arrival, is_enough, saved, wanted_gap


@given(d=st.floats(0.1, 500), v=st.floats(0.1, 60), a=st.floats(0, 5))
def test_arrival_solves_its_equation(d, v, a):
    t = arrival(d, v, a)
    assert v * t + 0.5 * a * t * t == pytest.approx(d, rel=1e-9)


def test_who_is_there_has_arrived_and_who_stands_never_does():
    assert arrival(0.0, 10.0, 1.0) == arrival(-3.0, 0.0, 0.0) == 0.0
    assert arrival(10.0, 0.0, 0.0) > 1e4


def test_from_rest_the_critical_gap_decides():
    """6.2 s: a lag of 6.19 s is too short, 6.2 s is enough; who rolls with 5 m/s over 16 m saves √(2·16/1.4) - 2.45 s."""
    assert not is_enough(6.19, 6.2, 16.0, 0.0, 1.4) and is_enough(6.2, 6.2, 16.0, 0.0, 1.4)
    rolling = (2 * 16 / 1.4) ** 0.5 - arrival(16.0, 5.0, 1.4)
    assert saved(16.0, 5.0, 1.4) == pytest.approx(rolling) and 2.0 < rolling < 3.0
    assert is_enough(6.21 - rolling, 6.2, 16.0, 5.0, 1.4) and not is_enough(6.19 - rolling, 6.2, 16.0, 5.0, 1.4)


def test_who_has_waited_for_long_takes_half_the_gap():
    assert [wanted_gap(6.0, t) for t in (0.0, PATIENT, 1.5 * PATIENT, 2 * PATIENT, 900.0)] == pytest.approx([6.0, 6.0, 4.5, 3.0, 3.0])
