"""CACC on whole vehicles: string stability against theory with the same parameters, losses, noise, strangers, and other laws."""

from functools import cache

import numpy as np
import pytest

from docs.figures.convoy import SPEED, convoy, gain, heard, lines, run, settled, swing
from studio import job
from studio.assess.transfer import FREQUENCIES, actuated, delayed, laplace, least_headway, ploeg
from studio.kind import registry
from studio.kind.number import numbers, tuple_of

R = 2.5  # [m] standstill distance of cacc
LAWS = {"cacc": R + 0.6 * SPEED, "cacc_path": 2.0 + 0.7 * SPEED, "cacc_leader": 5.0, "cacc_consensus": 4.0 + 0.4 * SPEED,
        "cacc_direct": 2.0 + 0.5 * SPEED}  # fmt: skip
STEADY = [[0.0, SPEED], [60.0, SPEED]]
BRAKING = [[0.0, SPEED], [20.0, SPEED], [22.0, 8.0], [30.0, 8.0], [40.0, SPEED], [60.0, SPEED]]
CRITICAL = (0.07, 0.085, 0.1)  # [Hz] where the gain is greatest at the least headway
TWO_TICKS = 0.04  # [s] the request of the last tick is sent, and used at the next one


def swinging(frequency, headway, **setup):
    """Two cars on cacc."""
    parameters = {"headway": headway} | setup.pop("parameters", {})
    return convoy("cacc", swing(frequency), gap=R + headway * SPEED, parameters=parameters, **setup)


@cache
def drive():
    """The lag [s] of drive and brakes of the car: phase of its acceleration behind what it was asked for."""
    (record,) = run([swinging(0.1, 1.0)])
    A = lines(record, "acceleration", 0.1) / lines(record, "requested_acceleration", 0.1)
    assert np.abs(A) == pytest.approx(1.0, abs=0.005)
    return float(-np.angle(A[0]) / (2.0 * np.pi * 0.1))


def test_least_headway_over_delay():
    """Within 0.05 s of theory: 0.05 s below the headway of theory cars amplify, 0.05 s above they do not."""
    A = actuated(drive(), 0.0)
    delays = (0.0, 0.02, 0.05, 0.1, 0.15)
    theory = [least_headway(lambda h, theta=theta: abs(ploeg(A, delayed(theta + TWO_TICKS), h))) for theta in delays]
    cases = [(h + dh, theta, f) for theta, h in zip(delays, theory, strict=True) for dh in (-0.05, 0.05) for f in CRITICAL]
    gains = [abs(gain(record, f)[0]) for record, (_, _, f) in zip(run([
        swinging(f, h, radio={"delay": theta}) for h, theta, f in cases
    ]), cases, strict=True)]  # fmt: skip
    peaks = np.max(np.reshape(gains, (len(delays), 2, len(CRITICAL))), axis=2)
    assert np.all(peaks[:, 0] > 1.0) and np.all(peaks[:, 1] < 1.0), dict(zip(delays, peaks.tolist(), strict=True))


def held(loss, period, age, f=FREQUENCIES):
    """What a message of this age [s] is worth that is held until the next one, each of which may be lost, at a frequency [Hz]."""
    s = laplace(f)
    z = np.exp(-s * period)
    return np.exp(-s * age) * (1.0 - z) / (s * period) * (1.0 - loss) / (1.0 - loss * z)


@pytest.mark.parametrize("loss", [0.0, 0.2, 0.4, 0.6])
def test_gain_over_loss(loss):
    """Ten messages a second, some lost: the mean gain is that of theory with the age that messages have then, within 0.03."""
    f, period = 0.12, 0.1
    records = run(
        [swinging(f, 0.5, radio={"delay": 0.02, "loss": loss}, period=period, parameters={"timeout": 5.0}, seed=seed) for seed in range(8)]
    )
    found = np.mean([gain(record, f)[0] for record in records])
    expected = ploeg(actuated(drive(), 0.0, f), held(loss, period, 0.02 + TWO_TICKS - 0.01, f), 0.5, frequency=f)
    assert abs(found) == pytest.approx(abs(expected), abs=0.03)


def lossy(headway, loss, seeds, f=0.08, period=0.1):
    """The gain at a frequency [Hz] near its greatest one, of ten messages a second some of which are lost: the mean over seeds."""
    radio, patient = {"delay": 0.02, "loss": loss}, {"timeout": 5.0}
    records = run([swinging(f, headway, radio=radio, period=period, parameters=patient, seed=seed) for seed in range(seeds)])
    return abs(np.mean([gain(record, f)[0] for record in records]))


@pytest.mark.parametrize(("loss", "seeds", "least"), [(0.0, 1, 0.545), (0.2, 24, 0.610), (0.4, 24, 0.706), (0.6, 24, 0.867)])
def test_least_headway_over_loss(loss, seeds, least):
    """Within 0.05 s of theory with the age that messages have then: 0.05 s below the headway of theory cars amplify, above they do not."""
    A, D = actuated(drive(), 0.0), held(loss, 0.1, 0.02 + TWO_TICKS - 0.01)
    theory = least_headway(lambda h: abs(ploeg(A, D, h)))
    assert theory == pytest.approx(least, abs=0.005), "as the documentation has it"
    assert lossy(theory - 0.05, loss, seeds) > 1.0 > lossy(theory + 0.05, loss, seeds)


def test_degraded_lies_between_link_and_radar_alone():
    """At 1.6 s without a link: the estimate keeps the string stable, the radar alone at the same headway does not, at 3.2 s it does."""
    frequencies = (0.03, 0.06, 0.09)
    silent = {"radio": {"loss": 1.0}}
    kinds = ({"degraded_headway": 1.6}, {"estimates": False, "fallback_headway": 1.6}, {"estimates": False, "fallback_headway": 3.2})
    cases = [(f, kind) for kind in kinds for f in frequencies]
    records = run([
        convoy("cacc", swing(f), gap=R + wanted(kind) * SPEED, parameters={"headway": wanted(kind)} | kind, **silent) for f, kind in cases
    ])  # fmt: skip
    gains = np.reshape([abs(gain(record, f)[0]) for record, (f, _) in zip(records, cases, strict=True)], (3, 3)).max(axis=1)
    expected = abs(ploeg(actuated(drive(), 0.0, frequencies), 0.0, 1.6, frequency=frequencies)).max()
    assert gains[0] < 1.0 and gains[1] == pytest.approx(expected, abs=0.01) and gains[2] < 1.002 and expected > 1.08


def wanted(kind):
    """The headway [s] in force without a link."""
    return kind.get("degraded_headway", kind.get("fallback_headway"))


def test_losing_the_link_opens_the_gap():
    """All messages are lost from 20 s on: the headway goes to 1.6 s and the car with it, without a jolt, and back when they return."""
    script = {"silence": {"when": {"kind": "time", "at": 20.0}, "do": {"kind": "drop_messages", "unit": "car_0", "count": 300}}}
    (record,) = run([convoy("cacc", [[0.0, SPEED], [90.0, SPEED]], gap=R + 0.6 * SPEED, period=0.1, script=script)])
    gap, linked, time = record.trace("car_1.gap"), record.probes["car_1.platoon.linked"].values, record.time
    assert np.all(linked[(time > 1.0) & (time < 20.0)] == 1.0) and np.all(linked[(time > 20.8) & (time < 50.0)] == 0.0)
    assert gap[(time > 45.0) & (time < 50.0)] == pytest.approx(R + 1.6 * SPEED, abs=1.0)
    assert gap[-1] == pytest.approx(R + 0.6 * SPEED, abs=1.0)
    assert np.abs(record.trace("car_1.acceleration")).max() < 2.0


def test_a_stranger_is_not_taken_for_the_sender():
    """The car ahead is another one than that which is listened to, two places on: nothing that it tells is fed forward."""
    document = convoy("cacc", STEADY, gap=R + 0.6 * SPEED, cars=3, period=0.1, noisy=True)
    document["applications"]["platoon"] |= {"units": ["car_2"], "listens_to": ["car_0"]}
    document["vehicles"]["car_1"]["driver"] = {"kind": "attentive", "time_headway": 0.8}
    (record,) = run([document])
    linked = record.probes["car_2.platoon.linked"].values[record.time > 2.0]
    assert np.all(linked == 0.0)
    assert record.trace("car_2.gap")[-1] == pytest.approx(R + 1.6 * record.trace("car_2.speed")[-1], abs=2.0)


def changes_of_sign(record, name):
    """Of what is asked of a car in the last 30 s."""
    asked = np.sign(record.trace(f"{name}.requested_acceleration")[record.time >= record.time[-1] - 30.0])
    asked = asked[asked != 0.0]
    return int(np.sum(asked[1:] * asked[:-1] < 0.0))


@pytest.mark.parametrize("law", LAWS)
def test_noise_does_not_make_it_chatter(law):
    """30 s behind a steady leader, radar and satellites as noisy as usual: the request hardly changes its sign."""
    (record,) = run([convoy(law, STEADY, gap=LAWS[law], cars=4, listens=heard(law, 4), period=0.1, noisy=True)])
    assert all(changes_of_sign(record, f"car_{i}") <= 16 for i in (1, 2, 3))


@pytest.mark.parametrize("law", LAWS)
def test_the_platoon_brakes_and_comes_back(law):
    """From 22 to 8 m/s with 7 m/s²: nobody hits anybody, nobody brakes much harder than the leader, and the gaps are the law's again."""
    (record,) = run([convoy(law, BRAKING, gap=LAWS[law], cars=6, listens=heard(law, 6), period=0.1, radio={"delay": 0.02, "loss": 0.05})])
    gaps = np.array([record.trace(f"car_{i}.gap") for i in range(1, 6)])
    strongest = [record.trace(f"car_{i}.acceleration").min() for i in range(6)]
    assert gaps.min() > 2.0 and min(strongest) > strongest[0] - 0.6
    assert gaps[:, -1] == pytest.approx(LAWS[law], abs=1.0)


def test_two_hundred_cars():
    """4 km of platoon at 0.8 s, ten messages a second: the swing of the leader is less in every car, and gone in the last."""
    points = [[0.0, SPEED], [2.0, SPEED], [5.0, SPEED - 6.0], [8.0, SPEED], [60.0, SPEED]]
    (record,) = run([convoy("cacc", points, gap=R + 0.8 * SPEED, cars=200, period=0.1, radio={"delay": 0.02}, parameters={"headway": 0.8})])
    swings = np.array([SPEED - record.trace(f"car_{i}.speed").min() for i in range(0, 200, 10)])
    assert swings[0] > 5.0 and np.all(np.diff(swings) < 0.05) and swings[-1] < 1.0
    assert not any(each.kind == "collision" for each in record.happenings)


def test_weights_of_leader_and_predecessor():
    """0.5, 0.5, -0.3, -0.1, -0.04 with Plexe's C_1, xi and omega, exactly (M. Segata et al., VNC 2014)."""
    module = registry.find("application", "cacc_leader").module
    p = tuple_of(module, module.Parameters)(*numbers(module.Parameters()))
    assert module.weights(p) == pytest.approx((0.5, 0.5, -0.3, -0.1, -0.04), abs=1e-12)


@pytest.mark.parametrize(("headway", "grows"), [(0.55, True), (0.8, False)])
def test_path_is_string_stable_from_its_headway_on(headway, grows):
    """sqrt(2 T_step/k_p) = 0.667 s: a car at 0.55 s amplifies at 0.1 Hz, one at 0.8 s does not."""
    document = convoy("cacc_path", swing(0.1), gap=2.0 + headway * SPEED, parameters={"headway": headway})
    (record,) = run([document])
    assert (abs(gain(record, 0.1)[0]) > 1.0) == grows


def test_what_is_measured_is_settled():
    """Whole periods at the end: the mean of a sine over them is nothing."""
    time = np.arange(0.0, 109.99, 0.02)
    kept = settled(time, 0.1)
    assert abs(np.mean(np.sin(2 * np.pi * 0.1 * time[kept]))) < 2e-3


SAMPLES = ("cacc_sine", "cacc_brake", "cacc_step")


@pytest.mark.parametrize("name", SAMPLES)
def test_the_samples_meet_their_goals(root, name):
    outcome = job.run(job.load(root / "scenarios" / f"{name}.yaml"))
    assert outcome.status == "done" and not outcome.unmet, outcome.unmet


def test_parameters_that_fail_are_told_by_the_gain(root):
    """A headway of 0.3 s with a radio of 0.15 s: every car works harder than the one ahead, the last almost twice as hard as the leader."""
    changes = {"applications.platoon.parameters.headway": 0.3, "radio.delay": 0.15}
    outcome = job.run(job.load(root / "scenarios" / "cacc_sine.yaml", changes))
    assert outcome.metrics["worst_hop_gain"].value > 1.05 and outcome.metrics["platoon_gain"].value > 1.5
    assert len(outcome.unmet) == 2
