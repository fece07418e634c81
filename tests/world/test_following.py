"""The usual driver in whole vehicles: waves from car to car as the linear law has them, and stopping behind an object."""

import numpy as np
import pytest

from studio.road.drawn.motorway import motorway
from studio.scenario.setup import complete
from studio.vehicle.parameter import FRONT, LENGTH
from studio.vehicle.state import A_X, V_X
from studio.world.build import build
from studio.world.setting import setting
from studio.world.table.mind import GAP
from studio.world.tick import tick

TICK = 0.02


def chain(folder, speeds, places, profile, limit, length):
    """Cars behind one that drives a profile [[s, m/s]], the first of them; road of a length [m] with a limit [m/s]."""
    (folder / "motorway.xodr").write_text(motorway(length=length, lanes=1), encoding="utf-8")
    vehicles = {
        f"car_{i:02d}": {"route": "way", "position": {"along": float(at)}, "speed": float(speed)}
        for i, (speed, at) in enumerate(zip(speeds, places, strict=True))
    }
    first = {"kind": "speed_profile", "vehicle": "car_00", "points": profile}
    document = {
        "title": "chain", "map": {"file": "motorway.xodr"}, "vehicles": vehicles,
        "routes": {"way": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": limit}]}},
        "script": {"lead": {"when": {"kind": "time", "at": 0}, "do": first}},
    }  # fmt: skip
    return build([setting(complete(document, "chain"), folder, "chain")])


def test_a_wave_grows_as_the_linear_law_has_it(tmp_path):
    """±0.3 m/s about 54 km/h at 0.015 Hz through ten vehicles: 1.0023 from car to car, within 0.01."""
    v, frequency, cars, gain = 15.0, 0.015, 11, 1.00231
    gap = (2.0 + 1.2 * v) / np.sqrt(1.0 - (v / (120 / 3.6)) ** 4)
    omega, times = 2.0 * np.pi * frequency, np.arange(0.0, 480.0, 0.5)
    profile = [[float(t), float(v + 0.3 * np.sin(omega * t))] for t in times]
    world = chain(tmp_path, np.full(cars, v), 400.0 - np.arange(cars) * (gap + 4.5), profile, 120 / 3.6, 8000.0)
    speeds = []
    for _ in range(round(466.67 / TICK)):
        tick(world)
        speeds.append(world.vehicles.state[V_X].copy())
    settled = np.array(speeds[-round(4.0 / frequency / TICK) :])
    phase = np.exp(-1j * omega * TICK * np.arange(len(settled)))
    amplitude = 2.0 * np.abs(np.mean((settled - settled.mean(axis=0)) * phase[:, None], axis=0))
    assert amplitude[0] == pytest.approx(0.3, rel=0.05)
    assert amplitude[1:] / amplitude[:-1] == pytest.approx(gain, abs=0.01)


@pytest.mark.parametrize(("v", "gap", "hardest"), [(14.0, 300.0, 1.789), (20.0, 300.0, 2.006), (30.0, 400.0, 2.219)])
def test_behind_an_object(tmp_path, v, gap, hardest):
    """A standing vehicle far ahead: the greatest deceleration of the law, up to a tenth more, and its gap at rest."""
    world = chain(tmp_path, [0.0, v], [gap + 54.5, 50.0], [[0, 0.0], [200, 0.0]], v, 3000.0)
    p, found = world.vehicles.parameter, []
    assert p[LENGTH, 0] - p[FRONT, 0] + p[FRONT, 1] == pytest.approx(4.5, abs=0.5)
    for _ in range(round(90.0 / TICK)):
        tick(world)
        found.append(world.vehicles.state[A_X, 1])
    smooth = np.convolve(found, np.full(10, 0.1), "valid")
    assert hardest * 0.97 < -smooth.min() < hardest * 1.1
    assert abs(world.vehicles.state[V_X, 1]) < 0.05
    assert world.vehicles.mind[GAP, 1] == pytest.approx(1.94, abs=0.25)
