"""Ways into spaces: every space of the drawn deck, what is driven, and what is kept clear."""

from math import hypot

import numpy as np
import pytest
import shapely

from studio.garage import plan, way
from studio.garage.plan import SIXTY, Plan, Pose
from studio.garage.way import CLEARANCE, Car

COMPACT = Car(2.765, 4.261, 1.809, 0.84, 4.6)
SMALL = Car(1.81, 2.5, 1.52, 0.35, 4.0)


OTHER = Plan(3, 4, 5.2, 2.6, 6.5)  # 48 spaces, wider, in shorter rows


@pytest.mark.parametrize(("deck", "car"), [(SIXTY, COMPACT), (SIXTY, SMALL), (OTHER, COMPACT)], ids=["compact", "small", "other deck"])
def test_every_space_is_reached_and_nothing_comes_near(deck, car):
    for number in range(deck.spaces):
        found, goal = way.into(deck, number, car), way.goal(deck, number, car)
        assert hypot(found.x[-1] - goal.x, found.y[-1] - goal.y) < 1e-6
        around = plan.full(deck, number)
        outlines = [
            plan.box(Pose(*each), car.wheelbase + car.front, car.rear, car.width)
            for each in zip(found.x[::8], found.y[::8], found.heading[::8], strict=True)
        ]
        assert float(shapely.distance(np.array(outlines), around).min()) >= CLEARANCE - 0.03


def test_the_rear_axle_moves_along_the_heading():
    """No point jumps, and the way turns by its curvature."""
    found = way.into(SIXTY, 7, COMPACT)
    dx, dy, ds = np.diff(found.x), np.diff(found.y), np.diff(found.driven)
    g, psi = found.direction[1:], found.heading[:-1] + 0.5 * np.diff(found.heading)
    moved = ds > 1e-6
    assert np.allclose((g * (dx * np.cos(psi) + dy * np.sin(psi)))[moved], ds[moved], atol=1e-6)
    assert np.abs(found.bend).max() <= 1.0 / COMPACT.radius + 1e-9


def test_out_is_in_the_other_way_round():
    there, back = way.into(SIXTY, 20, COMPACT), way.out_of(SIXTY, 20, COMPACT)
    assert (back.x[0], back.y[0]) == pytest.approx((there.x[-1], there.y[-1]))
    assert back.x[-1] == pytest.approx(-SIXTY.gate - 4.0) and back.y[-1] == pytest.approx(SIXTY.radius)
    assert np.all(np.diff(back.station[back.direction > 0][200:]) > 0.0), "one way"


def test_a_car_that_turns_too_wide_is_refused():
    with pytest.raises(ValueError, match="does not get into space 0"):
        way.turning_in(SIXTY, 0, Car(3.2, 4.8, 1.9, 0.9, 8.0))


@pytest.mark.parametrize(("steer", "inner", "outer"), [(25.0, 4.890, 7.597), (30.0, 3.777, 6.638), (35.0, 2.956, 5.965)])
def test_swept_width(steer, inner, outer):
    """Wheelbase 2.7, overhang 0.9, width 1.8 m: inner side and outer front corner [m] from the centre (O13)."""
    r = 2.7 / np.tan(np.radians(steer))
    outline = plan.box(Pose(0.0, 0.0, 0.0), 3.6, 0.9, 1.8)
    centre = shapely.Point(0.0, r)
    assert outline.distance(centre) == pytest.approx(inner, abs=1e-3)
    assert max(centre.distance(shapely.Point(corner)) for corner in outline.exterior.coords) == pytest.approx(outer, abs=1e-3)
