"""Hits: every contact of a pair is an event, however many there are at once."""

import numpy as np
import pytest
import yaml

from studio import job
from studio.execution.simulation import simulation
from studio.road.drawn.motorway import motorway
from studio.vehicle.state import V_X, X, Y
from studio.world.build import build
from studio.world.snapshot import restore, snapshot
from studio.world.table.street import HIT_FIRST, HIT_SECOND
from studio.world.tick import tick

CARS = 16  # 120 pairs


@pytest.fixture(scope="module")
def setting(tmp_path_factory):
    """Cars in one lane, which tests put into each other."""
    folder = tmp_path_factory.mktemp("pile")
    (folder / "motorway.xodr").write_text(motorway(length=600.0, lanes=2), encoding="utf-8")
    start = {"route": "way", "speed": 0.0}
    document = {
        "version": 3, "title": "a pile", "map": {"file": "motorway.xodr"}, "clock": {"duration": 2},
        "routes": {"way": {"roads": ["motorway"]}},
        "vehicles": {f"car_{i:02d}": start | {"position": {"along": 100 + 10 * i}} for i in range(CARS)},
    }  # fmt: skip
    (folder / "pile.yaml").write_text(yaml.safe_dump(document))
    return job.prepare(job.load(folder / "pile.yaml"))


def piled(world, columns):
    """The cars of these columns in one place."""
    world.vehicles.state[X, columns], world.vehicles.state[Y, columns] = world.vehicles.state[[X, Y], columns.start][:, None]
    world.vehicles.state[V_X, columns] = 0.0
    return world


def test_more_than_there_is_room_for_at_first(setting):
    """120 pairs at one tick: 120 events, each pair once."""
    run = simulation(setting)
    piled(run.world, run.world.columns())
    run.advance(2)
    told = [each for each in run.cases[0].happenings if each.kind == "collision"]
    assert len(told) == len({frozenset(each.units) for each in told}) == CARS * (CARS - 1) // 2
    assert run.world.events.hits_found == len(told)


def test_what_one_world_needs_changes_nothing_for_the_others(setting):
    """The second of three is piled up: all have the bits that they have alone."""

    def run(*piles):
        world = build([setting] * len(piles))
        for number in np.flatnonzero(piles):
            piled(world, world.columns(int(number)))
        for _ in range(5):
            tick(world)
        return [world.digest(w) for w in range(len(piles))]

    assert run(False, True, False) == [*run(False), *run(True), *run(False)]


def test_a_snapshot_has_them_all(setting):
    """Taken with more than there is room for in a world that is built anew."""
    world = piled(build([setting]), slice(0, CARS))
    tick(world)
    kept = snapshot(world)
    tick(world)
    anew = build([setting])
    restore(anew, kept)
    tick(anew)
    assert anew.digest() == world.digest()
    pairs = anew.events.of(0)[[HIT_FIRST, HIT_SECOND]]
    assert len(set(map(tuple, pairs.T))) == CARS * (CARS - 1) // 2
