"""Platoons that are not alone: a stranger cuts in, a car joins, one leaves, a red light splits them; cars of several models."""

import numpy as np
import pytest

from studio import job
from studio.execution.loop import as_fast_as_possible
from studio.execution.simulation import simulation

HEADWAY, R = 0.6, 2.5  # [s], [m] of cacc


def driven(path):
    """The record of a scenario."""
    running = simulation(job.prepare(job.load(path)))
    as_fast_as_possible(running)
    assert running.cases[0].status == "done", running.cases[0].error
    return running.record(0)


@pytest.fixture(scope="module")
def company(root):
    return driven(root / "scenarios" / "platoon_company.yaml")


@pytest.fixture(scope="module")
def light(root):
    return driven(root / "scenarios" / "platoon_red_light.yaml")


@pytest.mark.parametrize("name", ["platoon_company", "platoon_red_light"])
def test_the_samples_meet_their_goals(root, name):
    outcome = job.run(job.load(root / "scenarios" / f"{name}.yaml"))
    assert outcome.status == "done" and not outcome.unmet, outcome.unmet


def linked(record, name, begin, end):
    """Share of a time [s] in which a car takes what it hears for that of the car ahead."""
    at = (record.time > begin) & (record.time < end)
    return float(np.mean(record.probes[f"{name}.platoon.linked"].values[at]))


def gap(record, name, ahead, time):
    """Between two cars [m], as the crow flies: stations of two lanes differ in a bend, and the channel `gap` goes by the car's route."""
    k = int(np.argmin(np.abs(record.time - time)))
    (x, y), (to_x, to_y) = ([record.trace(f"{each}.{axis}")[k] for axis in ("x", "y")] for each in (name, ahead))
    front, rear = record.bodies[name].front, record.bodies[ahead].length - record.bodies[ahead].front
    return float(np.hypot(to_x - x, to_y - y)) - front - rear


def law(record, name, time):
    """The gap that the law wants [m]."""
    k = int(np.argmin(np.abs(record.time - time)))
    return R + HEADWAY * float(record.trace(f"{name}.speed")[k])


def test_a_stranger_who_cuts_in_is_given_room_and_nothing_of_those_beyond_counts(company):
    """Linked before; not while he is there; closed up again after he has gone."""
    assert linked(company, "third", 5.0, 9.0) == 1.0
    assert linked(company, "third", 15.0, 34.0) < 0.05
    assert gap(company, "third", "stranger", 33.0) > law(company, "third", 33.0) + 5.0, "without a link the headway is longer"
    assert linked(company, "third", 50.0, 79.0) == 1.0
    assert gap(company, "third", "second", 75.0) == pytest.approx(law(company, "third", 75.0), abs=1.0)


def test_a_newcomer_joins_behind_the_last(company):
    assert abs(company.trace("newcomer.lateral_offset")[-1] + 3.75) < 0.2
    assert linked(company, "newcomer", 60.0, 78.0) == 1.0
    assert gap(company, "newcomer", "fifth", 75.0) == pytest.approx(law(company, "newcomer", 75.0), abs=1.5)


def test_one_leaves_and_the_next_hears_the_one_before(company):
    """The fifth listens to both; once the fourth is beside, it is the third that it follows, and its request is fed forward."""
    assert abs(company.trace("fourth.lateral_offset")[-1] - 3.75) < 0.2
    assert linked(company, "fifth", 95.0, 119.0) == 1.0
    assert gap(company, "fifth", "third", 118.0) == pytest.approx(law(company, "fifth", 118.0), abs=1.0)


def test_a_red_light_splits_and_the_rest_closes_up(light):
    """Three are through; the others stand, 100 m and more behind; at the end they stand behind the third again."""
    at = (light.time > 28.0) & (light.time < 38.0)
    assert np.all(light.trace("third.speed")[at] > 5.0) and np.all(light.trace("fourth.speed")[at] < 0.3)
    assert gap(light, "fourth", "third", 38.0) > 80.0
    assert 0.5 < gap(light, "fourth", "third", 89.0) < 4.0 and 0.5 < gap(light, "fifth", "fourth", 89.0) < 4.0
