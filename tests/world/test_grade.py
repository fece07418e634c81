"""A road that climbs is felt: force, speed, height and attitude of a car on a 5 % grade against closed forms."""

import numpy as np
import pytest

from studio.conventions import GRAVITY
from studio.scenario.setup import complete
from studio.scene import pose
from studio.server.frame import poses
from studio.vehicle.command import RING, U_BRAKE, U_DRIVE, U_GEAR, U_PEDAL
from studio.vehicle.contact import HEIGHT, SLOPE_X, SLOPE_Y
from studio.vehicle.parameter import C_D, C_ROLL, MASS, RADIUS, H
from studio.vehicle.state import GEAR, NEXT_GEAR, NEXT_RATIO, PITCH, PITCH_RATE, PSI, RATIO, TORQUE_DRIVE, V_UP, V_X, X, Y, Z
from studio.world.build import build
from studio.world.setting import setting
from studio.world.table.mind import STATION
from studio.world.tick import environment, part, tick
from tests.proving_ground import heavier

GRADE = 0.05
ALPHA = np.arctan(GRADE)
ROAD = (
    '<OpenDRIVE><header/><road id="a" length="{length}" junction="-1"><type s="0" type="rural"><speed max="90" unit="km/h"/></type>'
    '<planView><geometry s="0" x="100" y="50" hdg="0.7" length="{length}"><line/></geometry></planView><elevationProfile>{profile}'
    '</elevationProfile><lanes><laneSection s="0"><left><lane id="1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane>'
    '</left><right><lane id="-1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></right></laneSection></lanes>'
    "</road></OpenDRIVE>"
)


def place(tmp_path, *rows, road="a", speed=20.0, traffic=None, length=3000):
    """A car on a straight road whose elevation has these cubics (s, a, b, c)."""
    profile = "".join(f'<elevation s="{s}" a="{a}" b="{b}" c="{c}" d="0"/>' for s, a, b, c in rows)
    (tmp_path / "map.xodr").write_text(ROAD.format(length=length, profile=profile))
    document = {
        "title": "grade", "map": {"file": "map.xodr"}, "routes": {"way": {"roads": [road], "speeds": [{"at": 0, "speed": speed}]}},
        "vehicles": {"car": {"route": "way", "position": {"along": 100}, "speed": speed}},
        "traffic": traffic or {"count": 0},
    }  # fmt: skip
    return setting(complete(document, "grade"), tmp_path, "grade")


def steady(world, seconds=25.0):
    """Drives on until the speed is steady; state and parameters of the car."""
    for _ in range(round(seconds / 0.02)):
        tick(world)
    return world.vehicles.state[:, 0], world.vehicles.parameter[:, 0]


def test_a_level_road_is_level_to_the_bit(tmp_path):
    world = build([place(tmp_path, (0, 0, 0, 0))])
    steady(world, 1.0)
    assert not world.roads.raised.any()
    assert world.vehicles.ground[:3].tobytes() == np.zeros_like(world.vehicles.ground[:3]).tobytes()


@pytest.mark.parametrize(("road", "sign"), [("a", 1.0), ("-a", -1.0)])
def test_climbing_needs_m_g_sin_alpha_more(tmp_path, road, sign):
    """Drive torque over radius, on the grade less on the level, at one speed: m g sin(alpha) less what rolling resists less."""
    level, p = steady(build([place(tmp_path, (0, 0, 0, 0), road=road)]))
    level = level.copy()
    world = build([place(tmp_path, (0, 20, GRADE, 0), road=road)])
    steep, p = steady(world)
    assert steep[V_X] == pytest.approx(level[V_X], abs=0.15)
    torque = steep[TORQUE_DRIVE] - level[TORQUE_DRIVE]
    if sign < 0.0:  # downhill the brakes do what the engine's drag does not
        torque -= world.vehicles.commands[U_BRAKE, (world.clock.k - 1) % RING]
    expected = sign * p[MASS] * GRAVITY * np.sin(ALPHA) - p[C_ROLL] * p[MASS] * GRAVITY * (1.0 - np.cos(ALPHA))
    assert torque / p[RADIUS] == pytest.approx(expected, rel=0.03)
    assert steep[V_UP] == pytest.approx(sign * steep[V_X] * np.sin(ALPHA), rel=0.01)
    assert steep[PITCH] == pytest.approx(-sign * ALPHA, abs=0.004)


@pytest.mark.parametrize("grade", [0.05, -0.05])
def test_coasting_slows_by_g_sin_alpha(tmp_path, grade):
    """In neutral, without resistances: m g sin(alpha) slows m and the wheels' spin."""
    speeds = []
    for slope in (0.0, grade):
        world = build([place(tmp_path, (0, 0, slope, 0))])
        state, commands = world.vehicles.state, world.vehicles.commands
        world.vehicles.parameter[[C_D, C_ROLL]] = 0.0
        state[[GEAR, NEXT_GEAR, RATIO, NEXT_RATIO]] = 0.0
        for _ in range(200):
            environment(world)
            world.vehicles.mind[STATION, 0] += state[V_X, 0] * 0.02 * np.cos(np.arctan(slope))
            commands[[U_DRIVE, U_PEDAL]], commands[U_BRAKE], commands[U_GEAR] = np.nan, 0.0, 0.0
            part(world)
        speeds.append(state[V_X, 0])
    p = world.vehicles.parameter[:, 0]
    assert speeds[0] == pytest.approx(20.0, abs=0.002)
    slower = (speeds[0] - speeds[1]) / 4.0
    assert slower == pytest.approx(p[MASS] * GRAVITY * np.sin(np.arctan(grade)) / heavier(p), rel=0.01)


def test_the_start_is_at_rest_on_the_slope(tmp_path):
    """Nothing jumps at first: the car stands on the road, pitched as it is, and rolls up along it."""
    world = build([place(tmp_path, (0, 300, GRADE, 0))])
    state, p = world.vehicles.state[:, 0], world.vehicles.parameter[:, 0]
    assert state[Z] == pytest.approx(300.0 + 100.0 * GRADE + p[H] / np.cos(ALPHA), abs=1e-6)
    for _ in range(10):
        tick(world)
        assert abs(state[PITCH] + ALPHA) < 0.01 and abs(state[PITCH_RATE]) < 0.05
        assert state[V_UP] == pytest.approx(state[V_X] * np.sin(ALPHA), abs=0.05)


def test_a_crest_is_followed(tmp_path):
    """Up 5 %, a parabola of 2000 m radius, down 5 %: height and slope under the car are the profile's all along."""
    rows = ((0, 0, 0.05, 0), (400, 20, 0.05, -0.00025), (600, 20, -0.05, 0))
    world = build([place(tmp_path, *rows)])
    state, p = world.vehicles.state[:, 0], world.vehicles.parameter[:, 0]
    worst = 0.0
    for _ in range(1700):
        tick(world)
        s = world.vehicles.mind[STATION, 0] + 0.02 * state[V_X]
        a, b, c, at = next((a, b, c, s - at) for at, a, b, c in reversed(rows) if s >= at)
        height, slope = a + b * at + c * at * at, b + 2.0 * c * at
        worst = max(worst, abs(state[Z] - p[H] - height))
        g_x, g_y = world.vehicles.ground[[SLOPE_X, SLOPE_Y], 0]
        assert g_x * np.cos(state[PSI]) + g_y * np.sin(state[PSI]) == pytest.approx(slope, abs=0.003)
        assert world.vehicles.ground[HEIGHT, 0] + g_x * state[X] + g_y * state[Y] == pytest.approx(height, abs=0.03)
    assert worst < 0.06 and s > 700.0


def test_traffic_comes_in_again_on_its_slope(tmp_path):
    """Cars that have arrived at the top begin anew at the bottom, standing on the road there."""
    found = place(tmp_path, (0, 0, GRADE, 0), traffic={"count": 6, "speed": 20, "spacing": 40}, length=600)
    world, (x_0, y_0) = build([found]), found.network.datum
    before, returned = world.vehicles.state[X].copy(), 0
    for _ in range(1600):
        tick(world)
        state = world.vehicles.state
        jumped = np.abs(state[X] - before) > 100.0
        returned += int(jumped.sum())
        before = state[X].copy()
        up = (state[X] + x_0 - 100.0) * np.cos(0.7) + (state[Y] + y_0 - 50.0) * np.sin(0.7)
        assert np.abs(state[Z] - world.vehicles.parameter[H] - GRADE * up).max() < 0.15
    assert returned >= 3


def test_the_flat_picture_shows_cars_on_its_plane(tmp_path):
    world = build([place(tmp_path, (0, 300, GRADE, 0))])
    steady(world, 5.0)
    rows = poses(world.vehicles, None)
    assert abs(rows[pose.Z, 0]) < 0.05 and abs(rows[pose.PITCH, 0]) < 0.01
