"""Traffic in whole places: nobody hits anybody, nobody passes a red light, everybody gets on."""

from dataclasses import replace

import numpy as np
import pytest

from studio import job
from studio.road.network.signals import RED
from studio.vehicle.parameter import FRONT
from studio.vehicle.state import ACTIVE, V_X
from studio.world.build import build
from studio.world.table.mind import OFFSET, STATION, STOOD
from studio.world.tick import tick
from tests.conftest import ROOT

LONGEST = 150.0  # [s] more than a cycle of lights


@pytest.fixture(scope="module", params=[("urban_grid", 150), ("grosser_stern_platoon", 90), ("left_hand", 40)], ids=lambda each: each[0])
def driven(request):
    """Three minutes of cars that nothing but drivers drive: what happened at every tick, and the world."""
    name, count = request.param
    document = {"traffic.count": count, "traffic.spacing": 12, "clock.duration": 180, "seed": 7}
    loaded = job.load(ROOT / "scenarios" / f"{name}.yaml", document)
    scenario = loaded.scenario.model_copy(update={"applications": {}, "script": {}})
    setting = job.prepare(replace(loaded, scenario=scenario))
    world = build([setting])
    noses, shown, stood, offsets, speeds = [], [], [], [], []
    for _ in range(round(180 / world.clock.tick)):
        tick(world)
        noses.append(np.where(world.vehicles.state[ACTIVE] > 0, world.vehicles.mind[STATION] + world.vehicles.parameter[FRONT], np.nan))
        shown.append(world.roads.shown.copy())
        stood.append(world.vehicles.mind[STOOD].max())
        offsets.append(np.abs(world.vehicles.mind[OFFSET, world.vehicles.state[ACTIVE] > 0]).max(initial=0.0))
        speeds.append(world.vehicles.state[V_X].mean())
    return world, np.array(noses), np.array(shown), np.array(stood), np.array(offsets), np.array(speeds)


def test_nobody_hits_anybody_or_leaves_the_road(driven):
    world, _, _, _, offsets, _ = driven
    assert world.events.hits_found == 0
    assert offsets.max() < 1.0


def test_nobody_passes_a_red_light(driven):
    """A nose that comes over a line does not do so at red, once there has been time to brake since the start."""
    world, noses, shown, _, _, _ = driven
    r, passed, early = world.roads, 0, round(5.0 / world.clock.tick)
    for v in range(world.size):
        for k in range(r.stop_first[v], r.stop_first[v] + r.stop_count[v]):
            over = np.flatnonzero((noses[:-1, v] <= r.stop_station[k]) & (noses[1:, v] > r.stop_station[k]))
            passed += over.size
            assert not (shown[over[over > early], r.stop_link[k]] == RED).any()
    assert passed > 30 or not shown.shape[1]


def test_everybody_gets_on(driven):
    """Nobody stands for longer than lights and others take, and the traffic does not die."""
    _, _, _, stood, _, speeds = driven
    assert stood.max() < LONGEST
    assert speeds[-1500:].mean() > 2.0
