"""Maneuvers in a long log: each is found where it was driven, aligned by its reference, and measured as its closed form says."""

from dataclasses import replace

import numpy as np
import pytest

from studio.errors import ScenarioError
from studio.log.recording import Recording
from studio.validation import known, path
from studio.validation.criterion import Limits, Measure, verdicts
from studio.validation.judge import aligned
from studio.validation.maneuver import double_lane_change, j_turn, oval

PERIOD = 0.01


def recording(length, **signals):
    """Signals as functions of time [s]."""
    time = np.arange(round(length / PERIOD) + 1) * PERIOD
    return Recording(
        "log",
        time,
        {name: np.broadcast_to(each(time) if callable(each) else each, time.shape).astype(float) for name, each in signals.items()},
    )


def ramp(t, since, lasts, height):
    return height * np.clip((t - since) / lasts, 0.0, 1.0)


def lane_change(t, since, height=0.03):
    out = np.where((t > since) & (t < since + 2), np.sin(np.pi * (t - since)), 0.0)
    back = np.where((t > since + 3) & (t < since + 5), -np.sin(np.pi * (t - since - 3)), 0.0)
    return height * (out + back)


def day(t):
    """A step that is held, straight, a double lane change, straight."""
    return ramp(t, 5, 0.1, 0.03) - ramp(t, 10, 0.5, 0.03) + lane_change(t, 20)


STEERED = recording(
    40.0, road_wheel_angle=day, speed=15.0, yaw_rate=lambda t: 5.0 * day(t - 0.1), lateral_acceleration=lambda t: 75.0 * day(t - 0.05)
)


def test_a_long_log_is_cut():
    found = known.cuts(STEERED)
    assert [kind for kind, _, _ in found] == ["j_turn", "double_lane_change"]
    (_, begin, end), (_, since, until) = found
    assert 3.9 < begin < 4.2 and 9.5 < end < 10.5 and 18.8 < since < 19.3 and 25.4 < until < 26.0


def test_a_step_is_aligned_at_half_of_its_steady_angle():
    run = STEERED.between(*known.cuts(STEERED)[0][1:])
    at = j_turn.marks(run)
    assert run.start + at.reference == pytest.approx(5.05, abs=0.003)
    found = j_turn.measures(run, at)
    assert found["steady yaw_rate"][0] == pytest.approx(0.15, rel=2e-3) and found["steady lateral_acceleration"][0] == pytest.approx(
        2.25, rel=2e-3
    )


@pytest.mark.parametrize(("late", "side"), [(0.0, 1.0), (0.1, 1.0), (0.1, -1.0)])
def test_a_step_that_is_followed_late_has_that_lag(late, side):
    step = lambda t: np.clip((t - 2.0) / 0.2, 0.0, 1.0)  # noqa: E731
    run = recording(
        8.0, speed=20.0, road_wheel_angle=lambda t: 0.02 * side * step(t), yaw_rate=lambda t: 0.2 * side * step(t - late),
        lateral_acceleration=lambda t: 4.0 * side * step(t),
    )  # fmt: skip
    found = j_turn.measures(run, j_turn.marks(run))
    assert found["yaw_rate, lag of the step"] == (pytest.approx(late, abs=0.005), "lag", "s")


def test_nobody_knows_the_lag_of_a_signal_that_begins_where_it_ends():
    """A log of a logger that wrote its buffer in a wrong order: what came last stands before what came first."""
    step = lambda t: np.clip((t - 2.0) / 0.2, 0.0, 1.0)  # noqa: E731
    run = recording(8.0, speed=20.0, road_wheel_angle=lambda t: 0.02 * step(t), yaw_rate=lambda t: 0.2 * step(t), lateral_acceleration=0.0)
    rolled = replace(run, signals=run.signals | {"yaw_rate": np.roll(run["yaw_rate"], 20)})
    at = j_turn.marks(run)
    (straight, *_), (lag, *_) = (j_turn.measures(each, at)["yaw_rate, lag of the step"] for each in (run, rolled))
    assert straight == pytest.approx(0.0, abs=0.005) and np.isnan(lag)
    found = Measure("lag", "lag", np.array([straight, lag]), np.array([0.0, 0.0]), 0.0, "s", ("day_1.csv", "day_2.csv"))
    judged = verdicts("turn", found, Limits(), "two-sided")
    assert [each.verdict for each in judged] == ["unjudged", "unjudged"]
    assert all(each.reason.startswith("day_2.csv: beyond half of its value from the first sample on") for each in judged)


def test_extrema_and_lags_of_both_half_waves():
    """A sine of 2 s: extrema 0.5 s and 1.5 s after its beginning, half of the first one a sixth of a second after it."""
    run = STEERED.between(*known.cuts(STEERED)[1][1:])
    at = double_lane_change.marks(run)
    references = [run.start + each.since for each in at.parts]
    assert references == pytest.approx([20 + 1 / 6, 23 + 1 / 6], abs=0.01)
    found = {name: value for name, (value, *_) in double_lane_change.measures(run, at).items()}
    gains = [found[f"yaw_rate, {each} extremum"] for each in double_lane_change.ORDER]
    assert gains == pytest.approx([0.15, -0.15, -0.15, 0.15], rel=0.01)
    times = [found[f"yaw_rate, time of the {each} extremum"] for each in double_lane_change.ORDER]
    assert times == pytest.approx([0.5 - 1 / 6 + 0.1, 1.5 - 1 / 6 + 0.1] * 2, abs=0.015)
    assert found["yaw_rate, lag of the second half wave"] == pytest.approx(0.1, abs=0.01)
    assert found["lateral_acceleration, lag of the first half wave"] == pytest.approx(0.05, abs=0.01)


def test_half_waves_lie_on_each_other_though_the_pause_between_them_differs():
    runs = [
        recording(12.0, road_wheel_angle=lambda t, p=p: lane_change(t, 1) * (t < 3.5) + lane_change(t, 1 + p) * (t > 3.5 + p), speed=15.0)
        for p in (0.0, 0.4)
    ]
    marks = [double_lane_change.marks(each) for each in runs]
    time, values = aligned(runs, marks, "road_wheel_angle")
    steered = np.abs(values).max(axis=0) > 0.005
    assert np.abs(values[0] - values[1])[steered].max() < 2e-3
    assert values.max() == pytest.approx(0.03, rel=0.02) and time[0] < -0.5


def test_what_is_no_lane_change_is_refused():
    with pytest.raises(ScenarioError, match="turns the wheel left;"):
        double_lane_change.marks(STEERED.between(4.0, 12.0))


def rolling(brake, gear, slowing):
    """Constant speed, then slowing down to a stop."""
    speed = lambda t: np.maximum(15.0 - slowing * np.maximum(t - 5.0, 0.0), 0.0)  # noqa: E731
    is_rolling = lambda t: (t > 5.0) & (speed(t) > 0.0)  # noqa: E731
    return recording(
        30.0, speed=speed, acceleration=lambda t: np.where(is_rolling(t), -slowing, 0.0), gear=lambda t: np.where(t > 5.0, gear, 3),
        brake_torque=lambda t: brake * is_rolling(t), throttle=lambda t: 0.2 * (t <= 5.0),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("kind", "brake", "gear", "slowing"), [("coasting", 0, 0, 1.0), ("braked_coasting", 500, 0, 2.0), ("braking", 900, 3, 3.0)]
)
def test_what_slows_down_is_found_and_measured(kind, brake, gear, slowing):
    log = rolling(brake, gear, slowing)
    ((found, begin, end),) = known.cuts(log)
    assert found == kind and begin == pytest.approx(5.0, abs=0.1) and end == pytest.approx(5.0 + 15.0 / slowing, abs=0.4)
    run = log.between(begin - 1.0 if kind == "braking" else begin, end + 1.0 if kind == "braking" else end)
    module = known.find(kind)
    measured = module.measures(run, module.marks(run))
    assert [value for value, *_ in measured.values()] == pytest.approx([-slowing] * len(measured), rel=0.03)


def test_gears_are_measured_one_by_one():
    """Third gear until 4 s, half a second of open clutch, second until 8 s; -0.8 and -1.2 m/s²."""
    slowing = lambda t: np.where(t < 4.0, -0.8, np.where(t < 4.5, -0.2, -1.2))  # noqa: E731
    log = recording(
        8.0, speed=lambda t: 20.0 + np.cumsum(slowing(t)) * PERIOD, acceleration=slowing, gear=lambda t: np.where(t < 4.0, 3, 2),
        clutch=lambda t: np.where((t >= 4.0) & (t < 4.5), 0.0, 1.0), throttle=0.0,
    )  # fmt: skip
    module = known.find("engine_drag")
    found = module.measures(log, module.marks(log))
    assert {name: value for name, (value, *_) in found.items()} == pytest.approx(
        {"acceleration, gear 3": -0.8, "acceleration, gear 2": -1.2}, rel=0.05
    )
    assert known.cuts(log) == [("engine_drag", 0.0, pytest.approx(8.0))]


def test_a_line_through_the_acceleration_of_each_gear():
    """a = 3 - 0.4 t in first gear, 2 - 0.2 t in second."""
    push = lambda t: np.where(t < 4.0, 3.0 - 0.4 * t, 2.0 - 0.2 * t)  # noqa: E731
    log = recording(
        8.0, speed=lambda t: np.cumsum(push(t)) * PERIOD, acceleration=push, gear=lambda t: np.where(t < 4.0, 1, 2), throttle=0.5
    )
    module = known.find("acceleration")
    found = {name: value for name, (value, *_) in module.measures(log, module.marks(log)).items()}
    assert found["gear 1, slope"] == pytest.approx(-0.4, rel=0.03) and found["gear 2, slope"] == pytest.approx(-0.2, rel=0.03)
    assert found["gear 1, midpoint"] == pytest.approx(3.0 - 0.4 * 2.5, rel=0.02)
    assert [kind for kind, _, _ in known.cuts(log)] == ["acceleration"]


# -- the oval --------------------------------------------------------------------------------------------


def circle(radius, turns=1.0, speed=5.0, wobble=0.0):
    length = 2 * np.pi * radius * turns / speed
    angle = lambda t: speed * t / radius  # noqa: E731
    around = lambda t: radius + wobble * np.sin(3 * angle(t))  # noqa: E731
    return recording(
        length, x=lambda t: around(t) * np.cos(angle(t)), y=lambda t: around(t) * np.sin(angle(t)), speed=speed, road_wheel_angle=0.1
    )


def test_a_lap_is_found_and_as_long_as_a_circle():
    assert [kind for kind, _, _ in known.cuts(circle(10.0, 2.1))].count("oval") == 2
    assert oval.measures(circle(10.0), oval.marks(circle(10.0)))["final travelled distance"][0] == pytest.approx(20 * np.pi, rel=1e-3)


def test_the_averaged_path_lies_between_and_deviations_are_signed():
    """Circles of 9 and 11 m: the average is one of 10 m, and left of a left turn is inside."""
    inner, outer = (oval.line(circle(radius)) for radius in (9.0, 11.0))
    between = path.averaged([inner, outer])
    radius = np.linalg.norm(between.points, axis=1)
    assert radius == pytest.approx(np.full(radius.size, 10.0), abs=0.02)
    base = oval.line(circle(10.0))
    assert np.median(path.offsets(base, inner)) == pytest.approx(1.0, abs=0.01)
    assert np.median(path.offsets(base, outer)) == pytest.approx(-1.0, abs=0.01)


def test_a_path_is_placed_where_the_recorded_one_begins():
    base, moved = circle(10.0), circle(10.0)
    turned = Recording("sim", moved.time, moved.signals | {"x": -moved["y"] + 3.0, "y": moved["x"] - 7.0})
    assert np.abs(path.deviations(oval.line(base), oval.placed(turned, base))).max() < 1e-6
