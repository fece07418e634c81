"""Hints: what looks wrong between signals that each could be right, and what does not."""

import numpy as np
import pytest

from studio.kind.log import Log, signal
from studio.log import mapping, recording
from studio.log.hint import contradictions, hints
from studio.scenario.text import source

TIME = np.arange(0.0, 10.0, 0.01)
RATE = 0.2 * np.sin(TIME)


def told(**changed):
    """Of a car at 20 m/s that sways, its acceleration off by the noise and tilt that a real sensor has."""
    noise = np.random.default_rng(1).normal(0.0, 0.1, TIME.size)
    signals = {
        "speed": np.full(TIME.size, 20.0),
        "yaw_rate": RATE,
        "lateral_acceleration": 20.0 * RATE + 0.3 + noise,
        "road_wheel_angle": 0.05 * RATE,
    }
    units = {"speed": "m/s", "yaw_rate": "rad/s", "lateral_acceleration": "m/s²", "road_wheel_angle": "rad"}
    found = Log("drive", {name: signal(name, units[name], TIME, changed.get(name, lambda x: x)(each)) for name, each in signals.items()})
    return hints(recording.of_log(found))


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"speed": lambda x: 3.6 * x}, "lateral_acceleration is 0.28 times speed × yaw_rate"),
        ({"lateral_acceleration": lambda x: x / 9.81}, "lateral_acceleration is 0.1 times speed × yaw_rate"),
        ({"lateral_acceleration": lambda x: -x}, "lateral_acceleration is -1 times speed × yaw_rate"),
        ({"road_wheel_angle": lambda x: -x}, "the car turns to the other side than road_wheel_angle"),
    ],
)
def test_what_does_not_go_together_is_told(changed, words):
    (only,) = told(**changed)
    assert only.startswith(words) and ("sign: -1" in only) == ("-1 times" in words or "other side" in words)


def test_a_car_as_it_is_gives_none():
    """Nor one that slides by a third, nor one that drives straight on, where nothing can be told."""
    assert told() == [] and told(lateral_acceleration=lambda x: 0.75 * x) == []
    assert told(yaw_rate=lambda x: 0.05 * x, lateral_acceleration=lambda x: -0.05 * x) == []


def test_a_mapping_without_one_of_them_gives_none():
    made = mapping.of_text(source.read("signals: {yaw_rate: {from: yaw_rate, unit: rad/s}}", "mapping"))
    assert hints(recording.of_log(Log("drive", {"yaw_rate": signal("yaw_rate", "rad/s", TIME, RATE)}), made)) == []


def test_a_mapping_that_takes_another_unit_than_the_log_says_is_told():
    """Though 1.3 deg and 0.023 rad are both angles that a wheel may have; another spelling of the same unit is none."""
    log = Log("drive", {"Steer": signal("Steer", "deg", TIME, RATE), "Rate": signal("Rate", "°/s", TIME, RATE)})

    def told_of(steer, rate):
        text = f"signals: {{road_wheel_angle: {{from: Steer{steer}}}, yaw_rate: {{from: Rate{rate}}}}}"
        return contradictions(mapping.of_text(source.read(text, "mapping")), log)

    (only,) = told_of(", unit: rad", ", unit: deg/s")
    assert only.startswith("Steer is recorded in deg, and the mapping takes it in rad")
    assert told_of("", "") == told_of(", unit: deg", ", unit: deg/s") == []


def test_gaps_are_told_with_their_times():
    """A wheel angle that is missing for 60 ms, so that no maneuver is found across it; a second gap is counted."""
    speed = signal("speed", "m/s", TIME, np.full(TIME.size, 20.0))
    one = np.where((TIME > 1.494) & (TIME < 1.556), np.nan, 0.05 * RATE)
    both = np.where((TIME > 6.0) & (TIME < 6.5), np.nan, one)
    for angle, words in ((one, "1.50 to 1.55 s: a maneuver"), (both, "1.50 to 1.55 s and 1 more")):
        (only,) = hints(
            recording.of_log(Log("drive", {"speed": speed, "road_wheel_angle": signal("road_wheel_angle", "rad", TIME, angle)}))
        )
        assert only.startswith(f"nothing was recorded of road_wheel_angle from {words}")
