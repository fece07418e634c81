"""What lies beside a fast road where nothing is mapped: a paved shoulder, and a rail that keeps cars on it.

Sizes as German guidelines have them for motorways: a shoulder of 2.50 m (RAA 2008, cross-section RQ 31), the upper edge of a steel rail
0.75 m above the road and half a metre beyond the shoulder (RPS 2009). Nobody drives on it, and nobody drives into it in the simulation.
"""

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from studio.road.network import Network, Wall
from studio.road.network.outline import strip
from studio.road.network.plane import polygons
from studio.scene.city.upright import barrier
from studio.scene.shape import Surface, box

FAST = 27.0  # [m/s] of the limit, from which on a road is a motorway or built like one
SHOULDER = 2.5  # [m]
RAIL_BEYOND, RAIL_FOOT, RAIL_HEIGHT, RAIL_THICKNESS = 0.5, 0.44, 0.75, 0.1  # [m]
POST_SPACING = 8.0  # [m] twice that of the guidelines, for the eye is content with it
RAIL_POST = box((0.1, 0.1, RAIL_FOOT), "#8d9297")
CLEAR = 1.5  # [m] from any asphalt, so that no rail stands in the way of a junction
SHORTEST = 20.0  # [m] of rail


def fast_form(network: Network) -> BaseGeometry:
    """The carriageways of fast roads as a plane shape."""
    lanes = [lane for road in network.roads.values() if road.speed >= FAST and not road.internal for lane in network.lanes_of(road.id)]
    return shapely.union_all([strip(lane.centre, lane.width) for lane in lanes])


def shoulder(network: Network, form: BaseGeometry) -> BaseGeometry:
    """The ground of the shoulders beside a road of this plane shape; empty where no road is fast."""
    return widened(fast_form(network), SHOULDER).difference(form)


def rails(network: Network, form: BaseGeometry) -> list[Surface]:
    """The rails beyond the shoulders: a band of steel, and the posts that carry it."""
    found = []
    for line in rail_lines(network, form):
        band = Wall("guard_rail", np.array(line.coords).T, RAIL_HEIGHT - RAIL_FOOT, RAIL_THICKNESS)
        places = shapely.get_coordinates(line.interpolate(np.arange(POST_SPACING / 2.0, line.length, POST_SPACING)))
        found += [barrier(band).moved(z=RAIL_FOOT), *(RAIL_POST.moved(x=x, y=y, z=RAIL_FOOT / 2.0) for x, y in places)]
    return found


def rail_lines(network: Network, form: BaseGeometry) -> list[shapely.LineString]:
    """Where the rails stand."""
    around = widened(fast_form(network), SHOULDER + RAIL_BEYOND)
    clear = form.buffer(CLEAR)
    lines = [polygon.exterior.difference(clear) for polygon in polygons(around)]
    lines += [hole.difference(clear) for polygon in polygons(around) for hole in map(shapely.LineString, polygon.interiors)]
    parts = [part for line in lines for part in shapely.get_parts(shapely.line_merge(line)) if part.length >= SHORTEST]
    return [part.simplify(0.05) for part in parts]


def widened(form: BaseGeometry, by: float) -> BaseGeometry:
    """A plane shape that reaches farther to all sides [m]."""
    return form.buffer(by, cap_style="flat", join_style="mitre", mitre_limit=2.0)
