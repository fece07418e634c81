"""A table of OpenDRIVE files: imported or refused with the reason, and how a single car drives the longest way through each.

uv run python tools/opendrive_table.py FILE.xodr FOLDER ...
"""

import sys
from pathlib import Path

import numpy as np

from studio.errors import StudioError
from studio.road import load
from studio.road.network import Network
from studio.road.ways.path import PATH_SPEED, path
from studio.road.ways.path import Path as Line
from studio.road.ways.route import all_routes
from studio.scenario import catalogue
from studio.scenario.schema import Gps, Intervention, Scenario
from studio.vehicle.state import ACTIVE
from studio.world.build import build
from studio.world.car import Car
from studio.world.setting import Setting
from studio.world.table.mind import OFFSET
from studio.world.tick import tick
from studio.world.way import Works

SHORTEST, BEGIN = 40.0, 8.0  # [m] of a way that is driven; where the car begins
SLOW = 3.0  # times as long as in free traffic a car may take
TEXT = {"title": "x", "map": {"file": "x"}, "routes": {"way": {"roads": ["x"]}},
        "vehicles": {"car": {"route": "way", "position": {"along": 0}, "speed": 0}}}  # fmt: skip
HEAD = ("file", "what came", "lanes [km]", "left out or guessed", "way [m]", "driven")


def main() -> None:
    """Prints the table of the files and folders that are named."""
    given = [Path(each) for each in sys.argv[1:]]
    files = sorted(each for path in given for each in (path.rglob("*.xodr") if path.is_dir() else [path]))
    for cells in (HEAD, ("---",) * len(HEAD), *map(row, files)):
        print("|", " | ".join(cells), "|", flush=True)


def row(file: Path) -> tuple[str, ...]:
    """What becomes of a file."""
    try:
        network = load(file)
    except StudioError as error:
        return file.name, f"refused: {error.message.removeprefix(str(file))[:120].lstrip(': ')}", "", "", "", ""
    told = len(network.report.skipped) + len(network.report.guesses)
    lines = [path(network, way) for way in all_routes(network)]
    longest = max(lines, key=lambda line: line.length, default=None)
    about = file.name, "imported", f"{network.report.lane_km:.2f}", f"{told}"
    if longest is None or longest.length < SHORTEST:
        return *about, "", "no way to drive"
    return *about, f"{longest.length:.0f}", driven(network, longest)


def driven(network: Network, line: Line) -> str:
    """How a car drives a line alone: whether it arrives, and how far it comes off the line."""
    speed = float(min(8.0, line.points[PATH_SPEED, int(BEGIN) : int(BEGIN) + 20].min()))
    driver = Scenario.model_validate(TEXT).vehicles["car"].driver
    car = Car("car", catalogue.find_vehicle("bmw_320i"), line, BEGIN, speed, driver, Intervention(), "#2f6fde", Gps())
    world = build([Setting(Scenario.model_validate(TEXT), network, (car,), (), Works(()), {})])
    until, beside = SLOW * float(np.sum(1.0 / line.points[PATH_SPEED])) + 120.0, 0.0
    while world.vehicles.state[ACTIVE, 0] > 0.0 and world.clock.time < until:
        tick(world)
        beside = max(beside, abs(float(world.vehicles.mind[OFFSET, 0])))
    return f"{'arrives' if world.vehicles.state[ACTIVE, 0] == 0.0 else 'does not arrive'}, at most {beside:.2f} m beside"


if __name__ == "__main__":
    main()
