"""What accelerations that are asked for become: drive and brake without overlap, gears that do not hunt, a stop at an amber as decided."""

import numpy as np
import pytest

from studio.conventions import GRAVITY
from studio.model import tyre
from studio.road.drawn.motorway import motorway
from studio.road.network.signals import AMBER, GREEN
from studio.scenario import file
from studio.scenario.setup import complete
from studio.vehicle.parameter import BRAKE_MAX, BRAKE_SHARE, FRONT, L_F, L_R, MASS, RADIUS, REGEN, STATIC_F, STATIC_R, H
from studio.vehicle.state import A_X, GEAR, OMEGA, TORQUE_BRAKE, V_X
from studio.world.build import build
from studio.world.passes.control import APP_ACCELERATION
from studio.world.setting import setting
from studio.world.table.mind import STATION
from studio.world.tick import act, meet, part, tick
from tests.proving_ground import MODELS

TICK = 0.02


@pytest.fixture
def alone(tmp_path):
    """A world of one car each, of these models at a speed [m/s], on a straight road."""
    (tmp_path / "motorway.xodr").write_text(motorway(length=3000.0, lanes=1), encoding="utf-8")

    def made(models, speed, friction=1.0):
        return build([setting(complete(document(model, speed, friction), "pedals"), tmp_path, "pedals") for model in models])

    return made


def document(model, speed, friction):
    return {
        "title": "pedals", "map": {"file": "motorway.xodr"}, "routes": {"way": {"roads": ["motorway"]}},
        "vehicles": {"car": {"model": model, "route": "way", "position": {"along": 50}, "speed": speed}},
        "weather": {"friction": friction},
    }  # fmt: skip


def asked(world, request, seconds, rows):
    """float64[row, tick, vehicle] of a drive with accelerations asked for, `request(time, speeds)` [m/s²]."""
    seen = []
    for _ in range(round(seconds / TICK)):
        meet(world)
        v = world.vehicles
        v.app_command[APP_ACCELERATION] = request(world.clock.time, v.state[V_X])
        act(world)
        part(world)
        seen.append(v.state[rows])
    return np.array(seen).transpose(1, 0, 2)


# -- drive and brake -------------------------------------------------------------------------------------


@pytest.mark.parametrize("model", MODELS)
def test_what_is_asked_is_what_comes(alone, model):
    """Steady decelerations from 20 m/s, drag alone to firm braking: within 1 %, between drive and brake too."""
    wanted = -np.array([0.2, 0.5, 0.8, 1.2, 1.6, 2.0, 3.0, 4.0])
    world = alone([model] * wanted.size, 20.0)
    asked(world, lambda time, speed: 0.0 * speed, 3.0, [A_X])
    (a,) = asked(world, lambda time, speed: wanted, 2.5, [A_X])
    assert a[50:].mean(axis=0) == pytest.approx(wanted, rel=0.01)


@pytest.mark.parametrize("model", MODELS)
def test_at_walking_pace_a_creeping_engine_is_held_back(alone, model):
    """Mild decelerations where an idling engine pushes through the converter: the brakes take that too."""
    wanted = -np.array([0.1, 0.2, 0.35, 0.5, 0.8])
    world = alone([model] * wanted.size, 3.5)
    asked(world, lambda time, speed: 0.0 * speed, 2.0, [A_X])
    v, a = asked(world, lambda time, speed: wanted, 3.5, [V_X, A_X])
    assert v.min() > 0.4
    assert a[75:].mean(axis=0) == pytest.approx(wanted, rel=0.08, abs=0.02)


def test_a_motor_that_takes_back_leaves_the_brakes_alone(alone):
    """Up to what the motor can; beyond it the brakes do the rest, with no more than a tenth beyond what is asked meanwhile."""
    wanted = -np.array([0.5, 1.0, 2.0, 4.0])
    world = alone(["electric_compact"] * wanted.size, 20.0)
    asked(world, lambda time, speed: 0.0 * speed + 0.5, 3.0, [A_X])
    brake, a = asked(world, lambda time, speed: wanted, 2.5, [TORQUE_BRAKE, A_X])
    assert brake[:, :3].max() == 0.0 and brake[-1, 3] > 500.0
    assert (a.min(axis=0) > 1.05 * wanted).all()


def hardest(world, friction):
    """Deceleration [m/s²] at which the first axle comes to the peak of its tyres, by the loads at rest, or the brakes to theirs.

    An axle with the share xi of the brakes and the load m (g b + a h)/L, b from the centre of gravity to the other axle, holds
    xi a = mu (g b + a h)/L, so a = mu g b/(xi L - mu h); of the rear axle h counts the other way. A motor on the axle that would come
    second fills that axle up, so both come to it together, at mu g.
    """
    p, v = world.vehicles.parameter, world.vehicles
    L, loads = p[L_F] + p[L_R], (p[STATIC_F], p[STATIC_R])
    mu = np.array([
        [tyre.longitudinal_peak(tyre.Tyre(*v.tyres[t]), F, friction) / F for t, F in zip(of, load, strict=True)]
        for of, load in zip(v.tyres_of, loads, strict=True)
    ])  # fmt: skip
    front = mu[0] * GRAVITY * p[L_R] / (p[BRAKE_SHARE] * L - mu[0] * p[H])
    rear = mu[1] * GRAVITY * p[L_F] / ((1.0 - p[BRAKE_SHARE]) * L + mu[1] * p[H])
    tyres = np.where(p[REGEN] > 0.0, mu.min(axis=0) * GRAVITY, np.minimum(front, rear))
    return np.minimum(tyres, p[BRAKE_MAX] / (p[MASS] * p[RADIUS]))


@pytest.mark.parametrize("friction", [0.2, 0.3, 0.6, 1.0])
def test_on_any_road_comes_what_is_asked(alone, friction):
    """Up to 0.85 of the hardest that brings no tyre beyond its peak, within 3 % after a second, and no wheel slides.

    An electric car, whose motor answers quicker than brakes and whose brakes fill up what its driven wheels do not hold, within 2 % after
    half a second.
    """
    shares = np.repeat([0.3, 0.6, 0.85], len(MODELS))
    world = alone(MODELS * 3, 20.0, friction)
    wanted = -shares * hardest(world, friction)
    asked(world, lambda time, speed: 0.0 * speed, 3.0, [V_X])
    (v,) = asked(world, lambda time, speed: wanted, 1.5, [V_X])
    early, late = (v[50] - v[25]) / (25 * TICK), (v[-1] - v[50]) / (24 * TICK)
    is_electric = world.vehicles.parameter[REGEN] > 0.0
    assert late == pytest.approx(wanted, rel=0.03)
    assert is_electric.any() and early[is_electric] == pytest.approx(wanted[is_electric], rel=0.02)
    turning = world.vehicles.wheels[OMEGA].reshape(4, -1) * world.vehicles.parameter[RADIUS]
    assert (turning > 0.85 * v[-1]).all()


# -- gears -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("frequency", [0.1, 0.2, 0.4])
def test_a_swing_of_the_pedal_shifts_nothing(alone, frequency):
    """±0.5 m/s about 20 m/s, the truck ±0.2 m/s as its engine lets: no change of gear in 40 s, and 85 % of what is asked comes."""
    world, omega = alone(MODELS, 20.0), 2.0 * np.pi * frequency
    swing = np.array([0.2 if model == "truck" else 0.5 for model in MODELS]) * (0.5 if frequency > 0.3 else 1.0)

    def request(time, speed):
        return swing * omega * np.cos(omega * time) + 0.2 * (20.0 + swing * np.sin(omega * time) - speed)

    asked(world, request, 20.0, [V_X])
    time = 20.0 + TICK * np.arange(2000)
    gear, speed = asked(world, request, 40.0, [GEAR, V_X])
    assert (np.diff(gear, axis=0) == 0.0).all()
    amplitude = 2.0 * np.abs(np.mean(speed * np.exp(-1j * omega * time)[:, None], axis=0))
    assert amplitude == pytest.approx(swing, rel=0.15)


# -- an amber --------------------------------------------------------------------------------------------


def before_lights(sample, model, speed):
    """A car on its way to the second light of a street, 120 m before it."""
    document = {key: value for key, value in file.read(sample.parent / "urban_grid.yaml").items() if key not in ("applications", "goals")}
    car = {"model": model, "route": "straight_on", "position": {"along": 476}, "speed": speed, "driver": {"speed_factor": speed / 13.89}}
    return setting(complete(document | {"vehicles": {"car": car}, "traffic": {"count": 0}}, "amber"), sample.parent, "amber")


@pytest.mark.parametrize("speed", [7.0, 13.9, 20.0])
def test_an_amber_is_stopped_at_as_decided(sample, speed):
    """It comes when firm braking just does: 4 m/s², a tenth more over half a second while gears shift, and 2 m are left."""
    world = build([before_lights(sample, model, speed) for model in MODELS])
    v, r = world.vehicles, world.roads
    second, hardest, n = r.stop_first + 1, [], len(MODELS)
    r.forced[:] = GREEN
    shown = np.zeros(n, bool)
    for _ in range(1500):
        left, v_x = r.stop_station[second] - v.mind[STATION] - v.parameter[FRONT], v.state[V_X]
        shown |= left <= 2.6 + 0.3 * v_x + v_x**2 / 8.0
        r.forced[r.stop_link[second[shown]]] = AMBER
        tick(world)
        hardest.append(v.state[A_X].copy())
        if shown.all() and (v_x < 0.01).all():
            break
    smooth = np.array([np.convolve(each, np.full(25, 0.04), "valid").min() for each in np.array(hardest).T])
    assert shown.all() and (smooth > -4.4).all()
    assert r.stop_station[second] - v.mind[STATION] - v.parameter[FRONT] == pytest.approx(2.0, abs=0.25)
