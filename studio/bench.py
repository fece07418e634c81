"""Benchmark: how many vehicle steps and ticks a second this machine does.

    dynamics    one vehicle step is one integration step (5 ms) of one car, three passes, nothing else
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
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from studio import job
from studio.conventions import DEFAULT_STEP, DEFAULT_TICK
from studio.scenario.schema import Driver, FrontSensor
from studio.world import motion
from studio.world.build import build, tyres_of, vehicles_of
from studio.world.setting import Car
from studio.world.tick import tick

FLEETS = (1, 8, 100, 1000, 10_000)
REPEATS = 5
SPAN = 0.2  # [s] of real time that one repeat takes at least
MODEL = "bmw_320i"
STEPS = round(DEFAULT_TICK / DEFAULT_STEP)


@dataclass(frozen=True)
class Straight:
    """A path that is only a straight line, for cars that nobody steers."""

    points: np.ndarray


def fleet(count: int):
    """`count` cars side by side at 20 m/s with steering commands of their own: arrays of `integrate`, in its order."""
    line = np.zeros((5, 2))
    line[0] = [0.0, 1.0]
    cars = [Car(f"car_{i}", MODEL, Straight(line), 0.0, 20.0, Driver(), FrontSensor(range=0.0), "#ffffff") for i in range(count)]
    v = vehicles_of(cars)
    v.commands[1] = np.tile(np.linspace(-0.02, 0.02, count), v.commands.shape[1] // count)
    tyres, tyre_of, _ = tyres_of(cars)
    return v.state, v.parameter, tyres, tyre_of, v.wheels, v.contact, v.commands


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
    arrays = fleet(count)
    return rate(lambda: motion.integrate(*arrays, 0, DEFAULT_TICK, DEFAULT_STEP), count * STEPS)


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
        "versions": {"studio": job.code_version(), "python": platform.python_version(), "numba": version("numba")},
        "unit": {"dynamics": "vehicle steps/s", "tick": "vehicle ticks/s"},
        "dynamics": {"one_core": one_core, "all_cores": all_cores()},
        "tick": {"one_core": tick_rate},
    }


def machine() -> str:
    """Processor and number of cores."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        name = next(line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        name = platform.processor() or platform.machine()
    return f"{name}, {os.cpu_count()} cores"
