"""Whether a change of lanes is worth it: MOBIL with the Intelligent Driver Model, against calculated values; and how it is driven."""

import pytest

from studio.model.driver import following_acceleration
from studio.model.lane_change import DURATION, SHORTEST, gone_over, incentive, left_over

LENGTH, SAFE, THRESHOLD = 4.5, 4.0, 0.1


def idm(speed, gap, ahead):
    """Acceleration [m/s²] of a driver who wants 120 km/h."""
    return following_acceleration(speed, 120 / 3.6, gap, speed - ahead, 2.0, 1.0, 1.0, 1.5)


def changes(own, here, there, behind, old):
    """Accelerations now and then, of oneself, the new and the old follower; each of the others is a gap [m] and a speed [m/s]."""
    (gap, ahead), (new_gap, new_ahead), (its_gap, its_speed), (old_gap, old_speed) = here, there, behind, old
    return (
        idm(own, gap, ahead), idm(own, new_gap, new_ahead),
        idm(its_speed, its_gap + LENGTH + new_gap, new_ahead), idm(its_speed, its_gap, own),
        idm(old_speed, old_gap, own), idm(old_speed, old_gap + LENGTH + gap, ahead),
    )  # fmt: skip


SLOWER_AHEAD = changes(27.0, (40, 22.0), (60, 30.0), (35, 29.0), (40, 27.0))
HARDLY_WORTH_IT = changes(25.0, (45, 24.0), (70, 26.0), (32, 27.0), (60, 25.0))


def test_the_accelerations_are_those_of_the_law():
    assert pytest.approx((-3.8524, 0.5684, 0.3900, -2.0135, 0.0439, -0.4213), abs=1e-3) == SLOWER_AHEAD


@pytest.mark.parametrize(("politeness", "expected"), [(0.0, 4.4208), (0.5, 2.9864), (1.0, 1.5521)])
def test_a_slower_car_ahead_is_passed_whatever_the_politeness(politeness, expected):
    assert incentive(*SLOWER_AHEAD, politeness) == pytest.approx(expected, abs=1e-3) and expected > THRESHOLD
    assert SLOWER_AHEAD[3] > -SAFE


@pytest.mark.parametrize(("politeness", "expected"), [(0.0, 0.6260), (0.3, -0.0688), (1.0, -1.6902)])
def test_for_a_small_gain_the_selfish_only_changes(politeness, expected):
    assert incentive(*HARDLY_WORTH_IT, politeness) == pytest.approx(expected, abs=1e-3)
    assert (expected > THRESHOLD) == (politeness == 0.0)


def test_nobody_is_cut_off():
    braking = changes(27.0, (40, 22.0), (60, 30.0), (22, 33.0), (40, 27.0))[3]
    assert braking == pytest.approx(-27.68, abs=1e-2) and braking < -SAFE


@pytest.mark.parametrize("speed", [30.0, 10.0, 1.0])
def test_going_over_takes_its_time_or_its_length(speed):
    share, driven, tick = 0.0, 0.0, 0.02
    while share < 1.0:
        share, driven = gone_over(share, speed, tick), driven + speed * tick
    assert driven == pytest.approx(max(speed * DURATION, SHORTEST), abs=2 * speed * tick)
    assert (left_over(0.0), left_over(0.5), left_over(1.0)) == pytest.approx((1.0, 0.5, 0.0))
    assert gone_over(0.3, 0.0, tick) == gone_over(0.3, -1.0, tick) == 0.3
