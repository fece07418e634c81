"""CACC and ACC in a platoon of ideal cars, against the closed forms of their transfer functions.

The cars are a/u = 1/(tau s + 1), as the formulas have it; the controllers are the built-in applications themselves.
"""

from math import inf, pi

import numpy as np
import pytest

from studio.application.contract import Clock, Heard, Inbox, Own, Targets
from studio.kind import registry
from studio.kind.number import numbers, tuple_of
from studio.kinds.application.cacc import CAR
from studio.kinds.message.awareness import Payload
from studio.kinds.sensor.front_radar import Reading

TICK, TAU, SUBSTEPS = 0.005, 0.1, 5


def parameters(name, **given):
    module = registry.find("application", name).module
    return tuple_of(module, module.Parameters)(*numbers(module.Parameters(**given)))


def own(v, a):
    """What the bus tells; only speed and acceleration count here."""
    return Own(v, a, 0.0, 0.0, 60.0, 0.0, 0.0, 0.0)


def sees(module, time, tick, v, a, gap, rate, heard):
    """What an application sees behind one car, from which it may hear something."""
    place = Payload(
        gap + CAR - heard.payload.speed * heard.age, 0.0, heard.payload.speed, heard.payload.acceleration, heard.payload.intention
    )
    heard = heard._replace(payload=place)  # the sender is where the radar sees it
    ports = {
        "clock": Clock(time, tick),
        "own": own(v, a),
        "front": Targets(1, (Reading(gap, rate, 0.0),), 0.0),
        "heard": Inbox(1, (heard,)),
    }
    return module.Sees(**{name: ports[name] for name in module.Sees._fields})


def message(age, u, *, received=True, v=0.0, a=0.0):
    """The newest message of the car ahead."""
    return Heard(received, 0.0, age, age, 0.0, Payload(0.0, 0.0, v, a, u))


def platoon(name, *, frequency, cars=2, seconds=120.0, link=True, message_delay=0.0, **given):
    """Amplitudes of the cars' accelerations when the first one's speed swings by ±0.5 m/s about 20 m/s."""
    module, p = registry.find("application", name).module, parameters(name, **given)
    v, u, a = np.full(cars, 20.0), np.zeros(cars), np.zeros(cars)
    gap = np.full(cars, p.standstill + p.headway * 20.0)
    memories = [module.Memory() for _ in range(cars)]
    omega, trace, sent = 2 * pi * frequency, [], []
    for k in range(round(seconds / TICK)):
        t = k * TICK
        sent.append(u.copy())
        heard = sent[max(k - round(message_delay / TICK), 0)]
        # The first car's request is what makes a = 0.5 omega cos(omega t) through its own lag.
        u[0] = 0.5 * omega * (np.cos(omega * t) - TAU * omega * np.sin(omega * t))
        for i in range(1, cars):
            told = message(message_delay if link else inf, heard[i - 1], received=link, v=v[i - 1], a=a[i - 1])
            seen = sees(module, t, TICK, v[i], a[i], gap[i], v[i - 1] - v[i], told)
            memories[i], does = module.decide(p, memories[i], seen)
            u[i] = does.command.acceleration
        for _ in range(SUBSTEPS):
            dt = TICK / SUBSTEPS
            a += dt * (u - a) / TAU
            v_before = v.copy()
            v += dt * a
            gap[1:] += dt * 0.5 * (v[:-1] + v_before[:-1] - v[1:] - v_before[1:])
        trace.append(a.copy())
    settled = np.array(trace[len(trace) // 2 :])
    time = np.arange(len(trace))[len(trace) // 2 :] * TICK
    return np.abs(settled.T @ np.exp(-1j * omega * time)) * 2 / time.size


def gamma(frequency, *, h, theta, k_p=0.2, k_d=0.7, phi=0.0):
    """|Gamma(j omega)| = |(e^(-theta s) + G K)/(H (1 + G K))| (Ploeg et al. 2014); phi [s] dead time of the drive."""
    s = 2j * pi * frequency
    GK = np.exp(-phi * s) * (k_p + k_d * s) / (s * s * (TAU * s + 1))
    return abs((np.exp(-theta * s) + GK) / ((h * s + 1) * (1 + GK)))


@pytest.mark.parametrize("frequency", [0.05, 0.1, 0.2, 0.4])
@pytest.mark.parametrize("theta", [0.0, 0.3])
def test_cacc_is_ploegs(frequency, theta):
    """Gain per car within 1 % of |Gamma|; at theta = 0 that is 1/sqrt(1 + (omega h)²)."""
    amplitudes = platoon("cacc", frequency=frequency, message_delay=theta, headway=0.6)
    expected = gamma(frequency, h=0.6, theta=theta)
    assert amplitudes[1] / amplitudes[0] == pytest.approx(expected, rel=0.01)
    if theta == 0:
        assert expected == pytest.approx(1 / np.sqrt(1 + (2 * pi * frequency * 0.6) ** 2))


def peak(**setup):
    """Greatest gain over 0.01 to 1 Hz, and where."""
    frequencies = np.linspace(0.01, 1.0, 400)
    gains = [gamma(each, **setup) for each in frequencies]
    return max(gains), frequencies[int(np.argmax(gains))]


def test_the_formula_is_the_published_one():
    """With the published test car (tau = 0.1 s, phi = 0.2 s): gain 1.127 at theta = 0.3, h = 0.5; 1.017 at 0.15, 0.6."""
    assert peak(h=0.5, theta=0.3, phi=0.2)[0] == pytest.approx(1.127, abs=0.003)
    assert peak(h=0.6, theta=0.15, phi=0.2)[0] == pytest.approx(1.017, abs=0.003)


def test_cacc_loses_string_stability_with_delay():
    """Where the formula says a 0.3 s old message amplifies at h = 0.5 s, the simulated platoon does; at 1.1 s it does not."""
    expected, worst = peak(h=0.5, theta=0.3)
    assert expected > 1.05
    amplitudes = platoon("cacc", frequency=worst, message_delay=0.3, headway=0.5, seconds=240)
    assert amplitudes[1] / amplitudes[0] == pytest.approx(expected, rel=0.01)
    amplitudes = platoon("cacc", frequency=worst, message_delay=0.3, headway=1.1, seconds=240)
    assert amplitudes[1] / amplitudes[0] < 1.0


@pytest.mark.parametrize("headway", [0.3, 0.6, 1.2])
@pytest.mark.parametrize("frequency", [0.05, 0.2, 0.5])
def test_acc_is_rajamanis(headway, frequency):
    """Gain per car of (s + lambda)/(h tau s³ + h s² + (1 + lambda h) s + lambda) (Rajamani, Eq. 6.22), within 1 %."""
    amplitudes = platoon("acc", frequency=frequency, headway=headway)
    s = 2j * pi * frequency
    expected = abs((s + 0.1) / (headway * TAU * s**3 + headway * s**2 + (1 + 0.1 * headway) * s + 0.1))
    assert amplitudes[1] / amplitudes[0] == pytest.approx(expected, rel=0.01)


def test_a_silent_link_lengthens_the_headway():
    """From the time-out on the wanted gap grows towards that of the fallback."""
    module, p = registry.find("application", "cacc").module, parameters("cacc")
    memory = module.Memory()
    for k in range(1000):
        seen = sees(module, k * 0.02, 0.02, 20.0, 0.0, p.standstill + 0.6 * 20, 0.0, message(k * 0.02, 0.0, v=20.0))
        memory, does = module.decide(p, memory, seen)
        if k == 20:
            assert memory.headway == pytest.approx(0.6) and abs(does.command.acceleration) < 1e-9
    assert memory.headway == pytest.approx(p.degraded_headway)
    assert does.command.acceleration < -0.5
