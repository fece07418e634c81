"""Roads off the land: drawn at their height, carried by what stands clear of those below, and the ground open above those that are sunk."""

import numpy as np
import pytest
import shapely

from studio.road import load
from studio.road.assembly.storey import STOREY
from studio.road.network import curve
from studio.road.network.outline import strip
from studio.road.ways.relief import relief_of
from studio.scene import city
from studio.scene.city import deck, marking, raised, stretch
from tests.road.plot import plot

LAYERS = {"aloft", "decks"}


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("STUDIO_CACHE", str(tmp_path / "cache"))


def crossed(target, tags, *, streets=1):
    """A road to the east of which the middle 200 m have tags, and streets that cross it there, 60 m apart."""
    nodes = {1: (-400, 0), 2: (-100, 0), 3: (100, 0), 4: (400, 0)}
    ways = {11: ([1, 2], {}), 12: ([2, 3], tags), 13: ([3, 4], {})}
    for i in range(streets):
        nodes |= {10 + 2 * i: (60 * i - 30, -200), 11 + 2 * i: (60 * i - 30, 200)}
        ways[20 + i] = ([10 + 2 * i, 11 + 2 * i], {})
    return load(plot(target, nodes, ways))


BRIDGE, TUNNEL = {"bridge": "yes"}, {"tunnel": "yes"}


@pytest.mark.parametrize("tags", [BRIDGE, TUNNEL, BRIDGE | {"layer": "2"}])
def test_every_metre_of_a_lane_is_on_the_land_or_off_it(tmp_path, tags):
    network = crossed(tmp_path / "map.osm", tags)
    relief = relief_of(network)
    off = {lane.id: 0.0 for lane in network.lanes}
    for lane, a, b in stretch.off_land(network, relief):
        off[lane] += float(np.diff(relief.of_lane(lane)[0][[a, b]])[0])
    for lane in network.lanes:
        on = sum(curve.length(centre) for _, _, centre in stretch.land_of(lane, relief))
        assert on + off[lane.id] == pytest.approx(lane.length, abs=0.05)
    land = stretch.on_land(network, relief)
    assert [lane.id for lane in land.lanes] == list(range(len(land.lanes)))
    assert all(land.lanes[lane].road == road.id for road in land.roads.values() for lane in road.lanes)
    assert sum(lane.length for lane in land.lanes) + sum(off.values()) == pytest.approx(sum(lane.length for lane in network.lanes), abs=0.5)


@pytest.mark.parametrize("streets", [1, 3])
def test_a_bridge_is_drawn_above_and_stands_clear_of_what_passes_below(tmp_path, streets):
    network = crossed(tmp_path / "map.osm", BRIDGE, streets=streets)
    relief = relief_of(network)
    made, below = deck.aloft(network, relief), [lane for lane in network.lanes if lane.road.strip("-").startswith("2")]
    assert len(below) == 2 * streets
    assert made.roads.vertices[:, 2].max() == pytest.approx(STOREY + deck.PAINT, abs=0.05)
    assert (made.roads.normals[:, 2] > 0.9).all()
    tops = made.solids.vertices[:, 2]
    assert tops.max() == pytest.approx(STOREY + deck.PARAPET, abs=0.05) and tops.min() == pytest.approx(deck.FOOT, abs=1e-3)
    # nothing solid reaches into the headroom above a lane below
    ground = shapely.union_all([strip(lane.centre, lane.width) for lane in below])
    inside = shapely.contains_xy(ground, *made.solids.vertices[:, :2].T.astype(float))
    assert inside.any() and tops[inside].min() > STOREY - deck.THICK - 0.1
    assert made.opened.is_empty and made.covered.is_empty


def test_piers_stand_under_the_deck(tmp_path):
    network = crossed(tmp_path / "map.osm", BRIDGE)
    relief = relief_of(network)
    p, others = deck.places(network, relief), stretch.Neighbours(network, relief)
    found = deck.piers(p, others, p.follows & (p.level > 0.0))
    assert len(found) >= 2 * 200.0 / deck.SPAN - 6  # two lanes of 200 m, but where the street is
    tops = np.array([each.vertices[:, 2].max() for each in found])
    assert tops == pytest.approx(np.full(len(found), STOREY - deck.THICK), abs=0.1)


def test_a_tunnel_opens_the_ground_and_covers_it_only_where_it_is_deep(tmp_path):
    network = crossed(tmp_path / "map.osm", TUNNEL)
    relief = relief_of(network)
    made = deck.aloft(network, relief)
    assert made.roads.vertices[:, 2].min() == pytest.approx(-STOREY, abs=0.1)
    sunk = [lane for lane in network.lanes if relief.of_lane(lane.id)[2].any()]
    x = np.concatenate([relief.of_lane(lane.id)[1][0][relief.of_lane(lane.id)[2] < -1.0] for lane in sunk])
    y = np.concatenate([relief.of_lane(lane.id)[1][1][relief.of_lane(lane.id)[2] < -1.0] for lane in sunk])
    assert shapely.contains_xy(made.opened, x, y).all()
    assert not made.covered.is_empty and made.covered.difference(made.opened.buffer(0.01)).area < 1.0
    assert made.covered.bounds[2] - made.covered.bounds[0] == pytest.approx(200.0, abs=15.0)
    hole = city.holed(city.ground_form(1000.0), made.opened)
    a, b, c = (hole.vertices[hole.faces[:, i], :2].astype(float) for i in range(3))
    triangles = shapely.STRtree(shapely.polygons(np.stack([a, b, c], axis=1)))
    place, _ = triangles.query(shapely.points(x, y), predicate="within")
    assert place.size == 0


@pytest.mark.parametrize("streets", [1, 3])
def test_all_bridges_are_two_meshes(tmp_path, streets):
    plain = {each.name for each in city.layers(crossed(tmp_path / "flat.osm", {}, streets=streets))}
    names = [each.name for each in city.layers(crossed(tmp_path / "map.osm", BRIDGE, streets=streets))]
    assert set(names) == plain | LAYERS | {"deck_shadow"} and len(names) == len(set(names))


# -- what is painted on a bridge -------------------------------------------------------------------

LIT, ZEBRA = {"highway": "traffic_signals"}, {"highway": "crossing", "crossing": "zebra", "crossing:markings": "zebra"}
TURNS = {"oneway": "yes", "lanes": "2", "turn:lanes": "left|through"}


def painted_crossing(target, tags):
    """A street of two lanes that goes up onto a bridge, where it meets another at lights; a zebra; and a street below."""
    nodes = {
        1: (-500, 0),
        2: (-150, 0),
        3: (-40, 0, ZEBRA),
        4: (0, 0, LIT),
        5: (150, 0),
        6: (500, 0),
        7: (0, 150),
        8: (-90, -200),
        9: (-90, 200),
    }
    ways = {
        11: ([1, 2], TURNS), 12: ([2, 3, 4], TURNS | tags), 13: ([4, 5], {"oneway": "yes"} | tags), 14: ([5, 6], {"oneway": "yes"}),
        15: ([4, 7], {"oneway": "yes"} | tags), 16: ([8, 9], {}),
    }  # fmt: skip
    return load(plot(target, nodes, ways))


@pytest.mark.parametrize("tags", [BRIDGE, BRIDGE | {"layer": "2"}, TUNNEL])
def test_marks_lie_on_the_road_that_they_are_painted_on(tmp_path, tags):
    """On the bridge as many triangles as on the same street on the ground, all at the height of its deck, and none below."""
    plain, network = painted_crossing(tmp_path / "flat.osm", {}), painted_crossing(tmp_path / "map.osm", tags)
    relief = relief_of(network)
    low, high = raised.parted(network, relief)
    flat = marking.marks_of(plain)
    assert len(plain.signals) == len(network.signals) == 2
    assert (len(flat.bars), len(flat.crossings)) == (2, 1) and len(flat.arrows) >= 2
    # the arrows of the way up, if any, stay on the ground
    assert (len(low.bars), len(low.crossings)) == (0, 0) and len(high) + len(low.arrows) == 3 + len(flat.arrows)
    assert len(high) >= 5
    sign = -1.0 if tags == TUNNEL else 1.0
    storey = sign * STOREY * float(tags.get("layer", 1))
    deck_ground = shapely.union_all([strip(lane.centre, lane.width) for lane in network.lanes if relief.of_lane(lane.id)[2].any()])
    for each in high:
        assert (each.normals[:, 2] > 0.9).all()
        x, y, z = each.vertices.T.astype(float)
        assert z == pytest.approx(np.full(z.size, storey + deck.PAINT), abs=0.35)
        assert shapely.contains_xy(deck_ground.buffer(1.0), x, y).all()
    assert {each.name for each in city.layers(network)} >= LAYERS
