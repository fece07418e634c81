"""The line a vehicle drives: a lane path drawn as one smooth curve, with a point every metre.

Lanes are smooth curves, but not where a road begins in the middle of a junction, and not from one lane to the next. A path
follows them within `CORRIDOR`, blends lane changes over the length the road gives, and smooths the whole so that curvature
changes steadily.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from studio.compiled import inlined, lean
from studio.errors import RouteError
from studio.portable import arctan2
from studio.road import kept
from studio.road.network import Lane, Network, curve
from studio.road.ways import swing
from studio.road.ways.lane_path import LanePath

PATH_SPACING = 1.0  # [m]
PATH_X, PATH_Y, PATH_HEADING, PATH_CURVATURE, PATH_SPEED, PATH_HEIGHT, PATH_SLOPE = range(7)
PATH_ROWS = 7
GRAIN = 0.25  # [m] spacing of the curve while it is made
CORRIDOR = 0.15  # [m] how far smoothing may leave the lane
CHANGE_CORRIDOR = 0.8  # [m] in a lane change
WAVELENGTH = 12.0  # [m] shorter waves are corners where lanes meet
HEIGHT_WAVELENGTH = 60.0  # [m] the same of its height
CHANGE_LENGTH = 45.0  # [m] of road that one lane change takes, if the road is long enough
MARK_REACH = 10.0  # [m] how far smoothing may have moved a place along the path since the place before
ROOM = (0.3, 0.6)  # [m] how far a sharper bend may leave the centre line, from one attempt to the next; then one swings
ROOM_REACH = 10.0  # [m] before and behind the bend
GENTLER = (0.93, 0.87)  # [1] times the lock, for which a swing is made again where smoothing has sharpened it
NEARLY_SHARP = 0.9  # [1] times the lock: where one swings, one does so in bends as sharp as this
SWING_WAVELENGTH = 1.0  # [1] over the lock: shorter waves of a swing are where its arcs meet
HAND = 0.15  # [1/(m s)] how fast a car's curvature may change: wheels that turn by 0.4 rad/s, 2.7 m apart; a truck's as its lock is less
LOWEST_SPEED = 2.0  # [m/s] the sharpest bend is still driven
PROJECTION_REACH = 5  # [m] how far `project` looks from its guess
ROUNDED = 1.0 + 1e-9  # more than a sum of squares is wrong by


@dataclass(frozen=True)
class Station:
    """From arc length `s` [m] on the path runs on this lane of this road."""

    road: str
    lane_index: int
    s: float


@dataclass(frozen=True, eq=False)
class Path:
    """Points float64[PATH_ROWS, n], one per metre; stop lines as (arc length [m], link); stations in order.

    PATH_HEIGHT [m] is the road's, PATH_SLOPE [1] its rise per metre driven, measured level like every arc length.
    """

    points: np.ndarray
    stop_lines: tuple[tuple[float, int], ...]
    stations: tuple[Station, ...]

    @property
    def length(self) -> float:
        """Arc length from the first to the last point [m]."""
        return (self.points.shape[1] - 1) * PATH_SPACING


@dataclass(frozen=True, eq=False)
class Mark:
    """A place on the rough line, and its arc length there [m]."""

    place: np.ndarray
    s: float


@dataclass
class Draft:
    """The rough line while it is put together: pieces, their heights [m], where each starts, the room beside it [m], its limit [m/s]."""

    pieces: list[np.ndarray] = field(default_factory=list)
    heights: list[np.ndarray] = field(default_factory=list)
    starts: list[Mark] = field(default_factory=list)
    corridors: list[float] = field(default_factory=list)
    limits: list[float] = field(default_factory=list)
    stop_lines: list[tuple[Mark, int]] = field(default_factory=list)
    stations: list[tuple[Mark, Lane]] = field(default_factory=list)
    s: float = 0.0

    def add(self, piece: np.ndarray, height: np.ndarray, corridor: float, limit: float) -> None:
        """Goes on along `piece`."""
        self.starts.append(Mark(piece[:, 0], self.s))
        self.pieces.append(piece)
        self.heights.append(height)
        self.corridors.append(corridor)
        self.limits.append(limit)
        self.s += curve.length(piece)


def path(network: Network, lane_path: LanePath, *, lateral_acceleration=2.5, deceleration=1.5, lock=curve.LOCK) -> Path:
    """The driving line along a lane path; kept on disk.

    Args:
        network: the map.
        lane_path: from `studio.road.ways.route.connect`.
        lateral_acceleration: what PATH_SPEED allows in bends [m/s²].
        deceleration: what PATH_SPEED needs before slower places [m/s²].
        lock: the sharpest curve that the vehicle can drive [1/m]; where the lanes are sharper, it swings out.

    Raises:
        RouteError: the line is too short to be driven.
    """
    parts = lane_path, lateral_acceleration, deceleration, lock
    return kept.of_map(network.digest, "paths", Path, lambda: made(network, *parts), lane_path.lanes, *parts[1:], maker=__file__)


def made(network: Network, lane_path: LanePath, lateral_acceleration: float, deceleration: float, lock: float) -> Path:
    """The same, made anew."""
    draft = drafted(network, lane_path)
    points = sampled(*smooth(draft, lock))
    if points.shape[1] < 2:
        raise RouteError(f"{network.name}: the route is too short to be driven, less than {PATH_SPACING:g} m")
    limit = limits(draft, points)
    hand = HAND * min(lock / curve.LOCK, 1.0)
    points[PATH_SPEED] = speeds(points[PATH_CURVATURE], limit, lateral_acceleration, deceleration, hand)
    stops = located(points, [mark for mark, _ in draft.stop_lines])
    starts = located(points, [mark for mark, _ in draft.stations])
    return Path(
        points=points,
        stop_lines=tuple((s, link) for s, (_, link) in zip(stops, draft.stop_lines, strict=True)),
        stations=tuple(Station(lane.road, lane.index, s) for s, (_, lane) in zip(starts, draft.stations, strict=True)),
    )


# -- the rough line --------------------------------------------------------------------------------


def drafted(network: Network, lane_path: LanePath) -> Draft:
    """Lane by lane the centre lines, with lane changes blended in."""
    draft = Draft()
    link = {c.from_lane: c.link for c in network.connections}
    for used in stretches(network, lane_path):
        last = used[-1]
        if last.internal:
            draft.add(last.centre, last.height, CORRIDOR, last.speed)
            continue
        line, height = blended(used)
        for i, lane in enumerate(used):
            at = i * line.shape[1] // len(used)
            draft.stations.append((Mark(line[:, at], draft.s + curve.length(line[:, : at + 1])), lane))
        draft.add(line, height, CORRIDOR if len(used) == 1 else CHANGE_CORRIDOR, min(lane.speed for lane in used))
        if link.get(last.id, -1) >= 0:
            draft.stop_lines.append((Mark(line[:, -1], draft.s), link[last.id]))
    return draft


def stretches(network: Network, lane_path: LanePath) -> list[list[Lane]]:
    """The lanes of the path, those of one road together."""
    found = []
    for number in lane_path.lanes:
        lane = network.lanes[number]
        together = found and not lane.internal and found[-1][0].road == lane.road
        found[-1].append(lane) if together else found.append([lane])
    return found


def blended(used: list[Lane]) -> tuple[np.ndarray, np.ndarray]:
    """The line along a road from its first used lane to its last, lane changes one after another, and its height [m]."""
    lines = [curve.resampled(lane.centre, GRAIN) for lane in used]
    count = max(line.shape[1] for line in lines)
    total = sum(lane.length for lane in used) / len(used)
    fraction = np.linspace(0.0, 1.0, count)
    lines = [curve.along(lane.centre, fraction * curve.length(lane.centre)) for lane in used]
    heights = [np.interp(fraction * curve.length(lane.centre), curve.stations(lane.centre), lane.height) for lane in used]
    line, height = lines[0], heights[0]
    slot = 1.0 / max(1, len(used) - 1)
    for i, other in enumerate(lines[1:]):
        reach = min(slot, CHANGE_LENGTH / total)
        middle = (i + 0.5) * slot
        share = ease((fraction - middle) / reach + 0.5)
        line = line + share * (other - lines[i])
        height = height + share * (heights[i + 1] - heights[i])
    return line, height


def ease(u: np.ndarray) -> np.ndarray:
    """From 0 to 1 with neither slope nor curvature at the ends: 10 u³ - 15 u⁴ + 6 u⁵."""
    u = np.clip(u, 0.0, 1.0)
    return u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)


def joined(draft: Draft) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """One polyline of all pieces that never turns back, its height [m], and how far it may be left at each point [m].

    netconvert lets short ways through a junction run backwards where a signal stands close before it.
    """
    points = np.concatenate(draft.pieces, axis=1)
    corridor = np.repeat(draft.corridors, [piece.shape[1] for piece in draft.pieces])
    fresh = np.flatnonzero(np.append(1.0, np.hypot(*np.diff(points))) > 1e-3)
    kept = fresh[curve.forward(points[:, fresh])]
    return points[:, kept], np.concatenate(draft.heights)[kept], corridor[kept]


# -- the smooth line -------------------------------------------------------------------------------


def smooth(draft: Draft, lock: float = curve.LOCK) -> tuple[np.ndarray, np.ndarray]:
    """The fine curve of a draft, a point every `GRAIN` metres, and its height [m]; where it would be sharper than the lock [1/m], it gets
    a little room, and where that is not enough, it swings."""
    rough, height, corridor = joined(draft)
    own, fine = curve.stations(rough), curve.resampled(rough, GRAIN)
    s = np.linspace(0.0, own[-1], fine.shape[1])
    corridor, height = np.interp(s, own, corridor), np.interp(s, own, height)
    tight = line = curve.smoothed(fine, spacing=s[1], wavelength=WAVELENGTH, corridor=corridor)
    for room in ROOM:
        sharp = np.abs(curvature_of(line)) > lock
        if not sharp.any():
            return line, height
        corridor = np.where(curve.widened(sharp, round(ROOM_REACH / GRAIN)), np.maximum(corridor, room), corridor)
        line = curve.smoothed(fine, spacing=s[1], wavelength=WAVELENGTH, corridor=corridor)
    return (line, height) if is_within(line, lock) else swinging(tight, height, lock)


def swinging(line: np.ndarray, height: np.ndarray, lock: float) -> tuple[np.ndarray, np.ndarray]:
    """A fine curve with swings in its bends, and its height [m]; a little gentler where smoothing has sharpened them."""
    sharp = np.abs(curvature_of(line)) > NEARLY_SHARP * lock
    made = with_swings(line, height, sharp, lock)
    for gentler in GENTLER:
        if is_within(made[0], lock):
            break
        made = with_swings(line, height, sharp, gentler * lock)
    return made


def with_swings(line: np.ndarray, height: np.ndarray, sharp: np.ndarray, lock: float) -> tuple[np.ndarray, np.ndarray]:
    """The same with swings for a lock [1/m], smoothed where their arcs meet."""
    rough, at = swing.swung(line, heading_of(line), sharp, lock)
    own, fine = curve.stations(rough), curve.resampled(rough, GRAIN)
    s = np.linspace(0.0, own[-1], fine.shape[1])
    made = curve.smoothed(fine, spacing=s[1], wavelength=SWING_WAVELENGTH / lock, corridor=np.full(s.size, CORRIDOR))
    return made, np.interp(np.interp(s, own, at), np.arange(height.size), height)


def is_within(line: np.ndarray, lock: float) -> bool:
    """Whether a line is nowhere sharper than a lock [1/m]."""
    return bool(np.abs(curvature_of(line)).max() <= lock)


def without_kinks(height: np.ndarray) -> np.ndarray:
    """Heights [m] of points one metre apart, smoothed about the straight line between their ends; level ones stay as they are."""
    if not height.any():
        return height
    weight = np.ones(height.size)
    weight[[0, -1]] = 1e6
    straight = np.linspace(height[0], height[-1], height.size)
    stiffness = (HEIGHT_WAVELENGTH / (2.0 * np.pi * PATH_SPACING)) ** 6
    return straight + curve.whittaker((height - straight)[None], weight, stiffness)[0]


def curvature_of(line: np.ndarray) -> np.ndarray:
    """Curvature at every point [1/m]."""
    return np.gradient(heading_of(line), curve.stations(line))


def heading_of(line: np.ndarray) -> np.ndarray:
    """Direction at every point [rad], without jumps."""
    return np.unwrap(arctan2(np.gradient(line[1]), np.gradient(line[0])))


def sampled(fine: np.ndarray, height: np.ndarray) -> np.ndarray:
    """Points exactly one metre of arc apart, with heading, curvature and slope of the fine curve."""
    s, heading, curvature = curve.stations(fine), heading_of(fine), curvature_of(fine)
    at = np.arange(0.0, np.floor(s[-1] / PATH_SPACING + 1e-6) + 1.0) * PATH_SPACING
    points = np.zeros((PATH_ROWS, len(at)))
    for row, values in (
        (PATH_X, fine[0]),
        (PATH_Y, fine[1]),
        (PATH_HEADING, heading),
        (PATH_CURVATURE, curvature),
        (PATH_HEIGHT, height),
    ):
        points[row] = np.interp(at, s, values)
    points[PATH_HEIGHT] = without_kinks(points[PATH_HEIGHT])
    points[PATH_SLOPE] = np.gradient(points[PATH_HEIGHT], PATH_SPACING)
    return points


def located(points: np.ndarray, marks: list[Mark]) -> list[float]:
    """Arc lengths of marks on the finished path [m], in order: each is looked for where the one before leads."""
    found, shift = [], 0.0
    for mark in marks:
        guess = mark.s + shift
        low, high = np.clip([guess - MARK_REACH, guess + MARK_REACH], 0, points.shape[1] - 1).astype(int)
        near = low + np.hypot(*(points[:2, low : high + 1] - mark.place[:, None])).argmin()
        s, _ = project(points, 0, points.shape[1], mark.place[0], mark.place[1], float(near))
        found.append(max(float(s), found[-1] if found else 0.0))
        shift = found[-1] - mark.s
    return found


def limits(draft: Draft, points: np.ndarray) -> np.ndarray:
    """What is allowed at every point [m/s]."""
    starts = np.array(located(points, draft.starts))
    at = np.arange(points.shape[1]) * PATH_SPACING
    return np.array(draft.limits)[np.clip(np.searchsorted(starts, at, side="right") - 1, 0, None)]


def speeds(curvature: np.ndarray, limit: np.ndarray, lateral_acceleration: float, deceleration: float, hand: float) -> np.ndarray:
    """The speed for every point: the limit, what the bend and the turning of the wheels allow, and what can be slowed down from in
    time [m/s]."""
    bend = np.sqrt(lateral_acceleration / np.maximum(np.abs(curvature), 1e-6))
    turning = hand / np.maximum(np.abs(np.gradient(curvature, PATH_SPACING)), 1e-6)
    speed = np.maximum(np.minimum(np.minimum(limit, bend), turning), LOWEST_SPEED)
    for i in range(len(speed) - 2, -1, -1):
        speed[i] = min(speed[i], np.sqrt(speed[i + 1] ** 2 + 2.0 * deceleration * PATH_SPACING))
    return speed


# -- on the path -----------------------------------------------------------------------------------


@lean
def interpolate(points, first, row, s):
    """The value of a row at arc length s [m] of the path that starts at column `first`; s is within the path."""
    i = int(s)
    f = s - i
    if f == 0.0:
        return points[row, first + i]
    return (1.0 - f) * points[row, first + i] + f * points[row, first + i + 1]


@inlined
def to_piece(points, column, x, y):
    """The squared distance [m²] of a position from a piece of a path."""
    d_x, d_y = x - points[PATH_X, column], y - points[PATH_Y, column]
    t_x, t_y = points[PATH_X, column + 1] - points[PATH_X, column], points[PATH_Y, column + 1] - points[PATH_Y, column]
    along, squared = d_x * t_x + d_y * t_y, t_x * t_x + t_y * t_y
    u = 0.0 if along <= 0.0 else 1.0 if along >= squared else along / squared
    return (d_x - u * t_x) * (d_x - u * t_x) + (d_y - u * t_y) * (d_y - u * t_y)


@lean
def project(points, first, count, x, y, s_guess):
    """Arc length s [m] and lateral offset [m] (left positive) of a position, looked for within 5 m of `s_guess`.

    A piece from a to b cannot be the nearest where a is farther than the piece in the middle by more than its own length t. By the sign of
    (1 - t)² that is so where a's squared distance is above t² + (1 + t²) m + m², with the distance m of the one in the middle.
    """
    middle = int(s_guess)
    low = max(0, min(middle - PROJECTION_REACH, count - 2))
    high = min(count - 2, max(middle + PROJECTION_REACH, 0))
    best, best_s, side = np.inf, 0.0, 0.0
    most = to_piece(points, first + min(max(middle, low), high), x, y)
    m = np.sqrt(most)
    for i in range(low, high + 1):
        column = first + i
        a_x, a_y = points[PATH_X, column], points[PATH_Y, column]
        t_x, t_y = points[PATH_X, column + 1] - a_x, points[PATH_Y, column + 1] - a_y
        d_x, d_y = x - a_x, y - a_y
        squared = t_x * t_x + t_y * t_y
        if d_x * d_x + d_y * d_y > (squared + (1.0 + squared) * m + most) * ROUNDED:
            continue
        along = d_x * t_x + d_y * t_y
        u = 0.0 if along <= 0.0 else 1.0 if along >= squared else along / squared
        r_x, r_y = d_x - u * t_x, d_y - u * t_y
        distance = r_x * r_x + r_y * r_y
        if distance < best:
            best, best_s, side = distance, i + u, t_x * d_y - t_y * d_x
    return best_s * PATH_SPACING, np.copysign(np.sqrt(best), side)


def annotated(path: Path, speeds, joined: float) -> Path:
    """The path with the annotated speeds of its route, which it joins at a station; bends and limits still hold."""
    if not speeds:
        return path
    points = path.points.copy()
    stations = joined + np.arange(points.shape[1]) * PATH_SPACING
    wanted = np.full(points.shape[1], np.inf)
    for annotation in sorted(speeds, key=lambda each: each.at):
        wanted[stations >= annotation.at] = annotation.speed
    points[PATH_SPEED] = np.minimum(points[PATH_SPEED], wanted)
    return replace(path, points=points)
