"""What counts of vehicles that collide: nothing from then on, and no gap is left."""

import numpy as np
import pytest

from studio.assess.assessment import assessed
from studio.assess.goal import Ends, unmet
from studio.assess.intact import intact
from studio.assess.measure import measure_all
from studio.execution.happening import happening
from studio.scenario.schema import Scenario
from studio.world.table.event import HIT
from tests.assess.drive import record

TIME = np.linspace(0.0, 10.0, 501)
HIT_AT = 5.0  # [s]


def crashed(*, order=("a", "b")):
    """b comes nearer to a, whom it hits; then it is driven through a, which has b ahead from there on, and brakes as nobody asked it to."""
    a, b = order.index("a"), order.index("b")
    gap, ahead, acceleration = np.full((2, TIME.size), np.nan), np.full((2, TIME.size), -1.0), np.zeros((2, TIME.size))
    before = TIME < HIT_AT
    gap[b, before], ahead[b, before] = 50.0 - 10.0 * TIME[before] + 0.2, float(a)
    gap[a, ~before], ahead[a, ~before] = 0.1 + 10.0 * (TIME[~before] - HIT_AT), float(b)
    acceleration[b, before], acceleration[a, TIME > HIT_AT + 0.5] = -3.0, -8.0
    hit = happening(HIT, HIT_AT, ("a", "b"), impact_speed=10.0)
    found = record(TIME, order, gap=gap, ahead=ahead, acceleration=acceleration, speed=20.0, ahead_speed=10.0)
    return type(found)(found.time, found.values, found.vehicles, (hit,), bodies=found.bodies, called=found.called)


@pytest.mark.parametrize("order", [("a", "b"), ("b", "a")])
def test_no_gap_is_left_where_bodies_have_touched(order):
    """Whatever was measured after the cars were driven through each other, and whoever stands first in the file."""
    found = measure_all(crashed(order=order))
    gap = found["min_gap"]
    assert (gap.value, gap.time, gap.subject, gap.about) == (0.0, HIT_AT, ("b", "a"), "b behind a at 5.00 s")
    assert unmet({"min_gap": Ends(least=0.1)}, found) == ["min_gap is 0 m (b behind a at 5.00 s), at least 0.1 is wanted"]
    assert found["max_deceleration"].value == pytest.approx(3.0) and found["max_deceleration"].subject == ("b",)
    assert found["collisions"].value == 1.0 and found["max_impact_speed"].value == 10.0


def test_who_was_hit_is_in_no_danger_any_more():
    made = assessed(crashed(), Scenario.model_construct(measures={}, goals={})).record
    assert not [each for each in made.happenings if each.kind == "hard_brake"]
    assert np.nanmin(made.channel("acceleration")) == -8.0  # what was recorded stays in the record


def test_others_drive_on():
    """Somebody who is not hit counts to the end, and a run without a collision is the same record."""
    third = record(TIME, ("a", "b", "c"), speed=np.array([[10.0], [20.0], [30.0]]))
    hit = type(third)(third.time, third.values, third.vehicles, (happening(HIT, HIT_AT, ("a", "cone"), impact_speed=5.0),))
    left = np.isfinite(intact(hit).channel("speed")).sum(axis=-1)
    assert left.tolist() == [250, 501, 501] and intact(third) is third


def test_a_follower_is_who_has_somebody_ahead():
    """Where no application makes a chain, the one in front is not measured as a follower, however hard it brakes."""
    gap = np.full((2, TIME.size), np.nan)
    gap[1] = 30.0
    made = record(TIME, gap=gap, acceleration=np.array([[-6.0], [-4.0]]))
    assert made.followers == ["b"] and measure_all(made)["max_deceleration"].value == 4.0
    assert record(TIME).followers == ["a", "b"]  # nobody follows: all count
