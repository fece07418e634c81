"""Drives whose truth is known: our own vehicle with changed parameters, driven by somebody who never does it twice alike, and recorded by
instruments with noise, steps, an offset and a delay of known sizes."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import yaml

from studio.rig import side
from studio.rig.side import Order
from studio.scenario import catalogue

CAR = "bmw_320i"
TRUE = {"tyres.front_cornering": 0.85, "tyres.rear_cornering": 1.1, "body.yaw_inertia": 2100.0}
NOISE = {"vx_mps": 0.02, "yaw_rate_radps": 0.003, "ay_mps2": 0.05, "ax_mps2": 0.05}
STEPS = {"vx_mps": 0.01, "yaw_rate_radps": 0.001, "ay_mps2": 0.01, "ax_mps2": 0.01}
NAMES = {"speed": "vx_mps", "yaw_rate": "yaw_rate_radps", "lateral_acceleration": "ay_mps2", "acceleration": "ax_mps2"}
PERIOD = 0.01


@dataclass(frozen=True)
class Instrument:
    """What is wrong with the yaw rate sensor: offset [rad/s], delay [s], sign. The mapping knows it, or does not."""

    offset: float = 0.01
    delay: float = 0.03
    sign: int = -1
    is_known: bool = True

    @property
    def source(self) -> dict:
        """Its line in a mapping."""
        known = {"sign": self.sign, "offset": self.offset, "delay": self.delay} if self.is_known else {}
        return {"from": "yaw_rate_radps", "unit": "rad/s"} | known


@dataclass
class Ground:
    """A folder with logs, a mapping, and a project about them."""

    folder: Path
    instrument: Instrument = field(default_factory=Instrument)
    maneuvers: dict = field(default_factory=dict)

    def drive(self, name: str, kind: str, inputs: list[dict], *, calibrates: int = 0, changes: dict | None = None, seed: int = 0) -> None:
        """Drives, records, and adds the runs to the project: the first ones to calibrate with."""
        model = catalogue.find_vehicle(CAR, TRUE if changes is None else changes)
        orders = [Order(model, {key: row for key, row in each.items() if key != "start"}, start_of(each)) for each in inputs]
        made = side.together(orders, step=0.005, period=PERIOD)
        random = np.random.default_rng(seed)
        runs = [{"log": f"{name}_{i}.csv"} for i in range(len(made))]
        for run, given, each in zip(runs, inputs, made, strict=True):
            self.record(self.folder / run["log"], given, each.columns, random)
        self.maneuvers[name] = {"kind": kind, "calibration": runs[:calibrates], "validation": runs[calibrates:]}

    def record(self, path: Path, given: dict, columns: dict, random) -> None:
        """Writes a log as the instruments see it."""
        time, known = columns["time_s"], self.instrument
        seen = dict(columns)
        seen["yaw_rate_radps"] = known.sign * np.interp(time - known.delay, time, columns["yaw_rate_radps"]) + known.offset
        shown = {name: np.round((seen[name] + random.normal(0, NOISE[name], time.size)) / STEPS[name]) * STEPS[name] for name in NOISE}
        fed = {
            name: np.interp(time, given["time_s"], values) for name, values in given.items() if name not in ("time_s", "speed_mps", "start")
        }
        rows = {"time_s": time} | shown | fed
        lines = [",".join(rows), *(",".join(f"{value:.9g}" for value in row) for row in zip(*rows.values(), strict=True))]
        path.write_text("\n".join(lines), encoding="utf-8")

    def project(self, **more) -> Path:
        """Writes the project."""
        fed = {"road_wheel_angle": "road_wheel_angle_rad", "brake_torque": "brake_torque_Nm"}
        signals = {name: {"from": column} for name, column in NAMES.items()} | {"yaw_rate": self.instrument.source}
        kinds = {each["kind"] for each in self.maneuvers.values()}
        wanted = {"braked_coasting": "brake_torque"}
        signals |= {name: {"from": fed[name]} for kind in kinds for name in [wanted.get(kind, "road_wheel_angle")]}
        (self.folder / "mapping.yaml").write_text(yaml.safe_dump({"signals": signals}), encoding="utf-8")
        document = {"title": "Known truth", "vehicle": CAR, "mapping": "mapping.yaml", "maneuvers": self.maneuvers} | more
        path = self.folder / "project.yaml"
        path.write_text(yaml.safe_dump(document, sort_keys=False), encoding="utf-8")
        return path


def start_of(inputs: dict) -> float:
    """Speed at the start [m/s]: that which is held, or `start`."""
    return float(inputs.get("speed_mps", inputs.get("start"))[0])


def j_turns(count: int, seed: int = 1, speed: float = 20.0, angle: float = 0.03) -> list[dict]:
    """A wheel that is turned within a tenth of a second and held, never quite alike."""
    random = np.random.default_rng(seed)
    time = np.arange(0.0, 5.0, PERIOD)
    return [
        {
            "time_s": time,
            "speed_mps": np.full(time.size, speed * random.uniform(0.98, 1.02)),
            "road_wheel_angle_rad": angle * random.uniform(0.95, 1.05) * np.clip((time - random.uniform(0.9, 1.1)) / 0.12, 0.0, 1.0),
        }
        for _ in range(count)
    ]


def lane_changes(count: int, seed: int = 2, speed: float = 13.9, angle: float = 0.035) -> list[dict]:
    """Out and back: a sine, and its opposite."""
    random = np.random.default_rng(seed)
    time = np.arange(0.0, 8.0, PERIOD)
    found = []
    for _ in range(count):
        out, back = random.uniform(1.8, 2.2, 2)
        begin, again = random.uniform(0.9, 1.1), random.uniform(3.9, 4.2)
        first = np.where((time > begin) & (time < begin + out), np.sin(2 * np.pi * (time - begin) / out), 0.0)
        second = np.where((time > again) & (time < again + back), -np.sin(2 * np.pi * (time - again) / back), 0.0)
        wheel = angle * random.uniform(0.95, 1.05) * (first + random.uniform(0.95, 1.05) * second)
        found.append({"time_s": time, "speed_mps": np.full(time.size, speed * random.uniform(0.98, 1.02)), "road_wheel_angle_rad": wheel})
    return found


def stops(count: int, seed: int = 3, speed: float = 14.0, torque: float = 800.0) -> list[dict]:
    """Rolling in neutral with the brake held."""
    random = np.random.default_rng(seed)
    time = np.arange(0.0, 4.0, PERIOD)
    return [
        {
            "time_s": time,
            "start": np.array([speed * random.uniform(0.98, 1.02)]),
            "brake_torque_Nm": np.full(time.size, torque * random.uniform(0.95, 1.05)),
        }
        for _ in range(count)
    ]
