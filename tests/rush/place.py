"""Places where traffic is tried: streets of a city, a large ring, a drawn grid, a place where one drives on the left, a motorway.

On the motorway one of three lanes is closed, so that everybody on it has to go over.
"""

from pathlib import Path
from typing import Any

from studio.road import load
from studio.road.ways.path import path
from studio.road.ways.route import all_routes
from studio.scenario import setup
from studio.world.setting import USUAL_RADIUS, Setting, setting
from tests.conftest import ROOT

SCENARIOS, REFERENCE = ROOT / "scenarios" / "maps", ROOT / "tests" / "reference" / "maps"
CLOSED = {"do": {"kind": "close_lane", "road": "motorway", "lane": 1, "start": 3000, "end": 3300, "taper": 150}}
FIRST = 20
PLACES: dict[str, tuple[Path, dict[str, Any]]] = {  # those first that are over soonest
    "grid": (SCENARIOS / "urban_grid.osm", {"map": {"radius": 450, "signal_start": 20}}),
    "on the left": (SCENARIOS / "singapore_bayfront.osm.pbf", {"map": {"radius": 800, "signal_start": 20}}),
    "Großer Stern": (SCENARIOS / "berlin_siegessaeule_grosser_stern.osm.gz", {"map": {"signal_start": 60}}),
    "Berlin Mitte": (REFERENCE / "berlin_mitte.osm.gz", {}),
    "motorway": (SCENARIOS / "motorway.xodr", {"script": {"works": CLOSED}}),
}


def prepared(name: str, cars: int, seconds: float, seed: int) -> Setting:
    """Traffic of so many cars at a place, for so long [s]; and one car with a way of its own, the longest of the first ones."""
    file, more = PLACES[name]
    network = load(file, radius=more.get("map", {}).get("radius", USUAL_RADIUS))
    way = max(all_routes(network)[:FIRST], key=lambda each: path(network, each).length)
    document = {
        "title": name,
        **more,
        "map": {"file": file.name, **more.get("map", {})},
        "clock": {"duration": seconds},
        "seed": seed,
        "routes": {"way": {"roads": way.roads(network)}},
        "vehicles": {"own": {"route": "way", "position": {"along": 20}, "speed": 5}},
        "traffic": {"count": cars},
    }
    return setting(setup.complete(document, name), file.parent, name)
