"""Rings: what leads around to itself under one name."""

import pytest

from studio.road import load
from studio.road.ways.ring import onto_rings, rings
from tests.conftest import ROOT

MAPS = ROOT / "scenarios" / "maps"


@pytest.mark.parametrize(
    ("file", "name", "arms"), [("berlin_siegessaeule_grosser_stern.osm.gz", "Großer Stern", 5), ("urban_grid.osm", "Lindenrondell", 4)]
)
def test_a_ring_is_found_with_its_ways_in(file, name, arms):
    """All of its roads and nothing else; it is entered from as many streets."""
    network = load(MAPS / file)
    found = rings(network)
    assert {network.roads[each].name for each in found} == {name} and len(set(found.values())) == 1
    ways = [each for each, is_onto in zip(network.connections, onto_rings(network), strict=True) if is_onto]
    assert all(network.lanes[each.to_lane].road in found and network.lanes[each.from_lane].road not in found for each in ways)
    assert len({network.lanes[each.from_lane].road for each in ways}) == arms


def test_a_motorway_has_none():
    assert not rings(load(MAPS / "motorway.xodr")) and not onto_rings(load(MAPS / "motorway.xodr")).any()
