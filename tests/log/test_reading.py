"""From recorded signals to ours: units, signs, offsets, delays, clocks, gaps; and values that cannot be right."""

import numpy as np
import pytest
import yaml

from studio.errors import ScenarioError
from studio.kind.log import Log, signal
from studio.log import mapping, reading, recording
from studio.log.unit import factor
from studio.scenario.text import source
from tests.conftest import ROOT

TIME = np.arange(0.0, 10.0, 0.02)


def log(**signals):
    return Log("drive", {name: signal(name, unit, time, values) for name, (unit, time, values) in signals.items()})


def told(document):
    """A mapping as its file has it."""
    return mapping.of_text(source.read(yaml.safe_dump(document), "mapping"))


def taken(document, found):
    return recording.resampled("drive", mapping.apply(told({"signals": document}), found))


def refusal(document, found):
    with pytest.raises(ScenarioError) as caught:
        taken(document, found)
    return str(caught.value)


def test_units_signs_and_offsets():
    """Ours is sign · (recorded - offset) in SI."""
    found = log(Yaw=("deg/s", TIME, np.full(TIME.size, -17.5)), V=("km/h", TIME, np.full(TIME.size, 72.0)))
    made = taken({"yaw_rate": {"from": "Yaw", "sign": -1, "offset": 0.5}, "speed": {"from": "V"}}, found)
    assert np.allclose(made["yaw_rate"], np.radians(18.0)) and np.allclose(made["speed"], 20.0)


@pytest.mark.parametrize(
    ("unit", "ours", "value"),
    [("rpm", "rad/s", 2 * np.pi / 60), ("mph", "m/s", 0.44704), ("g", "m/s²", 9.80665), ("%", "1", 0.01), ("DEG", "rad", np.pi / 180)],
)
def test_factors_are_those_of_the_units(unit, ours, value):
    assert factor(unit, ours, "signal") == pytest.approx(value, rel=1e-12)


def test_a_delay_moves_the_times_back():
    """A yaw rate that comes 0.1 s late lies on the steering again."""
    steer = np.sin(TIME)
    found = log(Steer=("rad", TIME, steer), Yaw=("rad/s", TIME + 0.1, steer))
    made = taken({"road_wheel_angle": {"from": "Steer"}, "yaw_rate": {"from": "Yaw", "delay": 0.1}}, found)
    assert np.allclose(made["yaw_rate"], made["road_wheel_angle"], atol=1e-9)


def test_clocks_of_three_rates_become_one_and_nothing_is_made_up_beyond_them():
    fast, slow = np.arange(0.3, 9.0, 0.007), np.arange(-0.5, 8.0, 0.1)
    found = log(A=("rad/s", fast, 0.1 * fast), B=("m/s", slow, 2.0 * slow), C=("m/s²", TIME, TIME))
    made = taken({"yaw_rate": {"from": "A"}, "speed": {"from": "B"}, "acceleration": {"from": "C"}}, found)
    assert made.start == pytest.approx(0.3) and made.start + made.time[-1] == pytest.approx(7.9, abs=0.011)
    clock = made.start + made.time
    assert np.allclose(np.diff(made.time), 0.01)
    assert (
        np.allclose(made["yaw_rate"], 0.1 * clock) and np.allclose(made["speed"], 2.0 * clock) and np.allclose(made["acceleration"], clock)
    )


def test_a_gap_stays_a_gap_and_a_gear_holds():
    kept = (TIME < 4.0) | (TIME > 5.0)
    found = log(
        Yaw=("rad/s", TIME[kept], 0.1 * TIME[kept]),
        Gear=("", np.array([0.0, 3.0, 6.0, 9.9]), np.array([1.0, 2.0, 3.0, 3.0])),
    )
    made = taken({"yaw_rate": {"from": "Yaw"}, "gear": {"from": "Gear"}}, found)
    inside = (made.time > 3.985) & (made.time < 5.015)
    assert np.isnan(made["yaw_rate"][inside]).all() and np.isfinite(made["yaw_rate"][~inside]).all()
    ((since, until),) = made.gaps("yaw_rate")
    assert since == pytest.approx(3.99) and until == pytest.approx(5.01)
    assert set(made["gear"]) == {1.0, 2.0, 3.0} and made["gear"][made.time < 2.99].max() == 1.0


def test_what_cannot_be_right_is_refused_with_the_unit_that_it_may_have():
    found = log(Yaw=("rad/s", TIME, np.full(TIME.size, 500.0)))
    told = refusal({"yaw_rate": {"from": "Yaw"}}, found)
    assert "500 rad/s" in told and "deg/s" in told and "500 of 500 samples" in told


@pytest.mark.parametrize(
    ("document", "what"),
    [
        ({"yaw_rate": {"from": "Yaww"}}, "did you mean 'Yaw'?"),
        ({"yaw_rat": {"from": "Yaw"}}, "did you mean 'yaw_rate'?"),
        ({"yaw_rate": {"from": "Yaw", "unit": "km/h"}}, "is not a unit of this quantity"),
        ({"yaw_rate": {"from": "Yaw", "unit": "furlongs"}}, "is not a unit that is read"),
        ({"yaw_rate": {"from": "Yaw", "sign": 2}}, "signals.yaw_rate.sign"),
        ({"yaw_rate": {"from": "Yaw"}, "speed": {"from": "V"}}, "do not overlap"),
        ({}, "signals"),
    ],
)
def test_mappings_that_are_none(document, what):
    found = log(Yaw=("rad/s", TIME, 0.1 * TIME), V=("m/s", TIME + 100.0, TIME))
    assert what in refusal(document, found)


def test_a_mapping_is_a_file_and_a_recording_is_written_and_read_again(tmp_path):
    (tmp_path / "m.yaml").write_text(yaml.safe_dump({"signals": {"yaw_rate": {"from": "Yaw", "unit": "deg/s"}}}))
    (tmp_path / "drive.csv").write_text("t,Yaw\n" + "\n".join(f"{t:.2f},{10 * t:.4f}" for t in TIME if not 4 < t < 5))
    made = recording.load(tmp_path / "drive.csv", mapping.read(tmp_path / "m.yaml"))
    recording.write(made, tmp_path / "ours.csv.gz")
    again = recording.load(tmp_path / "ours.csv.gz")
    assert np.allclose(again["yaw_rate"], made["yaw_rate"], atol=1e-8, equal_nan=True) and again.time.size == made.time.size


def test_content_tells_a_run_whatever_its_file_is_called(tmp_path):
    lines = "\n".join(f"{t:.2f},{np.sin(t):.6f}" for t in TIME)
    (tmp_path / "a.csv").write_text(f"t,yaw_rate [rad/s]\n{lines}")
    (tmp_path / "b.csv").write_text(f"t;yaw_rate [rad/s]\n{lines.replace(',', ';')}")
    np.savez(tmp_path / "c.npz", t=TIME, yaw_rate=np.round(np.sin(TIME), 6))
    whole = {"yaw_rate": {"from": "yaw_rate", "unit": "rad/s"}}
    known = mapping.Known(told({"signals": whole}))
    a, b, c = (recording.load(tmp_path / name, known) for name in ("a.csv", "b.csv", "c.npz"))
    assert a.digest == b.digest == c.digest != a.between(1.0, 9.0).digest


# -- a real drive ----------------------------------------------------------------------------------------


def test_a_real_drive_of_three_clocks():
    """comma2k19: speeds of satellites, bus and wheels agree as its facts say, the way is 1011.9 m long."""
    path = ROOT / "tests" / "reference" / "comma2k19" / "drive.npz"
    wheels = [f"CAN__wheel_speed[{i}]" for i in range(4)]
    gnss = [f"pose_velocities[{i}]" for i in range(3)]
    at = lambda names, **more: {"speed": {"from": names, "unit": "m/s", **more}}  # noqa: E731
    found = reading.read(path)
    kinds = {name: recording.resampled(name, mapping.apply(told({"signals": each}), found)) for name, each in {
        "bus": at("CAN__speed"), "wheels": at(wheels), "gnss": at(gnss, combine="norm"),
    }.items()}  # fmt: skip
    clock = np.arange(46409.0, 46468.0, 0.01)
    bus, wheel, satellite = (np.interp(clock, each.start + each.time, each["speed"]) for each in kinds.values())
    ratio = satellite / bus
    assert ratio.mean() == pytest.approx(1.0085, abs=0.0005) and ratio.std() < 0.005
    assert (wheel / satellite).mean() == pytest.approx(0.9916, abs=0.0005)
    raw = found["pose_velocities[0]"].time
    norm = np.linalg.norm([found[name].values for name in gnss], axis=0)
    assert np.trapezoid(norm, raw) == pytest.approx(1011.9, abs=0.5)


def test_the_gyroscope_of_that_drive_has_the_clock_of_the_satellites():
    """comma2k19's third clock: how its velocity turns about the axis across the car, over humps and dips, is what the gyroscope shows."""
    found = reading.read(ROOT / "tests" / "reference" / "comma2k19" / "drive.npz")
    time = found["pose_velocities[0]"].time
    v = smooth(time, np.array([found[f"pose_velocities[{i}]"].values for i in range(3)]))
    rotation = np.cross(v, np.gradient(v, time, axis=1), axis=0) / np.sum(v * v, axis=0)
    across = np.linalg.svd(rotation[:, 60:-60])[0][:, 0]  # the road is straight: it turns up and down more than to the sides
    gyro = found["IMU__gyro[1]"]
    clock = np.arange(time[0] + 3.0, time[-1] - 3.0, 0.01)
    one, other = np.interp(clock, time, across @ rotation), np.interp(clock, gyro.time, smooth(gyro.time, gyro.values))
    shifts = np.arange(-50, 51)
    alike = [abs(np.corrcoef(one[100:-100], np.roll(other, shift)[100:-100])[0, 1]) for shift in shifts]
    assert max(alike) > 0.95 and abs(shifts[int(np.argmax(alike))]) * 0.01 <= 0.05  # [s]
    assert other.std() / one.std() == pytest.approx(1.0, abs=0.05)


def smooth(time, values, span=1.0):
    """Means over a span [s] around each time."""
    count = int(span / np.median(np.diff(time)))
    return np.apply_along_axis(np.convolve, -1, values, np.ones(count) / count, "same")


# -- clocks ----------------------------------------------------------------------------------------------


def test_a_clock_that_jumps_back_is_refused_for_it_would_lose_a_part_of_the_drive():
    time = np.concatenate([TIME[:300], TIME[200:400]])
    with pytest.raises(ScenarioError, match=r"jumps back by 1\.98 s, after sample 300 of 500 \(got 5\.98 s, then 4 s\)"):
        signal("Yaw", "rad/s", time, np.ones(500))


def test_samples_that_come_a_little_late_are_put_in_order():
    time = TIME.copy()
    time[[100, 101]] = time[[101, 100]]
    found = signal("Yaw", "rad/s", time, time)
    assert np.array_equal(found.time, TIME) and np.array_equal(found.values, TIME)


def test_times_that_have_lost_their_digits_are_refused_and_a_few_that_are_shared_are_not():
    with pytest.raises(ScenarioError, match="has 399 of 500 samples at the time of another"):
        signal("Yaw", "rad/s", np.round(TIME, 1), TIME)
    shared = TIME.copy()
    shared[10] = shared[9]
    assert signal("Yaw", "rad/s", shared, TIME).values[9] == TIME[10]
