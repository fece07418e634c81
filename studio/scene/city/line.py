"""Lines that are painted along lanes, and bars before signals, as plane shapes."""

from collections.abc import Iterator

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from studio.road.network import Lane, Network, curve
from studio.road.network.outline import strip

LINE_WIDTH = 0.12  # [m] of lane markings in town (RMS: 0.12)
DASH, DASH_PERIOD = 3.0, 9.0  # [m] a lead line in town: 3 m line, 6 m gap (RMS)
STOP_LINE_WIDTH = 0.5  # [m] (RMS: 0.50)
EDGE_INSET = 0.1  # [m] of the edge line from the edge of the asphalt
MIDDLE_INSET = 1.0  # [m] of asphalt beyond a line, from which on it is one between directions


def beside(lane: Lane, offset: float) -> BaseGeometry:
    """The line along a lane, `offset` [m] to the left of its centre."""
    return shapely.LineString(lane.centre.T).offset_curve(offset, join_style="mitre")


def road_lines(network: Network, road: str) -> Iterator[BaseGeometry]:
    """The dashes between the lanes of a road."""
    for lane in network.lanes_of(road)[:-1]:
        yield from dashes(beside(lane, network.middle * lane.width / 2.0))


def dashes(line: BaseGeometry) -> Iterator[BaseGeometry]:
    """Dashes along a line; a line too short for one stays empty."""
    if line.geom_type != "LineString" or line.is_empty:
        return
    points = np.array(line.coords).T
    for start in np.arange(DASH, line.length - DASH, DASH_PERIOD):
        own = curve.stations(points)
        inside = points[:, (start < own) & (own < start + DASH)]
        ends = curve.along(points, np.array([start, start + DASH]))
        yield strip(np.column_stack([ends[:, :1], inside, ends[:, 1:]]), LINE_WIDTH)


def middle_line(network: Network, road: str) -> BaseGeometry:
    """The line beside a road towards its middle; it is drawn where asphalt, the other direction's, lies beyond it."""
    inner = network.lanes_of(road)[-1]
    line = beside(inner, network.middle * inner.width / 2.0)
    return line.buffer(LINE_WIDTH / 2.0, cap_style="flat", join_style="mitre")


def edge_lines(network: Network, form: BaseGeometry) -> BaseGeometry:
    """A line along the edge of the asphalt, but not across the ends where the map is cut."""
    inner = form.buffer(-EDGE_INSET, join_style="mitre")
    line = inner.difference(inner.buffer(-LINE_WIDTH, join_style="mitre"))
    return line.difference(shapely.union_all([end for lane in loose_ends(network) for end in lane]))


def loose_ends(network: Network) -> Iterator[list[BaseGeometry]]:
    """Bars over the ends of lanes where the map is cut."""
    fed = {connection.to_lane for connection in network.connections}
    feeding = {connection.from_lane for connection in network.connections}
    for lane in network.lanes:
        if not lane.internal:
            starts = [] if lane.id in fed else [lane.centre[:, :2]]
            ends = [] if lane.id in feeding else [lane.centre[:, -2:]]
            yield [across(points, at, lane.width) for points, at in [*((p, 0) for p in starts), *((p, 1) for p in ends)]]


def across(points: np.ndarray, at: int, width: float) -> BaseGeometry:
    """A bar over the end of a lane, a little narrower than the lane so that its edge lines stay."""
    direction = np.diff(points)[:, 0]
    direction = direction / np.hypot(*direction)
    left = np.array([-direction[1], direction[0]]) * (width / 2.0 - EDGE_INSET - LINE_WIDTH)
    return strip(np.column_stack([points[:, at] - left, points[:, at] + left]), 1.0)


def stop_line(network: Network, link: int) -> BaseGeometry:
    """The bar before a signal, across its lane."""
    signals = network.signals
    heading, half = signals.link_heading[link], signals.link_width[link] / 2.0
    forward = np.array([np.cos(heading), np.sin(heading)])
    middle = np.array([signals.link_x[link], signals.link_y[link]]) - forward * STOP_LINE_WIDTH / 2.0
    left = np.array([-forward[1], forward[0]]) * half
    return strip(np.column_stack([middle - left, middle + left]), STOP_LINE_WIDTH)
