"""Spots: where stations stand.

spots(scenario, network, where)   →  {name: (x, y)} [m]
"""

import numpy as np

from studio.errors import Problem, ScenarioError, nearest
from studio.road.network import Network
from studio.road.ways.detour import lane_line
from studio.road.ways.path import PATH_HEADING, PATH_SPACING, PATH_X, PATH_Y
from studio.scenario.schema import Scenario, Spot


def spots(scenario: Scenario, network: Network, where: str) -> dict[str, tuple[float, float]]:
    """The place of every station; raises ScenarioError for a road that the map does not have, or that is shorter."""
    return {name: spot(station.position, network, f"{where}: stations.{name}.position") for name, station in scenario.stations.items()}


def spot(of: Spot, network: Network, where: str) -> tuple[float, float]:
    """One place."""
    if of.x is not None and of.y is not None:
        return of.x, of.y
    assert of.road is not None  # a spot has this or coordinates
    roads = network.roads
    if of.road not in roads:
        refuse(Problem(f"{where}.road", "is not on the map", repr(of.road), remedy=nearest(of.road, roads)))
    points = lane_line(network, network.lanes_of(of.road)[0]).points
    length = (points.shape[1] - 1) * PATH_SPACING
    if of.along > length:
        refuse(Problem(f"{where}.along", "lies beyond the end of the road", f"{of.along:g} m", f"≤ {length:.0f} m"))
    x, y, heading = (
        float(np.interp(of.along, np.arange(points.shape[1]) * PATH_SPACING, points[row])) for row in (PATH_X, PATH_Y, PATH_HEADING)
    )
    return x - of.aside * float(np.sin(heading)), y + of.aside * float(np.cos(heading))


def refuse(problem: Problem) -> None:
    """Raises ScenarioError."""
    raise ScenarioError("A station cannot stand there.", [problem])
