"""Heights where none is mapped: who crosses on another level lies a storey above, with ramps of bounded slope, and the report says so."""

import itertools

import numpy as np
import pytest

from studio.road import load
from studio.road.assembly.storey import RAMP, STOREY
from studio.road.network import curve
from tests.road.plot import guessed, plot


@pytest.fixture(autouse=True)
def cache(own_cache):
    return own_cache


def flyover(target, tags, *, under=None, ele=None):
    """A street to the east of which the middle 100 m have tags, and one that crosses below, without a node of both."""
    nodes = {1: (-400, 0), 2: (-50, 0), 3: (50, 0), 4: (400, 0), 5: (0, -300), 6: (0, 300)}
    nodes = {name: (*at, {"ele": (ele or {})[name]} if name in (ele or {}) else {}) for name, at in nodes.items()}
    ways = {11: ([1, 2], {}), 12: ([2, 3], tags), 13: ([3, 4], {}), 14: ([5, 6], under or {})}
    return load(plot(target, nodes, ways))


def heights(network, *, east):
    """Places along a street, from where it is crossed, and the heights there, of all its lanes [m]."""
    row, own, others = 0 if east else 1, [], []
    for lane in (each for each in network.lanes if not each.internal):
        (own if (np.ptp(lane.centre[0]) > np.ptp(lane.centre[1])) == east else others).append(lane)
    middle = np.mean([lane.centre[row].mean() for lane in others])
    return np.concatenate([lane.centre[row] for lane in own]) - middle, np.concatenate([lane.height for lane in own])


@pytest.mark.parametrize(("tags", "level"), [({"bridge": "yes"}, 1), ({"layer": "2", "bridge": "yes"}, 2), ({"tunnel": "yes"}, -1)])
def test_a_bridge_is_a_storey_up_with_ramps(tmp_path, tags, level):
    network = flyover(tmp_path / "map.osm", tags)
    at, z = heights(network, east=True)
    assert z[np.abs(at) < 45.0] == pytest.approx(STOREY * level, abs=0.1)
    assert z[np.abs(at) > 395.0] == pytest.approx(0.0, abs=0.25)
    assert not heights(network, east=False)[1].any()
    slopes = [np.diff(lane.height) / np.maximum(np.diff(curve.stations(lane.centre)), 1e-6) for lane in network.lanes]
    assert max(np.abs(each).max() for each in slopes) < RAMP + 0.005
    (line,) = [line for line in guessed(network) if line.startswith("storey")]
    assert "way 12" in line and f"{STOREY * abs(level):g} m {'above' if level > 0 else 'below'}" in line


def test_lanes_join_without_a_step(tmp_path):
    network = flyover(tmp_path / "map.osm", {"bridge": "yes"})
    for each in network.connections:
        whole = [network.lanes[lane] for lane in (each.from_lane, *each.via, each.to_lane)]
        assert all(a.height[-1] == pytest.approx(b.height[0], abs=0.05) for a, b in itertools.pairwise(whole))


@pytest.mark.parametrize(("tags", "under"), [({}, {}), ({"bridge": "no"}, {}), ({"layer": "1"}, {"layer": "1"})])
def test_on_one_level_the_ground_is_level(tmp_path, tags, under):
    network = flyover(tmp_path / "map.osm", tags, under=under)
    assert not any(lane.height.any() for lane in network.lanes) and not any(line.startswith("storey") for line in guessed(network))


def test_a_bridge_that_crosses_nobody_stays_level(tmp_path):
    """Over water, say: nodes that both ways have are no crossing."""
    nodes = {1: (-300, 0), 2: (0, 0), 3: (300, 0), 4: (0, -300)}
    network = load(plot(tmp_path / "map.osm", nodes, {11: ([1, 2], {"bridge": "yes"}), 12: ([2, 3], {}), 13: ([4, 2], {})}))
    assert not any(lane.height.any() for lane in network.lanes)


def test_known_heights_that_tell_it_are_kept(tmp_path):
    """100 m on the ground and 106 m on the bridge are mapped."""
    ele = {1: "100", 2: "106", 3: "106", 4: "100", 5: "100", 6: "100"}
    network = flyover(tmp_path / "map.osm", {"bridge": "yes"}, ele=ele)
    at, z = heights(network, east=True)
    assert z[np.abs(at) < 45.0] == pytest.approx(106.0, abs=1.5) and not any(line.startswith("storey") for line in guessed(network))


def test_known_heights_of_the_land_carry_the_storey(tmp_path):
    """Everything at 100 m, as a model of the land has it."""
    network = flyover(tmp_path / "map.osm", {"bridge": "yes"}, ele=dict.fromkeys(range(1, 7), "100"))
    at, z = heights(network, east=True)
    assert z[np.abs(at) < 45.0] == pytest.approx(100.0 + STOREY, abs=0.2) and heights(network, east=False)[1] == pytest.approx(
        100.0, abs=0.2
    )
