"""Ages of information against their closed forms: messages every T, delayed by L, of which some are lost."""

import numpy as np
import pytest

from studio.assess import freshness

T, L, MANY = 0.1, 0.02, 400_000


def stream(lost):
    """When messages were made and came [s]."""
    made = T * np.arange(len(lost))
    return made, np.where(lost, np.inf, made + L)


def independent(p):
    """Losses by chance, seed 11."""
    return stream(np.random.default_rng(11).random(MANY) < p)


def bursty(to_bad, to_good, in_good, in_bad):
    """Losses of a channel that is good or bad (E. N. Gilbert, E. O. Elliott), from the stationary state on; seed 13."""
    draw = np.random.default_rng(13)
    turn, loss, bad, lost = draw.random(MANY), draw.random(MANY), draw.random() < to_bad / (to_bad + to_good), np.empty(MANY, bool)
    for i in range(MANY):
        lost[i] = loss[i] < (in_bad if bad else in_good)
        bad = turn[i] >= to_good if bad else turn[i] < to_bad
    return stream(lost)


@pytest.mark.parametrize(
    ("p", "mean", "peak", "older"),
    [
        (0.0, 0.07, 0.12, (0.0, 0.0, 0.0)),
        (0.1, 0.08111, 0.13111, (0.073, 0.001, 0.00001)),
        (0.3, 0.11286, 0.16286, (0.237, 0.027, 0.00243)),
        (0.6, 0.22, 0.27, (0.528, 0.216, 0.07776)),
    ],
)
def test_ages_with_independent_losses(p, mean, peak, older):
    """400 000 messages: mean age and mean peak within 2 %, shares of time within 2 % or 0.0006."""
    made, came = independent(p)
    assert freshness.mean_age(made, came) == pytest.approx(mean, rel=0.02)
    assert freshness.mean_age(made, came) == pytest.approx(L + T * (1 + p) / (2 * (1 - p)), rel=0.02)
    assert freshness.peaks(made, came).mean() == pytest.approx(peak, rel=0.02)
    for limit, share in zip((0.15, 0.32, 0.52), older, strict=True):
        assert freshness.share_of_time_older(made, came, limit) == pytest.approx(share, rel=0.02, abs=6e-4)


def test_time_between_receptions_and_losses_in_a_row():
    """p = 0.2 at 10 Hz: 0.125 s between receptions, mean age 75 ms + L, three lost in a row 0.008; within 3 %."""
    made, came = independent(0.2)
    assert freshness.inter_reception(came).mean() == pytest.approx(0.125, rel=0.03)
    assert freshness.mean_age(made, came) == pytest.approx(0.075 + L, rel=0.03)
    runs = freshness.runs_of_losses(came)
    assert np.maximum(runs - 2, 0).sum() / MANY == pytest.approx(0.008, rel=0.03)


@pytest.mark.parametrize(
    ("channel", "loss", "run", "between", "age"),
    [((0.05, 0.25, 0.01, 0.6), 0.10833, 1.7263, 0.11215, 0.08912), ((0.02, 0.2, 0.0, 1.0), 0.09091, 5.0, 0.110, 0.11545)],
)
def test_ages_with_losses_in_bursts(channel, loss, run, between, age):
    """400 000 messages over a channel with memory: within 2 %."""
    made, came = bursty(*channel)
    assert np.isinf(came).mean() == pytest.approx(loss, rel=0.02)
    assert freshness.runs_of_losses(came).mean() == pytest.approx(run, rel=0.02)
    assert freshness.inter_reception(came).mean() == pytest.approx(between, rel=0.02)
    assert freshness.mean_age(made, came) == pytest.approx(age, rel=0.02)


def test_what_is_overtaken_is_no_news():
    """The second message comes before the first: the first changes no age."""
    made, came = freshness.newest(np.array([0.0, 1.0, 2.0]), np.array([5.0, 3.0, np.inf]))
    assert (made.tolist(), came.tolist()) == ([1.0], [3.0])


def test_sampled_ages():
    """Two links, the second with a gap: means and shares over what is known."""
    ages = np.array([[0.1, 0.2, 0.3, 0.4], [np.nan, 0.5, 0.7, np.nan]])
    assert freshness.mean(ages) == pytest.approx([0.25, 0.6])
    assert freshness.share_older(ages, 0.25) == pytest.approx([0.5, 1.0])
