"""A channel in a few numbers, against what can be said in closed form."""

import numpy as np
import pytest

from studio.assess.aggregate import MEANINGS, aggregates


def of(time, values, moment=None):
    """By kind."""
    return {each.kind: each for each in aggregates(np.asarray(time, float), np.asarray(values, float), moment)}


def test_a_straight_line_has_its_quantiles_on_it():
    """Of x = 3 + 2 t from 0 to 10 s each quantile p is 3 + 20 p, the mean that of the ends."""
    time = np.linspace(0, 10, 101)
    found = of(time, 3 + 2 * time)
    assert [found[each].value for each in ("min", "p5", "mean", "p95", "max")] == pytest.approx([3, 4, 13, 22, 23])
    assert (found["min"].time, found["max"].time) == (0, 10)


def test_a_sine_over_whole_periods_has_no_mean_and_its_quantiles():
    """A phase that is spread evenly has the distribution 1/2 + arcsin(x)/π: the quantile p is sin(π (p - 1/2))."""
    phase = np.arange(200_000) / 200_000 * 2 * np.pi
    found = of(phase, np.sin(phase))
    assert found["mean"].value == pytest.approx(0, abs=1e-12)
    assert found["p95"].value == pytest.approx(np.sin(0.45 * np.pi), abs=1e-4)
    assert found["p5"].value == pytest.approx(-np.sin(0.45 * np.pi), abs=1e-4)


def test_the_order_of_samples_is_of_no_account_but_for_times():
    values = np.random.default_rng(1).normal(size=200)
    forward, back = of(range(200), values), of(range(200), values[::-1])
    for each in ("min", "max", "p5", "p95"):
        assert forward[each].value == back[each].value
    assert forward["min"].time == 199 - back["min"].time


def test_what_is_no_number_does_not_count():
    found = of([0, 1, 2, 3], [np.nan, 4, np.inf, 6])
    assert (found["min"].value, found["mean"].value, found["max"].value) == (4, 5, 6)
    assert all(each.value is None for each in of([0, 1], [np.nan, np.nan], 0.5).values())


def test_at_a_moment_counts_what_was_there_already():
    assert of([0, 1, 2], [5, 6, 7], 1.9)["at_event"][1:] == (6, 1)
    assert of([0, 1, 2], [5, 6, 7], 1.0)["at_event"][1:] == (6, 1)
    assert of([0, 0.1, 0.1 + 0.2], [5, 6, 7], 0.3)["at_event"].value == 7  # the same time within the bits of a sum
    assert of([1, 2], [5, 6], 0.5)["at_event"].value is None
    assert of([0, 1], [5, np.nan], 1.5)["at_event"].value is None  # no older value is taken for it
    assert of([0, 1], [5, 6])["at_event"].value is None


def test_each_says_how_it_is_made():
    assert [each.kind for each in aggregates(np.zeros(1), np.zeros(1))] == list(MEANINGS)
    assert [each.kind for each in aggregates(np.zeros(0), np.zeros(0))] == list(MEANINGS)
