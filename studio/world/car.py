"""Cars before they are columns: model, path, start and driver, and where that is."""

from dataclasses import dataclass

import numpy as np

from studio.kind.driver import Driver
from studio.road.ways.path import PATH_HEADING, PATH_HEIGHT, PATH_SPACING, PATH_X, PATH_Y, Path
from studio.scenario.catalogue import VehicleModel
from studio.scenario.schema import Gps, Intervention
from studio.world.footprint import Footprint


@dataclass(frozen=True)
class Car:
    """One car."""

    name: str
    model: VehicleModel
    path: Path
    station: float  # [m] of the centre of gravity
    speed: float  # [m/s]
    driver: Driver
    intervention: Intervention
    colour: str
    gps: Gps
    is_light: bool = False  # whether it moves with the light dynamics
    returns: bool = False  # whether it comes in again when it has arrived
    source: int | None = None  # the number of the source that lets it in when one is due
    is_outside: bool = False  # whether it is not on the road yet
    changes_lanes: bool = False  # whether its driver does so where nothing asks for it


def pose(path: Path, station: float) -> tuple[float, float, float]:
    """Position [m] and heading [rad] at a station of a path."""
    return at(path, station, PATH_X), at(path, station, PATH_Y), at(path, station, PATH_HEADING)


def position(path: Path, station: float) -> tuple[float, float]:
    """Where a station of a path lies [m]."""
    return at(path, station, PATH_X), at(path, station, PATH_Y)


def at(path: Path, station: float, row: int) -> float:
    """A row of a path's points at a station [m], between its ends."""
    place = min(max(station / PATH_SPACING, 0.0), path.points.shape[1] - 1.0)
    before = min(int(place), path.points.shape[1] - 2)
    here, there = path.points[row, before : before + 2].tolist()
    return (there - here) * (place - before) + here


def footprint(name: str, model: VehicleModel, path: Path, station: float) -> Footprint:
    """The outline of a car whose centre of gravity is at a station of a path."""
    x, y, heading = pose(path, station)
    body = model.values.body
    ahead = body.front_distance + body.front_overhang - 0.5 * body.length
    return Footprint(
        name, x + ahead * np.cos(heading), y + ahead * np.sin(heading), heading, body.length, body.width, at(path, station, PATH_HEIGHT)
    )
