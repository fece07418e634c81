"""Behind a measured car: platoons that answer as measured platoons do.

The leader drives as the second car of eleven under series ACC did (OpenACC, tests/reference/README.md). What the others of that platoon
and those of its other runs did, car by car, as measured from the published speeds: at median time gaps of 1.3 to 1.8 s the standard
deviation of the speed grows by 1.1 to 1.35 from car to car and accelerations follow by 1.3 to 1.9 s; at 2.3 to 2.6 s it grows by 0.9 to
1.05. Cars that told each other what they were about to do (CARMA, 2018) followed by less than 0.3 s at 0.6 to 0.75 s.
"""

import gzip
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest

from studio.road.drawn.motorway import motorway
from studio.scenario.setup import complete
from studio.vehicle.state import V_X
from studio.world.build import build
from studio.world.setting import setting
from studio.world.table.mind import DRIVES, GAP, SCRIPT_ACCELERATION
from studio.world.tick import tick
from tests.conftest import ROOT

MEASURED = ROOT / "tests" / "reference" / "traffic" / "openacc_short_setting_car_2.csv.gz"
CARS, TICK, SAMPLE = 5, 0.02, 0.1
LENGTH = 4.6  # [m] about that of a car
AHEAD = 0.5  # [s] that whoever drives the leader looks ahead in the measured speed


class Answer(NamedTuple):
    """How a platoon answers: growth from car to car from the second follower on, median lag [s] and median time gap [s]."""

    gain: float
    lag: float
    time_gap: float


@cache
def measured():
    """Time [s] and speed [m/s] of the measured car."""
    with gzip.open(MEASURED, "rt") as file:
        return np.loadtxt(file, delimiter=",", skiprows=1).T


def platoon(folder, group, headway, sensor):
    """Five cars on a motorway; the followers have the application."""
    (folder / "motorway.xodr").write_text(motorway(length=5000.0, lanes=2))
    speed, names = float(measured()[1][0]), [f"car_{i}" for i in range(CARS)]
    place = {name: {"road": "motorway", "lane": 0, "offset": 250.0 - i * (headway * speed + 2.0 + LENGTH)} for i, name in enumerate(names)}
    document = {
        "title": "behind a measured car",
        "map": {"file": "motorway.xodr"},
        "routes": {"way": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": 30}]}},
        "vehicles": {name: {"route": "way", "position": place[name], "speed": speed, "sensors": {"front": sensor}} for name in names},
        "applications": {"platoon": {"units": names[1:], **group}},
    }
    return build([setting(complete(document, "platoon"), folder, "platoon")])


def driven(world):
    """Speeds [m/s] and gaps [m] of all cars at 10 Hz, while the leader is driven after the measured speed."""
    time, speed = measured()
    seen = []
    for k in range(round((time[-1] - AHEAD) / TICK)):
        now, soon = np.interp([k * TICK, k * TICK + AHEAD], time, speed)
        world.script.commands[DRIVES, 0] = 1.0
        world.script.commands[SCRIPT_ACCELERATION, 0] = 1.5 * (now - world.vehicles.state[V_X, 0]) + (soon - now) / AHEAD
        tick(world)
        if k % round(SAMPLE / TICK) == 0:
            seen.append((world.vehicles.state[V_X].copy(), world.vehicles.mind[GAP].copy()))
    return np.moveaxis(np.array(seen), 0, -1)


def acceleration(speed):
    """Of a speed at 10 Hz, which is smoothed over 0.7 s."""
    return np.gradient(np.convolve(speed, np.full(7, 1.0 / 7.0), "valid"), SAMPLE)


def lag(ahead, behind, most=6.0):
    """The shift [s] at which the acceleration of one car is most like that of the car ahead of it."""
    a, b = acceleration(ahead), acceleration(behind)
    alike = [np.corrcoef(a[: a.size - i], b[i:])[0, 1] for i in range(round(most / SAMPLE))]
    return SAMPLE * int(np.argmax(alike))


def answer(folder, group, headway, sensor):
    """How a platoon answers to the measured leader."""
    speed, gap = driven(platoon(folder, group, headway, sensor))
    assert np.abs(speed[0] - np.interp(SAMPLE * np.arange(speed.shape[1]), *measured())).max() < 0.5  # he drives as measured
    spread = speed.std(axis=1)
    lags = [lag(speed[i], speed[i + 1]) for i in range(CARS - 1)]
    gain = (spread[-1] / spread[1]) ** (1.0 / (CARS - 2))
    return Answer(float(gain), float(np.median(lags)), float(np.nanmedian(gap[1:] / speed[1:])))


def series(folder, headway):
    """A platoon with the presets of a series ACC and its radar."""
    group = {"application": "acc", "preset": "series", "parameters": {"headway": headway}}
    return answer(folder, group, headway, {"kind": "front_radar", "preset": "series_acc_radar"})


@pytest.mark.parametrize("headway", [1.15, 1.35, 1.5])
def test_series_acc_at_its_short_setting_makes_waves_grow(tmp_path, headway):
    found = series(tmp_path, headway)
    assert 1.3 <= found.time_gap <= 1.8
    assert 1.1 <= found.gain <= 1.35 and 1.3 <= found.lag <= 1.9 + 1e-9


@pytest.mark.parametrize("headway", [2.12, 2.4])
def test_series_acc_at_its_long_setting_does_not(tmp_path, headway):
    found = series(tmp_path, headway)
    assert found.time_gap + 0.005 >= 2.3 and found.time_gap <= 2.6
    assert 0.9 <= found.gain <= 1.05


@pytest.mark.parametrize("headway", [0.43, 0.55])
def test_cars_that_tell_their_request_answer_together(tmp_path, headway):
    names = [f"car_{i}" for i in range(CARS - 1)]
    group = {"application": "cacc_direct", "listens_to": names, "parameters": {"headway": headway}}
    found = answer(tmp_path, group, headway, {"kind": "front_radar", "preset": "long_range_radar"})
    assert 0.6 <= found.time_gap <= 0.75
    assert found.lag < 0.3 and found.gain < 1.0
