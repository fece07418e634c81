"""Bridges and tunnels of OpenDRIVE: the lanes are on another level there, and where the document has no heights, as high as those of a map
of OpenStreetMap."""

import numpy as np
import pytest

from studio.road import load
from studio.road.assembly.storey import RAMP, STOREY
from studio.road.ways.meeting import meetings_of
from studio.road.ways.relief import relief_of

ROAD = (
    '<road id="{id}" length="400" junction="-1"><planView><geometry s="0" x="{x}" y="{y}" hdg="{heading}" length="400"><line/>'
    '</geometry></planView>{profile}<lanes><laneSection s="0"><right>'
    '<lane id="-1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/>'
    "</lane></right></laneSection></lanes><objects>{objects}</objects></road>"
)


@pytest.fixture(autouse=True)
def cache(own_cache):
    return own_cache


def crossing(tmp_path, objects, profile=""):
    """A road to the east with these objects and one to the north; they cross 200 m behind their starts."""
    roads = (
        ROAD.format(id="east", x=-200, y=0, heading=0, objects=objects, profile=profile),
        ROAD.format(id="north", x=0, y=-200, heading=np.pi / 2, objects="", profile=""),
    )
    path = tmp_path / "map.xodr"
    path.write_text(f"<OpenDRIVE><header/>{''.join(roads)}</OpenDRIVE>")
    return load(path)


def told(network, kind):
    return [each.what for each in network.report.guesses if each.kind == kind]


@pytest.mark.parametrize(("objects", "level"), [
    ('<bridge id="1" s="180" length="40" type="concrete"/>', 1), ('<tunnel id="1" s="150" length="100" type="underpass"/>', -1),
    ('<bridge id="1" s="180" length="40"><validity fromLane="-1" toLane="-1"/></bridge>', 1),
    ('<bridge id="1" s="180" length="9"/><bridge id="2" s="189" length="31"/>', 1),
])  # fmt: skip
def test_a_deck_that_others_cross_lies_a_storey_above_or_below(tmp_path, objects, level):
    network = crossing(tmp_path, objects)
    east, north = (network.lanes_of(name)[0] for name in ("east", "north"))
    station = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(east.centre)))])
    on = np.abs(station - 200.0) < 15.0
    assert on.any() and (east.level[on] == level).all() and east.height[on] == pytest.approx(STOREY * level, abs=0.3)
    assert not north.height.any() and east.height[[0, -1]] == pytest.approx(0.0, abs=0.01)
    assert np.abs(np.diff(east.height) / np.diff(station)).max() < RAMP + 0.01
    assert not meetings_of(network).partner.size
    relief = relief_of(network)
    assert relief is not None and np.abs(relief.lift).max() == pytest.approx(STOREY, abs=0.3)
    assert len(told(network, "storey")) == 1 and told(network, "level")


@pytest.mark.parametrize("objects", [
    "", '<bridge id="1" s="10" length="40"/>', '<bridge id="1" s="500" length="40"/>', '<bridge id="1" s="180" length="0"/>',
    '<bridge id="1" s="180"/>', '<tunnel id="1" s="x" length="20"/>', '<bridge id="1" s="180" length="nan"/>',
])  # fmt: skip
def test_what_is_no_deck_over_the_crossing_parts_nobody(tmp_path, objects):
    """Elsewhere, beside the road, of no length, or unreadable: both roads lie on the ground, and what cannot be used is told."""
    network = crossing(tmp_path, objects)
    assert not any(lane.height.any() for lane in network.lanes) and meetings_of(network).partner.size
    is_used = 's="10"' in objects
    assert len(told(network, "level")) == is_used
    assert [each.kind for each in network.report.skipped] == ([] if is_used or not objects else [objects[1:7]])


def test_heights_of_the_document_stay(tmp_path):
    profile = '<elevationProfile><elevation s="0" a="8" b="0" c="0" d="0"/></elevationProfile>'
    network = crossing(tmp_path, '<bridge id="1" s="180" length="40"/>', profile)
    assert (network.lanes_of("east")[0].height == 8.0).all() and not told(network, "storey")
