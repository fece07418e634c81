"""The short form: forty cars for two minutes at four of the places; and a ring to which more cars come than it takes."""

import pytest

from studio.road.network.signals import CYCLE
from tests.rush.outcome import outcome


@pytest.mark.parametrize("place", ["Großer Stern", "grid", "on the left", "motorway"])
def test_nobody_strikes_anybody_or_breaks_a_rule(place):
    found = outcome(place, cars=40, minutes=2, seed=1)
    assert not found.wrong, found
    assert found.measures["arrivals"] or place == "motorway"


def test_a_ring_does_not_take_less_because_more_come():
    """At the Großer Stern more arrive when three times as many come; on a ring that is filled up fewer do. While there is room, who has
    come over the line of a light goes on: nobody stands for more than two cycles of the lights."""
    few, many = (outcome("Großer Stern", cars, minutes=7, seed=1).measures for cars in (80, 240))
    assert many["arrivals"] > few["arrivals"]
    assert few["longest_wait"] < 2 * CYCLE
