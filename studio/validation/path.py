"""Paths that are compared over travelled distance: the averaged path, deviations along its normal (Eqs. 17 to 22).

Every point of a base run is averaged with the nearest point of every other run (17); distance adds up along what comes out (18). Where
two drives have travelled equally far they are compared (19, 20). The zone lies along the normal of the averaged path: mean ∓ T s / √n
of the signed distances of the runs, left positive (21, 22).
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.spatial import KDTree


class Path(NamedTuple):
    """Points [m], float64[n, 2], and the distance travelled until each [m]."""

    points: np.ndarray
    distance: np.ndarray

    @property
    def length(self) -> float:
        """Final travelled distance [m]."""
        return float(self.distance[-1])

    @property
    def normals(self) -> np.ndarray:
        """To the left of the direction of travel at each point."""
        along = np.gradient(self.points, axis=0)
        along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-12)
        return np.stack([-along[:, 1], along[:, 0]], axis=1)

    def at(self, distance: np.ndarray) -> np.ndarray:
        """Points where so much has been travelled."""
        return np.stack([np.interp(distance, self.distance, self.points[:, i]) for i in (0, 1)], axis=1)


def path(x: np.ndarray, y: np.ndarray, spacing: float = 0.1) -> Path:
    """A path of positions [m], at points that lie about `spacing` [m] apart, whatever the speed was."""
    points = np.stack([x, y], axis=1)
    points = points[np.isfinite(points).all(axis=1)]
    distance = travelled(points)
    even = np.linspace(0.0, distance[-1], max(int(distance[-1] / spacing) + 1, 2))
    return Path(np.stack([np.interp(even, distance, points[:, i]) for i in (0, 1)], axis=1), even)


def travelled(points: np.ndarray) -> np.ndarray:
    """Distance until each point [m]."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


def averaged(paths: Sequence[Path], reach: float = 10.0) -> Path:
    """The averaged path, with the first as base. The nearest point is looked for where about as far was travelled, ± `reach` [m],
    for laps cross themselves."""
    base = paths[0]
    others = [nearest(base, each, reach) for each in paths[1:]]
    points = np.mean([base.points, *others], axis=0)
    return Path(points, travelled(points))


def nearest(base: Path, other: Path, reach: float) -> np.ndarray:
    """Of each point of the base the nearest of another path: distance travelled counts as a third direction, lightly."""
    weight = 1.0 / reach
    tree = KDTree(np.column_stack([other.points, weight * other.distance]))
    return other.points[tree.query(np.column_stack([base.points, weight * base.distance]))[1]]


def offsets(base: Path, other: Path, reach: float = 10.0) -> np.ndarray:
    """Signed distances [m] of another path along the normals of the base."""
    return ((nearest(base, other, reach) - base.points) * base.normals).sum(axis=1)


def deviations(base: Path, other: Path) -> np.ndarray:
    """Signed distances [m] where both have travelled equally far: the sign says to which side, the size is the whole distance."""
    apart = other.at(base.distance) - base.points
    side = np.sign((apart * base.normals).sum(axis=1))
    return np.where(side == 0.0, 1.0, side) * np.linalg.norm(apart, axis=1)
