"""The cellular radio: coverage, delay, loss, and a bandwidth whose excess becomes delay."""

import numpy as np
import pytest
from pydantic import ValidationError

from studio import job
from studio.errors import ScenarioError
from studio.kind.number import numbers
from studio.kinds.radio import cellular
from studio.workshop import draw
from studio.world.table.cause import BANDWIDTH, CHANCE, NO_COVERAGE, RECEIVED
from studio.world.view import Draw, Sent, Way

SHAPE = [(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (50.0, 20.0), (0.0, 100.0)]


def settings(**changes):
    """As compiled code gets them."""
    return draw.settings_tuple(cellular, cellular.Settings(**changes))


def sent(of, here, there, k=0, wait=0.0):
    """What becomes of message k from one place to another."""
    (x, y), (x_2, y_2) = here, there
    way = Way(np.hypot(x_2 - x, y_2 - y), 0.0, 0.0, 350.0, 0.0, 0.0, 0.0, x, y, 1.5, x_2, y_2, 1.5, 0.0, 0.0, wait)
    return cellular.transmit(of, way, Draw(1, 2, 3, 4000, k, 0))


def test_everywhere_is_as_far_as_one_likes():
    assert sent(settings(loss=0.0), (0.0, 0.0), (5e5, 5e5)).lost == RECEIVED
    assert cellular.reach(cellular.Settings()) >= 1e6


@pytest.mark.parametrize(
    ("region", "inside", "outside"),
    [
        (
            {"coverage": "circle", "x": 500.0, "y": -200.0, "radius": 100.0},
            [(500.0, -101.0), (599.0, -200.0)],
            [(500.0, -99.0), (0.0, 0.0)],
        ),
        ({"coverage": "polygon", "corners": SHAPE}, [(1.0, 1.0), (95.0, 80.0), (50.0, 19.0)], [(50.0, 21.0), (-1.0, 50.0), (50.0, 99.0)]),
    ],
)
def test_outside_nothing_is_delivered(region, inside, outside):
    """To, from and both ways of every pair of places."""
    of = settings(loss=0.0, **region)
    for here in inside + outside:
        for there in inside + outside:
            covered = here in inside and there in inside
            assert sent(of, here, there).lost == (RECEIVED if covered else NO_COVERAGE)


def test_delay_and_loss():
    """40 ± 15 ms and a tenth lost: 20 000 messages, four standard errors."""
    found = [sent(settings(loss=0.1), (0.0, 0.0), (9.0, 9.0), k) for k in range(20_000)]
    lost, delays = np.array([each.lost == CHANCE for each in found]), np.array([each.delay for each in found])
    assert lost.mean() == pytest.approx(0.1, abs=4.0 * (0.09 / 20_000) ** 0.5)
    assert delays.mean() == pytest.approx(0.04, abs=4.0 * 0.03 / 12**0.5 / 20_000**0.5)
    assert delays.min() >= 0.025 and delays.max() <= 0.055


def admitted(of, rate, size, seconds):
    """The waits [s] of messages that are sent at a steady rate [1/s]."""
    waits, cell = [], cellular.Cell()
    for k in range(round(rate * seconds)):
        wait, cell = cellular.admit(of, Sent(k / rate, 0.0, 0.0, size), cell)
        waits.append(wait)
    return np.array(waits)


def test_what_is_beyond_the_bandwidth_becomes_delay():
    """200 kB/s on 100 kB/s for ten seconds: one second more every second; at 100 kB/s none."""
    of = settings(bandwidth=100e3, longest_wait=30.0)
    waits = admitted(of, 200.0, 1000.0, 10.0)
    assert np.diff(waits) == pytest.approx(0.005, abs=1e-9)
    assert waits[-1] - waits[0] == pytest.approx(10.0, abs=0.01)
    assert admitted(of, 100.0, 1000.0, 10.0) == pytest.approx(0.01, abs=1e-9)
    assert sent(of, (0.0, 0.0), (1.0, 1.0), wait=3.0).delay - sent(of, (0.0, 0.0), (1.0, 1.0)).delay == pytest.approx(3.0)


def test_who_would_wait_too_long_is_thrown_away():
    """At twice the bandwidth and 1 s at most: it fills within a second, then half of what is sent gets through, late."""
    of = settings(bandwidth=100e3, longest_wait=1.0, loss=0.0)
    waits = admitted(of, 200.0, 1000.0, 20.0)
    assert np.mean(waits[1000:] <= 1.0) == pytest.approx(0.5, abs=0.01)
    assert sent(of, (0.0, 0.0), (1.0, 1.0), wait=1.001).lost == BANDWIDTH and sent(of, (0.0, 0.0), (1.0, 1.0), wait=0.999).lost == RECEIVED
    assert sent(of, (0.0, 0.0), (1.0, 1.0), wait=0.999).delay <= cellular.longest(cellular.Settings(longest_wait=1.0))


def test_who_is_not_covered_takes_no_bandwidth():
    of = settings(coverage="circle", radius=10.0)
    wait, cell = cellular.admit(of, Sent(1.0, 100.0, 0.0, 1000.0), cellular.Cell(5e5, 1.0))
    assert (wait, cell) == (0.0, cellular.Cell(5e5, 1.0))


@pytest.mark.parametrize(("name", "delay", "variation"), [("LTE", 0.040, 0.015), ("5G", 0.015, 0.005)])
def test_presets(sample, name, delay, variation):
    radio = job.load(sample, {"radio.kind": "cellular", "radio.preset": name}).scenario.radio
    assert (radio.delay, radio.delay_variation) == (delay, variation)


@pytest.mark.parametrize(
    "values",
    [{"radius": 0.0}, {"bandwidth": 0.0}, {"delay": -0.1}, {"loss": 1.5}, {"longest_wait": -1.0},
     {"coverage": "polygon", "corners": [[0.0, 0.0], [1.0, 1.0]]},
     {"coverage": "polygon", "corners": [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]}],
)  # fmt: skip
def test_what_makes_no_sense_is_refused(sample, values):
    """Out of range, or a region without extent."""
    with pytest.raises(ValidationError):
        cellular.Settings(**values)
    with pytest.raises(ScenarioError) as told:
        job.load(sample, {"radio.kind": "cellular"} | {f"radio.{name}": value for name, value in values.items()})
    assert any("radio" in problem.where for problem in told.value.problems)


def test_corners_are_numbers_for_compiled_code():
    """Sixteen at most; behind the last there is none."""
    given = numbers(cellular.Settings(corners=SHAPE))
    assert given.count(100.0) >= 4 and sum(np.isnan(given)) == 2 * (cellular.CORNERS - len(SHAPE))
