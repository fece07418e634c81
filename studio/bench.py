"""Benchmark: how many vehicle steps and ticks a second this machine does.

    dynamics    one vehicle step is one integration step (5 ms) of one car with the whole model, nothing else
    tick        one vehicle tick is one tick (20 ms, four steps) of one car in the whole world: lights, drivers, sensors,
                radio, applications, integration, collisions

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
from studio.scenario import catalogue
from studio.vehicle import fleet
from studio.vehicle.command import RING, U_DRIVE, U_STEER
from studio.vehicle.fleet import Fleet, Start
from studio.world.build import build
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


def whole_tick(sample: Path) -> float:
    """Vehicle ticks a second on one core in a scenario."""
    world = build([job.prepare(job.load(sample))])
    return rate(lambda: tick(world), world.size)


def all_cores(count: int = 1000) -> float:
    """Vehicle steps a second of as many processes as there are cores, each with a fleet of its own."""
    cores = os.cpu_count() or 1
    with multiprocessing.get_context("spawn").Pool(cores) as pool:
        return sum(pool.map(dynamics, [count] * cores, chunksize=1))


def run(sample: Path, progress: Callable[[float], None] = lambda share: None) -> dict[str, Any]:
    """All figures, with the machine and the versions."""
    one_core = {}
    for i, count in enumerate(FLEETS):
        one_core[str(count)] = dynamics(count)
        progress((i + 1) / (len(FLEETS) + 2))
    tick_rate = whole_tick(sample)
    progress(1 - 1 / (len(FLEETS) + 2))
    return {
        "machine": machine(),
        "versions": versions(),
        "unit": {"dynamics": "vehicle steps/s", "tick": "vehicle ticks/s"},
        "dynamics": {"one_core": one_core, "all_cores": all_cores()},
        "tick": {"one_core": tick_rate},
    }


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
    return {"studio": job.code_version(), "python": platform.python_version(), "numba": version("numba")}


def machine() -> str:
    """Processor and number of cores."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        name = next(line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        name = platform.processor() or platform.machine()
    return f"{name}, {os.cpu_count()} cores"
