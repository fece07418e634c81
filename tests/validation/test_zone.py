"""Data zones: exact quantiles, the interval by hand, and that it covers as often as it says."""

import numpy as np
import pytest
from scipy import stats

from studio.validation.zone import quantile, zone

EXACT = {6: (2.0150, 2.5706), 10: (1.8331, 2.2622), 11: (1.8125, 2.2281), 21: (1.7247, 2.0860)}  # tables of Student's distribution


@pytest.mark.parametrize("n", EXACT)
def test_quantiles_are_those_of_the_tables(n):
    assert quantile(n, "one-sided") == pytest.approx(EXACT[n][0], abs=5e-5)
    assert quantile(n) == pytest.approx(EXACT[n][1], abs=5e-5)


def test_the_interval_by_hand():
    """1, 2, 3: mean 2, s 1, T(2) = 4.3027."""
    found = zone([1.0, 2.0, 3.0])
    assert (found.mean, found.high) == pytest.approx((2.0, 2.0 + 4.302653 / np.sqrt(3)))


def test_where_a_run_says_nothing_the_others_count():
    gap = zone(np.array([[1.0, 1.0], [2.0, np.nan], [3.0, 3.0]]))
    assert gap.count.tolist() == [3, 2] and gap.mean.tolist() == [2.0, 2.0]
    assert gap.high[1] == pytest.approx(2.0 + 12.7062 * np.sqrt(2) / np.sqrt(2), abs=1e-3)


def test_one_run_has_no_interval():
    alone = zone([[1.0, 2.0]])
    assert alone.mean.tolist() == [1.0, 2.0] and np.isnan(alone.low).all() and not alone.holds(np.array([1.0, 2.0])).any()


@pytest.mark.parametrize(("confidence", "share"), [("two-sided", 0.95), ("one-sided", 0.90)])
@pytest.mark.parametrize("n", [6, 11, 21])
def test_it_covers_as_often_as_it_says(n, confidence, share):
    """20 000 repetitions of n runs: the count of covered means lies within the 99.99 % bounds of the binomial distribution."""
    runs = np.random.default_rng(n).normal(3.0, 2.0, (n, 20_000))
    covered = int(zone(runs, confidence).holds(np.full(20_000, 3.0)).sum())
    low, high = stats.binom.interval(0.9999, 20_000, share)
    assert low <= covered <= high
