"""Who comes in: types of cars, drivers whose settings are drawn, trips between origins and destinations, ways around closed roads."""

from dataclasses import replace
from math import erf, sqrt

import numpy as np
import pytest

from studio import job
from studio.errors import StudioError
from studio.execution.event import foreseen
from studio.execution.simulation import simulation
from studio.world.build import at_start
from studio.world.table.mind import HEADWAY
from tests.conftest import ROOT

NORMAL = {"kind": "normal", "mean": 1.3, "deviation": 0.3, "least": 0.8, "most": 2.0}


def prepared(name="motorway_platoon", seconds=60.0, script=None, **traffic):
    """A sample with other traffic."""
    loaded = job.load(ROOT / "scenarios" / f"{name}.yaml", {"clock.duration": seconds})
    document = loaded.scenario.model_dump(mode="json", exclude_unset=True)
    document |= {"traffic": traffic, "script": script or {}, "goals": {}, "measures": {}}
    return job.prepare(replace(loaded, scenario=type(loaded.scenario).model_validate(document)))


def drivers(setting):
    """Those of the traffic, by name."""
    return {car.name: car.driver for car in setting.cars if car.name.startswith("traffic_")}


# -- drivers ---------------------------------------------------------------------------------------


def headways(distribution, count=400):
    """The wanted headways of some drivers."""
    setting = prepared(count=count, spacing=8, spread={"time_headway": distribution})
    return np.array([each.time_headway for each in drivers(setting).values()])


def test_a_normal_distribution_is_cut_at_its_bounds():
    """Its share below each bound by the error function: mean and deviation of what is left, within three standard errors."""
    found = headways(NORMAL)
    a, b = (0.8 - 1.3) / 0.3, (2.0 - 1.3) / 0.3
    share = 0.5 * (erf(b / sqrt(2)) - erf(a / sqrt(2)))
    density = [np.exp(-0.5 * z * z) / sqrt(2 * np.pi) for z in (a, b)]
    mean = 1.3 + 0.3 * (density[0] - density[1]) / share
    assert found.min() >= 0.8 and found.max() <= 2.0
    assert np.mean(found) == pytest.approx(mean, abs=3 * 0.3 / sqrt(found.size))
    assert len(set(found)) == found.size


def test_a_lognormal_distribution_has_mean_and_deviation_of_the_number_itself():
    found = headways({"kind": "lognormal", "mean": 1.4, "deviation": 0.35})
    assert np.mean(found) == pytest.approx(1.4, abs=3 * 0.35 / sqrt(found.size))
    assert np.std(found) == pytest.approx(0.35, rel=0.15)
    assert np.std(np.log(found)) == pytest.approx(sqrt(np.log(1 + (0.35 / 1.4) ** 2)), rel=0.12)


def test_a_uniform_distribution_fills_its_bounds():
    found = headways({"kind": "uniform", "least": 1.0, "most": 2.0})
    assert 1.0 < found.min() < 1.02 and 1.98 < found.max() < 2.0
    assert np.mean(found) == pytest.approx(1.5, abs=3 * sqrt(1 / 12) / sqrt(found.size))


def test_what_was_drawn_is_what_the_driver_is_like():
    setting = prepared(count=20, spread={"time_headway": NORMAL})
    rows = at_start(setting).drivers[HEADWAY]
    assert rows.tolist() == [car.driver.time_headway for car in setting.cars]


def test_one_spread_more_changes_no_other_and_nor_does_the_order():
    """Of the settings and of the flows; the seed of the traffic does."""
    other = {"standstill_gap": {"kind": "uniform", "least": 1.0, "most": 3.0}}
    one = drivers(prepared(count=10, spread={"time_headway": NORMAL}))
    two = drivers(prepared(count=10, spread=other | {"time_headway": NORMAL}))
    assert [each.time_headway for each in one.values()] == [each.time_headway for each in two.values()]
    assert [each.speed_factor for each in one.values()] == [each.speed_factor for each in two.values()]
    assert [each.standstill_gap for each in one.values()] != [each.standstill_gap for each in two.values()]


def flow(**changes):
    """A flow on the only route of the sample."""
    return {"route": "eastbound", "rate": 900, **changes}


def test_drivers_of_a_flow_do_not_hang_on_other_flows():
    alone = prepared(flows={"b": flow()}, spread={"time_headway": NORMAL})
    beside = prepared(flows={"a": flow(), "b": flow()}, spread={"time_headway": NORMAL})
    of_b = [car.driver.time_headway for car in beside.cars if car.source is not None and beside.sources[car.source].stream.startswith("b/")]
    assert of_b == [car.driver.time_headway for car in alone.cars if car.source is not None]


def test_a_type_has_drivers_of_its_own():
    """In the mix three to one; the flow names one of them."""
    hurried = {
        "model": "bmw_320i",
        "driver": {"time_headway": 0.8},
        "spread": {"speed_factor": {"kind": "uniform", "least": 1.1, "most": 1.2}},
    }
    setting = prepared(
        count=80, spacing=8, types={"hurried": hurried}, mix={"hurried": 1, "ford_escort": 3}, flows={"f": flow(model="hurried")}
    )
    of = {model: [car.driver for car in setting.cars if car.returns and car.model.name == model] for model in ("bmw_320i", "ford_escort")}
    assert len(of["bmw_320i"]) == pytest.approx(20, abs=12)
    assert all(each.time_headway == 0.8 and 1.1 < each.speed_factor < 1.2 for each in of["bmw_320i"])
    assert all(each.time_headway == 1.2 and 0.9 < each.speed_factor < 1.1 for each in of["ford_escort"])
    assert {car.model.name for car in setting.cars if car.source is not None} == {"bmw_320i"}


def test_a_type_without_drivers_has_those_of_the_traffic():
    setting = prepared(count=5, types={"big": {"model": "suv"}}, model="big", driver={"time_headway": 1.9})
    assert {(car.model.name, car.driver.time_headway) for car in setting.cars if car.returns} == {("suv", 1.9)}


@pytest.mark.parametrize(
    ("traffic", "said"),
    [
        ({"spread": {"time_headwy": NORMAL}}, r"traffic\.spread\.time_headwy: names no setting.*did you mean 'time_headway'"),
        ({"spread": {"time_headway": NORMAL | {"least": 0.1}}}, r"traffic\.spread\.time_headway\.least: is beyond.*0\.1.*0\.3 to 5"),
        ({"spread": {"time_headway": {"kind": "normal", "mean": 9.0, "deviation": 1.0}}}, r"time_headway\.mean: is beyond"),
        ({"spread": {"time_headway": NORMAL | {"least": 1.98}}}, r"time_headway: lies beyond its bounds"),
        ({"types": {"t": {"spread": {"kind": NORMAL}}}, "model": "t"}, r"traffic\.types\.t\.spread\.kind: names no setting"),
        ({"types": {"suv": {}}}, r"traffic\.types\.suv: is the name of a vehicle"),
        ({"mix": {"hurried": 1}}, r"traffic\.mix\.hurried: names no vehicle of the catalogue, nor a type"),
        ({"flows": {"f": {"route": "eastbound", "rate": 1, "model": "hurried"}}}, r"traffic\.flows\.f\.model: names no vehicle"),
    ],
)  # fmt: skip
def test_drivers_that_there_cannot_be_are_refused(traffic, said):
    with pytest.raises(StudioError, match=said):
        prepared(count=3, **traffic)


def test_a_distribution_without_room_is_refused():
    with pytest.raises(ValueError, match="exchange them"):
        prepared(count=3, spread={"time_headway": NORMAL | {"least": 2.5}})


# -- how many --------------------------------------------------------------------------------------


def test_a_density_is_cars_per_kilometre_of_lane():
    setting = prepared(density=5.0, spacing=8)
    kilometres = sum(lane.length for lane in setting.network.lanes if not lane.internal) / 1000
    assert len(drivers(setting)) == round(5.0 * kilometres)


@pytest.mark.parametrize(
    ("traffic", "said"),
    [
        ({"density": 5.0, "count": 3}, "either `count` or `density`"),
        ({"density": 0.001}, r"traffic\.density: makes 0 cars of [\d.]+ km"),
        ({"density": 150.0}, r"traffic\.density: makes \d+ cars.*1 to 3000"),
        ({"flows": {f"f{i}": {"route": "eastbound", "rate": 20_000} for i in range(4)}}, "traffic: would have [0-9]+ cars"),
    ],
)  # fmt: skip
def test_numbers_that_cannot_be_are_refused(traffic, said):
    with pytest.raises((StudioError, ValueError), match=said):
        prepared(seconds=600.0, **traffic)


# -- origins and destinations ----------------------------------------------------------------------


def arms(setting):
    """Where one comes into the map and where one leaves it."""
    from studio.road.ways.route import arms as found

    return found(setting.network)


@pytest.fixture(scope="module")
def town():
    """The drawn town without traffic."""
    return prepared("urban_grid", count=0)


def pair(setting):
    """An entry and an exit that are not on one road, with two ways between them."""
    entries, exits = arms(setting)
    return entries[0], next(each for each in exits if each.partition("#")[0].lstrip("-") != entries[0].partition("#")[0].lstrip("-"))


def matrix(trips, **changes):
    """One matrix."""
    return {"morning": {"trips": [{"origin": a, "destination": b, "rate": rate} for a, b, rate in trips], **changes}}


def test_trips_go_from_where_they_begin_to_where_they_end(town):
    """In the interval, as often as the matrix says, by any lane that leads there."""
    a, b = pair(town)
    setting = prepared("urban_grid", 300.0, matrices=matrix([(a, b, 360)], begin=60, end=160, headways="even"))
    due = np.sort(np.concatenate([each.due for each in setting.sources]))
    assert due.tolist() == [65 + 10 * i for i in range(10)]
    for each in setting.sources:
        roads = [station.road for station in each.path.stations]
        assert (roads[0], roads[-1]) == (a, b)


def test_they_come_in(town):
    a, b = pair(town)
    running = simulation(prepared("urban_grid", 40.0, matrices=matrix([(a, b, 720)], headways="even")))
    while not running.is_over:
        running.advance(500)
    assert running.world.demand.gone.sum() == 8


def test_the_order_of_the_trips_changes_nothing(town):
    a, b = pair(town)
    trips = [(a, b, 100), (a, arms(town).exits[-1], 200)]
    one, two = (prepared("urban_grid", 300.0, matrices=matrix(order)) for order in (trips, trips[::-1]))
    assert [(each.stream, each.due.tolist()) for each in one.sources] == [(each.stream, each.due.tolist()) for each in two.sources]
    assert drivers(one) == drivers(two)


def test_a_trip_that_has_no_way_is_refused(town):
    """With the trip's place and where one could go instead; all of them at once."""
    a, b = pair(town)
    with pytest.raises(StudioError) as refused:
        prepared("urban_grid", matrices=matrix([(b, a, 10), (a, "nowhere", 10)]))
    places = sorted(each.where.rpartition(": ")[2] for each in refused.value.problems)
    assert places == ["traffic.matrices.morning.trips.0", "traffic.matrices.morning.trips.1"]


def test_a_matrix_after_the_end_of_the_run_is_refused(town):
    with pytest.raises(StudioError, match=r"traffic\.matrices\.morning\.begin"):
        prepared("urban_grid", 60.0, matrices=matrix([(*pair(town), 10)], begin=60))


# -- closed roads ----------------------------------------------------------------------------------


def closing(setting, road, **when):
    """A script that closes all lanes of a road."""
    lanes = setting.network.lanes_of(road)
    length = lanes[0].length
    lane = {"kind": "close_lane", "road": road, "start": round(0.4 * length), "end": round(0.6 * length), "taper": 20}
    return {f"shut_{i}": {"do": lane | {"lane": i}, **when} for i in range(len(lanes))}


def way(setting):
    """The roads of the first source."""
    return [station.road for station in setting.sources[0].path.stations]


def middle(setting):
    """A road in the middle of the way of its only trip that is long enough to be closed."""
    roads = list(dict.fromkeys(way(setting)))[1:-1]
    return max(roads, key=lambda road: setting.network.roads[road].length)


def test_a_trip_is_led_around_a_closed_road_and_that_is_told(town):
    trips = matrix([(*pair(town), 100)])
    road = middle(prepared("urban_grid", matrices=trips))
    setting = prepared("urban_grid", matrices=trips, script=closing(town, road))
    assert road not in way(setting)
    (told,) = [each for each in foreseen(setting) if each.kind == "led_around"]
    assert told.words == {"demand": "traffic.matrices.morning.trips.0", "road": road}
    assert told.numbers["longer"].value > -1.0


def test_who_is_due_before_and_after_goes_the_usual_way(town):
    trips = matrix([(*pair(town), 360)], headways="even")
    road = middle(prepared("urban_grid", 300.0, matrices=trips))
    times = {"when": {"kind": "time", "at": 100.0}, "until": {"kind": "time", "at": 200.0}}
    setting = prepared("urban_grid", 300.0, matrices=trips, script=closing(town, road, **times))
    around = [each for each in setting.sources if road not in [station.road for station in each.path.stations]]
    due = np.concatenate([each.due for each in around])
    assert due.size == 10 and due.min() > 100 and due.max() < 200
    assert sum(each.due.size for each in setting.sources) == 30


def test_where_no_way_leads_around_it_is_told(town):
    a, b = pair(town)
    setting = prepared("urban_grid", matrices=matrix([(a, b, 100)]), script=closing(town, b))
    assert way(setting)[-1] == b
    assert [each.kind for each in foreseen(setting) if each.kind in ("led_around", "cut_off")] == ["cut_off"]


def test_the_same_seed_gives_the_same_cars():
    one, two = (prepared(flows={"f": flow()}, spread={"time_headway": NORMAL}) for _ in range(2))
    assert drivers(one) == drivers(two)
