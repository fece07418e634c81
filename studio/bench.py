"""Benchmark: how many vehicle steps and ticks a second this machine does, and how long a place and its picture take.

    dynamics    one vehicle step is one integration step (5 ms) of one car with the whole model, nothing else
    tick        one vehicle tick is one tick (20 ms, four steps) of one car in the whole world: lights, drivers, sensors,
                radio, applications, integration, collisions
    place       the sample's map imported from its file, with nothing kept from before; where the ways of its vehicles run
                close to each other
    scene       one update of the sample's vehicles in the 3D picture, which at 60 Hz has 16.7 ms for everything

Medians of several repeats; machine and versions stand beside the figures.
"""

import multiprocessing
import os
import platform
import statistics
import time
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from studio import job
from studio.conventions import DEFAULT_STEP, DEFAULT_TICK
from studio.errors import Problem, ServerError
from studio.road.assembly.plan import Wish
from studio.road.library.place import imported
from studio.road.library.reader import reader_of
from studio.road.ways.conflict import zones
from studio.scenario import catalogue
from studio.scene import pose
from studio.scene.fleet import Look
from studio.scene.projection import Scene
from studio.world import fleet
from studio.world.build import build
from studio.world.fleet import Fleet, Start
from studio.world.setting import Setting
from studio.world.state import RING, U_DRIVE, U_STEER
from studio.world.tick import tick

FLEETS = (1, 8, 100, 1000, 10_000)
DEVICE_FLEETS = (1000, 10_000, 100_000)
REPEATS = 5
SPAN = 0.2  # [s] of real time that one repeat takes at least
MODEL = "bmw_320i"
STEPS = round(DEFAULT_TICK / DEFAULT_STEP)


def cars(count: int) -> Fleet:
    """`count` cars side by side at 20 m/s with steering commands of their own, a little drive, in gear."""
    model = catalogue.find_vehicle(MODEL)
    made = fleet.fleet([Start(model, 0.0, 4.0 * i, 0.0, 20.0) for i in range(count)])
    made.commands[U_STEER] = np.tile(np.linspace(-0.02, 0.02, count), RING)
    made.commands[U_DRIVE] = 100.0
    return made


def rate(action: Callable[[], Any], units: int) -> float:
    """Units a second: the median over repeats of at least SPAN seconds."""
    action()
    rates = []
    for _ in range(REPEATS):
        began, rounds = time.perf_counter(), 0
        while time.perf_counter() - began < SPAN:
            action()
            rounds += 1
        rates.append(rounds * units / (time.perf_counter() - began))
    return statistics.median(rates)


def dynamics(count: int) -> float:
    """Vehicle steps a second on one core for a fleet of this size."""
    f = cars(count)
    return rate(lambda: fleet.integrate(f, 0, DEFAULT_TICK, DEFAULT_STEP), count * STEPS)


def seconds(action: Callable[[], Any]) -> float:
    """What an action takes [s]: the median of its repeats."""
    return 1.0 / rate(action, 1)


def whole_tick(sample: Setting) -> float:
    """Vehicle ticks a second on one core in a scenario."""
    world = build([sample])
    return rate(lambda: tick(world), world.size)


def whole_import(path: Path) -> float:
    """Seconds from a map file to its roads, signals and scenery."""
    reader = reader_of(path)
    part, data = reader.part(path, Wish(None, None, False, ())), reader.read(path)
    return seconds(lambda: imported(path, reader, data, part, "", lambda text: None))


def conflicts(sample: Setting) -> float:
    """Seconds to find where the ways of all vehicles run close to each other, each pair in both orders."""
    ways = [car.path.points for car in sample.cars]
    points, count = np.concatenate(ways, axis=1), np.array([way.shape[1] for way in ways])
    first = np.cumsum(count) - count
    pairs = [(i, j) for i in range(count.size) for j in range(count.size) if i != j]
    return seconds(lambda: [zones(points, first[i], count[i], first[j], count[j]) for i, j in pairs])


def picture(sample: Setting) -> float:
    """Seconds to move all vehicles once in the 3D picture, without anybody who looks at it."""
    scene = Scene()
    try:
        scene.show_vehicles([Look(car.name, car.colour) for car in sample.cars])
        poses = pose.standing(len(sample.cars))
        return seconds(lambda: scene.update(moved(poses)))
    finally:
        scene.stop()


def moved(poses: np.ndarray) -> np.ndarray:
    """The poses, 0.1 m further."""
    poses[pose.X] += 0.1
    return poses


def all_cores(count: int = 1000) -> float:
    """Vehicle steps a second of as many processes as there are cores, each with a fleet of its own."""
    cores = os.cpu_count() or 1
    with multiprocessing.get_context("spawn").Pool(cores) as pool:
        return sum(pool.map(dynamics, [count] * cores, chunksize=1))


def run(sample: Path, progress: Callable[[float], None] = lambda share: None) -> dict[str, Any]:
    """All figures, with the machine and the versions."""
    stages = len(FLEETS) + 3
    one_core = {}
    for i, count in enumerate(FLEETS):
        one_core[str(count)] = dynamics(count)
        progress((i + 1) / stages)
    loaded = job.load(sample)
    setting = job.prepare(loaded)
    tick_rate = whole_tick(setting)
    progress(1 - 2 / stages)
    place = {"import": whole_import(sample.parent / loaded.scenario.map.file), "conflicts": conflicts(setting)}
    scene = {"update": picture(setting)}
    progress(1 - 1 / stages)
    return {
        "machine": machine(),
        "versions": versions(),
        "unit": {"dynamics": "vehicle steps/s", "tick": "vehicle ticks/s", "place": "s", "scene": "s"},
        "dynamics": {"one_core": one_core, "all_cores": all_cores()},
        "tick": {"one_core": tick_rate},
        "place": place,
        "scene": scene,
    }


def run_device(progress: Callable[[float], None] = lambda share: None) -> dict[str, Any]:
    """Vehicle steps a second on a GPU, and how far its result is from the CPU's; raises ServerError when there is none."""
    try:
        from studio.world import cuda
    except ImportError as error:
        raise no_device("the extra `cuda` is not installed", f"uv pip install 'cooperative-adas-studio[cuda]' ({error})") from None
    if not cuda.is_available():
        raise no_device("there is no GPU, or no driver for it", "run it on a machine with an NVIDIA GPU")
    figures = {}
    for i, count in enumerate(DEVICE_FLEETS):
        figures[str(count)] = device_rate(count)
        progress((i + 1) / (len(DEVICE_FLEETS) + 1))
    return {
        "machine": cuda.name(),
        "versions": versions() | {"numba-cuda": version("numba-cuda")},
        "unit": {"dynamics": "vehicle steps/s", "difference": "m"},
        "dynamics": {"cuda": figures},
        "difference": device_difference(),
    }


def no_device(what: str, remedy: str) -> ServerError:
    """Why a GPU cannot be measured."""
    return ServerError("The GPU cannot be measured.", [Problem("--device cuda", what, allowed="cpu, cuda", remedy=remedy)])


def device_rate(count: int, ticks: int = 50) -> float:
    """Vehicle steps a second of a fleet on the GPU, `ticks` ticks in a launch."""
    from studio.world import cuda

    device = cuda.Device(cars(count))

    def launch() -> None:
        device.integrate(0, DEFAULT_TICK, DEFAULT_STEP, ticks=ticks)
        device.synchronize()

    return rate(launch, count * STEPS * ticks)


def device_difference(count: int = 1000, seconds: float = 10.0) -> float:
    """Largest distance [m] between the places of a car on GPU and CPU after a drive."""
    from studio.world import cuda

    here, there = cars(count), cars(count)
    device = cuda.Device(there)
    for k in range(round(seconds / DEFAULT_TICK)):
        fleet.integrate(here, k, DEFAULT_TICK, DEFAULT_STEP)
        device.integrate(k, DEFAULT_TICK, DEFAULT_STEP)
    device.fetch(there)
    return float(np.hypot(*(here.state[:2] - there.state[:2])).max())


def versions() -> dict[str, str]:
    """Of everything that makes the machine code."""
    return {"studio": job.code_version(), "python": platform.python_version(), "numba": version("numba")}


def machine() -> str:
    """Processor and number of cores."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        name = next(line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        name = platform.processor() or platform.machine()
    return f"{name}, {os.cpu_count()} cores"
