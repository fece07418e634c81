"""The sample with a script, and ways to drive through it."""

import numpy as np

from studio.scenario import file
from studio.scenario.setup import complete
from studio.vehicle.state import V_X
from studio.world.build import build
from studio.world.setting import setting
from studio.world.table.mind import STATION
from studio.world.tick import tick

SLOW = {"kind": "limit", "route": "east_to_west", "start": 470, "end": 560, "speed": 8.3}


def scenario(sample, script, *, alone=True, lane=None, minding=(), **parts):
    """The sample with this script; its leader alone, or everybody; on this lane of three, or that of their route.

    Drivers overrule applications for what they are minding.
    """
    document = file.read(sample) | {"script": script, "goals": {}}
    for vehicle in document["vehicles"].values() if lane is not None else ():
        vehicle["position"] = {"road": "340498991", "lane": lane, "offset": vehicle["position"]["along"]}
    for vehicle in document["vehicles"].values() if minding else ():
        vehicle["intervention"] = {"reasons": list(minding)}
    if alone:
        document |= {"applications": {}, "traffic": {"count": 0}}
        document["vehicles"] = {"leader": document["vehicles"]["leader"]}
    return setting(complete(document | parts, "changing"), sample.parent, "changing")


def drive(setting, seconds):
    """Station and speed of the first car at every tick, and the world after it."""
    world, seen = build([setting]), []
    for _ in range(round(seconds / world.clock.tick)):
        tick(world)
        seen.append((world.vehicles.mind[STATION, 0], world.vehicles.state[V_X, 0]))
    return *np.array(seen).T, world


def run_for(settings, seconds):
    made = build(settings)
    for _ in range(round(seconds / made.clock.tick)):
        tick(made)
    return made
