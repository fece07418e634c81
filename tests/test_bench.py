"""The benchmark measures what it says; how fast is not a matter of tests."""

import numpy as np
import pytest

from studio import bench
from studio.cli.machine import bench_rows
from studio.crowd import GAP, PLATOON, motorway_crowd, starts_in, town_crowd, traffic_crowd
from studio.errors import MapError, ServerError
from studio.execution.simulation import simulation
from studio.road import load
from studio.sample import town
from studio.vehicle import cuda, fleet


def test_a_fleet_drives():
    """Cars of the benchmark move, each on its own way, and none stands out by its place in the fleet."""
    cars = bench.cars(9)
    for k in range(50):
        fleet.integrate(cars, k, bench.DEFAULT_TICK, bench.DEFAULT_STEP)
    x, y = cars.state[:2] - [[0.0], [4.0]] * np.arange(9)
    assert (x > 15).all() and np.isfinite(cars.state).all()
    assert (np.diff(y) > 0).all()
    np.testing.assert_allclose(y, -y[::-1], atol=1e-9)


def test_the_report_has_all_figures(monkeypatch, sample):
    monkeypatch.setattr(bench, "SPAN", 0.001)
    monkeypatch.setattr(bench, "FLEETS", (1, 8))
    monkeypatch.setattr(bench, "CROWDS", (7,))
    monkeypatch.setattr(bench, "TOWN", 5)
    monkeypatch.setattr(bench, "MEASURED", 1)
    monkeypatch.setattr(bench, "REPEATS", 1)
    monkeypatch.setattr(bench, "all_cores", lambda: bench.dynamics(8))
    seen = []
    figures = bench.run(sample, town(), seen.append)
    assert set(figures["dynamics"]["one_core"]) == {"1", "8"}
    crowd = figures["advance"]["one_core"]["7"]
    assert min(crowd["rate"], crowd["ratio"]) > 0 and {"look", "sense", "move", "collide", "record", "report"} <= set(crowd["parts"])
    full = figures["equipped"]["one_core"]["7"]
    assert min(full["parts"]["sense"], full["ratio"]) > 0
    assert figures["town"]["one_core"]["5"]["parts"]["communicate"] > 0
    assert figures["tick"]["one_core"] > 0 and figures["dynamics"]["all_cores"] > 0
    assert set(figures["place"]) == {"import", "conflicts"} and set(figures["scene"]) == {"update"}
    assert min(*figures["place"].values(), *figures["scene"].values()) > 0
    assert figures["machine"] and figures["versions"]["numba"]
    assert seen == sorted(seen) and seen[-1] < 1


@pytest.mark.parametrize("count", [25, 62])
def test_a_crowd_is_as_dense_as_another(count):
    """Everybody but the first of a platoon follows at the distance of the file; nobody collides while the first one brakes."""
    run = simulation(motorway_crowd(count))
    run.advance(150)
    (case,) = run.cases
    followers = [v for v in range(count) if v % PLATOON]
    gap = run.record().channel("gap")[followers]
    assert case.status == "running" and run.world.events.hits_found == 0
    assert (gap[:, 0] == pytest.approx(GAP - 4.5, abs=0.1)) and np.isfinite(gap).all() and gap.min() > 10.0
    assert [event.text for event in case.happenings if event.kind == "script_begun"] == ["brake begins: brake with 2 m/s²"]


def test_cars_of_a_town_hear_each_other():
    """Each has its own way, all sensors and messages; nobody starts in another."""
    run = simulation(town_crowd(town(), 12))
    run.advance(100)
    (case,) = run.cases
    heard = run.record().trace("car_0.all.heard")
    assert case.status == "running" and run.world.events.hits_found == 0 and heard[-1] > 0


def test_a_town_may_be_too_small():
    with pytest.raises(MapError) as caught:
        list(starts_in(load(town()), 5000, town()))
    assert "no room for so many cars" in str(caught.value)


@pytest.mark.parametrize("count", [1, 7])
def test_a_rate_counts_units(monkeypatch, count):
    monkeypatch.setattr(bench, "SPAN", 0.01)
    calls = []
    assert bench.rate(lambda: calls.append(1), count) > 0
    assert len(calls) > bench.REPEATS


def test_without_a_gpu_the_reason_is_told(monkeypatch):
    monkeypatch.setattr(cuda, "is_available", lambda: False)
    with pytest.raises(ServerError) as caught:
        bench.run_device()
    (problem,) = caught.value.problems
    assert problem.where == "--device cuda" and "GPU" in problem.what and problem.remedy


def test_traffic_is_measured_with_both_dynamics(monkeypatch):
    """As many cars as are asked for go round; the light ones are light."""
    monkeypatch.setattr(bench, "TRAFFIC", (30,))
    monkeypatch.setattr(bench, "WARM", 5)
    monkeypatch.setattr(bench, "OFTEN", 2)
    figures = bench.run_traffic()
    for dynamics in ("full", "light"):
        each = figures["traffic"][dynamics]["30"]
        assert each["real_time"] == pytest.approx(each["rate"] * bench.DEFAULT_TICK / 30) and each["ratio"] > 1.0
        assert each["prepared"] > 0.0
        cars = traffic_crowd(30, dynamics).cars
        assert len(cars) == 30 and {car.is_light for car in cars} == {dynamics == "light"}
    told = ["traffic, light, 30 vehicles, one core", "times real time, light, 30 vehicles", "preparing, light, 30 vehicles"]
    assert [row[0] for row in bench_rows(figures)][:3] == told
