"""Places where traffic is tried: streets of a city, a large ring, a drawn grid, a place where one drives on the left, a motorway.

On the motorway one of three lanes is closed, so that everybody on it has to go over.
"""

from pathlib import Path
from typing import Any

from studio.scenario import setup
from studio.world.setting import Setting, setting
from tests.conftest import ROOT

SCENARIOS, REFERENCE = ROOT / "scenarios" / "maps", ROOT / "tests" / "reference" / "maps"
CLOSED = {"do": {"kind": "close_lane", "road": "motorway", "lane": 1, "start": 3000, "end": 3300, "taper": 150}}
PLACES: dict[str, tuple[Path, dict[str, Any]]] = {
    "Berlin Mitte": (REFERENCE / "berlin_mitte.osm.gz", {}),
    "Großer Stern": (SCENARIOS / "berlin_siegessaeule_grosser_stern.osm.gz", {"map": {"signal_start": 60}}),
    "grid": (SCENARIOS / "urban_grid.osm", {"map": {"radius": 450, "signal_start": 20}}),
    "on the left": (SCENARIOS / "singapore_bayfront.osm.pbf", {"map": {"radius": 800, "signal_start": 20}}),
    "motorway": (SCENARIOS / "motorway.xodr", {"script": {"works": CLOSED}}),
}


def prepared(name: str, cars: int, seconds: float, seed: int) -> Setting:
    """Traffic of so many cars at a place, for so long [s]."""
    file, more = PLACES[name]
    document = {
        "title": name,
        **more,
        "map": {"file": file.name, **more.get("map", {})},
        "clock": {"duration": seconds},
        "seed": seed,
        "traffic": {"count": cars},
    }
    return setting(setup.complete(document, name), file.parent, name)
