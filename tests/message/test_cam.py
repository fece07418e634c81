"""Awareness messages by the standard's rules: exact sequences for exact drives."""

from math import radians
from pathlib import Path

import numpy as np
import pytest

from studio.application.contract import Own
from studio.kind import registry
from studio.kind.number import tuple_of
from studio.workshop.stage import stage
from studio.world.view import Turn

CAM = registry.find("message", "cam").module
SETTINGS = tuple_of(CAM, CAM.Settings)(0.1)


def sent(seconds, speed, acceleration=0.0, yaw_rate=0.0, gap=0.0, standing=0.0):
    """When a car sends [s], looked at every 100 ms: its speed [m/s] is a number or a function of time, its place their integral."""
    at = speed if callable(speed) else lambda t: speed + acceleration * t
    memory, times, x = CAM.Memory(), [], 0.0
    for k in range(round(10 * seconds) + 1):
        t = k / 10.0
        own = Own(*[{"speed": at(t), "yaw_rate": yaw_rate, "gps_x": x}.get(name, 0.0) for name in Own._fields])
        is_due, memory = CAM.due(own, SETTINGS, memory, Turn(t, gap, 0.0))
        times += [round(t, 6)] if is_due else []
        x += 0.1 * (at(t) + at(t + 0.1)) / 2.0  # exact where the speed is linear
    return np.array(times)


@pytest.mark.parametrize(
    ("kmh", "period"),
    [(0, 1.0), (5, 1.0), (13, 1.0), (20, 0.8), (30, 0.5), (50, 0.3), (70, 0.3), (80, 0.2), (100, 0.2), (120, 0.2), (144, 0.2), (145, 0.1),
     (180, 0.1)],
)  # fmt: skip
def test_at_constant_speed(kmh, period):
    """13 km/h and less 1 Hz, 20 1.25, 30 2, 50 and 70 3.333, 80 to 144 5, from 145 on 10 Hz; 144 km/h are 4 m in 0.1 s, not more."""
    np.testing.assert_allclose(np.diff(sent(30.0, kmh / 3.6)), period, atol=1e-9)


@pytest.mark.parametrize(("acceleration", "first"), [(2.0, 0.3), (5.0, 0.2), (5.1, 0.1), (8.0, 0.1), (-2.0, 0.3), (-5.0, 0.2), (-8.0, 0.1)])
def test_a_change_of_speed(acceleration, first):
    """More than 0.5 m/s since the last: 5 m/s² for 0.1 s are not more. From 5 m/s, where the place changes too little."""
    assert sent(0.5, 5.0, acceleration)[1] == first


@pytest.mark.parametrize(("rate", "first"), [(20, 0.3), (40, 0.2), (41, 0.1), (-20, 0.3), (-41, 0.1)])
def test_a_change_of_heading(rate, first):
    """More than 4 degrees since the last: 40 degrees a second for 0.1 s are not more."""
    assert sent(1.0, 3.0, yaw_rate=radians(rate))[1] == first


def braking(t):
    """From standing with 2 m/s² to 14 m/s, 5 s so, then with -4 m/s² to rest at 15.5 s."""
    return 2.0 * t if t < 7.0 else 14.0 if t < 12.0 else max(14.0 - 4.0 * (t - 12.0), 0.0)


def test_a_whole_drive():
    """67 messages: to 12.0 s every 0.3 s, to 16.0 every 0.2, then every second. The last nine are timed, three at the interval before."""
    times = sent(22.0, braking)
    assert times.size == 67
    np.testing.assert_allclose(times, [*np.arange(0.0, 12.01, 0.3), *np.arange(12.2, 16.01, 0.2), *np.arange(17.0, 22.1, 1.0)], atol=1e-9)


def test_after_a_drive_three_come_at_the_interval_of_before():
    """25 m/s, 5 Hz, and from 2 s on nothing moves: the stop is told at once, then thrice after 0.2 s, then every second."""
    times = sent(8.0, lambda t: 25.0 if t < 1.95 else 0.0)
    np.testing.assert_allclose(times[times > 1.9], [2.0, 2.2, 2.4, 2.6, 3.6, 4.6, 5.6, 6.6, 7.6], atol=1e-9)


def test_congestion_control_makes_them_wait():
    np.testing.assert_allclose(np.diff(sent(10.0, 50 / 3.6, gap=0.4)), 0.4, atol=1e-9)
    np.testing.assert_allclose(np.diff(sent(10.0, 0.0, gap=0.4)), 1.0, atol=1e-9)


def test_in_the_world(own_kinds):
    """A car at 50 km/h whose satellite makes no error is heard every 0.3 s, a station every second; every half second it is larger."""
    own_kinds(Path(__file__).parent)
    exact = {"drift": 0.0, "noise": 0.0}
    current = stage(
        vehicles={"far": {"speed": 50 / 3.6, "gps": exact}},
        routes={"along": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": 50 / 3.6}]}},
        stations={"post": {"position": {"road": "motorway", "along": 500.0}}},
        applications={"hears": {"application": "listener", "units": ["post", "far"], "listens_to": [["far"], ["post"]]}},
        radio={"loss": 0.0},
    )
    current.advance(500)
    found = current.record().messages
    car, post = found.link("far", "post", "cam"), found.link("post", "far", "cam")
    np.testing.assert_allclose(np.diff(found.time[found.of[post]]), 1.0, atol=1e-9)
    gaps = np.diff(found.time[found.of[car]])
    assert np.mean(np.isclose(gaps, 0.3)) > 0.95 and car.size == pytest.approx(33, abs=1)
    sizes = found.size[found.of[car]]
    assert set(sizes) == {CAM.SMALL, CAM.SIZE} and np.mean(sizes == CAM.SIZE) == pytest.approx(0.5, abs=0.1)


def test_congestion_control_reaches_them(own_kinds):
    """Six cars at 25 m/s would send every 0.2 s; 50 ms on the air each fill the channel, and all wait 0.4 s from then on."""
    own_kinds(Path(__file__).parent)
    current = stage(
        routes={"along": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": 25.0}]}},
        applications={"hears": {"application": "listener", "units": ["own"]}},
        radio={"kind": "patchy", "airtime": 0.05, "range": 5000.0, "heard": 5000.0},
    )
    current.advance(400)
    found = current.record().messages
    for sender in range(len(found.units)):
        gaps = np.diff(found.time[(found.sender == sender) & (found.time > 1.0)])
        assert gaps.size > 10 and gaps.min() > 0.39 and np.median(gaps) == pytest.approx(0.4, abs=1e-6)
