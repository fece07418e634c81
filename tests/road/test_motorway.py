"""The generated motorway: what is asked for comes out, curvature is continuous, and 130 km/h is comfortable."""

from pathlib import Path

import numpy as np
import pytest

from studio.errors import MapError
from studio.road import load
from studio.road.drawn.motorway import LANE_WIDTH, motorway
from studio.road.opendrive.file import document
from studio.road.opendrive.reference_line import ReferenceLine
from studio.road.ways.path import PATH_CURVATURE, WAVELENGTH, path
from studio.road.ways.route import all_routes, connect

SAMPLE = Path(__file__).parents[2] / "scenarios" / "maps" / "motorway.xodr"
LIMIT = 130.0 / 3.6


def test_the_sample_is_what_the_generator_writes():
    assert SAMPLE.read_text(encoding="utf-8") == motorway()


@pytest.mark.parametrize(
    ("length", "lanes", "radius", "grade"), [(6000.0, 3, 1000.0, 0.0), (501.5, 1, 900.0, 0.04), (20000.0, 4, 3000.0, 0.06)]
)
def test_elements_join_in_place_heading_curvature_and_height(length, lanes, radius, grade):
    (road,) = document(motorway(length=length, lanes=lanes, radius=radius, grade=grade).encode()).roads.values()
    line = road.line
    assert isinstance(line, ReferenceLine) and line.length == pytest.approx(length) == road.length
    for _, gap, turn in line.gaps():
        assert gap < 1e-6 and turn < 1e-9
    for a, b in zip(line.elements, line.elements[1:], strict=False):
        assert a.end == b.start
    assert max(each.sharpest for each in line.elements) <= 1.0 / radius
    s = np.linspace(0.0, length, 4001)
    height, ds = road.elevation.at(s), s[1]
    slope = np.diff(height) / ds
    assert np.abs(slope).max() <= grade + 1e-9 and np.abs(np.diff(slope)).max() / ds <= 1.001 / 8800.0
    assert (np.abs(slope).max() == pytest.approx(grade, abs=2e-3)) or length < 1000.0


def test_130_km_h_needs_little_side_force_and_curvature_never_jumps(own_cache):
    """On every lane at most v²/(R - t) with t the farthest lane; a clothoid changes curvature by 1/(R L) a metre.

    The first and the last metres do not count: a path is smoothed there from one side.
    """
    network = load(SAMPLE)
    for way in all_routes(network):
        curvature = path(network, way).points[PATH_CURVATURE, int(3 * WAVELENGTH) : -int(3 * WAVELENGTH)]
        assert LIMIT**2 * np.abs(curvature).max() < 1.05 * LIMIT**2 / (1000.0 - 13.0) < 1.5
        assert np.abs(np.diff(curvature)).max() < 1.3 / (1000.0 * 160.0)


def test_three_lanes_each_way(own_cache):
    network = load(SAMPLE)
    assert {name: len(road.lanes) for name, road in network.roads.items()} == {"motorway": 3, "-motorway": 3}
    assert {lane.width for lane in network.lanes} == {LANE_WIDTH}
    assert {round(lane.speed, 3) for lane in network.lanes} == {round(LIMIT, 3)}
    assert network.attribution == "Motorway, Cooperative ADAS Studio" and network.licence == "MIT"
    assert len(all_routes(network)) == 6
    kerb, _, inner = (path(network, connect(network, ["motorway"], start_lane=lane)) for lane in range(3))
    apart = np.hypot(*(kerb.points[:2, 300] - inner.points[:2, 300]))
    assert apart == pytest.approx(2 * LANE_WIDTH, abs=0.01)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"length": 10.0}, "length"),
        ({"lanes": 0}, "lanes"),
        ({"radius": 200.0}, "900 to"),
        ({"grade": 0.5}, "grade"),
        ({"length": float("nan")}, "length"),
    ],
)
def test_what_nobody_would_build_is_refused(given, says):
    with pytest.raises(MapError, match=says):
        motorway(**given)
