"""Metrics on constructed records, where the answer is known."""

import numpy as np
import pytest

from studio.assess import compare
from studio.assess.following import time_to_collision
from studio.assess.goal import unmet
from studio.assess.measure import measure_all
from studio.assess.metric import Measured
from studio.execution.happening import happening
from studio.execution.record import Body, Chain, Record
from studio.scenario.schema import Goal
from studio.world.channel import CHANNELS
from studio.world.table.event import ARRIVED, HIT

NAMES = [channel.name for channel in CHANNELS]


def record(vehicles=("a", "b"), n=501, chains=(), happenings=(), **channels):
    """A record of 10 s with constant or given channels; the gap is not a number unless given."""
    values = np.zeros((len(NAMES), len(vehicles), n))
    values[NAMES.index("gap")], values[NAMES.index("ahead")] = np.nan, -1.0
    for name, value in channels.items():
        values[NAMES.index(name)] = value
    bodies, called = dict.fromkeys(vehicles, Body(4.5, 1.8, 2.2, 1500.0, 0.3)), dict(enumerate(vehicles))
    return Record(np.linspace(0, 10, n), values, vehicles, happenings, chains, bodies=bodies, called=called)


def test_ttc_of_the_textbook():
    """s = 30 m, 25 against 15 m/s: 3 s. Not closing: infinite. Nobody ahead: not a number."""
    found = time_to_collision(np.array([30.0, 30.0, np.nan]), np.array([25.0, 15.0, 15.0]), np.array([15.0, 25.0, 0.0]))
    assert found[0] == 3.0 and found[1] == np.inf and np.isnan(found[2])


def test_least_values():
    gap = np.full((2, 501), np.nan)
    gap[1] = np.linspace(40, 20, 501)
    found = measure_all(record(gap=gap, speed=20.0, ahead_speed=18.0))
    assert found["min_gap"].value == pytest.approx(20)
    assert found["min_ttc"].value == pytest.approx(10)
    assert found["min_time_gap"].value == pytest.approx(1)
    assert found["mean_gap"].value == pytest.approx(30)


def test_what_cannot_be_measured_is_empty():
    found = measure_all(record(("alone",)))
    assert found["min_ttc"].value is None and found["min_gap"].value is None and found["platoon_gain"].value is None
    assert found["collisions"].value == 0


def test_an_empty_record():
    empty = Record(np.zeros(0), np.zeros((len(NAMES), 1, 0)), ("a",), ())
    assert all(each.value is None for each in measure_all(empty).values())


def test_gains_of_a_chain():
    """Accelerations of amplitude 2, 1, 3: gains 0.5 and 3, together 1.5."""
    wave = np.sin(np.linspace(0, 20, 501))
    chain = Chain("platoon", "cacc", ("a", "b", "c"))
    found = measure_all(record(("a", "b", "c"), chains=(chain,), acceleration=np.array([2 * wave, wave, 3 * wave])))
    assert found["worst_hop_gain"].value == pytest.approx(3)
    assert found["platoon_gain"].value == pytest.approx(1.5)


def test_no_disturbance_no_gain():
    chain = Chain("platoon", "cacc", ("a", "b"))
    assert measure_all(record(chains=(chain,), acceleration=0.0))["worst_hop_gain"].value is None


def test_jerk_of_a_ramp():
    ramp = np.tile(np.linspace(0, 10, 501) * 0.7, (2, 1))
    assert measure_all(record(acceleration=ramp))["jerk_rms"].value == pytest.approx(0.7)


def test_collisions_are_counted():
    events = (happening(HIT, 1.0, ("a", "b"), impact_speed=3.0), happening(ARRIVED, 2.0, ("a",)))
    assert measure_all(record(happenings=events))["collisions"].value == 1


def test_goals():
    metrics = {"min_ttc": Measured(1.2, "s", "higher"), "collisions": Measured(0.0, "1", "lower"), "min_gap": Measured(None, "m", "higher")}
    told = unmet({"min_ttc": Goal(least=1.5), "collisions": Goal(most=0), "min_gap": Goal(least=1)}, metrics)
    assert len(told) == 2 and "1.2 s" in told[0] and "1.5" in told[0] and "could not be measured" in told[1]


@pytest.mark.parametrize(
    ("a", "b", "goal", "better"),
    [
        (1.0, 2.0, "higher", "b"),
        (1.0, 2.0, "lower", "a"),
        (2.0, 2.0, "lower", "same"),
        (1.0, 2.0, None, None),
        (0.0, 0.0, "higher", "same"),
        (100.0, 100.25, "higher", "same"),  # chance
        (100.0, 102.0, "higher", "b"),
        (-30.0, -30.1, "higher", "same"),
        (0.0, 3e-17, "lower", "same"),  # rounding
        (1e-6, 7e-6, "lower", "same"),  # m: nobody measures that
        (0.0, 0.002, "lower", "a"),
    ],
)
def test_better(a, b, goal, better):
    assert compare.better(a, b, goal) == better


def test_a_share_of_what_nobody_could_measure_is_none():
    none, some = (compare.metric("x", Measured(a, "m", "lower"), Measured(0.5, "m", "lower")) for a in (1e-6, 0.25))
    assert (none.difference, none.relative, none.better) == (pytest.approx(0.5, abs=1e-5), None, "a")
    assert (some.difference, some.relative, some.better) == (0.25, 1.0, "a")


def test_a_metric_on_one_side_only():
    found = compare.metrics({"x": Measured(1.0, "s", "lower")}, {"x": Measured(None, "s", "lower"), "y": Measured(2.0, "m", None)})
    assert [(each.name, each.a, each.b, each.better) for each in found] == [("x", 1.0, None, None), ("y", None, 2.0, None)]


def test_the_script_does_not_count_against_the_followers():
    """A leader that brakes by script with 6 m/s², followers with 2 m/s²: the followers' figures count."""
    acceleration = np.zeros((3, 501))
    acceleration[0, 200:300], acceleration[1:, 210:300] = -6.0, -2.0
    gap = np.array([np.full(501, 800.0), np.full(501, 10.0), np.full(501, 12.0)])
    chain = Chain("platoon", "cacc", ("a", "b", "c"))
    found = measure_all(record(("a", "b", "c"), chains=(chain,), acceleration=acceleration, gap=gap, speed=10.0))
    assert found["max_deceleration"].value == pytest.approx(2.0)
    assert found["mean_gap"].value == pytest.approx(11.0)


def test_creeping_up_is_no_danger():
    """Closing with 1 mm/s on a car 800 m ahead is no time to collision."""
    found = measure_all(record(gap=800.0, speed=10.001, ahead_speed=10.0))
    assert found["min_ttc"].value is None
