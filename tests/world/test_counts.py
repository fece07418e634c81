"""Counts at places of the road: the demand that meets them is the most likely one, and what cannot be met is refused."""

from dataclasses import replace

import numpy as np
import pytest

from studio import job
from studio.errors import StudioError
from studio.execution.event import foreseen
from studio.execution.simulation import simulation
from studio.world.demand.count import balanced
from tests.conftest import ROOT

HOUR = 3600.0


def prepared(name="urban_grid", seconds=600.0, **traffic):
    """A sample with other traffic."""
    loaded = job.load(ROOT / "scenarios" / f"{name}.yaml", {"clock.duration": seconds})
    document = loaded.scenario.model_dump(mode="json", exclude_unset=True)
    document |= {"traffic": traffic, "script": {}, "goals": {}, "measures": {}}
    return job.prepare(replace(loaded, scenario=type(loaded.scenario).model_validate(document)))


def due(setting, name=""):
    """When cars of a stream, or of all, are due."""
    return np.sort(np.concatenate([each.due for each in setting.sources if each.stream.startswith(name)]))


def flow(rate=600, **more):
    """A flow on the only route of the motorway."""
    return {"route": "eastbound", "rate": rate, "headways": "even", **more}


def test_one_count_scales_what_leads_over_its_road():
    """And tells what it did."""
    setting = prepared("motorway_platoon", 600, flows={"f": flow()}, counts={"bridge": {"road": "motorway", "rate": 900}})
    assert due(setting).size == 150
    assert np.diff(due(setting)) == pytest.approx(HOUR / 900)
    (told,) = [each for each in foreseen(setting) if each.kind == "counted"]
    assert told.numbers["rate"].value == 900 and told.numbers["brought"].value == 600
    assert told.words == {"count": "bridge", "road": "motorway"}


def test_a_count_holds_for_its_time():
    """Before and after it the flow is as it was; chance is the same by the clock of the flow."""
    count = {"bridge": {"road": "motorway", "rate": 1800, "begin": 200, "end": 400}}
    setting = prepared("motorway_platoon", 600, flows={"f": flow()}, counts=count)
    assert [int(np.sum((due(setting) >= t) & (due(setting) < t + 200))) for t in (0, 200, 400)] == pytest.approx([33, 100, 33], abs=1)
    usual = prepared("motorway_platoon", 600, flows={"f": flow(headways="random")})
    other = prepared("motorway_platoon", 600, flows={"f": flow(headways="random")}, counts=count)
    early = due(usual)[due(usual) < 200]
    assert due(other)[: early.size] == pytest.approx(early)


def test_a_count_of_nobody_closes_a_flow():
    assert prepared("motorway_platoon", 60, flows={"f": flow()}, counts={"b": {"road": "motorway", "rate": 0}}).sources[0].due.size == 0


def test_the_counted_cars_come_in():
    running = simulation(prepared("motorway_platoon", 40, flows={"f": flow()}, counts={"b": {"road": "motorway", "rate": 1800}}))
    while not running.is_over:
        running.advance(500)
    assert running.world.demand.gone.sum() == 20  # one every two seconds, where the flow alone would bring one every six


def test_the_demand_is_the_most_likely_one():
    """Of all that meet the counts, none has less information against what was asked for (Van Zuylen, Willumsen, 1980)."""
    a = np.array([[1.0, 0.0, 1.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]])
    asked, c = np.array([300.0, 200.0, 500.0, 100.0, 50.0]), np.array([800.0, 900.0, 700.0])
    factors, found = balanced(a, asked, np.zeros(5), c)
    q = factors * asked
    assert found == pytest.approx(c, rel=1e-6) and q @ a == pytest.approx(c, rel=1e-6)

    def information(q):
        return np.sum(q * (np.log(q / asked) - 1.0))

    beside = np.linalg.svd(a.T)[2][3:]  # by which demands that meet the counts differ
    assert beside @ a == pytest.approx(0.0, abs=1e-9)
    for way in beside:
        assert information(q + way) > information(q) and information(q - way) > information(q)


def test_two_turns_become_as_many_as_were_counted_behind_the_junction():
    """Trips from one road to two others; the counts there fix both, that before the junction would be their sum."""
    town = prepared()
    from studio.road.ways.route import arms

    entries, exits = arms(town.network)
    own = entries[0].partition("#")[0].lstrip("-")
    left, right = [each for each in exits if each.partition("#")[0].lstrip("-") != own][:2]
    trips = [{"origin": entries[0], "destination": to, "rate": 100} for to in (left, right)]
    counts = {"left": {"road": left, "rate": 300}, "right": {"road": right, "rate": 60}}
    setting = prepared(matrices={"m": {"trips": trips, "headways": "even"}}, counts=counts)
    assert [due(setting, f"m: {entries[0]} to {to}").size for to in (left, right)] == [50, 10]
    consistent = {"before": {"road": entries[0], "rate": 360}, "left": counts["left"]}
    setting = prepared(matrices={"m": {"trips": trips, "headways": "even"}}, counts=consistent)
    assert [due(setting, f"m: {entries[0]} to {to}").size for to in (left, right)] == [50, 10]
    with pytest.raises(StudioError, match=r"traffic\.counts\.(before|left)\.rate: cannot be met"):
        prepared(matrices={"m": {"trips": trips}}, counts=consistent | {"right": {"road": right, "rate": 200}})


@pytest.mark.parametrize(
    ("counts", "said"),
    [
        ({"b": {"road": "motorwy", "rate": 9}}, r"traffic\.counts\.b\.road: is not a road of this map.*did you mean 'motorway'"),
        ({"b": {"road": "motorway", "rate": 9, "begin": 60}}, r"traffic\.counts\.b\.begin: is after the end of the run"),
        ({"b": {"road": "motorway", "rate": 9, "begin": 30, "end": 20}}, "must end"),
        ({"b": {"road": "motorway", "rate": -1}}, "greater than or equal to 0|at least 0|≥ 0"),
        ({"b": {"road": "motorway", "rate": 900, "begin": 40}}, r"counts\.b\.rate: is on a road that no flow and no trip leads over.*40 s"),
    ],
)  # fmt: skip
def test_counts_that_cannot_be_are_refused(counts, said):
    with pytest.raises((StudioError, ValueError), match=said):
        prepared("motorway_platoon", 60, flows={"f": flow(end=40)}, counts=counts)
