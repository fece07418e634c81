"""A driver finds back to his path: from beside it, from a wrong heading, after a swerve, in a bend, backwards; every catalogue vehicle."""

from itertools import product

import numpy as np
import pytest

from studio.scenario import catalogue
from studio.scenario.setup import complete
from studio.vehicle.command import RING, U_BRAKE, U_DRIVE, U_GEAR, U_PEDAL
from studio.vehicle.parameter import C_D, C_ROLL, L_F, L_R
from studio.vehicle.state import A_Y, GEAR, NEXT_GEAR, NEXT_RATIO, PSI, Q_W, Q_Z, RATIO, ROLL, V_EAST, V_NORTH, V_X, X, Y
from studio.world.build import build
from studio.world.setting import setting
from studio.world.table.mind import D_PSI, FRONT_OFFSET
from studio.world.tick import between, meet, part, tick
from tests.closed_form import understeer_gradient
from tests.proving_ground import FIGURES, MODELS, Ground

TICK = 0.02
NEAR, ALIGNED = 0.3, np.radians(2.0)  # [m], [rad] from the path that count as back
ROAD = (
    '<OpenDRIVE><header/><road id="a" length="{length}" junction="-1"><type s="0" type="rural"><speed max="230" unit="km/h"/></type>'
    '<planView>{shape}</planView><lanes><laneSection s="0"><right><lane id="-1" type="driving">'
    '<width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></right></laneSection></lanes></road></OpenDRIVE>'
)
PIECE = '<geometry s="{s}" x="{s}" y="0" hdg="0" length="{length}">{form}</geometry>'
LEAD = 95.0  # [m] of straight road before a bend; cars start at its end


def drawn(radius):
    """A straight road, or three quarters of a turn to the left with this radius [m] of its only lane."""
    if radius is None:
        return ROAD.format(length=4000, shape=PIECE.format(s=0, length=4000, form="<line/>"))
    turn = 1.5 * np.pi * (radius - 1.75)
    bend = PIECE.format(s=LEAD, length=turn, form=f'<arc curvature="{1.0 / (radius - 1.75)}"/>')
    return ROAD.format(length=LEAD + turn, shape=PIECE.format(s=0, length=LEAD, form="<line/>") + bend)


@pytest.fixture
def road(tmp_path):
    """Settings of one car each, (model, speed [m/s], script), on such a road."""

    def settings(cars, radius=None):
        (tmp_path / "map.xodr").write_text(drawn(radius))
        return [setting(document(*car), tmp_path, "back") for car in cars]

    return settings


def document(model, speed, script=None):
    """One car on the road."""
    return complete(
        {
            "title": "back", "map": {"file": "map.xodr"}, "script": script or {},
            "routes": {"way": {"roads": ["a"], "speeds": [{"at": 0, "speed": speed}]}},
            "vehicles": {"car": {"model": model, "route": "way", "position": {"along": LEAD}, "speed": speed}},
        },
        "back",
    )  # fmt: skip


def displace(world, aside, turned):
    """Every car beside its place and turned from its heading, moving where it points; one number or one each [m], [rad]."""
    state = world.vehicles.state
    psi = state[PSI] + turned
    state[X], state[Y] = state[X] - aside * np.sin(state[PSI]), state[Y] + aside * np.cos(state[PSI])
    state[PSI], state[Q_W], state[Q_Z] = psi, np.cos(0.5 * psi), np.sin(0.5 * psi)
    state[V_EAST], state[V_NORTH] = state[V_X] * np.cos(psi), state[V_X] * np.sin(psi)


def watched(world, seconds, advance=tick):
    """float64[offset, heading error, lateral acceleration, roll; tick, vehicle], the first two at the front axle."""
    seen = []
    for _ in range(round(seconds / TICK)):
        advance(world)
        v = world.vehicles
        seen.append([*v.mind[[FRONT_OFFSET, D_PSI]], *v.state[[A_Y, ROLL]]])
    return np.array(seen).transpose(1, 0, 2)


def back_after(offset, heading):
    """When each vehicle is back for good [s]; infinite when it is not."""
    away = (np.abs(offset) > NEAR) | (np.abs(heading) > ALIGNED)
    last = away.shape[0] - np.argmax(away[::-1], axis=0)
    return np.where(away[-1], np.inf, np.where(away.any(axis=0), last, 0) * TICK)


# -- on a straight road ----------------------------------------------------------------------------------


@pytest.mark.parametrize(("aside", "turned"), [(3.5, 0.0), (0.0, np.radians(20.0)), (3.5, np.radians(10.0))])
def test_every_vehicle_finds_back(road, aside, turned):
    """From 5 to 30 m/s within 8 s, with less than 5 m/s² across, leaning no more than a bend makes it, not over the path."""
    cars = list(product(MODELS, (5.0, 10.0, 20.0, 30.0)))
    world = build(road(cars))
    displace(world, aside, turned)
    offset, heading, across, roll = watched(world, 9.0)
    assert back_after(offset, heading).max() < 8.0
    assert np.abs(across).max() < 5.0 and np.abs(roll).max() < np.radians(6.0)
    beyond = -np.sign(offset[0]) * offset
    assert beyond.max() < NEAR
    FIGURES.append(
        f"{aside:g} m and {np.degrees(turned):g}° from the path at 5 to 30 m/s: back after {back_after(offset, heading).max():.1f} s"
    )


def test_slow_and_fast_ones_too(road):
    """At 2, 40 and 60 m/s from 3.5 m beside; what is slow takes its way, not its time."""
    cars = list(product(MODELS, (2.0, 40.0, 60.0)))
    world = build(road(cars))
    displace(world, 3.5, 0.0)
    offset, heading, across, roll = watched(world, 12.0)
    assert back_after(offset, heading).max() < 12.0
    assert np.abs(across).max() < 5.0 and np.abs(roll).max() < np.radians(6.0)


def swerve(model, speed, width):
    """A sine of the wheels that takes a car aside by a width with 4.6 m/s² across: width = a T²/(2 pi), in a steady state."""
    ground = Ground(model)
    period = np.sqrt(2.0 * np.pi * width / 4.6)
    angle = 4.6 * ((ground.p[L_F] + ground.p[L_R]) / speed**2 + understeer_gradient(ground))
    do = {"kind": "steer", "vehicle": "car", "angle": float(angle), "frequency": float(1.0 / period)}
    return {"out": {"when": {"kind": "time", "at": 1}, "do": do | {"duration": float(period)}}}


@pytest.mark.parametrize("width", [2.0, 3.1, 4.0])
def test_a_swerve_is_handed_back(road, width):
    """At 10 to 40 m/s, every vehicle: upright, back within 6 s, with less than 5 m/s² once the driver has the wheel."""
    cars = [(model, speed, swerve(model, speed, width)) for model, speed in product(MODELS, (10.0, 20.0, 30.0, 40.0))]
    world = build(road(cars))
    offset, heading, across, roll = watched(world, 10.0)
    handed = round((1.0 + np.sqrt(2.0 * np.pi * width / 4.6)) / TICK)
    assert (np.abs(offset[handed]) > 0.5 * width).all()
    assert back_after(offset, heading).max() < handed * TICK + 6.0
    assert np.abs(across[handed + 10 :]).max() < 5.0 and np.abs(roll).max() < np.radians(6.0)


# -- in a bend -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("aside", [3.5, -3.5])
def test_the_way_back_in_a_bend(road, aside):
    """A bend to the left of 80 m at 10 m/s, from inside and outside: the way back comes on top of its 1.25 m/s²."""
    world = build(road([(model, 10.0) for model in MODELS], 80.0))
    watched(world, 2.0)
    displace(world, aside, 0.0)
    offset, heading, across, roll = watched(world, 8.0)
    assert back_after(offset, heading - heading[-1]).max() < 6.0
    assert np.abs(across).max() < 5.5 and np.abs(roll).max() < np.radians(6.0)


def test_a_body_lies_across_its_lane_in_a_bend(road):
    """Radius 25 m at 5 m/s: the front axle goes wide by L²/8 over the radius, so that the rear one cuts it by three times that."""
    world = build(road([(model, 5.0) for model in MODELS], 25.0))
    offset = watched(world, 12.0)[0]
    wide = 0.125 * (world.vehicles.parameter[L_F] + world.vehicles.parameter[L_R]) ** 2 / 25.0
    assert offset[-1] == pytest.approx(-wide, abs=0.03)


# -- backwards -------------------------------------------------------------------------------------------


def roll_backwards(world):
    """One tick in neutral: the driver steers, nobody drives or brakes."""
    meet(world)
    between(world)
    v, slot = world.vehicles, world.clock.k % RING
    columns = slice(slot * v.state.shape[1], (slot + 1) * v.state.shape[1])
    v.commands[[U_DRIVE, U_PEDAL], columns], v.commands[U_BRAKE, columns], v.commands[U_GEAR, columns] = np.nan, 0.0, 0.0
    part(world)


@pytest.mark.parametrize("speed", [3.0, 6.0, 10.0])
def test_backwards_too(road, speed):
    """After 45 m, from 3.5 m beside and 10° wrong, on a straight and round a bend of 60 m: now the rear axle is led."""
    for radius in (None, 60.0):
        world = build(road([(model, 10.0) for model in MODELS], radius))
        watched(world, 10.0)
        v = world.vehicles
        v.state[V_X] = -speed
        v.state[[GEAR, NEXT_GEAR, RATIO, NEXT_RATIO]] = 0.0
        v.parameter[[C_D, C_ROLL]] = 0.0
        displace(world, 3.5, np.radians(10.0))
        offset, _, across, roll = watched(world, 45.0 / speed, roll_backwards)
        assert v.state[V_X].max() < -0.7 * speed
        wide = 0.0 if radius is None else 0.5 * (v.parameter[L_F] + v.parameter[L_R]) ** 2 / radius
        assert np.abs(offset[-1] + wide).max() < NEAR
        assert np.abs(across).max() < 5.5 and np.abs(roll).max() < np.radians(6.0)


def test_the_catalogue_is_what_is_tried():
    assert catalogue.vehicle_names() == MODELS
