"""How long the studio takes to start: medians of a few starts each, in wall time and in processor time.

    python tools/start_times.py            everything
    python tools/start_times.py --cold     also the compilation of everything, from an empty cache

Processor time tells how long it would take on a machine that has nothing else to do. Bytecode is kept, as for any user.
"""

import argparse
import json
import os
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.request
from pathlib import Path

SAMPLE = Path(__file__).resolve().parent.parent / "scenarios" / "grosser_stern_platoon.yaml"
STUDIO = [sys.executable, "-m", "studio.cli"]
BUDGET = {"runs": 0.5, "--version": 0.5, "schema": 0.5, "run, outside the simulation": 1.5, "compile, nothing kept": 60.0}  # [s]
REPEATS = 5


def spent() -> float:
    """Processor time of all programs that were started and have ended [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def start(words: list[str], folder: Path, **environment: str) -> tuple[float, float, str]:
    """Wall time, processor time [s] and output of a program."""
    began, used = time.perf_counter(), spent()
    done = subprocess.run(words, cwd=folder, env=environment_with(**environment), capture_output=True, text=True, check=True)
    return time.perf_counter() - began, spent() - used, done.stdout


def environment_with(**more: str) -> dict[str, str]:
    """The environment of a user: bytecode is kept."""
    return {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"} | more


def run_outside(folder: Path) -> tuple[float, float]:
    """A run of the sample: its wall time without the simulation, and the processor time of a run of two ticks."""
    wall, _, output = start([*STUDIO, "run", str(SAMPLE), "--json"], folder)
    _, used, _ = start([*STUDIO, "run", str(SAMPLE), "--set", "clock.duration=0.04"], folder)
    return wall - json.loads(output)["wall_time_s"], used


def server(folder: Path) -> tuple[float, float]:
    """Wall time from the start until the first page, and until the first answer of REST [s]."""
    began = time.perf_counter()
    command = [*STUDIO, "--port", "0", "--no-browser"]
    process = subprocess.Popen(command, cwd=folder, env=environment_with(), stdout=subprocess.PIPE, text=True)
    try:
        address = re.search(r"http://\S+", process.stdout.readline()).group()
        times = []
        for path in ("/", "/api/scenarios"):
            urllib.request.urlopen(address + path).read()
            times.append(time.perf_counter() - began)
        return times[0], times[1]
    finally:
        process.terminate()
        process.wait()


def row(what: str, pairs: list[tuple[float, float]]) -> None:
    """A line: medians, and what they should stay under."""
    wall, used = (statistics.median(column) for column in zip(*pairs, strict=True))
    print(f"{what:32} {wall:8.2f} {used:8.2f} {BUDGET.get(what, ''):>8}", flush=True)


def main() -> None:
    """The table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cold", action="store_true", help="also compile everything from an empty cache")
    cold = parser.parse_args().cold
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        print(f"{'medians [s]':32} {'wall':>8} {'cpu':>8} {'budget':>8}")
        start([*STUDIO, "run", str(SAMPLE)], folder)  # now everything is warm, and there is a run
        row("import studio", [start([sys.executable, "-c", "import studio"], folder)[:2] for _ in range(REPEATS)])
        for words in ("runs", "--version", "schema", "--help"):
            row(words, [start([*STUDIO, words], folder)[:2] for _ in range(REPEATS)])
        row("run, outside the simulation", [run_outside(folder) for _ in range(REPEATS)])
        pages = [server(folder) for _ in range(REPEATS)]
        print(f"{'server, first page':32} {statistics.median(page for page, _ in pages):8.2f}")
        print(f"{'server, first answer of REST':32} {statistics.median(answer for _, answer in pages):8.2f}")
        if cold:
            row("compile, nothing kept", [start([*STUDIO, "compile"], folder, STUDIO_CACHE=str(folder / "cache"))[:2]])


if __name__ == "__main__":
    main()
