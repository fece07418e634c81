"""The clock of a run against a real time that the tests set."""

from math import inf

import pytest

from studio.execution.loop import LONGEST_DEBT, Pace


class Watch:
    """Real time [s], which goes on when it is told to."""

    def __init__(self):
        self.time = 1000.0

    def __call__(self):
        return self.time


@pytest.fixture
def watch():
    return Watch()


@pytest.mark.parametrize("factor", [0.1, 0.5, 1.0, 2.0, 8.0])
def test_a_tick_waits_for_its_real_time(watch, factor):
    """The k-th tick of 20 ms is due k 0.02/factor after the start, whatever the ones before have taken of it."""
    pace = Pace(factor, clock=watch)
    for k in range(1, 200):
        watch.time += pace.wait(0.02 * k)
        assert pace.wait(0.02 * k) == pytest.approx(0.0, abs=1e-9)
        assert watch.time - 1000.0 == pytest.approx(0.02 * k / factor, abs=1e-9)
        watch.time += (k % 3) * 0.005 / factor  # what the tick itself takes


def test_a_small_debt_is_made_up(watch):
    """A tick that took long is followed by ticks without a wait, until the real time is reached again."""
    pace = Pace(2.0, clock=watch)
    watch.time += 0.8 * LONGEST_DEBT  # 0.2 s, in which 20 ticks were due
    assert all(pace.wait(0.02 * k) == 0.0 for k in range(1, 20))
    assert pace.wait(0.02 * 20) == pytest.approx(0.0, abs=1e-9)
    assert pace.wait(0.02 * 21) == pytest.approx(0.01)


def test_a_large_debt_is_forgiven(watch):
    """A machine that is too slow runs as fast as it can, and does not race when it gets faster."""
    pace = Pace(2.0, clock=watch)
    watch.time += 10.0
    assert pace.wait(0.02) == 0.0
    assert pace.wait(0.04) == pytest.approx(0.01)


def test_a_pause_is_no_debt(watch):
    pace = Pace(1.0, clock=watch)
    watch.time += 0.2
    pace.restart(5.0)
    assert pace.wait(5.02) == pytest.approx(0.02)


def test_as_fast_as_possible_never_waits(watch):
    assert Pace(inf, clock=watch).wait(1e6) == 0.0
