"""The sensor of the road's condition: what it tells of weather and slippery stretches, at the spot where it looks, and how wrong it is."""

import numpy as np
import pytest

from studio.vehicle.parameter import FRONT
from studio.vehicle.state import X
from studio.workshop.stage import stage
from studio.world.tick import environment, gather, sense

AHEAD, NOISE = 8.0, 0.05  # [m], [1]
ICE = {"kind": "friction", "road": "motorway", "lane": 1, "start": 340.0, "end": 360.0, "friction": 0.15}


def looking(**parts):
    """A stage with two of it on `own`: one exact, one not."""
    exact = {"kind": "road_condition", "ahead": AHEAD, "noise": 0.0}
    run = stage(vehicles={"own": {"sensors": {"exact": exact, "rough": exact | {"noise": NOISE}}}}, weather={"friction": 0.7}, **parts)
    (each,) = run.world.units.mounted
    return run.world, each


def test_it_is_as_wrong_as_it_says():
    """Weather of 0.7: 400 looks have its mean within four standard errors, its spread within a tenth, and tell that spread."""
    world, each = looking()
    seen = []
    for _ in range(400):
        gather(world)
        sense(world)
        world.clock.k += 1
        seen.append(each.out[:, 1:3].copy())
    exact, rough = np.transpose(seen, (1, 2, 0))
    assert np.all(exact[0] == 0.7) and np.all(exact[1] == 0.0) and np.all(rough[1] == NOISE)
    assert np.mean(rough[0]) == pytest.approx(0.7, abs=4.0 * NOISE / 20.0) and np.std(rough[0]) == pytest.approx(NOISE, rel=0.15)


def test_it_sees_a_slippery_stretch_where_it_looks():
    """Ice from 340 to 360 m: told while the spot, 8 m before the bumper, is on it, neither before nor after; to the metre of its pieces."""
    world, each = looking(script={"ice": {"when": {"kind": "time", "at": 0.0}, "do": ICE}})
    own = world.column("own")
    start, told = world.vehicles.state[X, own], {}
    for moved in range(20, 70):
        world.vehicles.state[X, own] = start + moved
        environment(world)
        gather(world)
        sense(world)
        told[moved + 300.0 + world.vehicles.parameter[FRONT, own] + AHEAD] = each.out[0, 1]
    for spot, friction in told.items():
        if abs(spot - 340.0) > 1.0 and abs(spot - 360.0) > 1.0:
            assert friction == (0.15 if 340.0 < spot < 360.0 else 0.7), spot
    assert {0.15, 0.7} == set(told.values())
