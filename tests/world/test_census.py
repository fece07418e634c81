"""What is counted of everybody: right of way, red lights, waits, deadlocks, arrivals, lanes left, and who comes in from outside."""

from dataclasses import replace

import numpy as np
import pytest
import yaml

from studio import job
from studio.assess.measure import measure_all
from studio.errors import StudioError
from studio.execution.simulation import simulation
from studio.model.driver import NO_LIMIT
from studio.road import load
from studio.vehicle.parameter import PARAMETER
from studio.vehicle.state import ACTIVE, V_X, VEHICLE
from studio.world.passes import census
from studio.world.passes.census import (
    C_KIND,
    C_VALUE,
    C_WHO,
    CENSUS,
    EVERY,
    MOST,
    P_BRAKED,
    P_COMES,
    P_LEAVES,
    P_OTHER,
    PAIR,
    RING,
)
from studio.world.table.mind import FOLLOWING, MIND, MINDED, YIELDING
from tests.conftest import ROOT
from tests.road.conftest import Draft
from tests.road.test_priority import BERLIN, arms_of, crossing

MAJOR = {"west": "secondary", "east": "secondary"}


def measured(folder, ways, starts, script, seconds=20.0):
    """The measures of cars on a crossing whose street from west to east goes first."""
    network = load(crossing(Draft(), BERLIN, classes=MAJOR).write(folder / "cross.osm"))
    roads = {arms_of(network, c): [network.lanes[c.from_lane].road, network.lanes[c.to_lane].road] for c in network.connections}
    names = ["first", "second"][: len(ways)]
    scenario = {
        "version": 3, "title": "Crossing", "map": {"file": "cross.osm"}, "clock": {"duration": seconds}, "script": script,
        "routes": {name: {"roads": roads[way]} for name, way in zip(names, ways, strict=True)},
        "vehicles": {
            name: {"route": name, "position": {"along": start}, "speed": 8} for name, start in zip(names, starts, strict=True)
        },
    }  # fmt: skip
    (folder / "cross.yaml").write_text(yaml.safe_dump(scenario), encoding="utf-8")
    return metrics(job.prepare(job.load(folder / "cross.yaml")))


def metrics(setting):
    """All measures of a run to its end."""
    running = simulation(setting)
    while not running.is_over:
        running.advance(250)
    return measure_all(running.record(), None, pytest.fail)


def keep(speed, **when):
    """A script that has the first car keep a speed whatever its driver wants."""
    return {"keep": {**when, "do": {"kind": "hold", "vehicle": "first", "speed": speed, "duration": 15}}}


MEET = [("south", "north"), ("west", "east")]


def test_who_takes_the_right_of_way_violates_it(tmp_path):
    """A car of the side street that does not slow down has the other brake hard; both are named, and when."""
    found = measured(tmp_path, MEET, [60, 30], keep(8.0))
    assert found["conflicts"].value == found["right_of_way_violations"].value == 1
    assert found["right_of_way_violations"].subject == ("first", "second")
    assert found["right_of_way_violations"].time == pytest.approx(6.5, abs=1.0)  # some 52 m at 8 m/s


def test_who_waits_violates_nothing(tmp_path):
    found = measured(tmp_path, MEET, [60, 30], {})
    assert found["conflicts"].value == found["right_of_way_violations"].value == found["collisions"].value == 0


def test_who_goes_with_room_is_in_a_conflict_and_violates_nothing(tmp_path):
    """The other starts 20 m farther back: he is on his way there, and need not brake."""
    found = measured(tmp_path, MEET, [60, 10], keep(8.0))
    assert (found["conflicts"].value, found["right_of_way_violations"].value) == (1, 0)


def test_a_wait_is_as_long_as_it_was(tmp_path):
    """Held at rest from 1 s on for 15 s, and braking takes a while: a wait of 11 to 15 s, told when it is over."""
    found = measured(tmp_path, [("west", "east")], [20], keep(0.0, when={"kind": "time", "at": 1.0}), seconds=25.0)
    assert 10.0 < found["longest_wait"].value < 15.0
    assert found["longest_wait"].subject == ("first",)
    assert found["longest_wait"].time == pytest.approx(17.0, abs=2.0)


def test_a_wait_that_goes_on_at_the_end_counts(tmp_path):
    found = measured(tmp_path, [("west", "east")], [20], keep(0.0, when={"kind": "time", "at": 1.0}), seconds=12.0)
    assert 5.0 < found["longest_wait"].value < 11.0
    assert found["longest_wait"].time == 12.0


def test_who_is_steered_off_leaves_the_road(tmp_path):
    """To the right at 8 m/s: the centre of gravity comes over the kerb within seconds, once."""
    script = {"off": {"when": {"kind": "time", "at": 0.5}, "do": {"kind": "steer", "vehicle": "first", "angle": -0.06, "duration": 2.0}}}
    assert measured(tmp_path, [("west", "east")], [20], script, seconds=4.0)["left_road"].value == 1
    assert measured(tmp_path, [("west", "east")], [20], {}, seconds=4.0)["left_road"].value == 0


@pytest.mark.parametrize(("permitted", "braked"), [(1.4, 0.0), (-0.5, 3.5), (-3.8, 3.5)])
def test_who_slows_yet_for_somebody_else_is_not_hindered(permitted, braked):
    """The second minds the first in this tick and loses 3.5 m/s² in it. Brakes let go late: if the first permits it to accelerate, it slows
    for whom it minded before, as where a queue sets off in jerks; if he asks for braking, however gently, it slows for him."""
    state, mind, parameter = (np.zeros((len(rows), 2)) for rows in (VEHICLE, MIND, PARAMETER))
    pairs, table, count = np.full((len(PAIR), MOST, 2), np.nan), np.zeros((len(CENSUS), 8)), np.zeros(1, np.int64)
    state[ACTIVE], mind[MINDED], mind[YIELDING], mind[FOLLOWING, 1] = 1.0, [-1.0, 0.0], NO_LIMIT, permitted
    state[V_X, 1], tick, before = 1.0, 0.02, np.array([0.0, 1.07])
    pairs[P_OTHER], pairs[P_BRAKED] = -1.0, 0.0
    pairs[P_OTHER, 0, 0], pairs[P_LEAVES, 0, 0], pairs[P_COMES, 0, 0] = 1.0, 10.0, 20.0  # none of them is there in this tick
    census.watch(
        0, 5.0, tick, state, parameter, mind, np.zeros(2, np.int64), np.arange(2), before, np.ones(2, np.int64), pairs, table, count
    )
    assert pairs[P_BRAKED, 0, 0] == pytest.approx(braked)


# -- rings -----------------------------------------------------------------------------------------


def ringed(minds, speeds=None, seconds=3):
    """How long each of some vehicles, who mind each other as listed, is in a ring, and what is counted when all are free again."""
    n = len(minds)
    state, mind, table = np.zeros((len(VEHICLE), n)), np.zeros((len(MIND), n)), np.zeros((len(CENSUS), 4 * n))
    state[ACTIVE], state[V_X], mind[MINDED] = 1.0, speeds or 0.0, minds
    ones, numbers, count, rings = np.zeros(n, np.int64), np.arange(n), np.zeros(1, np.int64), np.zeros(n)
    for k in range(seconds):
        census.find_rings(float(k), state, mind, ones, numbers, np.zeros(1, np.int64), rings, np.zeros(n, np.int64), table, count)
    found = rings.copy()
    mind[MINDED] = -1.0
    census.find_rings(9.0, state, mind, ones, numbers, np.zeros(1, np.int64), rings, np.zeros(n, np.int64), table, count)
    return found.tolist(), table[[C_KIND, C_WHO, C_VALUE], : count[0]].T.tolist()


def test_a_ring_is_found_and_what_leads_into_it_is_none():
    """0 → 1 → 2 → 0 is a ring; 3 waits for it, 4 for nobody."""
    found, rows = ringed([1, 2, 0, 0, -1])
    assert found == [3 * EVERY] * 3 + [0.0, 0.0]
    assert rows == [[RING, who, 3 * EVERY] for who in range(3)]


def test_who_drives_breaks_a_ring():
    assert ringed([1, 2, 0], [0.0, 2.0, 0.0])[0] == [0.0] * 3


def test_two_rings_are_two_and_a_queue_is_none():
    assert ringed([1, 0, 3, 4, 2, 4, 5])[0] == [3 * EVERY] * 5 + [0.0, 0.0]
    assert ringed([-1, 0, 1, 2, 3])[0] == [0.0] * 5


# -- who comes in ----------------------------------------------------------------------------------


def flow(seconds=60, **changes):
    """A motorway with one flow on the route of the sample's vehicles, and its sources."""
    loaded = job.load(ROOT / "scenarios" / "motorway_platoon.yaml", {"clock.duration": seconds})
    document = loaded.scenario.model_dump(mode="json", exclude_unset=True)
    settings = {"route": next(iter(document["routes"])), "rate": 1800, **changes}
    document |= {"traffic": {"flows": {"main": settings}}, "script": {}, "goals": {}, "measures": {}}
    return job.prepare(replace(loaded, scenario=type(loaded.scenario).model_validate(document)))


def flow_named(name, route, seconds):
    """The times at which cars of a flow of this name are due, lane by lane."""
    loaded = job.load(ROOT / "scenarios" / "motorway_platoon.yaml", {"clock.duration": seconds})
    document = loaded.scenario.model_dump(mode="json", exclude_unset=True)
    document |= {"traffic": {"flows": {name: {"route": route, "rate": 1800}}}, "script": {}, "goals": {}, "measures": {}}
    return [each.due for each in job.prepare(replace(loaded, scenario=type(loaded.scenario).model_validate(document))).sources]


def test_a_flow_comes_in_when_it_is_due():
    """1800 an hour and evenly on three lanes: one every 2 s in all; there is room, so that each comes in at the tick after."""
    setting = flow(headways="even")
    assert sum(each.due.size for each in setting.sources) == 30
    found = metrics(setting)
    assert found["never_entered"].value == 0
    assert found["longest_entry_delay"].value <= setting.scenario.clock.tick


def test_random_headways_are_exponential():
    """Their mean and standard deviation are both 2 s: of 1800 within three standard errors, 7 % and 8 %; another seed gives others."""
    setting = flow(seconds=3600)
    due = np.sort(np.concatenate([each.due for each in setting.sources]))
    headways = np.diff(due)
    assert np.mean(headways) == pytest.approx(2.0, rel=0.07)
    assert np.std(headways) == pytest.approx(2.0, rel=0.10)
    assert (np.diff(np.sort(headways)) > 0).all()


def test_flows_are_drawn_apart():
    """Also those whose names end alike; and each is the same whatever others there are."""
    route = flow().scenario.traffic.flows["main"].route
    one, other = (flow_named(name, route, seconds=600) for name in ("north_entry", "south_entry"))
    assert not set(one[0]) & set(other[0])
    assert (flow_named("north_entry", route, seconds=600)[0] == one[0]).all()


def test_a_world_that_has_failed_lets_nobody_in():
    """Its flow's cars come in no more, and those of the world beside it do."""
    running = simulation(flow(), flow())
    running.advance(100)
    running.fail(0, "for a test")
    running.advance(1000)
    w, of = running.world, running.world.worlds.of
    assert not w.vehicles.state[ACTIVE, of == 0].any()
    assert w.vehicles.state[ACTIVE, of == 1].sum() > 5


def test_a_flow_after_the_end_of_the_run_is_refused():
    with pytest.raises(StudioError, match=r"traffic\.flows\.main\.begin"):
        flow(begin=60)


def test_a_flow_on_no_route_is_refused():
    with pytest.raises(StudioError, match=r"traffic\.flows\.main\.route"):
        flow(route="nowhere")


def test_more_than_a_road_takes_waits_outside():
    """9000 an hour on three lanes are more than drivers with 1.2 s headway follow each other: some wait, and are told."""
    found = metrics(flow(rate=9000))
    assert found["never_entered"].value > 5
    assert found["longest_entry_delay"].value > 5.0
    assert found["collisions"].value == 0


def test_who_finds_no_room_at_the_start_waits_outside():
    """So many cars do not fit on a small map at once; they come in as there is room."""
    loaded = job.load(ROOT / "scenarios" / "left_hand.yaml", {"traffic.count": 400, "clock.duration": 10})
    setting = job.prepare(loaded)
    assert sum(each.is_outside for each in setting.cars) > 20
    found = metrics(setting)
    assert found["collisions"].value == 0


def test_a_flow_that_leads_nowhere_is_refused():
    with pytest.raises(StudioError, match="lane"):
        flow(lane=9)


def test_a_mix_has_its_shares():
    """Three to one: of 200 cars within three standard deviations."""
    loaded = job.load(ROOT / "scenarios" / "motorway_platoon.yaml", {"traffic.count": 200, "traffic.spacing": 10})
    document = loaded.scenario.model_dump(mode="json", exclude_unset=True)
    document["traffic"] |= {"mix": {"ford_escort": 3, "bmw_320i": 1}}
    cars = job.prepare(replace(loaded, scenario=type(loaded.scenario).model_validate(document))).cars
    models = [each.model.name for each in cars if each.returns]
    assert len(set(models)) == 2
    assert max(models.count(each) for each in set(models)) == pytest.approx(150, abs=19)
