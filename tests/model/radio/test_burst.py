"""Losses by themselves and in bursts: ages, gaps and runs that follow, against closed forms; 4e6 messages each."""

import numpy as np
import pytest

from studio.compiled import compiled
from studio.model.radio import arrival, burst
from studio.model.random import uniform, uniforms

N = 4_000_000
T, L = 0.1, 0.02  # [s] period and latency


@compiled
def independent(p, n, lost):
    """Which of n messages are lost, each by itself."""
    for k in range(n):
        lost[k] = arrival.is_lost(50.0, 100.0, p, 0.0, uniform(11, 5, 1, k))


@compiled
def bursty(to_bad, to_good, loss_good, loss_bad, n, lost):
    """Which of n messages are lost on a link that is good or bad."""
    for k in range(n):
        bad = burst.is_bad(11, 5, 2, k, to_bad, to_good)
        lost[k] = uniform(11, 5, 3, k) < (loss_bad if bad else loss_good)


def losses(loop, *given):
    """Of N messages."""
    lost = np.zeros(N, dtype=bool)
    loop(*given, N, lost)
    return lost


def gaps(lost):
    """Times [s] between messages that arrive."""
    return T * np.diff(np.flatnonzero(~lost))


def in_a_row(lost, k):
    """The share of messages with which k in a row are lost."""
    sums = np.convolve(lost, np.ones(k), mode="valid")
    return np.mean(sums > k - 0.5)


def mean_run(lost):
    """The mean length of runs of losses."""
    return lost.sum() / np.count_nonzero(np.diff(lost.astype(int)) == 1)


def mean_age(lost):
    """That of continuous time: it grows from the latency on with every gap."""
    gap = gaps(lost)
    return L + (gap**2).sum() / (2.0 * gap.sum())


def older(lost, age):
    """The share of time in which what was heard is older."""
    gap = gaps(lost)
    return np.maximum(L + gap - max(age, L), 0.0).sum() / gap.sum()


@pytest.mark.parametrize(
    ("p", "age", "peak", "shares"),
    [
        (0.0, 0.07, 0.12, (0.0, 0.0, 0.0)),
        (0.1, 0.08111, 0.13111, (0.073, 0.001, 0.00001)),
        (0.3, 0.11286, 0.16286, (0.237, 0.027, 0.00243)),
        (0.6, 0.22, 0.27, (0.528, 0.216, 0.07776)),
    ],
)
def test_ages_with_losses_by_themselves(p, age, peak, shares):
    """Means within 2 %; shares older than 0.15, 0.32 and 0.52 s within 2 % and half of the last digit told, the rarest within a third."""
    lost = losses(independent, p)
    assert mean_age(lost) == pytest.approx(age, rel=0.02)
    assert L + gaps(lost).mean() == pytest.approx(peak, rel=0.02)
    for limit, share, digit in zip((0.15, 0.32, 0.52), shares, (5e-4, 5e-4, 3e-6), strict=True):
        assert older(lost, limit) == pytest.approx(share, rel=0.02, abs=digit)


def test_a_fifth_lost_at_ten_a_second():
    """Age 75 ms and latency, from one to the next 125 ms, three in a row 0.008: within 3 %."""
    lost = losses(independent, 0.2)
    assert mean_age(lost) - L == pytest.approx(0.075, rel=0.03)
    assert gaps(lost).mean() == pytest.approx(0.125, rel=0.03)
    assert in_a_row(lost, 3) == pytest.approx(0.008, rel=0.03)


def test_gilbert_and_elliott_with_losses_in_both_states():
    """0.05 to bad, 0.25 to good, loss 0.01 and 0.6: within 2 %, ten in a row (about 300 of 4e6, in clusters) within a third."""
    lost = losses(bursty, 0.05, 0.25, 0.01, 0.6)
    assert lost.mean() == pytest.approx(0.10833, rel=0.02)
    assert mean_run(lost) == pytest.approx(1.7263, rel=0.02)
    assert gaps(lost).mean() == pytest.approx(0.11215, rel=0.02)
    assert mean_age(lost) == pytest.approx(0.08912, rel=0.02)
    assert [in_a_row(lost, k) for k in (2, 3)] == pytest.approx([0.045579, 0.020489], rel=0.02)
    assert in_a_row(lost, 5) == pytest.approx(0.004152, rel=0.04)
    assert in_a_row(lost, 10) == pytest.approx(0.000077, rel=0.33)


def test_gilbert_where_bad_loses_all():
    """0.02 to bad, 0.2 to good: within 2 %."""
    lost = losses(bursty, 0.02, 0.2, 0.0, 1.0)
    assert lost.mean() == pytest.approx(0.09091, rel=0.02)
    assert mean_run(lost) == pytest.approx(5.0, rel=0.02)
    assert gaps(lost).mean() == pytest.approx(0.110, rel=0.02)
    assert mean_age(lost) == pytest.approx(0.11545, rel=0.02)
    assert [in_a_row(lost, k) for k in (2, 3, 5, 10)] == pytest.approx([0.072727, 0.058182, 0.037236, 0.012202], rel=0.03)


def test_states_do_not_depend_on_who_asks_first():
    forwards = [burst.is_bad(1, 2, 3, k, 0.05, 0.1) for k in range(500)]
    backwards = [burst.is_bad(1, 2, 3, k, 0.05, 0.1) for k in reversed(range(500))]
    assert forwards == backwards[::-1] and 10 < sum(forwards) < 400


@pytest.mark.parametrize(("to_bad", "to_good"), [(0.05, 0.2), (0.9, 0.7), (0.3, 0.7), (0.0, 0.5), (1.0, 0.0)])
def test_each_state_follows_the_one_before_by_its_own_draw(to_bad, to_good):
    """The chain itself, step by step from a state that was looked up; also one that rather turns, and those that never change."""
    before = burst.is_bad(4, 2, 3, 0, to_bad, to_good)
    for k in range(1, 300):
        now = uniforms(4, 2, 3, (burst.FIRST + k) // 4)[k % 4] < (1.0 - to_good if before else to_bad)
        assert burst.is_bad(4, 2, 3, k, to_bad, to_good) == now
        before = now


def test_a_chain_by_its_loss_and_run():
    for loss, run in ((0.3, 5.0), (0.01, 2.0), (0.8, 12.0)):
        to_bad, to_good = burst.of_loss(loss, run)
        assert to_bad / (to_bad + to_good) == pytest.approx(loss) and 1.0 / to_good == pytest.approx(run)
    to_bad, to_good = burst.of_loss(0.3, 1.0)
    assert to_bad == pytest.approx(0.3) and to_bad + to_good == pytest.approx(1.0)  # as by themselves
    assert burst.of_loss(1.0, 5.0) == (1.0, 0.0)


def test_a_chain_by_its_times():
    to_bad, to_good = burst.of_times(7.0, 3.0, 0.1)
    assert to_bad / (to_bad + to_good) == pytest.approx(0.3) and 0.1 / to_good == pytest.approx(3.0)
    assert burst.of_times(1.0, 0.0, 0.1) == (0.0, 1.0) and burst.of_times(0.0, 1.0, 0.1) == (1.0, 0.0)
