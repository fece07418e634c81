"""A real place, small maps written by hand, and small networks built by hand."""

from pathlib import Path

import numpy as np
import pytest

from studio.road import load
from studio.road.assembly.extract import ATTRIBUTION
from studio.road.network import Connection, Lane, Network, Road, Scenery
from studio.road.network.signals import signals
from studio.road.ways.path import path
from studio.road.ways.route import all_routes

GROSSER_STERN = Path(__file__).parents[2] / "scenarios" / "maps" / "berlin_siegessaeule_grosser_stern.osm.gz"


@pytest.fixture(scope="session")
def map_file():
    return GROSSER_STERN


@pytest.fixture(scope="session")
def place(tmp_path_factory):
    """Großer Stern, imported anew."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("STUDIO_CACHE", str(tmp_path_factory.mktemp("cache")))
        return load(GROSSER_STERN)


@pytest.fixture(scope="session")
def routes(place):
    return all_routes(place)


@pytest.fixture(scope="session")
def paths(place, routes):
    return [path(place, route) for route in routes]


@pytest.fixture
def own_cache(tmp_path, monkeypatch):
    """An empty cache for one test."""
    monkeypatch.setenv("STUDIO_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache" / "maps"


class Draft:
    """Writes OpenStreetMap XML."""

    def __init__(self):
        self.lines = []
        self.nodes = 0

    def node(self, lat, lon, **tags):
        self.nodes += 1
        inner = "".join(f'<tag k="{key}" v="{value}"/>' for key, value in tags.items())
        self.lines.append(f'<node id="{self.nodes}" version="1" lat="{lat}" lon="{lon}">{inner}</node>')
        return self.nodes

    def way(self, number, nodes, **tags):
        refs = "".join(f'<nd ref="{node}"/>' for node in nodes)
        inner = "".join(f'<tag k="{key.replace("__", ":")}" v="{value}"/>' for key, value in tags.items())
        self.lines.append(f'<way id="{number}" version="1">{refs}{inner}</way>')

    def write(self, target):
        target.write_text(f'<?xml version="1.0"?><osm version="0.6">{"".join(self.lines)}</osm>', encoding="utf-8")
        return target


@pytest.fixture
def draft():
    return Draft()


def lane(number, road, index, centre, *, speed=13.9):
    centre = np.asarray(centre, dtype=float)
    return Lane(number, road, index, 3.2, speed, centre, False, float(np.hypot(*np.diff(centre)).sum()))


def network(lanes, connections=()):
    """A network of lanes that are given by hand."""
    roads = {}
    for one in lanes:
        own = tuple(other.id for other in lanes if other.road == one.road)
        roads[one.road] = Road(one.road, one.road, own, "", "", one.speed, one.length, False)
    links = tuple(Connection(start, end, (), -1, "straight") for start, end in connections)
    scenery = Scenery((), (), np.empty((2, 0)))
    return Network("hand", ATTRIBUTION, (0.0, 0.0), (-500.0, -500.0, 500.0, 500.0), "", tuple(lanes), roads, links, (),
                   signals((), {}, (), frozenset()), scenery)  # fmt: skip


@pytest.fixture
def straight():
    """Two lanes, 200 m due east, 3.2 m apart."""
    x = np.array([0.0, 200.0])
    return network([lane(0, "a", 0, [x, 0 * x]), lane(1, "a", 1, [x, 0 * x + 3.2])])


@pytest.fixture
def bend():
    """100 m due east, then a quarter circle of 40 m radius to the left, then 100 m due north."""
    angle = np.linspace(0.0, np.pi / 2, 120)
    arc = [100.0 + 40.0 * np.sin(angle), 40.0 - 40.0 * np.cos(angle)]
    return network(
        [
            lane(0, "in", 0, [[0.0, 100.0], [0.0, 0.0]]),
            lane(1, "arc", 0, arc),
            lane(2, "out", 0, [[140.0, 140.0], [40.0, 140.0]]),
        ],
        [(0, 1), (1, 2)],
    )
