"""Another program's cars as if they were recorded: the runs of the multi-body model (tests/multibody.py), each several times.

A run is computed once; what differs from recording to recording are the instruments: on each day they show a little more or less
(SCATTER) and a little earlier or later (JITTER), of which the intervals of the experiments come, and they have noise, steps, an offset and
a delay of known sizes. The days of a set cancel: its mean is theirs, so that whether it is met hangs on the car and not on the draw. Their
axes are SAE-like, so the mapping turns the signs; of lane changes theirs with the wheels' own velocities count (tests/multibody.py says
why); an instrument that nobody knows about is one whose mapping says nothing of it.
"""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import yaml

from studio.scenario import catalogue
from tests import multibody

FREE = {"air.drag_coefficient": 0.0, "wheels.rolling_resistance": 0.0}  # theirs has neither
UNITS = {"road_wheel_angle": "rad", "speed": "m/s", "yaw_rate": "rad/s", "lateral_acceleration": "m/s²", "acceleration": "m/s²"}
COLUMNS = {
    "road_wheel_angle": "delta_rad",
    "speed": "vx_mps",
    "yaw_rate": "yaw_rate_rps",
    "lateral_acceleration": "ay_mps2",
    "acceleration": "ax_mps2",
}
FED = ("road_wheel_angle", "speed")
SIDEWAYS = ("road_wheel_angle", "yaw_rate", "lateral_acceleration")
NOISE = {"road_wheel_angle": 2e-5, "speed": 0.02, "yaw_rate": 0.002, "lateral_acceleration": 0.05, "acceleration": 0.05}
STEPS = {"road_wheel_angle": 1e-5, "speed": 0.01, "yaw_rate": 0.001, "lateral_acceleration": 0.01, "acceleration": 0.01}
SCATTER = 0.03  # [1] standard deviation of what an instrument shows more or less on a day
JITTER = 0.012  # [s] the same of when
OFFSET, DELAY = 0.02, 0.04  # [rad/s], [s] of the yaw rate


@dataclass
class Bench:
    """A folder with logs of one car, a mapping, and a project about them."""

    folder: Path
    car: str
    offset: float = OFFSET
    delay: float = DELAY
    maneuvers: dict = field(default_factory=dict)

    def record(self, name: str, kind: str, run: str, count: int, *, calibrates: int = 0, seed: int = 0) -> None:
        """A run of theirs, recorded so often: the first ones to calibrate with."""
        random = np.random.default_rng(seed)
        found = next(each for each in multibody.runs() if each.name == f"{self.car}_sym_{run}")
        logs = [{"log": f"{name}_{i}.csv"} for i in range(count)]
        days = np.concatenate([cancelling(random, each) for each in (calibrates, count - calibrates)])
        for each, day in zip(logs, days, strict=True):
            self.write(self.folder / each["log"], found, day, random)
        self.maneuvers[name] = {"kind": kind, "calibration": logs[:calibrates], "validation": logs[calibrates:]}

    def write(self, path: Path, run: multibody.Run, day: np.ndarray, random) -> None:
        """One recording, on a day with its own scatter of yaw rate and accelerations, and jitter."""
        time, answer = run.inputs["t_s"], sideways(run)
        rows = {"time [s]": time}
        more = dict(zip(("yaw_rate", "lateral_acceleration", "acceleration"), 1.0 + SCATTER * day, strict=False))
        for name, column in COLUMNS.items():
            late = JITTER * day[3] * (name not in FED) + self.delay * (name == "yaw_rate")
            true = np.interp(time - late, time, answer.get(name, run.inputs[column])) * more.get(name, 1.0)
            shown = true + self.offset * (name == "yaw_rate") + random.normal(0.0, NOISE[name], time.size)
            rows[f"{name} [{UNITS[name]}]"] = np.round(shown / STEPS[name]) * STEPS[name]
        torque = -np.minimum(run.inputs["u_acc_mps2"], 0.0) * pulled(self.car)
        rows["brake_torque [Nm]"] = torque if run.maneuver == "long" else np.zeros(time.size)
        lines = [",".join(rows), *(",".join(f"{value:.9g}" for value in row) for row in zip(*rows.values(), strict=True))]
        path.write_text("\n".join(lines), encoding="utf-8")

    def project(self, title: str = "Another program's car", *, known: bool = True, turned: bool = True, **more) -> Path:
        """Writes the project; `known`: offset and delay of the yaw rate are; `turned`: its sign is."""
        signals = {name: {"from": name, "unit": unit} for name, unit in UNITS.items()} | {
            "brake_torque": {"from": "brake_torque", "unit": "Nm"}
        }
        for name in SIDEWAYS:
            signals[name]["sign"] = -1
        if not turned:
            signals["yaw_rate"]["sign"] = 1
        signals["yaw_rate"] |= {"offset": self.offset, "delay": self.delay} if known else {}
        (self.folder / "mapping.yaml").write_text(yaml.safe_dump({"signals": signals}), encoding="utf-8")
        document = {"title": title, "vehicle": self.car, "mapping": "mapping.yaml", "changes": FREE, "maneuvers": self.maneuvers} | more
        path = self.folder / "project.yaml"
        path.write_text(yaml.safe_dump(document, sort_keys=False), encoding="utf-8")
        return path


def cancelling(random, count: int) -> np.ndarray:
    """What is different on each day, [day, instrument]: means 0, standard deviations 1."""
    drawn = random.normal(size=(count, 4))
    return (drawn - drawn.mean(axis=0)) / drawn.std(axis=0, ddof=1) if count > 1 else np.zeros((count, 4))


def sideways(run: multibody.Run) -> dict[str, np.ndarray]:
    """Their answer to a lane change, in which the wheels have velocities of their own."""
    if run.maneuver != "dlc":
        return {}
    made = multibody.consistent(run).columns
    return {"yaw_rate": made["r"], "lateral_acceleration": made["a_y"]}


def pulled(car: str) -> float:
    """Wheel torque per acceleration that was asked for, m R [Nm s²/m]: how theirs turns it into one."""
    values = catalogue.find_vehicle(car).values
    return values.body.mass * values.wheels.radius
