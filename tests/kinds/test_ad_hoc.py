"""The ad hoc radio: Table 3 in closed form, losses by themselves and in runs, presets."""

import numpy as np
import pytest
from pydantic import ValidationError

from studio import job
from studio.compiled import compiled
from studio.errors import ScenarioError
from studio.kinds.radio import ad_hoc
from studio.model.radio import propagation
from studio.workshop import draw
from studio.world.table.cause import BUILDING, BURST, CHANCE, RECEIVED
from studio.world.view import Draw, Way, chances

N = 200_000


@compiled
def send(settings, way, causes, delays):
    """Messages 0, 1, ... of one link."""
    for k in range(causes.size):
        found = ad_hoc.transmit(settings, way, Draw(1, 2, 3, 4000, k, 0))
        causes[k], delays[k] = found.lost, found.delay


def way(distance, walls=0.0, inside=0.0):
    """Of a message of 350 bytes."""
    return Way(distance, walls, inside, 350.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.5, distance, 0.0, 1.5, 0.0, 0.0, 0.0)


def heard(distance, n=N, **changes):
    """Causes and delays [s] of n messages over a distance."""
    causes, delays = np.zeros(n, dtype=np.int8), np.zeros(n)
    send(settings(**changes), way(distance), causes, delays)
    return causes, delays


def settings(**changes):
    """As compiled code gets them."""
    return draw.settings_tuple(ad_hoc, ad_hoc.Settings(**changes))


@pytest.mark.parametrize(("distance", "share"), [(0.0, 0.1), (100.0, 0.2), (250.0, 0.35)])
def test_losses_grow_with_the_distance(distance, share):
    """0.1 and 0.001 a metre, each by itself: 2e5 messages, four standard errors, and runs as chance has them."""
    lost = heard(distance, loss=0.1, loss_per_metre=0.001)[0] == CHANCE
    assert lost.mean() == pytest.approx(share, abs=4.0 * (share * (1.0 - share) / N) ** 0.5)
    assert np.mean(lost[1:] & lost[:-1]) == pytest.approx(share**2, abs=4.0 * (share**2 / N) ** 0.5)


def test_losses_in_runs():
    """A fifth lost, five in a row on average: the share within four standard errors of 2e5/13 spells, the run within 4 %."""
    causes = heard(50.0, loss=0.2, loss_run=5.0)[0]
    lost = causes == BURST
    assert set(np.unique(causes)) == {RECEIVED, BURST}
    assert lost.mean() == pytest.approx(0.2, abs=4.0 * 0.2 * (2.0 / 8000.0) ** 0.5)
    assert lost.sum() / np.count_nonzero(lost[1:] & ~lost[:-1]) == pytest.approx(5.0, rel=0.04)


def test_short_runs_are_those_of_chance():
    """Up to 1/(1 - p) nothing changes, bit by bit."""
    plain, short = heard(50.0, 2000, loss=0.5)[0], heard(50.0, 2000, loss=0.5, loss_run=2.0)[0]
    assert np.array_equal(plain, short) and set(np.unique(plain)) == {RECEIVED, CHANCE}


def test_all_is_lost_where_loss_is_1():
    for run in (1.0, 10.0):
        assert (heard(50.0, 100, loss=1.0, loss_run=run)[0] != RECEIVED).all()


def test_delays_have_mean_variation_and_weight_of_the_distance():
    """20 ± 5 ms, 10 µs a metre over 200 m, and 350 bytes at 6 Mbit/s: 2e5 messages, four standard errors."""
    delays = heard(200.0, loss=0.0, delay=0.02, delay_variation=0.005, delay_per_metre=1e-5)[1]
    mean = 0.02 + 0.002 + 2800.0 / 6e6
    assert delays.mean() == pytest.approx(mean, abs=4.0 * 0.01 / 12**0.5 / N**0.5)
    assert mean - 0.005 <= delays.min() < mean - 0.00499 and mean + 0.00499 < delays.max() <= mean + 0.005
    assert delays.max() <= ad_hoc.longest(ad_hoc.Settings(delay_per_metre=1e-5))


def test_what_was_set_before_keeps_its_bits():
    """Losses and delays are those draws that they always were."""
    causes, delays = heard(100.0, 300, loss=0.3, loss_per_metre=0.001)
    draws = [Draw(1, 2, 3, 4000, k, 0) for k in range(300)]
    assert [bool(each) for each in causes] == [chances(each, 0)[0] < 0.3 + 0.001 * 100.0 for each in draws]
    assert delays.tolist() == [max(0.02 + 0.005 * (2.0 * chances(each, 0)[1] - 1.0), 0.0) + 2800.0 / 6e6 for each in draws]


def test_buildings_count_as_distance():
    """26 dB at an exponent of 2 make 20 m to 400 m: beyond the range because of the building."""
    first, far = Draw(1, 2, 3, 4000, 0, 0), propagation.felt_distance(20.0, 26.0, 2.0)
    assert far == pytest.approx(399.1, abs=0.1)
    of = settings(loss=0.0, range=399.0)
    assert ad_hoc.transmit(of, way(20.0, 2.0, 20.0), first).lost == BUILDING
    assert ad_hoc.transmit(of._replace(range=400.0), way(20.0, 2.0, 20.0), first).lost == RECEIVED
    assert ad_hoc.transmit(of._replace(buildings=0.0), way(20.0, 2.0, 20.0), first).lost == RECEIVED


@pytest.mark.parametrize(
    ("name", "mean", "variation"), [("802.11p", 0.004, 0.001), ("LTE", 0.040, 0.015), ("5G", 0.015, 0.005), ("PC5 mode 4", 0.060, 0.040)]
)
def test_presets(sample, name, mean, variation):
    radio = job.load(sample, {"radio.preset": name}).scenario.radio
    assert (radio.kind, radio.delay, radio.delay_variation) == ("ad_hoc", mean, variation)


@pytest.mark.parametrize(
    ("name", "value"),
    [("loss", 1.1), ("loss_run", 0.5), ("delay", -0.01), ("delay_per_metre", -1e-6), ("range", 0.0), ("loss_per_metre", -0.1)],
)
def test_what_is_out_of_range_is_refused_with_its_path(sample, name, value):
    with pytest.raises(ScenarioError) as told:
        job.load(sample, {f"radio.{name}": value})
    assert any("radio" in problem.where and name in problem.where for problem in told.value.problems)
    with pytest.raises(ValidationError):
        ad_hoc.Settings(**{name: value})
