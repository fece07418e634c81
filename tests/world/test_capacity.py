"""How much traffic a junction takes: the saturation flow at a light, and the capacity of a minor street beside a main stream."""

from math import exp

import numpy as np
import pytest
import yaml

from studio import job
from studio.execution.simulation import simulation
from studio.road import load
from studio.road.ways.gap import FROM_MINOR
from tests.road.conftest import Draft
from tests.road.test_priority import BERLIN, arms_of, crossing, place_at

SETTLED = 300.0  # [s] after which is counted


def passages(folder, name, routes, seconds, at, **parts):
    """When fronts pass a station of the first route [s], in order; on each route that a flow takes drive 1500 cars an hour and more."""
    scenario = {
        "version": 3, "title": "Capacity", "map": {"file": name}, "clock": {"duration": seconds}, "routes": routes,
        "vehicles": {"first": {"route": "own", "position": {"along": 5}, "speed": 10, "model": "ford_escort"}},
        "recording": {"traffic": True, "period": 0.2, "channels": ["station"]}, **parts,
    }  # fmt: skip
    (folder / "scenario.yaml").write_text(yaml.safe_dump(scenario), encoding="utf-8")
    setting = job.prepare(job.load(folder / "scenario.yaml"))
    running = simulation(setting)
    while not running.is_over:
        running.advance(1000)
    assert running.world.events.hits_found == 0
    record = running.record()
    own = [i for i, car in enumerate(setting.cars) if car.source is None or setting.sources[car.source].stream.startswith("own/")]
    return np.sort(np.concatenate([passed(record, setting.cars[i], at) for i in own]))


def passed(record, car, at):
    """When the front of a car passes a station [s]."""
    front = record.trace(f"{car.name}.station") + record.bodies[car.name].front
    before = np.flatnonzero((front[:-1] < at) & (front[1:] >= at))
    return record.time[before] + np.diff(record.time)[before] * (at - front[before]) / (front[before + 1] - front[before])


# -- at a light ------------------------------------------------------------------------------------


def test_saturation_flow_at_a_light(tmp_path):
    """Drivers with a headway of 1 s: 1700 to 2000 cars an hour and lane, from the fifth car of a long queue on.

    Field values: Highway Capacity Manual 2000, 1900 an hour and lane; German HBS, 2000 an hour.
    """
    draft = Draft()
    nodes = [draft.node(*place_at(BERLIN, x, 0), **tags) for x, tags in ((-450, {}), (0, {"highway": "traffic_signals"}), (450, {}))]
    draft.way(1, nodes, highway="secondary", oneway="yes", lanes="1", maxspeed="50")
    network = load(draft.write(tmp_path / "light.osm"))
    first, last = (road for road in network.roads if not network.roads[road].internal)
    line = network.lanes_of(first)[0].length
    light = {"kind": "light", "road": first}
    script = {
        "red": {"until": {"kind": "time", "at": 110}, "do": light | {"shows": "red"}},
        "green": {"when": {"kind": "time", "at": 110}, "do": light | {"shows": "green"}},
    }
    traffic = {"driver": {"time_headway": 1.0}, "flows": {"own": {"route": "own", "rate": 2400}}}
    times = passages(tmp_path, "light.osm", {"own": {"roads": [first, last]}}, 190.0, line - 1.0, traffic=traffic, script=script)
    headways = np.diff(times[times > 110])
    assert headways.size > 30
    assert 1700 < 3600 / np.mean(headways[4:30]) < 2000


# -- beside a main stream --------------------------------------------------------------------------


def siegloch(q, critical, follow_up):
    """Cars an hour that a minor stream brings through gaps of a main stream of q [1/s] (W. Siegloch 1973)."""
    return 3600.0 / follow_up * exp(-q * (critical - 0.5 * follow_up))


@pytest.mark.parametrize(("to", "movement"), [("east", "near"), ("north", "through"), ("west", "across")])
def test_a_minor_street_has_the_capacity_of_its_gaps(tmp_path, to, movement):
    """Within 15 % of Siegloch's, with the critical gap of the drivers and the follow-up time that they have without a main stream."""
    network = load(crossing(Draft(), BERLIN, classes={"west": "secondary", "east": "secondary"}, reach=300).write(tmp_path / "cross.osm"))
    ways = {arms_of(network, c): [network.lanes[c.from_lane].road, network.lanes[c.to_lane].road] for c in network.connections}
    routes = {"own": {"roads": ways["south", to]}, "main": {"roads": ways["west", "east"]}}
    own = {"own": {"route": "own", "rate": 1500}}

    def a_second(seconds, **flows):
        times = passages(tmp_path, "cross.osm", routes, seconds, 330.0, traffic={"flows": own | flows})
        return np.sum(times > SETTLED) / (seconds - SETTLED)

    follow_up = 1.0 / a_second(700.0)
    main = {"route": "main", "rate": 400, "headways": "random"}
    capacity = siegloch(400 / 3600, FROM_MINOR[movement], follow_up)
    assert 3600 * a_second(2100.0, main=main) == pytest.approx(capacity, rel=0.15)
