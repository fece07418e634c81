"""The short form: forty cars for two minutes at four of the places; and a ring to which more cars come than it takes."""

import pytest

from tests.rush.outcome import outcome


@pytest.mark.parametrize("place", ["Großer Stern", "grid", "on the left", "motorway"])
def test_nobody_strikes_anybody_or_breaks_a_rule(place):
    found = outcome(place, cars=40, seconds=120, seed=1)
    assert not found.wrong, found
    assert found.measures["arrivals"] or place == "motorway"


def test_a_ring_does_not_take_less_because_more_come():
    """At the Großer Stern as many arrive when three times as many come; on a ring that is filled up fewer do."""
    arrived = [outcome("Großer Stern", cars, seconds=420, seed=1).measures["arrivals"] for cars in (80, 240)]
    assert arrived[1] >= arrived[0]
