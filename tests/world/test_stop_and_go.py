"""Stop and go out of nothing: 22 cars on a ring of 230 m, as in the experiment of Y. Sugiyama et al., New J. Phys. 10 (2008) 033001.

Whether it comes is told by the law of the drivers alone. About the equilibrium, where all drive with v at the gap s, cars that follow
each other in a ring have waves exp(λt + 2πi m n/N) with

    λ² - λ (f_v + f_c w) + f_s w = 0,   w = 1 - exp(2πi m/N)

f_s, f_v, f_c the derivatives of the law by gap, own speed and closing speed. The greatest real part of λ is the growth rate.
"""

from math import pi

import numpy as np
import pytest
from scipy.optimize import brentq

from studio.model import driver
from studio.road.ways.path import PATH_SPEED
from studio.scenario.setup import complete
from studio.vehicle.parameter import LENGTH
from studio.vehicle.state import V_X
from studio.world.build import build
from studio.world.setting import setting
from studio.world.tick import tick
from tests.road.test_opendrive import LINKED, lanes, road, written

RING, WIDTH, LAPS = 230.0, 3.5, 15  # [m]; laps for which there is a path
WAVY = {"time_headway": 1.0, "acceleration": 0.4, "deceleration": 1.5}
CALM = {"time_headway": 1.6, "acceleration": 3.0, "deceleration": 2.0}
PROMPT = {"expected_reaction": 0.0, "surprised_reaction": 0.0, "gap_error": 0.0, "closing_error": 0.0, "sway": 0.0}


def ring(folder):
    """A round of 230 m in the middle of its lane, of two halves."""
    radius, half = RING / (2 * pi) - WIDTH / 2, RING / 2 - pi * WIDTH / 2

    def piece(name, other, y, heading):
        ends = "".join(
            f'<{which} elementType="road" elementId="{other}" contactPoint="{end}"/>'
            for which, end in (("predecessor", "end"), ("successor", "start"))
        )
        plan = f'<geometry s="0" x="0" y="{y}" hdg="{heading}" length="{half}"><arc curvature="{1 / radius}"/></geometry>'
        section = f'<laneSection s="0">{lanes("driving", width=WIDTH, inner=LINKED.format(-1))}</laneSection>'
        return road(name, length=half, plan=plan, sections=section, link=ends)

    return written(folder, piece("a", "b", -radius, 0.0), piece("b", "a", radius, pi), name="ring.xodr")


def growth(gap, v, v0, cars, *, time_headway, acceleration, deceleration, s0=2.0):
    """The greatest growth rate [1/s] of a wave in the ring, by the law at its equilibrium."""

    def law(ds, dv, dc):
        return driver.following_acceleration.py_func(v + dv, v0, gap + ds, dc, s0, time_headway, acceleration, deceleration)

    h = 1e-6
    f_s, f_v, f_c = ((law(*(h * e)) - law(*(-h * e))) / (2 * h) for e in np.eye(3))
    w = 1.0 - np.exp(2j * pi * np.arange(1, cars) / cars)
    return max(np.roots([1.0, -(f_v + f_c * each), f_s * each]).real.max() for each in w)


def speeds_of(folder, cars, style, seconds):
    """Speeds [m/s] of all cars, second by second, in a ring where all begin at the equilibrium but one that is 0.3 m/s slower."""
    ring(folder)
    usual = {"model": "smart_fortwo", "route": "round", "driver": style | PROMPT}
    document = {
        "title": "ring", "map": {"file": "ring.xodr"}, "routes": {"round": {"roads": ["a", "b"] * LAPS}},
        "vehicles": {f"car_{i:02d}": usual | {"position": {"along": RING * (1 + i / cars)}, "speed": 1.0} for i in range(cars)},
    }  # fmt: skip
    start = build([setting(complete(document, "ring"), folder, "ring")])
    v0, gap = start.roads.points[PATH_SPEED, 20:].min(), RING / cars - start.vehicles.parameter[LENGTH, 0]
    law = (2.0, style["time_headway"], style["acceleration"], style["deceleration"])
    v = brentq(lambda v: driver.following_acceleration.py_func(v, v0, gap, 0.0, *law), 0.0, v0)
    for i, each in enumerate(document["vehicles"].values()):
        each["speed"] = v - (0.3 if i == 0 else 0.0)
    world = build([setting(complete(document, "ring"), folder, "ring")])
    found = []
    for k in range(round(seconds / world.clock.tick)):
        tick(world)
        if k % 50 == 0:
            found.append(world.vehicles.state[V_X].copy())
    assert world.events.hits_found == 0
    return np.array(found), growth(gap, v, v0, cars, **style)


def test_a_wave_forms_in_the_ring(tmp_path):
    """22 drivers who accelerate little: a wave grows as the law has it, by 0.024/s, until cars that drove 5.5 m/s crawl in turn."""
    speeds, rate = speeds_of(tmp_path, 22, WAVY, 420.0)
    assert rate == pytest.approx(0.0236, abs=0.001)
    small = slice(40, 120)
    measured = np.polyfit(np.arange(small.start, small.stop), np.log(speeds.std(axis=1)[small]), 1)[0]
    assert measured == pytest.approx(rate, rel=0.15)
    assert speeds[-60:].min() < 2.0 and speeds[-60:].max() > 7.5


def test_no_wave_forms_among_other_drivers(tmp_path):
    """30 drivers who accelerate readily and keep more distance: by the law waves die away with 0.011/s, and so they do."""
    speeds, rate = speeds_of(tmp_path, 30, CALM, 420.0)
    assert rate == pytest.approx(-0.0114, abs=0.001)
    assert speeds[-60:].std(axis=1).max() < 0.05
