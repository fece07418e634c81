"""Water whose outline is cut at the edge of an extract: closed along the box that the extract was cut by.

An extract has the lines of a lake that meet its box, and not the rest of the lake. The lines part the box into faces. Whoever crosses a
line goes from water to land or back, as each of them bounds the same water: so the faces fall into two sides, neighbours never on the same
one. On which side the water is no line tells, for the members of a multipolygon run either way round; but houses and streets do: they stand
on land. (A coastline is closed alike, and tells by its direction.)
"""

from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

Line = Sequence[tuple[float, float]]


def wet(lines: Sequence[Line], frame: tuple[float, float, float, float], dry: np.ndarray) -> list[shapely.Polygon]:
    """The water within a frame (x0, y0, x1, y1) that these lines bound; `dry` are places on land, float64[2, n].

    None where the lines end within the frame, do not meet it, or where the land does not show.
    """
    box = shapely.box(*frame)
    shores = shapely.union_all([shapely.LineString(line) for line in lines if len(line) > 1])
    if has_end(shores, box):
        return []
    first, second = sides(parted(shores, box))
    on_first, on_second = (land(side, dry) for side in (first, second))
    return [] if on_first == on_second else first if on_first < on_second else second


def has_end(shores: BaseGeometry, box: shapely.Polygon) -> bool:
    """Whether a line ends within the box."""
    ends = shapely.boundary(shapely.line_merge(shores))
    return not ends.is_empty and bool(shapely.contains(box, shapely.get_parts(ends)).any())


def parted(shores: BaseGeometry, box: shapely.Polygon) -> list[shapely.Polygon]:
    """The faces into which the lines part the box."""
    net = shapely.union_all([shores.intersection(box), box.exterior])
    return list(shapely.get_parts(shapely.polygonize(shapely.get_parts(net))))


def sides(faces: list[shapely.Polygon]) -> tuple[list[shapely.Polygon], list[shapely.Polygon]]:
    """The faces on the one side of the lines and those on the other."""
    side, coming = {0: 0}, [0]
    while coming:
        here = coming.pop()
        for other in range(len(faces)):
            if other not in side and faces[here].boundary.intersection(faces[other].boundary).length > 0.0:
                side[other] = 1 - side[here]
                coming.append(other)
    return [faces[i] for i, which in side.items() if which == 0], [faces[i] for i, which in side.items() if which == 1]


def land(faces: list[shapely.Polygon], dry: np.ndarray) -> int:
    """How many places on land lie in these faces."""
    return sum(int(shapely.contains_xy(face, *dry).sum()) for face in faces)
