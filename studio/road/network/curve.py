"""Polylines in the plane, float64[2, n]: length, points along them, smoothing."""

import numpy as np

from studio.road.network.band import solve

BESIDE = 0.5  # [m]
LOCK = 0.19  # [1/m] the sharpest curve that a car can drive, with the wheels at full lock


def stations(points: np.ndarray) -> np.ndarray:
    """Arc length at every point [m]."""
    found = np.zeros(points.shape[1])
    steps(points).cumsum(out=found[1:])
    return found


def length(points: np.ndarray) -> float:
    """Length of the polyline [m]."""
    return float(steps(points).sum())


def steps(points: np.ndarray) -> np.ndarray:
    """Distance from every point to the next [m]; np.diff takes longer than the work."""
    x, y = points
    return np.hypot(x[1:] - x[:-1], y[1:] - y[:-1])


def along(points: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Points at the arc lengths `s` [m]."""
    own = stations(points)
    return np.array([np.interp(s, own, points[0]), np.interp(s, own, points[1])])


def resampled(points: np.ndarray, spacing: float) -> np.ndarray:
    """The polyline with points at equal distances of about `spacing` [m], both ends kept."""
    total = length(points)
    count = max(2, round(total / spacing) + 1)
    return along(points, np.linspace(0.0, total, count))


def distances(points: np.ndarray, line: np.ndarray) -> np.ndarray:
    """Distance of each point from the polyline [m]."""
    start, step = line[:, :-1], np.diff(line)
    squared = np.maximum((step**2).sum(axis=0), 1e-18)
    apart = points[:, :, None] - start[:, None, :]
    fraction = np.clip((apart * step[:, None, :]).sum(axis=0) / squared, 0.0, 1.0)
    return np.hypot(*(apart - fraction * step[:, None, :])).min(axis=1)


def forward(points: np.ndarray) -> list[int]:
    """Indices of the points that are left when the polyline no longer doubles back on itself."""
    kept: list[int] = []
    for i, point in enumerate(points.T):
        while len(kept) > 1 and doubles_back(points[:, kept[-2]], points[:, kept[-1]], point):
            kept.pop()
        kept.append(i)
    return kept


def doubles_back(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> bool:
    """Whether c lies back beside the line from a to b; a turning loop, which leads away from it, does not count."""
    (t_x, t_y), (d_x, d_y) = b - a, c - b
    return t_x * d_x + t_y * d_y < 0.0 and abs(t_x * d_y - t_y * d_x) < BESIDE * np.hypot(t_x, t_y)


def curvature(points: np.ndarray) -> np.ndarray:
    """How sharply a curve bends at every point, without sign [1/m]; also of many, float64[..., 2, n]."""
    first = gradient(points)
    second = gradient(first)
    (x, y), (a, b) = np.moveaxis(first, -2, 0), np.moveaxis(second, -2, 0)
    speed = np.hypot(x, y)
    return np.abs(x * b - y * a) / np.maximum(1e-9, speed * speed * speed)


def gradient(values: np.ndarray) -> np.ndarray:
    """The change per step along the last axis, as np.gradient has it, which takes longer for what is as short as lanes are."""
    found = np.empty_like(values)
    np.subtract(values[..., 2:], values[..., :-2], out=found[..., 1:-1])
    found[..., 1:-1] *= 0.5
    np.subtract(values[..., 1], values[..., 0], out=found[..., 0])
    np.subtract(values[..., -1], values[..., -2], out=found[..., -1])
    return found


def smoothed(points: np.ndarray, *, spacing: float, wavelength: float, corridor: np.ndarray) -> np.ndarray:
    """The curve with least change of curvature near evenly spaced points (Whittaker 1923, third differences).

    Waves shorter than `wavelength` [m] are flattened. Where the curve would leave a point by more than its `corridor`
    [m], it is drawn to it harder, until it stays.
    """
    stiffness = (wavelength / (2.0 * np.pi * spacing)) ** 6
    weight = (corridor.min() / corridor) ** 2
    weight[[0, -1]] = 1e6
    for _ in range(40):
        curve = whittaker(points, weight, stiffness)
        excess = np.hypot(*(curve - points)) / corridor
        if excess.max() <= 1.0:
            break
        weight *= np.where(widened(excess, round(wavelength / 4.0 / spacing)) > 0.95, 2.0, 1.0)
    return curve


def widened(values: np.ndarray, reach: int) -> np.ndarray:
    """The largest of the values within `reach` places on either side."""
    padded = np.pad(values, reach, mode="edge")
    return np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1).max(axis=1)


def whittaker(points: np.ndarray, weight: np.ndarray, stiffness: float) -> np.ndarray:
    """Minimises sum w |p - q|² + stiffness sum |third difference of p|²."""
    n = points.shape[1]
    if n < 5:
        return points
    band = np.zeros((4, n))  # upper form: band[3] is the diagonal
    third = np.array([-1.0, 3.0, -3.0, 1.0])
    for a in range(4):
        for b in range(a, 4):
            band[3 - (b - a), b : n - 3 + b] += stiffness * third[a] * third[b]
    band[3] += weight
    return solve(band, weight * points)
