"""The line a vehicle drives: a lane path drawn as one smooth curve, with a point every metre.

Lane centre lines have corners where netconvert joins its pieces. A path follows them within `CORRIDOR`, blends lane
changes over the length the road gives, and smooths the whole so that curvature changes steadily.
"""

from dataclasses import dataclass

import numpy as np

from studio.compiled import compiled
from studio.road import curve
from studio.road.network import Lane, Network
from studio.road.route import LanePath

PATH_SPACING = 1.0  # [m]
PATH_X, PATH_Y, PATH_HEADING, PATH_CURVATURE, PATH_SPEED = range(5)
PATH_ROWS = 5

GRAIN = 0.25  # [m] spacing of the curve while it is made
CORRIDOR = 0.27  # [m] how far smoothing may leave the centre line
WAVELENGTH = 24.0  # [m] shorter waves are corners of the map, not bends of the road
CHANGE_LENGTH = 45.0  # [m] of road that one lane change takes, if the road is long enough
LOWEST_SPEED = 2.0  # [m/s] the sharpest bend is still driven
PROJECTION_REACH = 5  # [m] how far `project` looks from its guess


@dataclass(frozen=True)
class Station:
    """From arc length `s` [m] on the path runs on this lane of this road."""

    road: str
    lane_index: int
    s: float


@dataclass(frozen=True, eq=False)
class Path:
    """Points float64[PATH_ROWS, n], one per metre; stop lines as (arc length [m], link); stations in order."""

    points: np.ndarray
    stop_lines: tuple[tuple[float, int], ...]
    stations: tuple[Station, ...]

    @property
    def length(self) -> float:
        """Arc length from the first to the last point [m]."""
        return (self.points.shape[1] - 1) * PATH_SPACING


@dataclass
class Draft:
    """The rough line while it is put together: pieces, and what happens at which arc length [m]."""

    pieces: list[np.ndarray]
    limits: list[tuple[float, float]]
    stop_lines: list[tuple[float, int]]
    stations: list[Station]
    s: float = 0.0

    def add(self, piece: np.ndarray, speed: float) -> None:
        """Goes on along `piece`, where `speed` [m/s] is allowed."""
        self.pieces.append(piece)
        self.limits.append((self.s, speed))
        self.s += curve.length(piece)


def path(network: Network, lane_path: LanePath, *, lateral_acceleration=2.5, deceleration=1.5) -> Path:
    """The driving line along a lane path.

    Args:
        network: the map.
        lane_path: from `studio.road.route.connect`.
        lateral_acceleration: what PATH_SPEED allows in bends [m/s²].
        deceleration: what PATH_SPEED needs before slower places [m/s²].
    """
    draft = drafted(network, lane_path)
    rough = joined(draft.pieces)
    fine = curve.resampled(rough, GRAIN)
    spacing = curve.length(fine) / (fine.shape[1] - 1)
    fine = curve.smoothed(fine, spacing=spacing, wavelength=WAVELENGTH, corridor=CORRIDOR)
    points = sampled(fine)
    limit = limits(draft, points.shape[1])
    points[PATH_SPEED] = speeds(points[PATH_CURVATURE], limit, lateral_acceleration, deceleration)
    stations = tuple(station for station in draft.stations if station.s <= points.shape[1] - 1)
    return Path(points, tuple(draft.stop_lines), stations)


# -- the rough line -------------------------------------------------------------------------------------------------


def drafted(network: Network, lane_path: LanePath) -> Draft:
    """Lane by lane the centre lines, with lane changes blended in."""
    draft = Draft([], [], [], [])
    link = {c.from_lane: c.link for c in network.connections}
    for used in stretches(network, lane_path):
        if used[0].internal:
            draft.add(used[0].centre, used[0].speed)
            continue
        start, line = draft.s, blended(used)
        draft.stations += [
            Station(used[0].road, lane.index, start + curve.length(line) * i / len(used)) for i, lane in enumerate(used)
        ]
        draft.add(line, min(lane.speed for lane in used))
        if link.get(used[-1].id, -1) >= 0:
            draft.stop_lines.append((draft.s, link[used[-1].id]))
    return draft


def stretches(network: Network, lane_path: LanePath) -> list[list[Lane]]:
    """The lanes of the path, those of one road together."""
    found = []
    for number in lane_path.lanes:
        lane = network.lanes[number]
        together = found and not lane.internal and found[-1][0].road == lane.road
        found[-1].append(lane) if together else found.append([lane])
    return found


def blended(used: list[Lane]) -> np.ndarray:
    """The line along a road from its first used lane to its last, lane changes one after another."""
    lines = [curve.resampled(lane.centre, GRAIN) for lane in used]
    count = max(line.shape[1] for line in lines)
    total = sum(lane.length for lane in used) / len(used)
    fraction = np.linspace(0.0, 1.0, count)
    lines = [curve.along(lane.centre, fraction * curve.length(lane.centre)) for lane in used]
    line = lines[0]
    slot = 1.0 / max(1, len(used) - 1)
    for i, other in enumerate(lines[1:]):
        reach = min(slot, CHANGE_LENGTH / total)
        middle = (i + 0.5) * slot
        line = line + ease((fraction - middle) / reach + 0.5) * (other - lines[i])
    return line


def ease(u: np.ndarray) -> np.ndarray:
    """From 0 to 1 with neither slope nor curvature at the ends: 10 u³ - 15 u⁴ + 6 u⁵."""
    u = np.clip(u, 0.0, 1.0)
    return u**3 * (10.0 - 15.0 * u + 6.0 * u**2)


def joined(pieces: list[np.ndarray]) -> np.ndarray:
    """One polyline; where a piece starts on the end of the one before, the point is kept once."""
    points = np.concatenate(pieces, axis=1)
    keep = np.ones(points.shape[1], dtype=bool)
    keep[1:] = np.hypot(*np.diff(points)) > 1e-3
    return points[:, keep]


# -- the smooth line ------------------------------------------------------------------------------------------------


def sampled(fine: np.ndarray) -> np.ndarray:
    """Points exactly one metre of arc apart, with heading and curvature of the fine curve."""
    s = curve.stations(fine)
    heading = np.unwrap(np.arctan2(np.gradient(fine[1]), np.gradient(fine[0])))
    curvature = np.gradient(heading, s)
    at = np.arange(0.0, np.floor(s[-1] / PATH_SPACING) + 1.0) * PATH_SPACING
    points = np.zeros((PATH_ROWS, len(at)))
    for row, values in ((PATH_X, fine[0]), (PATH_Y, fine[1]), (PATH_HEADING, heading), (PATH_CURVATURE, curvature)):
        points[row] = np.interp(at, s, values)
    return points


def limits(draft: Draft, count: int) -> np.ndarray:
    """What is allowed at every point [m/s]."""
    starts, speed = np.array(draft.limits).T
    at = np.arange(count) * PATH_SPACING
    return speed[np.clip(np.searchsorted(starts, at, side="right") - 1, 0, None)]


def speeds(curvature: np.ndarray, limit: np.ndarray, lateral_acceleration: float, deceleration: float) -> np.ndarray:
    """The speed for every point: the limit, what the bend allows, and what can be slowed down from in time [m/s]."""
    bend = np.sqrt(lateral_acceleration / np.maximum(np.abs(curvature), 1e-6))
    speed = np.maximum(np.minimum(limit, bend), LOWEST_SPEED)
    for i in range(len(speed) - 2, -1, -1):
        speed[i] = min(speed[i], np.sqrt(speed[i + 1] ** 2 + 2.0 * deceleration * PATH_SPACING))
    return speed


# -- on the path ----------------------------------------------------------------------------------------------------


@compiled
def interpolate(points, first, row, s):
    """The value of a row at arc length s [m] of the path that starts at column `first`; s is within the path."""
    i = int(s)
    f = s - i
    if f == 0.0:
        return points[row, first + i]
    return (1.0 - f) * points[row, first + i] + f * points[row, first + i + 1]


@compiled
def project(points, first, count, x, y, s_guess):
    """Arc length s [m] and lateral offset [m] (left positive) of a position, looked for within 5 m of `s_guess`."""
    middle = int(s_guess)
    low = max(0, min(middle - PROJECTION_REACH, count - 2))
    high = min(count - 2, max(middle + PROJECTION_REACH, 0))
    best, best_s, best_lateral = np.inf, 0.0, 0.0
    for i in range(low, high + 1):
        column = first + i
        a_x, a_y = points[PATH_X, column], points[PATH_Y, column]
        t_x, t_y = points[PATH_X, column + 1] - a_x, points[PATH_Y, column + 1] - a_y
        d_x, d_y = x - a_x, y - a_y
        squared = t_x * t_x + t_y * t_y
        u = min(1.0, max(0.0, (d_x * t_x + d_y * t_y) / squared))
        r_x, r_y = d_x - u * t_x, d_y - u * t_y
        distance = r_x * r_x + r_y * r_y
        if distance < best:
            best, best_s = distance, i + u
            best_lateral = np.copysign(np.sqrt(distance), t_x * d_y - t_y * d_x)
    return best_s * PATH_SPACING, best_lateral
