"""The same bits, however many others there are, in whatever order, on however many threads, in whatever process."""

import hashlib
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from studio.vehicle import motion, shift
from studio.vehicle.command import RING, U_BRAKE, U_PEDAL, U_STEER
from studio.vehicle.state import PSI, VEHICLE
from studio.vehicle.tile import LANES, new_tile
from tests.conftest import ROOT
from tests.patience import PATIENCE
from tests.proving_ground import MODELS, Ground

FIRST = (0.03, 0.4, 17.0)  # steering [rad], pedal [1], speed [m/s] of the car that is compared
SECONDS = 3.0


def drivers(n, *, seed=7) -> np.ndarray:
    """Steering, pedal and speed of n cars, all different, the first one FIRST: [3, n]."""
    random = np.random.default_rng(seed)
    made = np.array([random.uniform(-0.1, 0.1, n), random.uniform(0.0, 1.0, n), random.uniform(0.0, 40.0, n)])
    made[:, 0] = FIRST
    return made


def driven(models, made, seconds=SECONDS) -> Ground:
    """Cars that steer and push their pedals, shift, then brake to a stop on the way."""
    steering, pedal, speed = made
    ground = Ground(models, speed=speed, powertrain=True)
    ground.command(steering=steering, pedal=pedal).run(seconds)
    return ground.command(pedal=0.0, brake=3000.0 * pedal).run(seconds)


def bits(ground, v) -> bytes:
    """All of one car's state and wheels."""
    return ground.state[:, v].tobytes() + ground.wheels.reshape(-1, 4, ground.n)[:, :, v].tobytes()


@pytest.fixture(scope="module")
def alone():
    """Each model by itself, driven as FIRST."""
    return {model: bits(driven(model, np.array(FIRST)[:, None]), 0) for model in MODELS}


@pytest.mark.parametrize("n", [1, 7, 8, 9, LANES, LANES + 1, 1000])
def test_bits_do_not_depend_on_the_batch(alone, n):
    """Car 0 among n others, each with a driver of its own; a tile holds 72."""
    seconds = SECONDS if n < 1000 else 0.5
    expected = alone["bmw_320i"] if n < 1000 else bits(driven("bmw_320i", np.array(FIRST)[:, None], seconds), 0)
    assert bits(driven(["bmw_320i"] * n, drivers(n), seconds), 0) == expected


def test_every_car_of_a_thousand_is_as_it_is_alone():
    made = drivers(1000)
    all_of_them = driven(["smart_fortwo"] * 1000, made, 0.3)
    for v in (1, 7, 71, 72, 73, 500, 999):
        assert bits(all_of_them, v) == bits(driven("smart_fortwo", made[:, v : v + 1], 0.3), 0), v


@pytest.mark.parametrize("n", [7, 8, 9, 100])
def test_bits_do_not_depend_on_the_order(n):
    made, order = drivers(n), np.random.default_rng(1).permutation(n)
    straight, shuffled = driven(["ford_escort"] * n, made), driven(["ford_escort"] * n, made[:, order])
    assert straight.state[:, order].tobytes() == shuffled.state.tobytes()
    wheels = straight.wheels.reshape(-1, 4, n)[:, :, order]
    assert wheels.tobytes() == shuffled.wheels.tobytes()


def mixed(n=300) -> tuple[list[str], np.ndarray]:
    """A fleet of all models on their different tyres, in a random order, with drivers."""
    return [MODELS[k] for k in np.random.default_rng(3).integers(0, len(MODELS), n)], drivers(n)


def test_a_mixed_fleet(alone):
    """Models and tyres in a random order make blocks of equal tyres: every car that is driven as FIRST is as it is alone."""
    models, made = mixed()
    places = {model: models.index(model) for model in MODELS}
    for v in places.values():
        made[:, v] = FIRST
    ground = driven(models, made)
    assert ground.fleet.blocks.shape[1] > len({tuple(pair) for pair in ground.fleet.blocks[2:].T}) - 1 >= 4
    for model, v in places.items():
        assert bits(ground, v) == alone[model], model


def on_threads(ground, threads, ticks):
    """Ticks of a fleet whose blocks are shared out to threads, each with a tile of its own."""
    f, tiles = ground.fleet, [new_tile() for _ in range(threads)]
    parts = [np.ascontiguousarray(f.blocks[:, k::threads]) for k in range(threads)]
    steps = motion.steps_of(ground.tick, ground.step)

    def some(k, part, tile):
        motion.integrate(
            part, f.order, f.state, f.wheels, f.ground, f.parameter, f.tyres, f.commands, k, ground.tick, ground.step, steps,
            f.broken, tile,
        )  # fmt: skip

    with ThreadPoolExecutor(threads) as pool:
        for k in range(ticks):
            shift.shifts(f.order, k, ground.tick, f.state, f.wheels, f.parameter, f.gears, f.commands)
            list(pool.map(some, [k] * threads, parts, tiles))


@pytest.mark.parametrize("threads", [2, 3])
def test_threads_share_the_blocks(threads):
    """motion.integrate lets go of the interpreter; who integrates a block makes no difference."""
    grounds = []
    for count in (1, threads):
        models, made = mixed(400)
        ground = Ground(models, speed=made[2], powertrain=True).command(steering=made[0], pedal=made[1])
        on_threads(ground, count, 100)
        grounds.append(ground)
    assert grounds[0].state.tobytes() == grounds[1].state.tobytes()
    assert grounds[0].wheels.tobytes() == grounds[1].wheels.tobytes()
    plain = Ground(models, speed=made[2], powertrain=True).command(steering=made[0], pedal=made[1]).run(100 * ground.tick)
    assert plain.state.tobytes() == grounds[0].state.tobytes()


def integrate(ground, tick, steps):
    """Motion alone, of the first steps of the present tick."""
    f = ground.fleet
    motion.integrate(
        f.blocks, f.order, f.state, f.wheels, f.ground, f.parameter, f.tyres, f.commands, ground.k, tick, ground.step, steps,
        f.broken, f.tile,
    )  # fmt: skip


@pytest.mark.parametrize("steps", [1, 2, 3])
def test_the_first_steps_of_a_tick_are_steps(steps):
    """Three steps of a tick at once are three ticks of one step each, but for the heading, unwound at every tick's end."""
    at_once, one_by_one = (Ground(MODELS, speed=15.0, powertrain=True) for _ in range(2))
    for ground in (at_once, one_by_one):
        ground.command(steering=0.05, pedal=0.6).run(1.0)
    integrate(at_once, 0.02, steps)
    for _ in range(steps):
        integrate(one_by_one, 0.005, 1)
    rows = [row for row in range(len(VEHICLE)) if row != PSI]
    assert at_once.state[rows].tobytes() == one_by_one.state[rows].tobytes()
    assert at_once.wheels.tobytes() == one_by_one.wheels.tobytes()
    assert at_once.state[PSI] == pytest.approx(one_by_one.state[PSI], abs=1e-15)


def digest() -> str:
    """Of the mixed fleet's drive."""
    ground = driven(*mixed(60), 1.0)
    return hashlib.sha256(ground.state.tobytes() + ground.wheels.tobytes()).hexdigest()


def test_a_fresh_process_gives_the_same_bits():
    program = "import sys; sys.path.insert(0, 'tests/vehicle'); import test_bits; print(test_bits.digest())"
    other = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, timeout=4 * PATIENCE)
    assert other.stdout.strip() == digest(), other.stderr


def test_a_car_obeys_its_own_commands():
    """None of its neighbours'."""
    ground = Ground(["bmw_320i"] * 3, speed=10.0, powertrain=True)
    ring = ground.fleet.commands.reshape(-1, RING, 3)
    ring[[U_STEER, U_PEDAL, U_BRAKE], :, 1] = np.array([[0.1], [0.5], [0.0]])
    ground.run(1.0)
    assert bits(ground, 0) == bits(ground, 2) != bits(ground, 1)
