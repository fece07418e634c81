"""The ground that roads and junctions cover, as plane shapes."""

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from studio.road.network import Net, Network
from studio.road.network.plane import polygons

SMALLEST_ISLAND = 12.0  # [m²] a smaller hole in the asphalt is a slit between lanes that overlap
SEAM = 0.15  # [m] gaps narrower than twice this between lanes and junctions are closed


def road_form(network: Net | Network) -> BaseGeometry:
    """The carriageway as one plane shape: lanes and junctions, with the seams and slits between them closed."""
    lanes = [strip(lane.centre, lane.width) for lane in network.lanes]
    joined = shapely.union_all([*lanes, junction_form(network)])
    closed = joined.buffer(SEAM, join_style="mitre").buffer(-SEAM, join_style="mitre").simplify(0.01)
    return shapely.union_all([without_slits(polygon) for polygon in polygons(closed)])


def without_slits(polygon: shapely.Polygon) -> shapely.Polygon:
    """The polygon without holes too small for an island."""
    islands = [hole for hole in polygon.interiors if shapely.Polygon(hole).area > SMALLEST_ISLAND]
    return shapely.Polygon(polygon.exterior, islands)


def junction_form(network: Net | Network) -> BaseGeometry:
    """The ground of all junctions."""
    return shapely.union_all([shapely.make_valid(shapely.Polygon(junction.T)) for junction in network.junctions])


def strip(centre: np.ndarray, width: float) -> BaseGeometry:
    """A band of this width [m] along a line."""
    return shapely.LineString(centre.T).buffer(width / 2.0, cap_style="flat", join_style="mitre", mitre_limit=2.0)
