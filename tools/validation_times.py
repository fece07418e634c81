"""How long a validation of sixty runs takes, and a step of calibration that looks for five parameters.

    uv run python tools/validation_times.py

Drives are those of the sample, with ten more of them to calibrate with, made in a folder that goes again. Reported are wall and processor
time of the second pass: the first one compiles.
"""

import argparse
import os
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import yaml

from studio.log import recording
from studio.log.recording import PERIOD
from studio.rig import side
from studio.scenario import catalogue
from studio.validation import calibration, judge, sample
from studio.validation.project import Loaded, load

RUNS, CALIBRATE = 60, 10
FIVE = {
    "tyres.front_cornering": {"low": 0.5, "high": 1.5},
    "tyres.rear_cornering": {"low": 0.5, "high": 1.5},
    "body.yaw_inertia": {"low": 1200.0, "high": 2600.0, "prior": 1790.0, "spread": 150.0},
    "body.mass": {"low": 900.0, "high": 1300.0, "prior": 1093.0, "spread": 20.0},
    "body.gravity_height": {"low": 0.4, "high": 0.75, "prior": 0.56, "spread": 0.03},
}


def made(folder: Path) -> Loaded:
    """The project, its logs written and read."""
    model = catalogue.find_vehicle(sample.CAR, {sample.WORN: sample.TRUTH})
    orders = [sample.order(model, np.random.default_rng(i)) for i in range(RUNS + CALIBRATE)]
    for i, outcome in enumerate(side.together(orders, step=0.005, period=PERIOD)):
        seen = sample.recorded(orders[i], outcome.columns, np.random.default_rng(1000 + i))
        recording.write(seen, folder / f"turn_{i}.csv")
    runs = [{"log": f"turn_{i}.csv"} for i in range(RUNS + CALIBRATE)]
    trial = {"kind": "j_turn", "calibration": runs[:CALIBRATE], "validation": runs[CALIBRATE:]}
    document = {"title": "Times", "vehicle": sample.CAR, "maneuvers": {"turn": trial}, "calibration": {"five": {"parameters": FIVE}}}
    (folder / "project.yaml").write_text(yaml.safe_dump(document), encoding="utf-8")
    return load(folder / "project.yaml")


def timed(what: str, action) -> None:
    """Does it twice, and tells how long the second time took."""
    action()
    wall, processor = time.perf_counter(), time.process_time()
    action()
    print(f"{what}: {time.perf_counter() - wall:.1f} s, processor {time.process_time() - processor:.1f} s", flush=True)


def main() -> int:
    """Measures."""
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    load_before = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as folder:
        loaded = made(Path(folder))
        timed(f"reading the logs of {RUNS + CALIBRATE} runs", lambda: load(loaded.path))
        timed(f"validation of {RUNS} runs", lambda: judge.validate(loaded))
        timed(f"calibration of {len(FIVE)} parameters with {CALIBRATE} runs", lambda: calibration.calibrate(loaded, "five"))
    print(f"{os.cpu_count()} cores, load {load_before:.1f} before and {os.getloadavg()[0]:.1f} after")
    return 0


if __name__ == "__main__":
    sys.exit(main())
