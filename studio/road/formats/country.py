"""Which country a place lies in, and so on which side one drives there, without asking the network.

The borders are Natural Earth's, simplified (countries.json.gz names its source): right to about 15 km. Near a border
behind which the other side is driven, the answer is no more than a guess; a map's own tags and roundabouts tell better.
"""

import gzip
import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from studio.road.network.report import Side

BORDERS = Path(__file__).with_name("countries.json.gz")
NEAR_BORDER = 0.3  # [deg] about 30 km: twice what simplifying moves a border
AT_SEA = 2.0  # [deg] farther from all land than this, a place belongs to nobody


@dataclass(frozen=True)
class Country:
    """The country of a place: its name, the side one drives on, and whether no border to the other side is near."""

    name: str
    drives: Side
    certain: bool


@cache
def borders() -> tuple[list[str], list[Side], np.ndarray]:
    """Names, sides and areas (longitude, latitude) [deg] of all countries."""
    with gzip.open(BORDERS) as file:
        countries = json.load(file)["countries"]
    areas = [shapely.union_all([area(rings) for rings in each["polygons"]]) for each in countries]
    return [each["name"] for each in countries], [each["drives"] for each in countries], np.array(areas)


def area(rings: list) -> BaseGeometry:
    """One area with its holes; simplifying can have made a ring cross itself."""
    return shapely.make_valid(shapely.Polygon(rings[0], rings[1:]))


@cache
def country_at(latitude: float, longitude: float) -> Country:
    """The country of a place [deg], or the one whose land is nearest.

    >>> country_at(1.286, 103.859)
    Country(name='Singapore', drives='left', certain=True)
    """
    names, sides, areas = borders()
    away = shapely.distance(areas, shapely.Point(longitude, latitude))
    nearest = int(away.argmin())
    if away[nearest] > AT_SEA:
        return Country("no country", "right", certain=False)
    others = away[[side != sides[nearest] for side in sides]]
    return Country(names[nearest], sides[nearest], certain=bool(others.min() > away[nearest] + NEAR_BORDER))
