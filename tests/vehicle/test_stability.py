"""Energy, wheels that leave the ground, kerbs; and the same violence from 0 to 70 m/s for every vehicle of the catalogue."""

import numpy as np
import pytest

from studio.conventions import GRAVITY
from studio.vehicle.contact import HEIGHT
from studio.vehicle.parameter import (
    ARB_F,
    ARB_R,
    BRAKE_MAX,
    J_WF,
    J_WR,
    J_X,
    J_Y,
    J_Z,
    K_F,
    K_R,
    K_TF,
    K_TR,
    L_F,
    L_R,
    M_UF,
    M_UR,
    MASS,
    MASS_S,
    STATIC_F,
    STATIC_R,
    STEER_MAX,
    TRACK_F,
    TRACK_R,
    H,
)  # fmt: skip
from studio.vehicle.state import (
    F_Z,
    OMEGA,
    PITCH,
    PITCH_RATE,
    PSI,
    Q_W,
    Q_X,
    Q_Y,
    Q_Z,
    ROLL,
    ROLL_RATE,
    TRAVEL,
    TRAVEL_RATE,
    V_EAST,
    V_NORTH,
    V_UP,
    V_X,
    YAW_RATE,
    X,
    Y,
    Z,
)  # fmt: skip
from tests.proving_ground import MODELS, Ground

# --- energy --------------------------------------------------------------------------------------------------------------


def at_wheels(p, front, rear) -> np.ndarray:
    return np.array([p[front], p[front], p[rear], p[rear]])


def energy(ground) -> np.ndarray:
    """Mechanical energy [J] of every car on level ground: motion, height, springs, bars and vertical tyres."""
    s, p = ground.state, ground.parameter
    omega, x, rate, F_z = (ground.wheels[row].reshape(4, -1) for row in (OMEGA, TRAVEL, TRAVEL_RATE, F_Z))
    k, k_t, bar = at_wheels(p, K_F, K_R), at_wheels(p, K_TF, K_TR), at_wheels(p, ARB_F, ARB_R)
    static, m_u = at_wheels(p, STATIC_F, STATIC_R), at_wheels(p, M_UF, M_UR)
    body = p[MASS] * (s[V_EAST] ** 2 + s[V_NORTH] ** 2) + p[MASS_S] * s[V_UP] ** 2
    turning = p[J_X] * s[ROLL_RATE] ** 2 + p[J_Y] * s[PITCH_RATE] ** 2 + p[J_Z] * s[YAW_RATE] ** 2
    forward = np.array([p[L_F], p[L_F], -p[L_R], -p[L_R]])
    left = 0.5 * np.array([p[TRACK_F], -p[TRACK_F], p[TRACK_R], -p[TRACK_R]])
    tilt_x, tilt_y = 2.0 * (s[Q_X] * s[Q_Z] - s[Q_W] * s[Q_Y]), 2.0 * (s[Q_Y] * s[Q_Z] + s[Q_W] * s[Q_X])
    height = s[Z] - p[H] + tilt_x * forward + tilt_y * left + x
    lift = s[V_UP] - s[PITCH_RATE] * forward + s[ROLL_RATE] * left + rate
    springs = (static - m_u * GRAVITY) * x + 0.5 * k * x**2 + 0.25 * bar * (x - x[[1, 0, 3, 2]]) ** 2
    tyres = (F_z**2 - static**2) / (2.0 * k_t)
    wheels = 0.5 * at_wheels(p, J_WF, J_WR) * omega**2 + m_u * (0.5 * lift**2 + GRAVITY * height) + springs + tyres
    return 0.5 * (body + turning) + p[MASS_S] * GRAVITY * (s[Z] - p[H]) + wheels.sum(axis=0)


@pytest.mark.parametrize("speed", [3.0, 10.0, 25.0])
@pytest.mark.parametrize("steer", [0.005, 0.03])
def test_coasting_in_a_bend_never_gains_energy(steer, speed):
    """No drag, no brakes, no engine, 12 s: the tyres' slip takes energy, tick by tick, and nothing gives any."""
    ground = Ground(MODELS, speed=speed, resistances=False).command(steering=steer).run(2.0)
    seen = ground.history(12.0, energy)
    assert (np.diff(seen, axis=0) <= 1e-9 * seen[0]).all()
    assert (seen[-1] < seen[0]).all()


def test_a_slalom_only_costs_energy():
    """Swinging at 1.5 Hz, springs, dampers, bars and links at work: over each second there is less than before."""
    ground = Ground(MODELS, speed=20.0, resistances=False).run(2.0)

    def steer(each):
        each.command(steering=0.02 * np.sin(3.0 * np.pi * each.time))

    seen = ground.history(12.0, energy, steer)
    assert (seen[50:] < seen[:-50]).all()


def test_rolling_straight_keeps_its_energy():
    """Without resistances nothing is lost in 20 s: less than a millionth, where static camber makes the tyres work 1e-3."""
    ground = Ground(MODELS, speed=20.0, resistances=False).run(2.0)
    before = energy(ground)
    lost = (before - energy(ground.run(20.0))) / before
    assert (lost > -1e-9).all() and (lost < 1e-3).all()
    assert abs(lost[[MODELS.index("bmw_320i"), MODELS.index("ford_escort")]]).max() < 1e-9


# --- wheels and the road ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("corner", [0, 3])
def test_a_wheel_leaves_the_ground_and_comes_back(model, corner):
    """The road falls away under one wheel for 0.3 s: it hangs in the air and carries nothing; afterwards all is as before."""
    ground = Ground(model, speed=15.0).run(1.0)
    before = ground.wheel(F_Z).copy()
    ground.put(HEIGHT, corner, -0.4)
    hanging = ground.history(0.3, lambda each: each.wheel(F_Z)[corner])
    assert (hanging == 0.0).any() and (hanging >= 0.0).all()
    others = np.delete(ground.wheel(F_Z), corner)
    assert others.sum() > 0.5 * before.sum()
    ground.put(HEIGHT, corner, 0.0)
    landing = ground.history(4.0, lambda each: each.wheel(F_Z).copy())
    assert landing[:, corner].max() > before[corner]
    assert landing[-1] == pytest.approx(before, rel=0.01)
    assert abs(ground[ROLL]) < 1e-3


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("speed", [0.0, 10.0, 40.0])
def test_a_kerb_under_one_wheel(model, speed):
    """0.1 m under the front left wheel for a second: a blow, no more; then the car stands or rolls level again."""
    ground = Ground(model, speed=speed).run(0.5)
    before = ground.wheel(F_Z).copy()
    ground.put(HEIGHT, 0, 0.1)
    up = ground.history(1.0, lambda each: each.wheel(F_Z).copy())
    assert np.isfinite(ground.state).all() and up[0, 0] > before[0] and (up >= 0.0).all()
    assert ground[ROLL] > 0.005 and ground[PITCH] < 0.0  # its left front stands higher
    ground.put(HEIGHT, 0, 0.0).run(6.0)
    assert ground.wheel(F_Z) == pytest.approx(before, rel=0.01)
    assert abs(ground[V_UP]) < 1e-3 and abs(ground[ROLL]) < 1e-3 and ground[V_X] <= speed + 0.05


# --- everything at once ----------------------------------------------------------------------------------------------------

SPEEDS = (0.0, 0.2, 1.0, 3.0, 10.0, 25.0, 45.0, 70.0)
FRICTIONS = (1.0, 0.1)
MANEUVERS = ("locked", "steering", "throttle", "kerb")
VIOLENCE, SAMPLE = 10.0, 0.1  # [s] of the maneuver; between two looks
OVERTURNED = 0.4 * np.pi  # [rad] roll or pitch of a car that lies on its side: it slides to a stop, nothing more is claimed
ROCKING = 0.3  # [m/s] that springs and contact patches may give back to a car that stops
CASES = [(model, speed, friction) for model in MODELS for speed in SPEEDS for friction in FRICTIONS]


class Violence:
    """All vehicles at all speeds on road and ice through one maneuver, then braked, locked, until they stand."""

    def __init__(self, maneuver):
        models, speeds, frictions = zip(*CASES, strict=True)
        ground = Ground(models, speed=speeds, friction=frictions, powertrain=maneuver == "throttle")
        self.ground, p = ground, ground.parameter
        if maneuver == "locked":
            ground.command(applied_brake=1e6)
        elif maneuver == "steering":
            ground.command(steering=p[STEER_MAX])
        elif maneuver == "throttle":
            ground.command(pedal=1.0)
        self.speeds, self.tilts = [np.array(speeds)], []
        for k in range(round(VIOLENCE / SAMPLE)):
            if maneuver == "kerb":
                ground.put(HEIGHT, 0, 0.1 if 5 <= k < 15 else 0.0)
            self.look(SAMPLE)
        if maneuver != "locked":
            ground.command(pedal=0.0, brake=p[BRAKE_MAX])
        while np.nanmax(self.speeds[-1]) > 0.01 and ground.time < 400.0:
            self.look(1.0)
        self.look(30.0)
        self.before = ground.state[[X, Y, Z, PSI]].copy()
        self.look(1.0)

    def look(self, seconds):
        s = self.ground.run(seconds).state
        self.speeds.append(np.hypot(s[V_EAST], s[V_NORTH]))
        self.tilts.append(np.maximum(np.abs(s[ROLL]), np.abs(s[PITCH])))


_seen: dict[str, Violence] = {}


def violence(maneuver) -> Violence:
    """One run for all cases of a maneuver."""
    if maneuver not in _seen:
        _seen[maneuver] = Violence(maneuver)
    return _seen[maneuver]


@pytest.mark.parametrize("maneuver", MANEUVERS)
@pytest.mark.parametrize("friction", FRICTIONS, ids=["road", "ice"])
@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("speed", SPEEDS)
def test_stable_at_every_speed(model, speed, friction, maneuver):
    """Finite; in the end it stands, without shaking; and never faster than it was, but for what rocks back."""
    seen, v = violence(maneuver), CASES.index((model, speed, friction))
    assert np.isfinite(seen.ground.state[:, v]).all()
    assert np.isfinite(seen.ground.wheels.reshape(-1, 4, len(CASES))[:, :, v]).all()
    speeds = np.array([each[v] for each in seen.speeds])
    assert speeds[-1] < 1e-5
    assert np.abs(seen.ground.state[[X, Y, Z, PSI], v] - seen.before[:, v]).max() < 1e-5
    if maneuver == "throttle":
        assert speeds.max() < 75.0
        speeds = speeds[round(VIOLENCE / SAMPLE) + 10 :]
    if max(tilt[v] for tilt in seen.tilts) < OVERTURNED:
        assert (speeds - np.minimum.accumulate(speeds)).max() < ROCKING


@pytest.mark.parametrize("maneuver", MANEUVERS)
def test_nobody_overturns_on_ice_nor_without_steering(maneuver):
    """Full steering on the road may: tyres of 1.05 g under cars as high as the BMW's and the Escort's, and the truck."""
    tilts = np.array(violence(maneuver).tilts).max(axis=0)
    calm = np.array([friction == 0.1 or maneuver != "steering" for _, _, friction in CASES])
    assert tilts[calm].max() < 0.35
