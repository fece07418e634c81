"""Procedural cars: a body lofted from sections, wheels turned on a lathe, and the soft shadow below.

Everything is made from Dimensions; there are no asset files. The origin lies on the road below the vehicle's
reference point, x forward, y left, z up (ISO 8855).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from studio.scene.shape import Surface, ball, box, fan, grid, joined, lathe, surface


@dataclass(frozen=True)
class Dimensions:
    """Outer dimensions of a car [m]; front_axle: how far the front axle is from the reference point."""

    length: float = 4.30
    width: float = 1.80
    height: float = 1.45
    wheelbase: float = 2.63
    track: float = 1.54
    wheel_radius: float = 0.316
    wheel_width: float = 0.215
    front_axle: float = 1.315

    @property
    def centre(self) -> float:
        """x of the middle of the body [m]; cars reach a little less far before the axles than behind."""
        overhang = self.length - self.wheelbase
        return self.front_axle + 0.49 * overhang - self.length / 2.0

    @property
    def axles(self) -> tuple[float, float]:
        """x of the front and of the rear axle [m]."""
        return self.front_axle, self.front_axle - self.wheelbase


@dataclass(frozen=True, eq=False)
class Outline:
    """A smooth line through points, without swinging beyond them: values at places `at`, which rise."""

    at: list[float]
    values: list[float]

    @cached_property
    def line(self):
        """What interpolates; its import takes a second, and a server without a scene does not need it."""
        from scipy.interpolate import PchipInterpolator

        return PchipInterpolator(self.at, self.values)

    def __call__(self, at) -> np.ndarray:
        """Values at places."""
        return self.line(at)


# what a quad of the body is made of
PAINT, TRIM, GLASS, HEADLIGHT, TAILLIGHT, GRILLE, PLATE = range(7)
GLASS_COLOUR = "#1a232c"
PARTS = ["", "#15171a", GLASS_COLOUR, "#eef3f6", "#c8101a", "#0c0d0f", "#e8e8e2"]
TYRE, RIM, GAP = range(3)
WHEEL_COLOURS = ["#17181a", "#b9bec4", "#2a2c2f"]

# The outline of the reference car (1.45 m high, 1.80 m wide) over the share of its length from the rear.
# Drawn by eye to look like a compact hatchback: height of the deck (boot, sill of the windows, bonnet) [m],
# height of the underside [m], and half width as a share of half the width.
DECK = Outline(
    [0.0, 0.008, 0.03, 0.08, 0.30, 0.70, 0.78, 0.90, 0.955, 0.985, 1.0],
    [0.62, 0.80, 0.915, 0.955, 0.955, 0.950, 0.925, 0.835, 0.760, 0.660, 0.56],
)
UNDERSIDE = Outline([0.0, 0.012, 0.04, 0.12, 0.88, 0.955, 0.985, 1.0], [0.42, 0.31, 0.25, 0.20, 0.20, 0.21, 0.24, 0.33])
HALF_WIDTH = Outline(
    [0.0, 0.008, 0.03, 0.08, 0.20, 0.50, 0.80, 0.90, 0.955, 0.985, 1.0],
    [0.74, 0.84, 0.91, 0.955, 0.99, 1.0, 0.985, 0.945, 0.865, 0.75, 0.62],
)
# The flank bulges: half width as a share of its largest over the height [m].
FLANK = Outline([0.19, 0.26, 0.36, 0.52, 0.62, 0.75, 0.88, 0.97], [0.935, 0.965, 0.985, 1.0, 0.998, 0.982, 0.955, 0.90])
# Height of the roof line [m] from the foot of the rear window to that of the windscreen.
ROOF = Outline(
    [0.055, 0.09, 0.16, 0.22, 0.33, 0.45, 0.53, 0.575, 0.66, 0.745],
    [0.95, 1.13, 1.33, 1.405, 1.44, 1.45, 1.43, 1.395, 1.18, 0.94],
)
CABIN_WIDTH = Outline([0.055, 0.16, 0.35, 0.6, 0.745], [0.80, 0.90, 0.935, 0.925, 0.82])
TUMBLEHOME = 0.42

# where the sections of the hull are: share of the length, and around a wheel arch the share of its radius
TAIL = np.array([0.0, 0.003, 0.008, 0.016, 0.03, 0.05, 0.08, 0.12])
NOSE = np.array([0.9, 0.93, 0.945, 0.958, 0.97, 0.979, 0.987, 0.993, 0.997, 1.0])
STATIONS = np.concatenate([TAIL, np.array([0.3, 0.4, 0.5, 0.6, 0.7, 0.745, 0.78]), NOSE])
REACH = np.array([0.0, 0.2, 0.4, 0.6, 0.78, 0.9, 0.97, 1.0, 1.004])
REAR_WINDOW = np.array([0.055, 0.07, 0.085, 0.12, 0.155, 0.175])
SIDES = np.array([0.20, 0.235, 0.28, 0.34, 0.405, 0.42, 0.48, 0.53, 0.56])
WINDSCREEN = np.array([0.58, 0.62, 0.66, 0.70, 0.725, 0.735, 0.745])
CABIN_STATIONS = np.concatenate([REAR_WINDOW, SIDES, WINDSCREEN])
LEVELS = np.array([0.0, 0.14, 0.34, 0.54, 0.70, 0.86, 1.0])
REFERENCE_HEIGHT = 1.45


@dataclass(frozen=True, eq=False)
class Detail:
    """How much of a car is there: where its sections are, and which points of half a section."""

    hull: np.ndarray
    reach: np.ndarray  # around a wheel arch
    hull_points: tuple[int, ...]
    cabin: np.ndarray
    cabin_points: tuple[int, ...]
    has_fittings: bool


FINE = Detail(STATIONS, REACH, tuple(range(15)), CABIN_STATIONS, tuple(range(9)), True)
# From afar: the same outlines through fewer points, which keep the borders between paint, glass and lamps.
MIDDLING = Detail(
    hull=np.array([0.0, 0.03, 0.12, 0.4, 0.6, 0.78, 0.945, 0.987, 1.0]),
    reach=np.array([0.0, 0.7, 1.004]),
    hull_points=(0, 2, 4, 7, 9, 11, 14),
    cabin=np.array([0.055, 0.07, 0.155, 0.20, 0.405, 0.42, 0.58, 0.62, 0.735, 0.745]),
    cabin_points=(0, 2, 3, 5, 8),
    has_fittings=True,
)
COARSE = Detail(
    hull=np.array([0.0, 0.03, 0.12, 0.5, 0.945, 0.987, 1.0]),
    reach=np.array([]),
    hull_points=(0, 4, 7, 9, 14),
    cabin=np.array([0.055, 0.155, 0.405, 0.58, 0.745]),
    cabin_points=(0, 2, 3, 5, 8),
    has_fittings=False,
)


def body(size: Dimensions, colour: str, detail: Detail = FINE) -> Surface:
    """The whole car without its wheels, painted `colour`."""
    palette = [colour, *PARTS[1:]]
    fittings = _fittings(size, palette) if detail.has_fittings else []
    return joined([hull(size, palette, detail), cabin(size, palette, detail), *fittings]).moved(x=size.centre)


def hull(size: Dimensions, palette: list[str], detail: Detail = FINE) -> Surface:
    """The lower body up to the window line: a closed body with tunnels for the wheels."""
    stations = _hull_stations(size, detail)
    rings = np.stack([_hull_ring(size, s) for s in stations])
    rings, kinds = _thinned(rings, _hull_kinds(stations, rings.shape[1]), detail.hull_points)
    return joined([grid(rings, kinds, palette), *_lids(rings, palette)])


def _thinned(rings: np.ndarray, kinds: np.ndarray, points: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Rings with some points of their left halves and the same of their right ones; a span is what its outermost part was."""
    last = rings.shape[1] - 1
    kept, left = np.array([*points, *(last - each for each in points[-2::-1])]), np.array(points[:-1])
    return rings[:, kept], kinds[:, np.concatenate([left, last - 1 - left[::-1]])]


def _lids(rings: np.ndarray, palette: list[str]) -> list[Surface]:
    # a ring closes by repeating its first point; seen from the front it runs counter-clockwise
    return [fan(rings[0, :-1][::-1], palette[PAINT]), fan(rings[-1, :-1], palette[PAINT])]


def _share(size: Dimensions, x: float) -> float:
    return (x - size.centre) / size.length + 0.5


def _hull_stations(size: Dimensions, detail: Detail) -> np.ndarray:
    reach = detail.reach * _arch(size) / size.length
    arches = [_share(size, axle) + side * reach for axle in size.axles for side in (-1.0, 1.0)]
    stations = np.unique(np.round(np.concatenate([detail.hull, *arches]), 5))
    return stations[(stations >= 0.0) & (stations <= 1.0)]


def _arch(size: Dimensions) -> float:
    return size.wheel_radius * 1.16


def _underside(size: Dimensions, s: float) -> float:
    scale = size.height / REFERENCE_HEIGHT
    low = float(UNDERSIDE(s)) * scale
    x = (s - 0.5) * size.length + size.centre
    for axle in size.axles:
        reach = abs(x - axle) / _arch(size)
        if reach <= 1.0005:
            low = max(low, size.wheel_radius + _arch(size) * np.sqrt(max(0.0, 1.0 - reach**2)))
    return low


def _hull_ring(size: Dimensions, s: float) -> np.ndarray:
    scale = size.height / REFERENCE_HEIGHT
    low, deck = _underside(size, s), float(DECK(s)) * scale
    half = float(HALF_WIDTH(s)) * size.width / 2.0
    rounding = min(0.055, 0.3 * (deck - low))
    z = low + LEVELS * (deck - rounding - low)
    y = half * FLANK(z / scale)
    edge = y[-1]
    top = np.array([[0.985, 0.45], [0.95, 0.80], [0.88, 1.0], [0.60, 1.25], [0.0, 1.55]])
    side = np.concatenate(
        [
            [[0.0, low], [0.5 * y[0], low], [0.94 * y[0], low]],
            np.stack([y, z], 1),
            np.stack([edge * top[:, 0], deck + rounding * (top[:, 1] - 1.0)], 1),
        ]
    )
    return _mirrored_ring((s - 0.5) * size.length, side)


def _mirrored_ring(x: float, side: np.ndarray) -> np.ndarray:
    """A closed ring from the left half of a section (y, z): up on the left, down on the right."""
    right = side[-2:0:-1] * [-1.0, 1.0]
    section = np.concatenate([side, right, side[:1]])
    return np.column_stack([np.full(len(section), x), section])


# segments of half a ring of the hull, from the bottom: 0..2 underside, 3..8 flank, 9..13 shoulder and deck
FLANK_FROM, FLANK_TO = 3, 8


def _hull_kinds(stations: np.ndarray, columns: int) -> np.ndarray:
    segments = columns - 1
    half = segments // 2
    middle = (stations[:-1] + stations[1:]) / 2.0
    kinds = np.full((len(middle), half), PAINT)
    kinds[:, :FLANK_FROM] = TRIM
    kinds[:, FLANK_FROM] = TRIM
    tail, ends = middle < 0.03, np.array([FLANK_TO - 1, FLANK_TO])
    kinds[np.ix_((middle > 0.945) & (middle < 0.987), ends)] = HEADLIGHT
    kinds[np.ix_(tail, ends)] = TAILLIGHT
    return np.concatenate([kinds, kinds[:, ::-1]], axis=1)


def cabin(size: Dimensions, palette: list[str], detail: Detail = FINE) -> Surface:
    """The part above the window line: windows in glass, pillars and roof in paint."""
    rings = np.stack([_cabin_ring(size, s) for s in detail.cabin])
    rings, kinds = _thinned(rings, _cabin_kinds(detail.cabin, rings.shape[1]), detail.cabin_points)
    return joined([grid(rings, kinds, palette), *_lids(rings, palette)])


def _cabin_ring(size: Dimensions, s: float) -> np.ndarray:
    scale = size.height / REFERENCE_HEIGHT
    sill, roof = 0.90 * scale, float(ROOF(s)) * scale
    base = float(CABIN_WIDTH(s)) * size.width / 2.0
    rise = roof - sill
    bow = min(0.05, 0.35 * rise)
    levels = sill + np.array([0.0, 0.14, 0.80]) * rise
    edge = base - TUMBLEHOME * rise
    wall = np.stack([base - TUMBLEHOME * (levels - sill), levels], 1)
    top = np.array(
        [
            [edge + 0.012 * min(1.0, 4.0 * rise), roof - 0.75 * bow],
            [edge - 0.03, roof - 0.30 * bow],
            [edge - 0.10, roof],
            [0.55 * edge, roof + 0.4 * bow],
            [0.0, roof + 0.6 * bow],
        ]
    )
    return _mirrored_ring((s - 0.5) * size.length, np.concatenate([[[0.0, sill - 0.02]], wall, top]))


def _cabin_kinds(stations: np.ndarray, columns: int) -> np.ndarray:
    middle = (stations[:-1] + stations[1:]) / 2.0
    kinds = np.full((len(middle), (columns - 1) // 2), PAINT)
    side = ((middle > 0.20) & (middle < 0.405)) | ((middle > 0.42) & (middle < 0.62))
    kinds[side, 2] = GLASS
    ends = ((middle > 0.07) & (middle < 0.155)) | ((middle > 0.58) & (middle < 0.735))
    kinds[ends, 5:] = GLASS
    return np.concatenate([kinds, kinds[:, ::-1]], axis=1)


def _fittings(size: Dimensions, palette: list[str]) -> list[Surface]:
    """Mirrors, rear lamps, number plates, and the dark openings at the front and the rear."""
    x = 0.16 * size.length
    mirror = ball((0.07, 0.10, 0.065), palette[PAINT]).moved(x=x, y=0.5 * size.width + 0.015, z=0.68 * size.height)
    lamp = box((0.03, 0.30, 0.10), palette[TAILLIGHT]).moved(x=-0.494 * size.length, y=0.29 * size.width, z=0.47 * size.height)
    plate = box((0.02, 0.52, 0.11), palette[PLATE])
    front, rear = 0.5 * size.length + 0.002, -0.5 * size.length - 0.004
    return [
        mirror,
        mirror.mirrored(),
        lamp,
        lamp.mirrored(),
        plate.moved(x=front + 0.008, z=0.325 * size.height),
        box((0.02, 0.98, 0.075), palette[GRILLE]).moved(x=front - 0.004, z=0.258 * size.height),
        box((0.02, 0.80, 0.035), palette[GRILLE]).moved(x=front - 0.004, z=0.376 * size.height),
        plate.moved(x=rear, z=0.375 * size.height),
        box((0.02, 1.10, 0.07), palette[GRILLE]).moved(x=rear + 0.004, z=0.305 * size.height),
    ]


def wheel(size: Dimensions) -> Surface:
    """A wheel about its own centre, axle along y: a tyre with round shoulders, five spokes on both sides."""
    r, b = size.wheel_radius, size.wheel_width / 2.0
    half = [
        (0.0, 0.72 * b),
        (0.16 * r, 0.74 * b),
        (0.20 * r, 0.62 * b),
        (0.60 * r, 0.80 * b),
        (0.64 * r, 0.92 * b),
        (0.70 * r, 0.97 * b),
        (0.86 * r, b),
        (0.96 * r, 0.90 * b),
        (r, 0.66 * b),
    ]
    profile = np.array(half + [(radius, -y) for radius, y in half[::-1]])
    rows = np.array([RIM, RIM, GAP, RIM, TYRE, TYRE, TYRE, TYRE])
    kinds = np.tile(np.concatenate([rows, [TYRE], rows[::-1]]), (40, 1))
    # five spokes, each three of eight segments wide
    spokes = np.arange(40) % 8 < 3
    kinds[np.ix_(spokes, np.array([2, len(profile) - 4]))] = RIM
    return lathe(profile, kinds, WHEEL_COLOURS)


def plain_wheel(size: Dimensions, *, segments: int) -> Surface:
    """A wheel as it looks from afar: a tyre around a disc, with so many corners."""
    r, b = size.wheel_radius, size.wheel_width / 2.0
    half = [(0.0, 0.72 * b), (0.64 * r, b), (r, 0.66 * b)]
    kinds = np.tile([RIM, TYRE, TYRE, TYRE, RIM], (segments, 1))
    return lathe(np.array(half + [(radius, -y) for radius, y in half[::-1]]), kinds, WHEEL_COLOURS)


SOFT = ((-0.28, 1.0), (-0.10, 0.85), (0.08, 0.35), (0.28, 0.0))  # [m] beyond the outline, and how dark it is there
SIMPLE = ((-0.10, 0.9), (0.28, 0.0))  # from afar


def shadow(size: Dimensions, *, darkness: float = 0.55, edge: tuple = SOFT, corners: int = 48) -> Surface:
    """A soft dark patch in the plane z = 0, dark below the car and fading out around it."""
    rings = [(grow, share * darkness) for grow, share in edge]
    angle = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    outline = [_rounded(size, angle, grow) for grow, _ in rings]
    vertices = np.concatenate([*outline, [[0.0, 0.0, 0.0]]])
    opacity = np.repeat([*(dark for _, dark in rings), darkness], [*(len(angle) for _ in rings), 1])
    colors = np.column_stack([np.zeros((len(vertices), 3)), opacity])
    return surface(vertices, _rings_faces(len(rings), len(angle)), colors).moved(x=size.centre)


def _rounded(size: Dimensions, angle: np.ndarray, grow: float) -> np.ndarray:
    # a superellipse of order 5 is a rectangle with round corners
    c, s = np.cos(angle), np.sin(angle)
    x = np.sign(c) * np.abs(c) ** 0.4 * (size.length / 2.0 + grow)
    y = np.sign(s) * np.abs(s) ** 0.4 * (size.width / 2.0 + grow)
    return np.column_stack([x, y, np.zeros(len(angle))])


def _rings_faces(rings: int, count: int) -> np.ndarray:
    here = np.arange(count)
    after = (here + 1) % count
    faces = [np.stack([np.full(count, rings * count), here, after], 1)]
    for ring in range(rings - 1):
        inner, outer = ring * count, (ring + 1) * count
        faces.append(np.stack([inner + here, outer + here, outer + after], 1))
        faces.append(np.stack([inner + here, outer + after, inner + after], 1))
    return np.concatenate(faces)
