"""Drives whose truth is known, to learn with: ten J-turns of a car whose front tyres have 15 % less cornering stiffness than the catalogue.

The wheel is never turned quite alike, speeds differ, and the instruments add noise; the counter of the drive is the seed of both.
"""

from pathlib import Path

import numpy as np
import yaml

from studio.log import recording
from studio.log.recording import PERIOD, Recording
from studio.rig import side
from studio.rig.side import Order
from studio.scenario import catalogue

TITLE = "A car with worn front tyres"
CAR, WORN, TRUTH = "bmw_320i", "tyres.front_cornering", 0.85
RUNS, CALIBRATE = 10, 4
LONG, RISE = 5.0, 0.12  # [s] a drive, and until the wheel is at its angle
ANGLE, SPEED = 0.03, 20.0  # [rad], [m/s]
NOISE = {"speed": ("vx_mps", 0.02), "yaw_rate": ("yaw_rate_radps", 0.003), "lateral_acceleration": ("ay_mps2", 0.05)}


def write(folder: Path, title: str = TITLE) -> None:
    """Writes logs and project into a folder that is there; raises ScenarioError when the disk does not take them."""
    model = catalogue.find_vehicle(CAR, {WORN: TRUTH})
    orders = [order(model, np.random.default_rng(i)) for i in range(RUNS)]
    for i, made in enumerate(side.together(orders, step=0.005, period=PERIOD)):
        recording.write(recorded(orders[i], made.columns, np.random.default_rng(RUNS + i)), folder / f"turn_{i}.csv")
    text = yaml.safe_dump(project(title), sort_keys=False, default_flow_style=None, width=100)
    (folder / "project.yaml").write_text(f"# Ten drives whose truth is known: {WORN} is {TRUTH:g}.\n{text}", encoding="utf-8")


def order(model, random: np.random.Generator) -> Order:
    """A drive: straight on, then the wheel is turned and held."""
    time = np.arange(0.0, LONG, PERIOD)
    wheel = ANGLE * random.uniform(0.95, 1.05) * np.clip((time - random.uniform(0.9, 1.1)) / RISE, 0.0, 1.0)
    speed = SPEED * random.uniform(0.98, 1.02)
    columns = {"time_s": time, "road_wheel_angle_rad": wheel, "speed_mps": np.full(time.size, speed)}
    return Order(model, columns, speed, {})


def recorded(given: Order, made: dict[str, np.ndarray], random: np.random.Generator) -> Recording:
    """What the instruments show of a drive."""
    time = made["time_s"]
    wheel = np.interp(time, given.inputs["time_s"], given.inputs["road_wheel_angle_rad"])
    seen = {name: made[column] + random.normal(0.0, sigma, time.size) for name, (column, sigma) in NOISE.items()}
    return Recording("turn", time, {"road_wheel_angle": wheel} | seen)


def project(title: str) -> dict:
    """The project: four runs calibrate, six validate."""
    runs = [{"log": f"turn_{i}.csv"} for i in range(RUNS)]
    trial = {"kind": "j_turn", "calibration": runs[:CALIBRATE], "validation": runs[CALIBRATE:]}
    lateral = {"parameters": {WORN: {"low": 0.5, "high": 1.5}}}
    return {"title": title, "vehicle": CAR, "maneuvers": {"turn": trial}, "calibration": {"lateral": lateral}}
