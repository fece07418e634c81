"""The short form: what is measured on roads is found in our traffic too, as far as it is; and the table tells what is not."""

import numpy as np
import pytest

from tests.likeness.measure import AT, WARM, Passage, car_speed, headways, most_frequent, motorway, shares
from tests.likeness.published import PUBLISHED
from tests.likeness.table import is_like, markdown


def test_what_is_made_of_passages():
    """By hand: two lanes, on which cars come every 2 s and every 4 s with 20 and 30 m/s."""
    time, lane = np.array([0.0, 2, 4, 6, 1, 5, 9, 13]), np.array([0.0] * 4 + [1] * 4)
    of = Passage(time, lane, np.where(lane > 0, 30.0, 20.0), np.array([1.0, 0, 0, 0, 1, 0, 0, 0]))
    assert sorted(headways(of)) == [2, 2, 2, 4, 4, 4]
    assert shares(of).tolist() == [0.5, 0.5, 0.0]
    assert car_speed(of) == pytest.approx(90.0)
    assert most_frequent(np.array([1.25, 1.3, 1.35, 3.1])) == pytest.approx(1.3)


def test_the_table_tells_what_is_within_and_what_is_not():
    found = {name: known.least - 1.0 if np.isfinite(known.least) else known.most - 1.0 for name, known in PUBLISHED.items()}
    rows = markdown(found).splitlines()[2:]
    assert [("| yes |" in row) for row in rows] == [is_like(found[name], known) for name, known in PUBLISHED.items()]
    assert sum("| no |" in row for row in rows) == sum(np.isfinite(known.least) for known in PUBLISHED.values())


def test_lanes_are_used_as_on_a_motorway():
    """With more traffic less of it on the lane at the kerb and more at the median (Duret, Ahn, Buisson 2012); cars drive hardly slower
    than the limit of 130 km/h; nobody is nearer than his wanted headway has him."""
    little, dense = (motorway(rate, WARM + 60.0, seed=1) for rate in (1500.0, 5100.0))
    assert little.time.size * 60 == pytest.approx(1500, rel=0.25) and dense.time.size * 60 == pytest.approx(5100, rel=0.25)
    assert little.time.min() > WARM and AT / 36.1 < WARM
    assert shares(little)[0] > shares(dense)[0] + 0.1 and shares(little)[2] + 0.1 < shares(dense)[2]
    assert 115.0 < car_speed(little) < 130.0  # [km/h]
    assert car_speed(dense) < car_speed(little)
    assert 1.2 < most_frequent(headways(dense)) < 2.2
