"""Benchmark: how many vehicle steps and ticks a second this machine does.

    dynamics    one vehicle step is one integration step (5 ms) of one car with the whole model, nothing else
    tick        one vehicle tick is one tick (20 ms, four steps) of one car in the whole world: lights, drivers, sensors,
                radio, applications, integration, collisions
    advance     the same with recording and events, for platoons on a motorway that is as long as their number asks, so
                that the density is always the same; `ratio` is what all of it costs over the integration of its vehicles alone
    equipped    the same with four sensors on every car that look late and not through others, and IEEE 802.11p with shadows, fading,
                bursts and a busy channel, over which everybody hears everybody; every message is recorded
    town        the same once more in a town: cars on ways of their own, which tell each other of themselves by the standard's rules
    traffic     by itself: cars with the full and with light dynamics that go round on a motorway, up to 3000 at the same density
    place       the sample's map imported from its file, with nothing kept from before; where the ways of its vehicles run
                close to each other
    scene       one update of the sample's vehicles in the 3D picture, which at 60 Hz has 16.7 ms for everything

Medians of several repeats, but for the parts of a tick, which are means; machine and versions stand beside the figures.
"""

import multiprocessing
import os
import platform
import statistics
import time
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from studio import job
from studio.conventions import DEFAULT_STEP, DEFAULT_TICK
from studio.crowd import equipped, motorway_crowd, town_crowd, traffic_crowd
from studio.errors import Problem, ServerError
from studio.execution.simulation import Simulation, simulation
from studio.road.assembly.plan import Wish
from studio.road.library.place import imported
from studio.road.library.reader import reader_of
from studio.road.ways.meeting import made
from studio.road.ways.strand import drawn
from studio.scenario import catalogue
from studio.scene import pose
from studio.scene.fleet import Look
from studio.scene.projection import Scene
from studio.source import code_version
from studio.vehicle import fleet
from studio.vehicle.command import RING, U_DRIVE, U_STEER
from studio.vehicle.fleet import Fleet, Start
from studio.world.build import build
from studio.world.channel import CHANNELS
from studio.world.passes import census, notice
from studio.world.setting import Setting
from studio.world.tick import (
    act,
    applications,
    collide,
    communicate,
    dispatch,
    environment,
    gather,
    look,
    move,
    recirculate,
    sense,
    think,
    tick,
)  # fmt: skip

FLEETS = (1, 8, 100, 1000, 10_000)
CROWDS = (25, 100, 300, 1000)
TOWN = 100  # cars
TRAFFIC = (300, 1000, 2000, 3000)  # cars
MEASURED, LEAST_TICKS, MOST_TICKS = 20_000, 10, 60  # vehicle ticks that one repeat takes; ticks at least and at most
WARM = 100  # ticks before the first repeat: until then everything that is compiled has been loaded, and the first car brakes
OFTEN = 25  # repeats of an advance, which are short
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


def whole_tick(sample: Setting) -> float:
    """Vehicle ticks a second on one core in a scenario."""
    world = build([sample])
    return rate(lambda: tick(world), world.size)


# -- the whole advance -----------------------------------------------------------------------------


def advance(setting: Setting) -> dict[str, Any]:
    """Vehicle ticks a second of the whole advance, its cost over that of the integration alone, and what each part costs.

    `parts` are shares of the integration's cost. Both are measured in turn, so that a machine that is busy is so for both.
    """
    running, count = simulation(setting), len(setting.cars)
    ticks = min(max(MEASURED // count, LEAST_TICKS), MOST_TICKS)
    touch_memory(running, WARM + (OFTEN + 2) * ticks)
    running.advance(WARM)
    whole, alone = [], []
    for _ in range(OFTEN):
        whole.append(seconds(lambda: running.advance(ticks)))
        alone.append(seconds(integration(running, ticks)))
    one = statistics.median(alone) / ticks
    return {
        "rate": count * ticks / statistics.median(whole),
        "ratio": statistics.median(a / b for a, b in zip(whole, alone, strict=True)),
        "parts": {name: spent / one for name, spent in parts(running, ticks).items()},
    }


def touch_memory(running: Simulation, ticks: int) -> None:
    """Uses as much memory as will be recorded, and gives it back: what a machine hands out for the first time it hands out slowly."""
    np.ones((ticks, len(CHANNELS), running.recorder.columns.size))


@contextmanager
def one_core_only() -> Generator[None]:
    """Keeps this process on one core, where the system can."""
    allowed = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else None
    if allowed:
        os.sched_setaffinity(0, {max(allowed)})
    yield
    if allowed:
        os.sched_setaffinity(0, allowed)


def repeated(action: Callable[[], Any], times: int) -> None:
    """Some action several times."""
    for _ in range(times):
        action()


def integration(running: Simulation, ticks: int) -> Callable[[], None]:
    """The motion of a run's vehicles for some ticks with the commands of now, on a copy of them."""
    world, clock = running.world, running.world.clock
    alone = replace(world.vehicles, state=world.vehicles.state.copy(), wheels=world.vehicles.wheels.copy())
    return lambda: repeated(lambda: fleet.integrate(alone, clock.k, clock.tick, clock.step), ticks)


def parts(running: Simulation, ticks: int) -> dict[str, float]:
    """Seconds that each part of a tick takes: means over some ticks, as there is more to do at some of them than at others."""
    spent: dict[str, list[float]] = {}
    for _, action in parts_of_tick(running):  # at the first tick parts by themselves get their arrays
        action()
    for _ in range(ticks):
        for name, action in parts_of_tick(running):
            spent.setdefault(name, []).append(seconds(action))
    return {name: statistics.fmean(each) for name, each in spent.items()}


def parts_of_tick(running: Simulation) -> Iterator[tuple[str, Callable[[], Any]]]:
    """One tick of a run, part by part."""
    world, clock = running.world, running.world.clock
    meeting = (environment, gather, look, think, sense, communicate, applications, dispatch, act)
    yield from ((part.__name__, partial(part, world)) for part in meeting)
    yield "record", lambda: running.recorder.take(world, clock.k)
    yield from ((part.__name__, partial(part, world)) for part in (move, collide, recirculate))
    clock.k += 1
    yield "check", running.check
    yield "report", lambda: notice.notice(world, running.watch)
    yield "count", lambda: census.take(world, running.census)


def seconds(action: Callable[[], Any]) -> float:
    """Processor time that something takes; what else runs on the machine does not count."""
    began = time.thread_time()
    action()
    return time.thread_time() - began


# -- a place and its picture -----------------------------------------------------------------------


def whole_import(path: Path) -> float:
    """Seconds from a map file to its roads, signals and scenery."""
    reader = reader_of(path)
    part, data = reader.part(path, Wish(None, None, False, ())), reader.read(path)
    return median_seconds(lambda: imported(path, reader, data, part, "", lambda text: None))


def conflicts(sample: Setting) -> float:
    """Seconds to draw all lanes and ways of the map as strands, and to find where they meet."""
    return median_seconds(lambda: (drawn(sample.network), made(sample.network)))


def picture(sample: Setting) -> float:
    """Seconds to move all vehicles once in the 3D picture, without anybody who looks at it."""
    scene = Scene()
    try:
        scene.show_vehicles([Look(car.name, car.colour) for car in sample.cars])
        poses = pose.standing(len(sample.cars))
        return median_seconds(lambda: scene.update(moved(poses)))
    finally:
        scene.stop()


def moved(poses: np.ndarray) -> np.ndarray:
    """The poses, 0.1 m further."""
    poses[pose.X] += 0.1
    return poses


def median_seconds(action: Callable[[], Any]) -> float:
    """What an action takes [s]: the median of its repeats."""
    return 1.0 / rate(action, 1)


def all_cores(count: int = 1000) -> float:
    """Vehicle steps a second of as many processes as there are cores, each with a fleet of its own."""
    cores = os.cpu_count() or 1
    with multiprocessing.get_context("spawn").Pool(cores) as pool:
        return sum(pool.map(dynamics, [count] * cores, chunksize=1))


def run(sample: Path, town: Path, progress: Callable[[float], None] = lambda share: None) -> dict[str, Any]:
    """All figures, with the machine and the versions; `town` is the map of a town."""
    one_core = {}
    for i, count in enumerate(FLEETS):
        one_core[str(count)] = dynamics(count)
        progress((i + 1) / (len(FLEETS) + 3))
    loaded = job.load(sample)
    prepared = job.prepare(loaded)
    tick_rate = whole_tick(prepared)
    progress(1 - 2 / (len(FLEETS) + 3))
    place = {"import": whole_import(loaded.path.parent / loaded.scenario.map.file), "conflicts": conflicts(prepared)}
    scene = {"update": picture(prepared)}
    progress(1 - 1 / (len(FLEETS) + 3))
    with one_core_only():
        crowds = {str(count): advance(motorway_crowd(count)) for count in CROWDS}
        full = {str(count): advance(motorway_crowd(count, equipped)) for count in CROWDS}
    return {
        "machine": machine(),
        "versions": versions(),
        "unit": {
            "dynamics": "vehicle steps/s",
            "tick": "vehicle ticks/s",
            "rate": "vehicle ticks/s",
            "ratio": "1",
            "place": "s",
            "scene": "s",
        },
        "dynamics": {"one_core": one_core, "all_cores": all_cores()},
        "tick": {"one_core": tick_rate},
        "advance": {"one_core": crowds},
        "equipped": {"one_core": full},
        "town": {"one_core": {str(TOWN): advance(town_crowd(town, TOWN))}},
        "place": place,
        "scene": scene,
    }


def run_traffic(progress: Callable[[float], None] = lambda share: None) -> dict[str, Any]:
    """What traffic costs with full and with light dynamics, on one core; `real_time` is how many times faster than real time it is.

    `prepared` is the processor time that it takes to prepare them.
    """
    found: dict[str, dict[str, Any]] = {"light": {}, "full": {}}
    with one_core_only():
        for i, (dynamics, count) in enumerate((dynamics, count) for dynamics in found for count in TRAFFIC):
            began = time.process_time()
            crowd = traffic_crowd(count, dynamics)
            prepared = time.process_time() - began
            each = advance(crowd)
            found[dynamics][str(count)] = each | {"real_time": each["rate"] * DEFAULT_TICK / count, "prepared": prepared}
            progress((i + 1) / (2 * len(TRAFFIC)))
    unit = {"rate": "vehicle ticks/s", "ratio": "1", "real_time": "1", "prepared": "s"}
    return {"machine": machine(), "versions": versions(), "unit": unit, "dynamics": {}, "traffic": found}


def run_device(progress: Callable[[float], None] = lambda share: None) -> dict[str, Any]:
    """Vehicle steps a second on a GPU, and how far its result is from the CPU's; raises ServerError when there is none."""
    try:
        from studio.vehicle import cuda
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
    from studio.vehicle import cuda

    device = cuda.Device(cars(count))

    def launch() -> None:
        device.integrate(0, DEFAULT_TICK, DEFAULT_STEP, ticks=ticks)
        device.synchronize()

    return rate(launch, count * STEPS * ticks)


def device_difference(count: int = 1000, seconds: float = 10.0) -> float:
    """Largest distance [m] between the places of a car on GPU and CPU after a drive."""
    from studio.vehicle import cuda

    here, there = cars(count), cars(count)
    device = cuda.Device(there)
    for k in range(round(seconds / DEFAULT_TICK)):
        fleet.integrate(here, k, DEFAULT_TICK, DEFAULT_STEP)
        device.integrate(k, DEFAULT_TICK, DEFAULT_STEP)
    device.fetch(there)
    return float(np.hypot(*(here.state[:2] - there.state[:2])).max())


def versions() -> dict[str, str]:
    """Of everything that makes the machine code."""
    return {"studio": code_version(), "python": platform.python_version(), "numba": version("numba")}


def machine() -> str:
    """Processor and number of cores."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        name = next(line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        name = platform.processor() or platform.machine()
    return f"{name}, {os.cpu_count()} cores"
