"""The whole world on the real map: determinism, batches, traffic that keeps to its lanes and lights."""

import itertools

import numpy as np
import pytest

from studio import job
from studio.execution.simulation import simulation
from studio.road.network.signals import GREEN
from studio.vehicle.parameter import FRONT
from studio.vehicle.state import ACTIVE, OMEGA, OMEGA_E, V_EAST, V_X, X, Y
from studio.world.build import build
from studio.world.table.mind import OFFSET, RED_STATION, STATION
from studio.world.tick import tick


def run_for(settings, seconds):
    world = build(settings)
    for _ in range(round(seconds / world.clock.tick)):
        tick(world)
    return world


def test_same_seed_same_bits(sample_setting):
    assert run_for([sample_setting], 5).digest() == run_for([sample_setting], 5).digest()


def test_another_seed_differs(sample):
    settings = [job.prepare(job.seeded(job.load(sample), seed)) for seed in (1, 2)]
    assert run_for(settings[:1], 2).digest() != run_for(settings[1:], 2).digest()


def test_a_world_does_not_know_its_batch(sample):
    """Three variants side by side end with the bits that each has alone, in any order."""
    variants = [
        job.prepare(job.load(sample, changes))
        for changes in (
            {},
            {"applications.platoon.parameters.headway": 1.0},
            {"applications.platoon.application": "acc", "traffic.count": 7},
        )
    ]
    alone = [run_for([variant], 22).digest(0) for variant in variants]
    together = run_for(variants, 22)
    reverse = run_for(variants[::-1], 22)
    assert [together.digest(w) for w in range(3)] == alone
    assert [reverse.digest(2 - w) for w in range(3)] == alone
    assert len(set(alone)) == 3


@pytest.fixture(scope="module", params=[1, 2, 3])
def long_run(request, sample):
    """A minute of the sample with everybody's place at every tick; three seeds."""
    setting = job.prepare(job.seeded(job.load(sample), request.param))
    world = build([setting])
    places = []
    for _ in range(3000):
        tick(world)
        places.append((world.vehicles.state.copy(), world.vehicles.mind.copy(), world.roads.shown.copy()))
    return setting, world, places


def test_nobody_collides(long_run):
    assert long_run[1].events.hits_found == 0


def test_everybody_keeps_the_lane(long_run):
    """The centre of every car stays within 0.5 m of its path."""
    _, _, places = long_run
    offsets = np.array([np.where(state[ACTIVE] > 0, np.abs(mind[OFFSET]), 0.0).max() for state, mind, _ in places])
    assert offsets.max() < 0.5


def test_nobody_passes_a_red_light(long_run):
    """A front bumper crosses a stop line at red only where the driver could not have stopped at amber."""
    setting, world, places = long_run
    front = world.vehicles.parameter[FRONT]
    crossings = reds = 0
    for (before, mind_before, _), (after, mind, shown) in itertools.pairwise(places):
        for v, car in enumerate(setting.cars):
            for stop, link in car.path.stop_lines:
                if mind_before[STATION, v] + front[v] < stop <= mind[STATION, v] + front[v] and after[ACTIVE, v] and before[ACTIVE, v]:
                    crossings += 1
                    reds += shown[link] not in (GREEN, 3)
    assert crossings > 20
    assert reds == 0


def test_some_wait_at_red(long_run):
    """The lights matter: somebody stands at a stop line."""
    _, _, places = long_run
    assert any(((mind[RED_STATION] < np.inf) & (state[V_X] < 0.1) & (state[ACTIVE] > 0)).any() for state, mind, _ in places)


def test_all_numbers_are_finite(long_run):
    assert all(np.isfinite(state).all() for state, _, _ in places_every_second(long_run))


def places_every_second(long_run):
    return long_run[2][::50]


def test_all_arm_to_arm_routes_are_driven(sample):
    """25 cars, each alone on its route between two arms: all arrive, none leaves its lane, none collides."""
    from studio import road
    from studio.road.ways.route import all_routes

    network = road.load(sample.parent / "maps" / "berlin_siegessaeule_grosser_stern.osm.gz", radius=800)
    ways = all_routes(network)
    assert len(ways) == 25
    for way in ways:
        roads = [each for each in way.roads(network) if not network.roads[each].internal]
        arrived, worst = drive_alone(sample, roads)
        assert arrived, roads
        assert worst < 0.5, (roads, worst)


def drive_alone(sample, roads):
    """Whether a single car gets to the end of a route within four minutes, and its greatest offset from the path [m]."""
    document = {
        "title": "alone",
        "map": {"file": "maps/berlin_siegessaeule_grosser_stern.osm.gz"},
        "clock": {"duration": 240},
        "routes": {"way": {"roads": roads}},
        "vehicles": {"car": {"route": "way", "position": {"along": 5}, "speed": 8}},
    }
    from studio.scenario.setup import complete
    from studio.world.setting import setting

    world = build([setting(complete(document, "alone"), sample.parent, "alone")])
    worst = 0.0
    for _ in range(12_000):
        tick(world)
        if world.vehicles.state[ACTIVE, 0] == 0.0:
            return True, worst
        worst = max(worst, abs(world.vehicles.mind[OFFSET, 0]))
    return False, worst


@pytest.mark.parametrize(
    ("part", "row", "quantity"),
    [("state", V_EAST, "velocity_east"), ("state", OMEGA_E, "engine_speed"), ("wheels", OMEGA, "wheel_speed of wheel 1")],
)
def test_the_state_that_breaks_is_named(sample_setting, part, row, quantity):
    """A run that meets a number which is none fails in the same tick, and says whose, which and when."""
    broken = simulation(sample_setting)
    for _ in range(7):
        broken.advance()
    getattr(broken.world.vehicles, part)[row, 3] = np.nan
    broken.advance()
    (case,) = broken.cases
    assert case.status == "failed"
    assert case.error == f"{quantity} of follower_3 is not finite any more at 0.140 s"


def test_traffic_comes_in_again(sample):
    """After two minutes cars have arrived, and most of the twenty are on the map all the same."""
    setting = job.prepare(job.load(sample))
    world = build([setting])
    jumps, last = 0, None
    for _ in range(6000):
        tick(world)
        now = world.vehicles.state[[X, Y], 5:].copy()
        if last is not None:
            jumps += int((np.hypot(*(now - last)) > 50).sum())
        last = now
    assert jumps > 5
    assert world.vehicles.state[ACTIVE, 5:].sum() >= 15
