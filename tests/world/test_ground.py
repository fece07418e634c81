"""Friction under every wheel: weather, slippery stretches, one side of them, worlds apart from each other."""

import numpy as np
import pytest

from studio.errors import ScenarioError
from studio.execution.simulation import simulation
from studio.scenario import file
from studio.scenario.setup import complete
from studio.vehicle.contact import MU
from studio.vehicle.state import V_X
from studio.world.build import build
from studio.world.setting import setting
from studio.world.table.mind import STATION
from studio.world.tick import environment, tick

ALONG = {"kind": "friction", "route": "east_to_west"}


def scenario(sample, *, weather=1.0, script=None, **stretches):
    """The sample's leader alone, on another surface."""
    document = file.read(sample)
    script = script or {name: {"do": ALONG | stretch} for name, stretch in stretches.items()}
    document |= {
        "weather": {"friction": weather},
        "script": script,
        "applications": {},
        "traffic": {"count": 0},
        "goals": {},
    }
    document["vehicles"] = {"leader": document["vehicles"]["leader"]}
    return setting(complete(document, "surface"), sample.parent, "surface")


def wheels(world):
    """Friction under the four wheels of the first car."""
    return world.vehicles.ground[MU].reshape(4, -1)[:, 0]


def test_weather_is_everywhere(sample):
    world = build([scenario(sample, weather=0.4)])
    environment(world)
    assert (world.vehicles.ground[MU] == 0.4).all()
    assert (world.vehicles.ground[:MU] == 0.0).all()


def test_a_stretch_comes_wheel_by_wheel(sample):
    """Front wheels first, by the wheelbase; after it the weather's friction again; only the left side where it says so."""
    ice = {"start": 400.0, "end": 420.0, "friction": 0.2, "side": "left", "width": 3.5}
    world = build([scenario(sample, weather=0.9, ice=ice)])
    seen = []
    for _ in range(600):
        tick(world)
        seen.append((world.vehicles.mind[STATION, 0], *wheels(world)))
    station, left_front, right_front, left_rear, right_rear = np.array(seen).T
    assert (right_front == 0.9).all() and (right_rear == 0.9).all()
    enters, leaves = station[left_front == 0.2][[0, -1]]
    assert enters == pytest.approx(400.0 - 1.156, abs=0.6) and leaves == pytest.approx(420.0 - 1.156, abs=0.6)
    rear_enters = station[left_rear == 0.2][0]
    assert rear_enters == pytest.approx(400.0 + 1.423, abs=0.6)


def test_a_later_stretch_covers_an_earlier_one(sample):
    stretches = {
        "wet": {"start": 300.0, "end": 500.0, "friction": 0.6, "width": 10.0},
        "ice": {"start": 350.0, "end": 370.0, "friction": 0.1, "width": 10.0},
    }
    for order, expected in ((("wet", "ice"), 0.1), (("ice", "wet"), 0.6)):
        world = build([scenario(sample, **{name: stretches[name] for name in order})])
        environment(world)
        assert (wheels(world) == expected).all()


def test_a_batch_has_its_own_roads(sample):
    dry = scenario(sample)
    icy = scenario(sample, ice={"start": 300, "end": 500, "friction": 0.1, "width": 20})
    world = build([dry, icy])
    environment(world)
    assert world.vehicles.ground[MU].reshape(4, 2).T.tolist() == [[1.0] * 4, [0.1] * 4]


def test_ice_lengthens_the_way_to_a_stop(sample):
    """The same driver needs several times the distance from 13 m/s to a stop where the road is icy."""
    ways = []
    brake = {"brake": {"do": {"kind": "brake", "vehicle": "leader", "deceleration": 8, "duration": 100}}}
    for friction in (1.0, 0.15):
        run = simulation(scenario(sample, weather=friction, script=brake))
        for _ in range(500):
            run.advance()
            if run.world.vehicles.state[V_X, 0] < 0.1:
                break
        ways.append(run.world.vehicles.mind[STATION, 0] - 360.0)
    assert ways[1] > 3.0 * ways[0]


@pytest.mark.parametrize(
    ("stretch", "field"),
    [
        ({"route": "nowhere"}, "script.ice.do.route"),
        ({"end": 100_000.0}, "script.ice.do.end"),
        ({"end": 10.0}, "script.ice.do"),
        ({"friction": -1.0}, "script.ice.do.friction"),
        ({"side": "top"}, "script.ice.do.side"),
    ],
)
def test_bad_stretches_are_named(sample, stretch, field):
    with pytest.raises(ScenarioError) as caught:
        scenario(sample, ice={"start": 50.0, "end": 60.0, "friction": 0.2} | stretch)
    assert any(problem.where.endswith(f": {field}") for problem in caught.value.problems)
