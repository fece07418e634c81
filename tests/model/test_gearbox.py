"""The gearbox's control unit: its schedule, and what it refuses."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.model import gearbox
from studio.model.gearbox import WALKING

UP, DOWN, TOP, LIMIT = 300.0, 150.0, 5, 600.0


def test_a_pressed_pedal_shifts_later():
    assert [gearbox.threshold(200.0, 500.0, pedal) for pedal in (0.0, 0.5, 1.0)] == [200.0, 350.0, 500.0]


def test_the_schedule_goes_one_gear_at_a_time_within_the_gears():
    assert gearbox.automatic(3, TOP, UP + 1, UP, DOWN) == 4
    assert gearbox.automatic(3, TOP, DOWN - 1, UP, DOWN) == 2
    assert gearbox.automatic(TOP, TOP, UP + 1, UP, DOWN) == TOP
    assert gearbox.automatic(1, TOP, 0.0, UP, DOWN) == 1


@given(st.floats(DOWN, UP), st.integers(1, TOP))
def test_between_the_curves_the_gear_is_kept(w_in, gear):
    assert gearbox.automatic(gear, TOP, w_in, UP, DOWN) == gear


def test_a_pedal_counts_at_once_and_is_forgotten_slowly():
    """dd/dt = -d²/CALMING: d = d_0/(1 + d_0 t/CALMING), exact but for the steps."""
    assert gearbox.kept(0.2, 0.7, 0.02) == 0.7
    pedal = 1.0
    for _ in range(round(gearbox.CALMING / 0.02)):
        pedal = gearbox.kept(pedal, 0.0, 0.02)
    assert pedal == pytest.approx(0.5, rel=0.01)
    assert 0.92 < gearbox.kept(0.5, 0.2, 1.0) / 0.5 < 1.0  # a swing of some seconds hardly counts


@given(st.floats(0, 1), st.floats(0.4, 1))
def test_the_next_gear_needs_more_pedal_for_the_same(pedal, fall):
    """u (2 - u) is what the pedal counts; where full pedal is not enough it is full."""
    after = gearbox.pedal_after(pedal, fall)
    assert pedal - 1e-12 <= after <= 1.0
    assert after * (2.0 - after) * fall == pytest.approx(min(pedal * (2.0 - pedal), fall), abs=1e-9)


def permitted(wanted, gear, v=0.0, *, w_wanted=100.0, w_present=100.0):
    return gearbox.permitted(wanted, gear, TOP, v, w_wanted, w_present, LIMIT)


def test_a_request_is_bounded_by_the_gears_there_are():
    assert permitted(9, 4, 20.0) == TOP
    assert permitted(-3, 0) == -1


def test_no_request_over_revs_the_engine():
    assert permitted(1, 4, 30.0, w_wanted=LIMIT + 1) == 4
    assert permitted(1, 4, 30.0, w_wanted=LIMIT - 1) == 1
    assert permitted(5, 4, 60.0, w_wanted=LIMIT + 1, w_present=LIMIT + 200) == 5  # up is always better then


@pytest.mark.parametrize("speed", [2.0 * WALKING, -2.0 * WALKING])
def test_nobody_shifts_between_forward_and_reverse_while_driving(speed):
    assert permitted(-1, 2, speed) == 2
    assert permitted(1, -1, speed) == -1
    assert permitted(0, 2, speed) == 0  # neutral always
    assert permitted(-1, 1, 0.5 * WALKING) == -1


def can_hold(a, a_drive, *, time=0.8, w_out=50.0, pedal=0.5):
    """A shift to a gear of 0.7 of the ratio; with wheels of 0.3 m it is left below 150 rad/s."""
    return gearbox.can_hold(a, a_drive, 0.7, time, w_out, 4.0, 0.3, 150.0, pedal)


def test_a_higher_gear_must_hold_what_the_lower_one_does():
    """On the level 0.7 of the drive still holds; on a hill that takes all of it the next gear would lose speed."""
    assert can_hold(1.5, 1.6) and not can_hold(0.2, 1.5)
    assert can_hold(0.0, 1.5, pedal=0.0)  # nobody asks for power


def test_a_shift_that_takes_too_long_is_not_begun():
    """Without drive a heavy car on a hill would fall below the shift down: 4 (50 - 2.6 t/0.3) < 150 from t = 1.44 s on."""
    assert can_hold(2.0, 4.6, time=1.4) and not can_hold(2.0, 4.6, time=1.5)


def test_an_automated_clutch_closes_when_somebody_wants_to_go_or_the_car_drags_the_engine():
    idle = 80.0
    assert gearbox.clutch_closes(0.0, 0.2, idle, False)
    assert gearbox.clutch_closes(2.0 * idle, 0.0, idle, False)
    assert not gearbox.clutch_closes(1.2 * idle, 0.0, idle, False)  # it rolls out with the clutch open
    assert gearbox.clutch_closes(1.2 * idle, 0.0, idle, True) and not gearbox.clutch_closes(0.9 * idle, 0.0, idle, True)


def test_the_lock_up_closes_where_nothing_is_multiplied_and_has_a_hysteresis():
    w_lock_up, ratio = 200.0, 0.88
    assert gearbox.lock_up_closes(210.0, 220.0, w_lock_up, ratio, False)
    assert not gearbox.lock_up_closes(190.0, 200.0, w_lock_up, ratio, False)
    assert not gearbox.lock_up_closes(210.0, 300.0, w_lock_up, ratio, False)  # it multiplies still
    assert gearbox.lock_up_closes(190.0, 300.0, w_lock_up, ratio, True)
    assert not gearbox.lock_up_closes(170.0, 170.0, w_lock_up, ratio, True)


def test_a_clutch_needs_a_tick_at_least():
    assert gearbox.rate(0.5, 0.02) == 2.0
    assert gearbox.rate(0.0, 0.02) == 50.0
