"""String gain over frequency, jerk and effort, where the answer is known."""

from dataclasses import replace

import numpy as np
import pytest

from studio.assess.effort import energy, lasting
from studio.assess.measure import measure_all
from studio.assess.string_stability import spectrum
from studio.execution.record import Chain
from tests.assess.drive import record

TIME = np.arange(0.0, 60.0, 0.02)


def chained(acceleration):
    """A record of a chain of cars with these accelerations [m/s²]."""
    names = tuple("abcdefgh"[: len(acceleration)])
    return replace(record(TIME, names, acceleration=acceleration), chains=(Chain("platoon", "", names),))


def lagged(values, h):
    """Through 1/(h s + 1), exactly for values that are held over each sample."""
    found, now, keep = np.zeros(values.size), 0.0, np.exp(-0.02 / h)
    for i in range(1, values.size):
        now = keep * now + (1.0 - keep) * values[i - 1]
        found[i] = now
    return found


@pytest.mark.parametrize("gain", [1.184, 0.697, 1.0])
def test_the_gain_of_a_sine(gain):
    """0.2 Hz with a shift of phase: the ratio of the amplitudes, at that frequency; within 0.003."""
    wave = np.array([np.sin(0.4 * np.pi * TIME), gain * np.sin(0.4 * np.pi * TIME - 0.7)])
    found = measure_all(chained(wave))
    assert found["hop_gain_peak"].value == pytest.approx(gain, abs=3e-3) and found["hop_gain_peak"].subject == ("a", "b")
    assert found["hop_gain_frequency"].value == pytest.approx(0.2, abs=1.0 / 60.0)


def test_the_gain_over_frequency_of_a_lag():
    """A brake through 1/(h s + 1) with h = 0.5 s: 1/√(1 + (ω h)²) at every excited frequency; within 0.01."""
    brake = np.where((TIME > 29.0) & (TIME < 30.5), -4.0, 0.0)
    found = spectrum(brake, lagged(brake, 0.5), TIME)
    assert found.frequency.size > 20
    np.testing.assert_allclose(found.gain, 1.0 / np.hypot(1.0, 2.0 * np.pi * found.frequency * 0.5), atol=0.01)


def test_from_the_first_to_the_last():
    """Three hops of 1.1 at 0.1 Hz, the fourth of 0.5: the worst hop 1.1, head to tail 0.6655."""
    waves = np.array([factor * np.sin(0.2 * np.pi * TIME - i) for i, factor in enumerate((1.0, 1.1, 1.21, 1.331, 0.6655))])
    found = measure_all(chained(waves))
    assert found["hop_gain_peak"].value == pytest.approx(1.1, abs=3e-3)
    assert found["platoon_gain_peak"].value == pytest.approx(0.6655, abs=3e-3)
    assert found["platoon_gain_peak"].subject == ("a", "e") and found["platoon_gain_frequency"].value == pytest.approx(0.1, abs=1.0 / 60.0)


def test_no_disturbance_has_no_spectrum():
    assert measure_all(chained(np.zeros((2, TIME.size))))["hop_gain_peak"].value is None


def test_the_strongest_jerk_of_a_second():
    """A step of 3 m/s² is 3 m/s³ over a second, wherever it is; a ramp of 2 m/s³ is that."""
    step = measure_all(record(TIME, acceleration=np.array([np.where(TIME < 20.0, 0.0, -3.0), np.minimum(2.0 * TIME, 2.0)])))
    assert step["jerk_peak"].value == pytest.approx(3.0) and step["jerk_peak"].subject == ("a",)


def test_energy_at_the_wheels():
    """100 Nm at wheels of 0.3 m and 30 m/s for 10 s: 100 kJ; what brakes gives nothing back. 100 N over 300 m against it."""
    time = np.linspace(0.0, 10.0, 501)
    torque = np.array([np.full(501, 100.0), np.where(time < 5.0, 100.0, -200.0)])
    found = energy(torque, np.full((2, 501), 30.0), np.array([0.3, 0.3]), time)
    assert found[0] == pytest.approx(100.0 / 0.3 * 300.0) and found[1] == pytest.approx(found[0] / 2.0, rel=3e-3)
    assert measure_all(record(time, drive_torque=torque, speed=30.0))["energy"].value == pytest.approx(found.sum())


def test_how_long_something_lasts():
    assert lasting(np.array([[True, True, False, True]]), np.array([0.0, 0.1, 0.3, 0.6])).tolist() == pytest.approx([0.3])


def test_outside_the_linear_span():
    """Of four wheels the one that uses most counts: 0.6 of its adhesion for 2 s."""
    time = np.linspace(0.0, 10.0, 501)
    use = np.where((time >= 3.0) & (time < 5.0), 0.6, 0.1)
    found = measure_all(record(time, adhesion_rear_left=np.array([use, 0.2 + 0.0 * use])))
    assert found["nonlinear_tyre_time"].value == pytest.approx(2.0) and found["nonlinear_tyre_time"].subject == ("a",)
    assert found["max_adhesion"].value == pytest.approx(0.6) and found["max_adhesion"].time == pytest.approx(3.0)
