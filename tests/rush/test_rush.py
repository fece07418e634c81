"""The short form: forty cars for two minutes at four of the places."""

import pytest

from tests.rush.outcome import outcome


@pytest.mark.parametrize("place", ["Großer Stern", "grid", "on the left", "motorway"])
def test_nobody_strikes_anybody_or_breaks_a_rule(place):
    found = outcome(place, cars=40, seconds=120, seed=1)
    assert not found.wrong, found
    assert found.measures["arrivals"] or place == "motorway"
