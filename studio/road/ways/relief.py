"""The relief of a map: how high its roads lie above the land around them, or how deep below it.

A picture that is flat where nothing crosses needs no model of the land: a road lies on it, but for bridges and tunnels that cross others
and for the ramps that lead to them. Where two lanes cross in the plan and their heights differ by 3 m or more, the one on the other level
(without levels the upper one) is off the ground. From there all lanes may be so that are reached within the way that a gentle ramp of 3 %
needs; a level that is mapped goes on as far as it is mapped. The land under them is taken from the lanes around that are on the ground,

    land(p) = sum w z / sum w,  w = 1/d²  over the 8 nearest      lift = z - land

(D. Shepard, *A two-dimensional interpolation function for irregularly-spaced data*, ACM National Conference 1968). A hill without
crossings is land all over, and has no relief.
"""

import itertools
from dataclasses import dataclass

import numpy as np
import shapely

from studio.road.network import Lane, Net, Network, curve
from studio.road.network.index import once
from studio.road.ways.path import PATH_HEIGHT, PATH_SPACING, Path

APART = 3.0  # [m] of height between lanes that pass above each other
GENTLE = 0.03  # [1] slope of the longest ramp that is thought of
LONGEST = 400.0  # [m] of a ramp
SPACING = 4.0  # [m] between places along a lane
BESIDE = 12.0  # [m] from a crossing, where the lane on the ground is certainly on it
NEAREST = 8  # places on the ground that tell the land
LEAST = 0.05  # [m] a lane less far from the land lies on it
TOUCH = 1e-6  # [m] between places that are one: a zero would be no link
UPRIGHT = 4.0  # [1] what a metre of height counts for where the nearest lane is looked for


@dataclass(frozen=True, eq=False)
class Relief:
    """Places along all lanes: `points` float64[3, n] east, north and height [m], `lift` float64[n] above the land [m], `slope`
    float64[2, n] of the lift to the east and north [1]; the places of lane i are those from first[i] to first[i + 1], at `station` [m] and
    on the mapped `level`.
    """

    points: np.ndarray
    lift: np.ndarray
    slope: np.ndarray
    first: np.ndarray
    station: np.ndarray
    level: np.ndarray

    def of_lane(self, lane: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Stations [m], places float64[2, n] and lifts of a lane."""
        own = slice(self.first[lane], self.first[lane + 1])
        return self.station[own], self.points[:2, own], self.lift[own]

    def at(self, x: np.ndarray, y: np.ndarray, height: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Lift [m] and its slope float64[2, n] at places on roads of these heights, by the nearest lane."""
        _, i = self._tree.query(np.column_stack([x, y, UPRIGHT * np.asarray(height)]))
        d_x, d_y = np.clip([x - self.points[0, i], y - self.points[1, i]], -SPACING, SPACING)
        return self.lift[i] + self.slope[0, i] * d_x + self.slope[1, i] * d_y, self.slope[:, i]

    @property
    def _tree(self):
        if "tree" not in self.__dict__:
            object.__setattr__(self, "tree", tree_of(self.points * np.array([[1.0], [1.0], [UPRIGHT]])))
        return self.__dict__["tree"]


@once
def relief_of(network: Network) -> Relief | None:
    """The relief of a map; None for one that lies on the ground all over."""
    if not any(lane.height.any() for lane in network.lanes):
        return None
    # what a storey was laid for needs no guess
    left = [lane.height - lifts(lane) for lane in network.lanes]
    off, below, apart = crossings(network.lanes, left)
    is_laid = any(lane.lift.size for lane in network.lanes)
    return shaped(network, off, below, apart) if off or is_laid else None


def road_height(network: Network, x: float, y: float) -> float:
    """Height of the nearest lane to a place [m], of several as near that of the lowest."""
    if not any(lane.height.any() for lane in network.lanes):
        return 0.0
    point, lines = shapely.Point(x, y), [shapely.LineString(lane.centre.T) for lane in network.lanes]
    far = shapely.distance(lines, point)
    near = np.flatnonzero(far <= far.min() + 1.0)
    return min(value(network.lanes[i].height, network.lanes[i], float(lines[i].project(point))) for i in near.tolist())


def height_at(path: Path, station: np.ndarray) -> np.ndarray:
    """Height of the road [m] at stations of a path [m]."""
    known = path.points[PATH_HEIGHT]
    return np.interp(np.nan_to_num(station), np.arange(known.size) * PATH_SPACING, known)


# -- where lanes pass above each other -------------------------------------------------------------


Spots = list[tuple[int, float]]  # a lane and a station on it [m]


def crossings(lanes: tuple[Lane, ...], height: list[np.ndarray]) -> tuple[Spots, Spots, list[float]]:
    """Who is off the ground, by these heights, and who is on it where lanes cross; and how far each of the first is from the other [m]."""
    lines = np.array([shapely.LineString(lane.centre.T) for lane in lanes])
    low, high = (np.array([end(z) for z in height]) for end in (np.min, np.max))
    i, j = shapely.STRtree(lines).query(lines, predicate="intersects")
    may = (i < j) & (np.maximum(high[i] - low[j], high[j] - low[i]) >= APART)
    off, below, apart = [], [], []
    for a, b in np.column_stack([i[may], j[may]]).tolist():
        for point in shapely.get_parts(shapely.intersection(lines[a], lines[b]).representative_point()):
            at = [shapely.line_locate_point(lines[lane], point) for lane in (a, b)]
            z = [value(height[lane], lanes[lane], s) for lane, s in zip((a, b), at, strict=True)]
            level = [value(levels(lanes[lane]), lanes[lane], s) for lane, s in zip((a, b), at, strict=True)]
            if abs(z[0] - z[1]) >= APART:
                for lane, s, own, other, on in zip((a, b), at, z, reversed(z), is_off(z, level), strict=True):
                    (off if on else below).append((lane, s))
                    apart += [abs(own - other)] if on else []
    return off, below, apart


def is_off(z: list[float], level: list[float]) -> list[bool]:
    """Who of two that cross is off the ground: whose level is another than that, else the upper one."""
    return [each != 0.0 for each in level] if any(level) else [each == max(z) for each in z]


def levels(lane: Lane) -> np.ndarray:
    """The levels of a lane."""
    return lane.level if lane.level.size else np.zeros(lane.height.size)


def lifts(lane: Lane) -> np.ndarray:
    """How far a lane lies above or below the land for the storeys that were laid [m]."""
    return lane.lift if lane.lift.size else np.zeros(lane.height.size)


def value(of: np.ndarray, lane: Lane, s: float) -> float:
    """What the points of a lane say at a station."""
    return float(np.interp(s, curve.stations(lane.centre), of))


# -- how far ramps reach, and what the land is there -----------------------------------------------


def shaped(network: Network, off: list, below: list, apart: list[float]) -> Relief:
    """The relief of a map with crossings."""
    stations, first = stationed(network.lanes)
    points = along(network.lanes, stations, first, [(*lane.centre, lane.height) for lane in network.lanes])
    level, lift = along(network.lanes, stations, first, [(levels(lane), lifts(lane)) for lane in network.lanes])
    if off:
        left = np.concatenate([points[:2], points[2:] - lift])
        crossed = [[nearest(stations, first, *each) for each in spots] for spots in (off, below)]
        lift = lift + guessed(links(network, first, points, level), left, first, crossed, apart)
    lift[np.abs(lift) < LEAST] = 0.0
    return Relief(points, lift, slopes(points, lift, first), first, stations, level)


def guessed(far, points: np.ndarray, first: np.ndarray, crossed: list[list[int]], apart: list[float]) -> np.ndarray:
    """The lift at all places [m], from those off the ground and on it where lanes cross."""
    seed, grounded = np.array(crossed[0]), np.array(crossed[1], dtype=int)
    aloft = reached(far, seed, np.minimum(np.array(apart) / GENTLE, LONGEST), points.shape[1]) >= 0.0
    aloft[beside(points, first, grounded, seed)] = False
    lift = np.zeros(points.shape[1])
    if aloft.any() and not aloft.all():
        lift[aloft] = points[2, aloft] - land(points[:, ~aloft], points[:2, aloft])
    return lift


def stationed(lanes: tuple[Lane, ...]) -> tuple[np.ndarray, np.ndarray]:
    """The stations of all places along lanes [m], and the first place of every lane."""
    own = [spaced(lane) for lane in lanes]
    return np.concatenate(own), np.concatenate([[0], np.cumsum([s.size for s in own])])


def along(lanes: tuple[Lane, ...], stations: np.ndarray, first: np.ndarray, rows: list[tuple]) -> np.ndarray:
    """What the points of the lanes say, at all places."""
    made = np.zeros((len(rows[0]), first[-1]))
    for lane, own, a, b in zip(lanes, rows, first[:-1], first[1:], strict=True):
        known = curve.stations(lane.centre)
        for row, of in zip(made, own, strict=True):
            row[a:b] = np.interp(stations[a:b], known, of)
    return made


def spaced(lane: Lane) -> np.ndarray:
    """Stations along a lane [m]: at equal distances, both ends among them."""
    length = curve.length(lane.centre)
    return np.linspace(0.0, length, max(2, int(np.ceil(length / SPACING)) + 1))


def nearest(stations: np.ndarray, first: np.ndarray, lane: int, s: float) -> int:
    """The place that is nearest to a station of a lane."""
    return int(first[lane] + np.abs(stations[first[lane] : first[lane + 1]] - s).argmin())


def links(network: Network | Net, first: np.ndarray, points: np.ndarray, level: np.ndarray):
    """How far it is from place to place [m], along lanes and from each to the next; on one mapped level off the ground it costs nothing."""
    from scipy.sparse import coo_matrix

    within = np.setdiff1d(np.arange(points.shape[1] - 1), first[1:-1] - 1)
    a, b = within, within + 1
    far = np.maximum(np.hypot(*(points[:2, b] - points[:2, a])), TOUCH)
    far[(level[a] == level[b]) & (level[a] != 0.0)] = TOUCH
    chains = [(each.from_lane, *each.via, each.to_lane) for each in network.connections]
    joints = np.array([(first[x + 1] - 1, first[y]) for chain in chains for x, y in itertools.pairwise(chain)], dtype=int)
    joints = np.unique(joints.reshape(-1, 2), axis=0).T
    rows, columns = np.concatenate([a, joints[0]]), np.concatenate([b, joints[1]])
    return coo_matrix((np.concatenate([far, np.full(joints.shape[1], TOUCH)]), (rows, columns)), shape=(points.shape[1],) * 2)


def reached(far, seed: np.ndarray, budget: np.ndarray, count: int) -> np.ndarray:
    """What is left of the way of a ramp at every place [m], the most of all seeds; negative where none reaches."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import dijkstra

    most = float(budget.max()) + 1.0
    rows, columns = np.append(far.row, np.full(seed.size, count)), np.append(far.col, seed)
    # one more place, from which every seed is as far as its ramp is shorter than the longest
    order = np.argsort(-budget, kind="stable")
    rows[far.row.size :], columns[far.row.size :] = count, seed[order]
    cost = np.append(far.data, most - budget[order])
    _, once_each = np.unique(np.column_stack([rows, columns]), axis=0, return_index=True)
    graph = coo_matrix((cost[once_each], (rows[once_each], columns[once_each])), shape=(count + 1,) * 2).tocsr()
    return most - dijkstra(graph, directed=False, indices=count, limit=most)[:count]


def beside(points: np.ndarray, first: np.ndarray, grounded: np.ndarray, seed: np.ndarray) -> np.ndarray:
    """The places near a crossing that are on the lane that is on the ground there."""
    lane = np.searchsorted(first, np.arange(points.shape[1]), side="right")
    found = [np.empty(0, dtype=int)]
    for place in np.setdiff1d(grounded, seed).tolist():
        own = np.flatnonzero(lane == lane[place])
        found.append(own[np.hypot(*(points[:2, own] - points[:2, place, None])) <= BESIDE])
    return np.setdiff1d(np.concatenate(found), seed)


def land(known: np.ndarray, at: np.ndarray) -> np.ndarray:
    """The height of the land [m] at places float64[2, n], by those on the ground."""
    count = min(NEAREST, known.shape[1])
    far, i = tree_of(known[:2]).query(at.T, k=count)
    far, i = far.reshape(-1, count), i.reshape(-1, count)
    weight = 1.0 / np.maximum(far, 0.1) ** 2
    return (weight * known[2, i]).sum(axis=1) / weight.sum(axis=1)


def slopes(points: np.ndarray, lift: np.ndarray, first: np.ndarray) -> np.ndarray:
    """The slope of the lift to the east and north at every place, along its lane."""
    found = np.zeros((2, lift.size))
    for a, b in itertools.pairwise(first):
        if lift[a:b].any():
            step = np.gradient(points[:2, a:b], axis=1)
            found[:, a:b] = step * np.gradient(lift[a:b]) / np.maximum((step * step).sum(axis=0), TOUCH)
    return found


def tree_of(points: np.ndarray):
    """A search tree over places float64[rows, n]."""
    from scipy.spatial import KDTree

    return KDTree(points.T)
