"""Lever arms: a body that turns in closed form, seen from a sensor somewhere on it, and brought to its centre of gravity."""

import numpy as np
import pytest
import yaml

from studio.errors import ScenarioError
from studio.kind.log import Log, signal
from studio.log import mapping, recording
from studio.scenario.text import source

TIME = np.arange(0.0, 12.0, 0.01)
INSIDE = slice(100, -100)  # away from the ends, where smoothing knows one side only
X, Y, Z = 1.4, -0.6, 0.5  # [m]
TURN = 2.0 * np.pi * 0.4  # [rad/s] of the sine
R, R_DOT = 0.5 * np.sin(TURN * TIME), 0.5 * TURN * np.cos(TURN * TIME)
P, P_DOT = 0.2 * np.cos(TURN * TIME), -0.2 * TURN * np.sin(TURN * TIME)


def taken(columns, places):
    """Our signals, of sensors that sit at the places that the mapping says."""
    units = {"speed": "m/s", "lateral_speed": "m/s", "acceleration": "m/s²", "lateral_acceleration": "m/s²"}
    log = Log("drive", {name: signal(name, units.get(name, "rad/s"), TIME, values) for name, values in columns.items()})
    document = {"signals": {name: {"from": name} | ({"at": places[name]} if name in places else {}) for name in columns}}
    return recording.of_log(log, mapping.of_text(source.read(yaml.safe_dump(document), "mapping")))


def test_in_a_steady_turn_a_sensor_ahead_feels_less_forward_acceleration():
    """At x ahead of the centre a_x is r² x less, at y to the left a_y is r² y less: 0.8 rad/s, 2 m, 1.28 m/s²."""
    r = np.full(TIME.size, 0.8)
    seen = {"yaw_rate": r, "acceleration": np.full(TIME.size, -1.28), "lateral_acceleration": 12.0 - 0.64 * np.full(TIME.size, 0.5)}
    made = taken(seen, {"acceleration": [2.0, 0.0, 0.0], "lateral_acceleration": [0.0, 0.5, 0.0]})
    assert np.allclose(made["acceleration"], 0.0, atol=1e-9) and np.allclose(made["lateral_acceleration"], 12.0, atol=1e-9)


def test_a_body_that_rolls_and_turns_seen_from_a_corner_of_it():
    """Velocities and accelerations of the corner by cross products, as they stand in the docstring's first line: the centre's come back."""
    omega = np.stack([P, np.zeros(TIME.size), R], axis=1)
    change = np.stack([P_DOT, np.zeros(TIME.size), R_DOT], axis=1)
    arm = np.array([X, Y, Z])
    v = np.cross(omega, arm)
    a = np.cross(change, arm) + np.cross(omega, v)
    true = {"speed": 20.0, "lateral_speed": 0.3, "acceleration": -1.0, "lateral_acceleration": 4.0}
    seen = {"speed": v[:, 0], "lateral_speed": v[:, 1], "acceleration": a[:, 0], "lateral_acceleration": a[:, 1]}
    columns = {name: true[name] + values for name, values in seen.items()} | {"yaw_rate": R, "roll_rate": P}
    made = taken(columns, {name: [X, Y, Z] for name in true})
    for name, value in true.items():
        assert np.ptp(seen[name]) > 0.3, name  # there is something to be taken away
        assert np.allclose(made[name][INSIDE], value, atol=2e-3), name


def test_without_a_roll_rate_the_height_does_not_count():
    flat = taken({"yaw_rate": R, "lateral_acceleration": R}, {"lateral_acceleration": [X, Y, 0.0]})
    high = taken({"yaw_rate": R, "lateral_acceleration": R}, {"lateral_acceleration": [X, Y, Z]})
    assert np.array_equal(flat["lateral_acceleration"], high["lateral_acceleration"])


@pytest.mark.parametrize(
    ("columns", "places", "told"),
    [
        (("lateral_acceleration",), {"lateral_acceleration": [1, 0, 0]}, "needs the yaw rate"),
        (("yaw_rate",), {"yaw_rate": [1, 0, 0]}, "is the same wherever a sensor sits"),
        (("yaw_rate", "acceleration"), {"acceleration": [1, 0]}, "signals.acceleration.at"),
        (("yaw_rate", "acceleration"), {"acceleration": [100, 0, 0]}, "25"),
    ],
)
def test_places_that_are_none(columns, places, told):
    with pytest.raises(ScenarioError) as caught:
        taken({name: np.zeros(TIME.size) for name in columns}, places)
    assert told in str(caught.value)
