"""How fast a long platoon is: 100 cars on CACC, 120 s, everything recorded, the application compiled and as plain Python.

uv run python tools/platoon_speed.py [--cars 100] [--seconds 120] [--profile]

Every car has the full model and a radar, and hears the car ahead ten times a second. The plain application is the same file without
its compilation. Wall and processor time of the simulation with its record on one core, building and compiling not counted; machine,
versions and load stand beside the figures. With --profile: what the parts of the plain one cost.
"""

import argparse
import cProfile
import json
import os
import pstats
import re
import tempfile
import time
from pathlib import Path

from docs.figures.convoy import SATELLITES, convoy
from studio import bench, job
from studio.execution.loop import as_fast_as_possible
from studio.execution.simulation import Simulation, simulation
from studio.kind import registry
from studio.kinds.application import cacc
from studio.road.drawn.motorway import motorway

SPEED, GAP, PERIOD = 25.0, 17.0, 0.1  # [m/s], [m], [s]
PLAIN = "cacc_plain"


def plain(folder: Path) -> None:
    """The same application without compilation of its own, as a file of a user: what it calls of others stays as it is."""
    text = Path(cacc.__file__).read_text(encoding="utf-8")
    (folder / f"{PLAIN}.py").write_text(re.sub(r"^@compiled\n", "", text, flags=re.MULTILINE), encoding="utf-8")
    registry.load_folder(folder)


def platoon(folder: Path, application: str, cars: int, seconds: float) -> Simulation:
    """A leader that swings once in ten seconds by 3 m/s, and all others behind it."""
    points = [[0.5 * i, round(SPEED + 3.0 * (i // 10 % 2), 3)] for i in range(int(2.0 * seconds) + 1)]
    document = convoy(application, points, gap=GAP, cars=cars, noisy=True, period=PERIOD)
    document["vehicles"] = {name: car | {"gps": SATELLITES} for name, car in document["vehicles"].items()}
    document["map"] = {"file": "motorway.xodr"}
    length = cars * (GAP + 5.0) + 35.0 * seconds + 1000.0
    (folder / "motorway.xodr").write_text(motorway(length=length, lanes=2, radius=20_000.0), encoding="utf-8")
    path = folder / f"{application}.yaml"
    path.write_text(json.dumps(document), encoding="utf-8")
    return simulation(job.prepare(job.load(path)))


def measured(running: Simulation, profile: bool) -> tuple[float, float]:
    """Wall and processor time [s] of a run to its end; the first second, in which things are compiled, is not counted."""
    running.advance(50)
    watch = cProfile.Profile()
    wall, own = time.perf_counter(), time.process_time()
    if profile:
        watch.runcall(as_fast_as_possible, running)
        pstats.Stats(watch).sort_stats("tottime").print_stats(15)
    else:
        as_fast_as_possible(running)
    assert running.cases[0].status == "done", running.cases[0].error
    return time.perf_counter() - wall, time.process_time() - own


def main() -> None:
    """Measures both, and prints them."""
    asked = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    asked.add_argument("--cars", type=int, default=100)
    asked.add_argument("--seconds", type=float, default=120.0)
    asked.add_argument("--profile", action="store_true")
    given = asked.parse_args()
    with tempfile.TemporaryDirectory() as name, bench.one_core_only():
        folder = Path(name)
        plain(folder)
        for application in ("cacc", PLAIN):
            wall, own = measured(platoon(folder, application, given.cars, given.seconds), given.profile and application == PLAIN)
            times = f"{given.seconds / wall:.1f} times real time by the clock, {given.seconds / own:.1f} by processor time"
            print(f"{application}: {given.cars} cars, {given.seconds:g} s, {wall:.1f} s wall, {own:.1f} s processor: {times}", flush=True)
    print(f"{bench.machine()}; {bench.versions()}; load {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main()
