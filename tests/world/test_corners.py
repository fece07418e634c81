"""Corners: a driver sees nobody through a house; where he gives way he comes so slowly that he can still stop, and he gets on."""

import numpy as np
import pytest
import shapely

from studio.road.ways.corner import FAR, sights_of
from studio.road.ways.meeting import meetings_of
from studio.vehicle.parameter import FRONT
from tests.world.test_right_of_way import AHEAD, LEFT_OF, MAJOR, RIGHT_OF, Run

NEAR, OVER = 7.0, 47.0  # [m] from the middle of the crossing to a house, and over it
SLOW = 5.0  # [m/s] 18 km/h, on a street for 30 or 50


def house(x, y):
    """At the corner towards x and y."""
    return [(x * NEAR, y * NEAR), (x * OVER, y * NEAR), (x * OVER, y * OVER), (x * NEAR, y * OVER)]


HOUSES = [house(x, y) for x in (-1, 1) for y in (-1, 1)]


def minds_first(run, i, other):
    """The first tick at which car i minds another."""
    found = np.flatnonzero(run.minded[i] == other)
    return found[0] if found.size else len(run.time)


def hardest(run, i):
    """How hard car i brakes about the crossing [m/s²]."""
    here = np.abs(run.nose[i, 1:] - run.line[i]) < 30.0
    return -np.diff(run.speed[i])[here].min() / run.time[1]


@pytest.mark.parametrize("drawn", [{}, {"classes": MAJOR}])
def test_who_cannot_see_comes_slowly_and_then_goes(tmp_path, drawn):
    """With nobody there he slows down behind a corner, gently, does not stop, and drives as ever where no house stands."""
    blind, free = (Run(tmp_path, [("south", "north")], houses=houses, seconds=20, **drawn) for houses in (HOUSES, ()))
    assert free.slowest(0) > 8.0 > SLOW > blind.slowest(0) > 2.0
    assert hardest(blind, 0) < 3.0
    assert free.passes(0) < blind.passes(0) < free.passes(0) + 5.0
    assert (blind.minded == -1.0).all()


@pytest.mark.parametrize("later", [4.0, 7.0, 10.0])
def test_whom_a_house_hides_is_minded_once_nothing_is_between(tmp_path, later):
    """He from the right is minded no sooner than their line of sight is clear, by geometry from another hand; then he goes first."""
    starts = [40.0 + later, 40.0]
    ways = [("south", "north"), ("east", "west")]
    blind, free = (Run(tmp_path, ways, houses=houses, seconds=25, starts=starts) for houses in (HOUSES, ()))
    assert blind.is_fine() and free.is_fine()
    front, first = blind.world.vehicles.parameter[FRONT], minds_first(blind, 0, 1)
    corners = np.array(house(1, -1)) - house_shift(blind)
    eye, nose = blind.place[0], blind.place[1] + [[-front[1]], [0.0]]
    sight = shapely.linestrings(np.stack([eye, nose], axis=1).transpose(2, 1, 0))
    clear = np.flatnonzero(~shapely.intersects(sight, shapely.Polygon(corners)))[0]
    assert minds_first(free, 0, 1) + 50 < clear
    assert clear - 15 <= first < len(blind.time)  # [ticks] the map knows where eyes and noses are in steps of some metres


def house_shift(run):
    """Where the middle of the drawn crossing lies on the map, as its houses have it [m]."""
    outlines = [each.outline.mean(axis=1) for each in run.network.scenery.buildings]
    return -np.mean(outlines, axis=0)


@pytest.mark.parametrize("drawn", [{}, {"classes": MAJOR}, {"classes": MAJOR, "sign": {"highway": "stop"}}])
@pytest.mark.parametrize("later", [-30.0, -20.0, -10.0, 0.0, 10.0])
def test_nobody_is_hit_behind_a_corner(tmp_path, drawn, later):
    """One from each side of somebody who gives way, so that they meet sooner or later; and nobody brakes as in an emergency."""
    ways = [("south", "north"), ("east", "west"), ("west", "east")]
    run = Run(tmp_path, ways, houses=HOUSES, starts=[40.0 - later, 40.0, 36.0], seconds=50, **drawn)
    assert run.is_fine()
    assert max(hardest(run, i) for i in range(3)) < 6.0


def test_four_at_once_get_through_between_houses(tmp_path):
    run = Run(tmp_path, [(arm, AHEAD[arm]) for arm in RIGHT_OF], houses=HOUSES)
    assert run.is_fine() and max(run.passes(i) for i in range(4)) < 35.0


def test_who_turns_across_is_not_kept_by_houses_beside_his_street(tmp_path):
    """One sees along one's own street: nobody slows down for those who come from ahead there, but for their bend."""
    ways = [("south", LEFT_OF["south"]), ("north", "south")]
    run = Run(tmp_path, ways, houses=HOUSES)
    assert run.is_fine() and run.passes(0) > run.passes(1) + 1.0


def test_what_one_sees_grows_towards_the_corner(tmp_path):
    """Without houses everything is seen; with them the less the farther one is, and enough from where the ways meet."""
    blind, free = (Run(tmp_path, [("south", "north")], houses=houses, seconds=0.1).network for houses in (HOUSES, ()))
    assert (sights_of(free) == FAR).all()
    sights = sights_of(blind)
    hidden = (sights < FAR).any(axis=0)
    assert hidden.sum() > 20 and sights.shape[1] == meetings_of(blind).partner.size
    assert (np.diff(sights[:, hidden], axis=0) <= 0.0).mean() > 0.95
    assert np.median(sights[0, hidden]) > 40.0 > 20.0 > np.median(sights[-1, hidden])
