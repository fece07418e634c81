"""Fading and shadowing: the distributions that are claimed, from the draws of a counter."""

from math import exp, lgamma, log10

import numpy as np
import pytest
from scipy import special, stats

from studio.compiled import compiled
from studio.model.radio import fading, normal, shadowing
from studio.model.random import uniform

DRAWS = 100_000
EDGES = np.r_[np.linspace(1e-5, 1.0 - 1e-5, 501), 1e-9, 1.0 - 1e-9]


@compiled
def powers(m, n, seed):
    """n powers over their mean."""
    return [fading.power(m, uniform(seed, 1, 2, k)) for k in range(n)]


def above(m, margin):
    """The share of messages with a power above a threshold that lies `margin` [dB] below the mean, in closed form."""
    return 1.0 - fading.lower(m, m * 10.0 ** (-0.1 * margin), lgamma(m))


def fields(seed, places):
    """The field at places [place, axis], in units of the correlation distance."""
    return fields_from(seed, places, shadowing.Around())


@compiled
def fields_from(seed, places, nothing):
    """The same in a compiled loop, where nothing is known of what is around."""
    return [shadowing.field(seed, 5, places[i, 0], places[i, 1], nothing)[0] for i in range(places.shape[0])]


def shadows(seed, ends, d_cor):
    """The shadow between two places each, [link, x y x y]."""
    f_p, f_q = (np.array(fields(seed, each / d_cor)) for each in (ends[:, :2], ends[:, 2:]))
    return [shadowing.of_both(*each, d_cor) for each in zip(f_p, f_q, np.hypot(*(ends[:, :2] - ends[:, 2:]).T), strict=True)]


def test_quantiles_of_the_normal_distribution():
    found = [normal.quantile(p) for p in EDGES]
    assert found == pytest.approx(stats.norm.ppf(EDGES), abs=2e-8)


@pytest.mark.parametrize("m", [0.5, 0.75, 1.0, 1.5, 3.0, 20.0])
def test_a_power_is_the_quantile_of_its_draw(m):
    """Against scipy's inverse, within 1e-5 of it."""
    found = np.array([fading.power(m, p) for p in EDGES])
    assert found == pytest.approx(special.gammaincinv(m, EDGES) / m, rel=1e-5)


@pytest.mark.parametrize("m", [0.5, 0.75, 1.5, 10.0, 50.0])
def test_a_power_is_between_its_bounds(m):
    """Those of the table, which stand behind something else; narrow where most draws are."""
    table = np.append([0.0, 0.0], fading.quantiles(m))
    least = fading.LEAST_DRAW
    draws = np.r_[least, np.geomspace(least, 1e-3, 200), np.linspace(1e-3, 1.0 - 1e-3, 5001), 1.0 - np.geomspace(1e-3, least, 200)]
    for p in draws:
        low, high = fading.bounds(table, 2, p)
        assert low <= 10.0 * log10(fading.power(m, p)) <= high
        assert high - low < 0.2 or not 0.05 < p < 0.98


@pytest.mark.parametrize("m", [0.5, 0.75, 3.0, 20.0])
def test_shares_below_a_power(m):
    x = np.geomspace(1e-6, 10.0 * m + 20.0, 200)
    assert [fading.lower(m, each, lgamma(m)) for each in x] == pytest.approx(special.gammainc(m, x), abs=1e-13)


@pytest.mark.parametrize(
    ("m", "shares"),
    [(1.0, (0.368, 0.606, 0.778, 0.905)), (1.5, (0.392, 0.681, 0.861, 0.960)), (3.0, (0.423, 0.808, 0.959, 0.996))],
)
def test_shares_above_a_threshold(m, shares):
    """0, 3, 6 and 10 dB below the mean: in closed form to the last digit told, by 1e5 draws within 0.005."""
    drawn = np.array(powers(m, DRAWS, 7))
    for margin, share in zip((0.0, 3.0, 6.0, 10.0), shares, strict=True):
        assert above(m, margin) == pytest.approx(share, abs=5.1e-4)
        assert np.mean(drawn > 10.0 ** (-0.1 * margin)) == pytest.approx(above(m, margin), abs=0.005)


def test_rayleigh_at_the_mean():
    assert above(1.0, 0.0) == pytest.approx(exp(-1.0), abs=1e-14)


@pytest.mark.parametrize("m", [0.75, 1.5])
def test_powers_have_mean_1_and_variance_1_over_m(m):
    """1e5 draws, four standard errors; the fourth moment of Gamma(m, 1/m) gives that of the variance: (6/m + 2)/m²/n."""
    drawn = np.array(powers(m, DRAWS, 3))
    assert drawn.mean() == pytest.approx(1.0, abs=4.0 * (1.0 / m / DRAWS) ** 0.5)
    assert drawn.var() == pytest.approx(1.0 / m, abs=4.0 * ((6.0 / m + 2.0) / m**2 / DRAWS) ** 0.5)


def test_m_changes_with_the_distance():
    assert [fading.m_of(d, 1.5, 0.75, 80.0) for d in (0.0, 79.9, 80.0, 500.0)] == [1.5, 1.5, 0.75, 0.75]


# -- shadows -----------------------------------------------------------------------------------------


def spread_out(n, seed, far=4000.0):
    """Places all over a wide plain, in units of the correlation distance."""
    return np.random.default_rng(seed).uniform(-far, far, (n, 2))


@pytest.mark.parametrize("distance", [0.1, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0])
def test_shadows_are_forgotten_over_distance(distance):
    """Within 0.07 of exp(-distance) in four directions; 40 000 pairs each, whose correlation has a standard error below 0.005."""
    here = spread_out(40_000, 1)
    for angle in (0.0, 25.0, 45.0, 80.0):
        there = here + distance * np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
        both = np.mean(np.array(fields(3, here)) * np.array(fields(3, there)))
        assert both == pytest.approx(exp(-distance), abs=0.07 + 0.015)


def test_the_field_has_mean_0_and_variance_1_and_is_nearly_normal():
    """40 000 places a correlation distance and more apart: four standard errors; shares beyond 1, 2 and 3 as normal within 0.004."""
    f = np.array(fields(4, spread_out(40_000, 2)))
    assert abs(f.mean()) < 4.0 / 200.0 and f.var() == pytest.approx(1.0, abs=4.0 * (2.0 / 40_000) ** 0.5)
    for z in (1.0, 2.0, 3.0):
        assert np.mean(f > z) == pytest.approx(stats.norm.sf(z), abs=0.004 + 4.0 * (stats.norm.sf(z) / 40_000) ** 0.5)


@pytest.mark.parametrize("apart", [1.0, 30.0, 300.0])
def test_a_link_has_variance_1_at_any_distance(apart):
    here = 25.0 * spread_out(40_000, 3)
    s = np.array(shadows(6, np.hstack([here, here + [apart, 0.0]]), 25.0))
    assert s.var() == pytest.approx(1.0, abs=0.06)


def test_a_link_is_the_same_in_both_directions_and_alike_beside_it():
    a, b = spread_out(500, 4), spread_out(500, 5)
    there, back = shadows(1, np.hstack([a, b]), 25.0), shadows(1, np.hstack([b, a]), 25.0)
    assert there == back
    beside = np.array(shadows(1, np.hstack([a, b + [1.0, 1.0]]), 25.0))
    assert np.corrcoef(there, beside)[0, 1] > 0.95
    assert abs(np.corrcoef(there, shadows(2, np.hstack([a, b]), 25.0))[0, 1]) < 4.0 / 500**0.5


def test_bounds_of_a_shadow():
    """Whatever the distance is, and whoever is darker."""
    for f_p, f_q in ((1.0, 2.0), (-1.5, 0.2), (-1.0, -1.0), (0.5, -0.5)):
        low, high = shadowing.bounds(f_p, f_q)
        assert all(low - 1e-15 <= shadowing.of_both(f_p, f_q, d, 25.0) <= high + 1e-15 for d in (0.0, 1.0, 25.0, 900.0, 1e4))


def test_the_field_has_no_edges():
    """Across the borders of cells it changes by as little as within them."""
    line = np.stack([np.arange(-20.0, 20.0, 1e-3), np.full(40_000, 0.3)], axis=1)
    assert np.abs(np.diff(fields(9, line))).max() < 0.02


def test_what_is_known_of_the_surroundings_changes_no_bit():
    """A walk through cells of both sizes, with the corners that were around before and without."""
    walk = np.cumsum(np.random.default_rng(8).normal(0.1, 0.3, (500, 2)), axis=0)
    around, kept = shadowing.Around(), []
    for x, y in walk:
        f, around = shadowing.field(9, 5, x, y, around)
        kept.append(f)
    assert kept == fields(9, walk)
