"""Recorded drives of others, held against what is known of them.

    uv run python -m tests.drives FOLDER

FOLDER has the drives in folders of their own; most may not be copied into this project, so they lie elsewhere, and what is not there is
told. Each is imported as a user would, and every fact that was found out about it independently must come out. Of comma2k19, which may be
copied, the same is a test (tests/log).
"""

import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml

from studio.log import mapping, reading, recording
from studio.log.smooth import smooth
from studio.scenario.text import source
from studio.validation import calibration, judge
from studio.validation.project import load


@dataclass(frozen=True)
class Fact:
    """What is known of a drive, what came out, and between which bounds it must be."""

    what: str
    value: float
    low: float
    high: float

    @property
    def holds(self) -> bool:
        """Whether it came out."""
        return bool(self.low <= self.value <= self.high)

    def __str__(self) -> str:
        return f"{'ok' if self.holds else 'failed':6}  {self.what}: {self.value:.6g}, from {self.low:g} to {self.high:g}"


def near(what: str, value: float, expected: float, within: float) -> Fact:
    """A fact with a tolerance."""
    return Fact(what, float(value), expected - within, expected + within)


def taken(path: Path, **signals) -> recording.Recording:
    """Our signals of a log, by a mapping that stands in a call."""
    document = yaml.safe_dump({"signals": {name: given if isinstance(given, dict) else {"from": given} for name, given in signals.items()}})
    return recording.of_log(reading.read(path), mapping.of_text(source.read(document, "mapping")))


# -- comma2k19: a motorway, three clocks -----------------------------------------------------------------

CAN, POSE, IMU = "processed_log__CAN__", "global_pose__frame_", "processed_log__IMU__"


def comma2k19(folder: Path) -> Iterator[Fact]:
    """Speeds of satellites, bus and wheels on one clock; the gyroscope's yaw rate against the heading that satellites saw."""
    bus = {"from": f"{CAN}speed", "unit": "m/s"}
    wheels = {"from": [f"{CAN}wheel_speed[{i}]" for i in range(4)], "unit": "m/s"}
    gnss = {"from": [f"{POSE}velocities[{i}]" for i in range(3)], "unit": "m/s", "combine": "norm"}
    made = [taken(folder, speed=each) for each in (bus, wheels, gnss)]
    since, until = max(each.start for each in made), min(each.start + each.time[-1] for each in made)
    clock = np.arange(since, until, 0.01)
    can, wheel, satellite = (np.interp(clock, each.start + each.time, each["speed"]) for each in made)
    yield near("satellites' speed over that of the bus", (satellite / can).mean(), 1.0085, 0.0005)
    yield Fact("scatter of that", float((satellite / can).std()), 0.0, 0.005)
    yield near("wheels' speed over that of satellites", (wheel / satellite).mean(), 0.9916, 0.0005)
    log = reading.read(folder)
    time = log[f"{POSE}velocities[0]"].time
    speed = np.linalg.norm([log[f"{POSE}velocities[{i}]"].values for i in range(3)], axis=0)
    yield near("distance [m]", np.trapezoid(speed, time), 1011.9, 0.5)
    yield near("how much later satellites are than the bus [s]", lag(clock, can, satellite), 0.0, 0.1)
    one = taken(folder, speed=bus, steering_wheel_angle={"from": f"{CAN}steering_angle", "unit": "deg"})
    yield Fact(
        "samples of speed and steering on one clock",
        float(np.isfinite([one["speed"], one["steering_wheel_angle"]]).all(axis=0).sum()),
        5900,
        6100,
    )


def lag(clock: np.ndarray, one: np.ndarray, other: np.ndarray) -> float:
    """By how much a speed comes later than another [s]: where their ratio varies least."""
    shifts = np.arange(-100, 101)
    spreads = [(np.roll(other, -shift) / one)[200:-200].std() for shift in shifts]
    return float(shifts[int(np.argmin(spreads))] * (clock[1] - clock[0]))


# -- stanford_250lm: a track ------------------------------------------------------------------------------


def stanford_250lm(folder: Path) -> Iterator[Fact]:
    """Sideslip is that of the speeds, lateral acceleration that of lateral speed and yaw rate."""
    log = reading.read(folder)
    v_x, v_y, beta = (log[name].values for name in ("vx", "vy", "beta_true"))
    yield Fact("sideslip beside atan(v_y / v_x) [rad]", float(np.abs(np.arctan(v_y / v_x) - beta).max()), 0.0, 5e-9)
    made = taken(
        folder, speed={"from": "vx", "unit": "m/s"}, lateral_speed={"from": "vy", "unit": "m/s"},
        yaw_rate={"from": "yawRate", "unit": "rad/s"}, lateral_acceleration={"from": "ayCG", "unit": "m/s²"},
        road_wheel_angle={"from": ["deltaFL", "deltaFR"], "unit": "rad"},
    )  # fmt: skip
    yield near("length [s]", made.time[-1], 550.0, 5.0)
    shown = smooth(made.time, made["lateral_acceleration"])
    kinematic = np.gradient(smooth(made.time, made["lateral_speed"]), made.time) + made["speed"] * made["yaw_rate"]
    yield near("correlation of a_y with dv_y/dt + v_x r", np.corrcoef(kinematic, shown)[0, 1], 0.998, 0.001)
    yield near("RMS of their difference [m/s²]", np.sqrt(np.mean((kinematic - shown) ** 2)), 0.36, 0.02)


# -- kit_seat_leon: gears -----------------------------------------------------------------------------------

GEARS = (58.5, 37.5, 25.5, 20.5, 16.5)  # [rpm/(km/h)]


def kit_seat_leon(folder: Path) -> Iterator[Fact]:
    """Engine speed over speed gathers at the gears."""
    found = np.concatenate([ratios(reading.read(path)) for path in sorted(folder.glob("*.csv.gz"))])
    count, edges = np.histogram(found, bins=np.arange(10.0, 70.0, 0.5))
    for gear in GEARS:
        around = np.abs(edges[:-1] + 0.25 - gear) < 2.0
        yield near(f"a gear [rpm/(km/h)], near {gear:g}", (edges[:-1] + 0.25)[around][int(count[around].argmax())], gear, 0.76)


def ratios(log) -> np.ndarray:
    """Engine speed over speed [rpm/(km/h)] while neither changes much within half a second."""
    rpm, speed = log["Engine RPM"], log["Vehicle Speed Sensor"]
    time = np.arange(max(rpm.time[0], speed.time[0]), min(rpm.time[-1], speed.time[-1]), 0.1)
    v, n = np.interp(time, speed.time, speed.values), np.interp(time, rpm.time, rpm.values)
    is_steady = np.abs(np.gradient(n / np.maximum(v, 1.0), time)) < 2.0
    return (n / np.maximum(v, 1.0))[is_steady & (v > 10.0) & (n > 900.0)]


# -- bosch_slalom2: a slalom, and our car calibrated to it --------------------------------------------------

SLALOM = {
    "road_wheel_angle": {"from": ["Car.SteerAngleFL", "Car.SteerAngleFR"], "unit": "rad"},
    "speed": {"from": "Car.vx", "unit": "m/s"},
    "yaw_rate": {"from": "Car.YawRate", "unit": "rad/s"},
    "lateral_acceleration": {"from": "Car.ay", "unit": "m/s²"},
}
MEGANE = {"body.mass": 1856.2, "body.yaw_inertia": 2806.23, "body.front_distance": 0.968, "body.wheelbase": 2.55}  # its README


def bosch_slalom2(folder: Path) -> Iterator[Fact]:
    """A car with its masses and lengths, its tyres calibrated to the first half, follows the second half."""
    made = taken(folder / "slalom2_14_5ms.csv.gz", **SLALOM)
    yield near("speed [m/s]", np.nanmean(made["speed"]), 14.57, 0.02)
    yield Fact("steering wheel over road wheels [1]", ratio(folder), 20.3, 21.2)
    with tempfile.TemporaryDirectory() as place:
        loaded = load(project(Path(place), folder, float(made.time[-1])))
        found = calibration.calibrate(loaded, "tyres")
        yield Fact("yaw rate, RMS difference over range where it was calibrated", found.misfit["yaw_rate"][1], 0.0, 0.01)
        verdicts = judge.validate(calibration.applied(loaded, found)).verdicts
        yield Fact("the same where it was not", next(each.ours for each in verdicts if "yaw_rate" in each.criterion), 0.0, 0.01)


def ratio(folder: Path) -> float:
    """Steering wheel over road wheel angle where both are large."""
    log = reading.read(folder / "slalom2_14_5ms.csv.gz")
    wheel, road = log["Driver.Steer.Ang"].values, 0.5 * (log["Car.SteerAngleFL"].values + log["Car.SteerAngleFR"].values)
    return float(np.median((wheel / road)[np.abs(road) > 0.01]))


def project(place: Path, folder: Path, length: float) -> Path:
    """A project about it: the first half calibrates, the second validates."""
    half = round(0.5 * length, 2)
    log = str(folder.resolve() / "slalom2_14_5ms.csv.gz")
    (place / "mapping.yaml").write_text(yaml.safe_dump({"signals": SLALOM}), encoding="utf-8")
    runs = {"kind": "steered", "calibration": [{"log": log, "end": half}], "validation": [{"log": log, "begin": half + 0.5}]}
    tyres = {"parameters": {f"tyres.{axle}_cornering": {"low": 0.3, "high": 3.0} for axle in ("front", "rear")}}
    document = {"title": "Slalom", "vehicle": "bmw_320i", "changes": MEGANE, "mapping": "mapping.yaml"}
    document |= {"maneuvers": {"slalom": runs}, "calibration": {"tyres": tyres}}
    (place / "project.yaml").write_text(yaml.safe_dump(document), encoding="utf-8")
    return place / "project.yaml"


DRIVES = (comma2k19, stanford_250lm, kit_seat_leon, bosch_slalom2)


def main(folder: Path) -> int:
    """Prints every fact; how many did not come out."""
    failed = 0
    for drive in DRIVES:
        place = folder / drive.__name__
        print(f"{drive.__name__}{'' if place.is_dir() else ': is not there'}")
        for fact in drive(place) if place.is_dir() else ():
            print(fact, flush=True)
            failed += not fact.holds
    return failed


if __name__ == "__main__":
    sys.exit(bool(main(Path(sys.argv[1]))))
