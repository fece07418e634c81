"""Where walkers cross the carriageway: mapped ways and points, laid from edge to edge of the road.

A mapped way (`footway=crossing`) tells how a crossing runs; a point on a street (`highway=crossing`) lies across it.
"""

from collections.abc import Iterator

import numpy as np
import shapely

from studio.road.formats.kind import is_signalled, markings
from studio.road.formats.osm import Survey, Thing
from studio.road.formats.way import Way
from studio.road.network import Crossing
from studio.road.network.plane import lines
from studio.road.scenery.site import Site

WIDTH = {"zebra": 4.0, "lines": 3.5, "none": 3.0}  # [m] (R-FGÜ: a zebra is 4 m wide, 3 m at the least)
REACH = 25.0  # [m] from a point on a street to the farther edge
NEAR = 5.0  # [m] a point that near to a crossing is told by it
ON_ROAD = 1.0  # [m] a point that near to the carriageway lies on it
SHORTEST = 2.0  # [m] what is shorter only touches the road
LANE, SHOULDER = 3.5, 4.0  # [m] a street is no wider than its lanes and this on both sides; longer lines run along another
USUAL_LANES = 2


def crossings(found: Survey, site: Site) -> Iterator[Crossing]:
    """The crossings over the roads of a site; those that lead over no road are noted."""
    points = [thing for thing in found.points if thing.kind == "crossing" and site.bounds.contains(shapely.Point(site.place(thing)))]
    places = np.asarray(shapely.points(np.array([site.place(thing) for thing in points]).reshape(-1, 2)))
    drawn = []
    for thing in found.lines:
        for line in over(thing, site) if thing.kind == "crossing" else ():
            drawn.append(shapely.LineString(line.T))
            near = np.flatnonzero(shapely.distance(places, drawn[-1]) < NEAR)
            yield crossing(line, {**thing.tags, **{key: value for i in near for key, value in points[i].tags.items()}})
    streets, known = {node: way for way in site.ways for node in way.nodes}, shapely.STRtree(drawn)
    for thing, place in zip(points, places, strict=True):
        if len(known.query(place, predicate="dwithin", distance=NEAR)):
            continue
        line = across(thing, streets, site)
        if line is None:
            found.notes.skip("crossing", f"crossing={thing.tags.get('crossing', '?')}", thing.spot, "leads over no road that is built")
        else:
            yield crossing(line, thing.tags)


def crossing(line: np.ndarray, tags: dict[str, str]) -> Crossing:
    """The crossing along a line from edge to edge."""
    marking = markings(tags)
    return Crossing(line, WIDTH[marking], marking, is_signalled(tags))


def over(thing: Thing, site: Site) -> Iterator[np.ndarray]:
    """The pieces of a mapped way that lie on the road, as straight lines, float64[2, 2]."""
    form = shapely.LineString(site.line(thing).T)
    if not site.road.intersects(form):
        return
    for piece in lines(shapely.line_merge(form.intersection(site.road))):
        ends = piece[:, [0, -1]]
        if np.hypot(*(ends[:, 1] - ends[:, 0])) > SHORTEST:
            yield ends


def across(thing: Thing, streets: dict[int, Way], site: Site) -> np.ndarray | None:
    """The line over the street at a point, from edge to edge, float64[2, 2]; None where there is no street."""
    node, place = int(thing.name.split()[-1]), site.place(thing)
    way = streets.get(node)
    if way is None or site.road.distance(shapely.Point(place)) > ON_ROAD:
        return None
    ahead = direction(way, node, site)
    left = np.array([-ahead[1], ahead[0]])
    pieces = list(lines(shapely.LineString([place - REACH * left, place + REACH * left]).intersection(site.road)))
    line = min(pieces, key=lambda piece: shapely.LineString(piece.T).distance(shapely.Point(place)), default=None)
    return line if line is not None and SHORTEST < np.hypot(*(line[:, 1] - line[:, 0])) <= widest(way) else None


def widest(way: Way) -> float:
    """How long a way across this street can be [m]."""
    text = way.tags.get("lanes", "")
    lanes = int(text) if text.isdigit() else USUAL_LANES
    return (lanes + 1) * LANE + 2.0 * SHOULDER


def direction(way: Way, node: int, site: Site) -> np.ndarray:
    """The direction in which a way passes one of its nodes, a unit vector."""
    line, at = site.line(way), way.nodes.index(node)
    step = line[:, min(line.shape[1] - 1, at + 1)] - line[:, max(0, at - 1)]
    return step / max(1e-9, np.hypot(*step))
