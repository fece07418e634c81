"""Where two ways become one behind lights one goes after the other: who stands for a stream takes his turn in it, and nobody is hit."""

import numpy as np
import yaml

from studio import job
from studio.model.driver import COURTESY
from studio.road.network.signals import GREEN
from studio.vehicle.state import V_X, X
from studio.world.build import build
from studio.world.tick import tick
from tests.road.conftest import Draft
from tests.road.test_priority import BERLIN, place_at

STREAM, APART, SLOW = 9, 13.0, 20  # cars, [m] from one to the next, [km/h] permitted on the great street
LINE = 141.0  # [m] along either way the way through the junction begins
BEFORE = 12.0  # [m] before it he stands who comes from the small street
EAST = 95.0  # [m] who is there has passed the place, on the map's axis


def joined(folder):
    """A small street joins a great one, each with a light; in the map's programme these are never green together."""
    draft, light = Draft(), {"highway": "traffic_signals"}
    south, north, west, east, middle = (draft.node(*place_at(BERLIN, x, y)) for x, y in ((0, -150), (0, 150), (-150, 0), (150, 0), (0, 0)))
    draft.way(1, [south, draft.node(*place_at(BERLIN, 0, -20), **light), middle, north], highway="residential", oneway="yes")
    lit = draft.node(*place_at(BERLIN, -30, 0), **light)
    draft.way(2, [west, lit, middle, east], highway="secondary", oneway="yes", maxspeed=str(SLOW))
    draft.write(folder / "joined.osm")


def driven(folder, seconds=45.0):
    """When those of the stream pass the place where the streets have become one, and who turns in [s]; speeds of all over time [m/s].

    All lights show green, so that nobody who has passed his light waits for anybody but those who come.
    """
    joined(folder)
    cars = {f"car_{i}": ("street", LINE - 4.0 - i * APART) for i in range(STREAM)} | {"turning": ("turning", LINE - BEFORE)}
    scenario = {
        "version": 3, "title": "Joined", "map": {"file": "joined.osm"}, "clock": {"duration": seconds},
        "routes": {"street": {"roads": ["2#0", "2#1", "2#2"]}, "turning": {"roads": ["1#0", "1#1", "2#2"]}},
        "vehicles": {name: {"route": way, "position": {"along": at}, "speed": 0} for name, (way, at) in cars.items()},
    }  # fmt: skip
    (folder / "joined.yaml").write_text(yaml.safe_dump(scenario), encoding="utf-8")
    world = build([job.prepare(job.load(folder / "joined.yaml"))])
    world.roads.forced[:] = GREEN
    east, speed = [], []
    for _ in range(round(seconds / world.clock.tick)):
        tick(world)
        east.append(world.vehicles.state[X].copy())
        speed.append(world.vehicles.state[V_X].copy())
    assert world.events.hits_found == 0
    passed = (np.array(east) > EAST).argmax(axis=0) * world.clock.tick
    assert (passed > 0.0).all()
    return passed[:STREAM], passed[STREAM], np.array(speed).T, world.clock.tick


def test_who_stands_takes_his_turn_in_a_stream(tmp_path):
    """No more than two go before him, and nobody brakes hard for him."""
    stream, own, speed, step = driven(tmp_path)
    assert (stream < own).sum() <= 2
    until = (stream / step).astype(int)
    hardest = max(-np.diff(speed[i, :end]).min() / step for i, end in enumerate(until))
    assert hardest < COURTESY + 0.5  # pedals are a little late
