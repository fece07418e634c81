"""The reference line of an OpenDRIVE road, and what varies along it (ASAM OpenDRIVE 1.8, chapters 8 and 9).

    Bend      line, arc and spiral are one: curvature changes linearly along the arc, k(s) = k_0 + (k_1 - k_0) s/L
    Cubic     poly3 and paramPoly3: u(p), v(p) in the axes of the element's start
    Profile   a piecewise cubic along s: widths, lane offset, elevation

A bend's heading is a quadratic of s; its position is the integral of the heading's cosine and sine, here by Gauss-Legendre
quadrature on pieces that turn so little that nothing but rounding is left. That holds for the spiral, whose closed form is
Fresnel's integrals, as for the line.
"""

from dataclasses import dataclass

import numpy as np

from studio.portable import arctan2

# Gauss-Legendre with five places: Abramowitz, Stegun, Handbook of Mathematical Functions, 1964, table 25.4.
OUTER, INNER = 0.906179845938663993, 0.538469310105683091
NODES = np.array([-OUTER, -INNER, 0.0, INNER, OUTER])
WEIGHTS = (0.236926885056189088, 0.478628670499366468, 0.568888888888888889, 0.478628670499366468, 0.236926885056189088)
MOST_TURN = 0.2  # [rad] of one piece: the quadrature's error is then below 1e-15 of its length
FINE = 0.05  # [m] between the points at which a poly3's arc length is known
SAGITTA = 0.001  # [m] a chord may leave its arc by that much
SHORTEST, LONGEST = 0.25, 5.0  # [m] of a chord


@dataclass(frozen=True)
class Bend:
    """Line, arc or spiral from x, y [m] and heading [rad]; curvature [1/m] at its start and end."""

    s: float  # [m] along the road
    x: float
    y: float
    heading: float
    length: float  # [m]
    start: float
    end: float

    def at(self, ds: np.ndarray) -> np.ndarray:
        """x, y [m] and heading [rad] at distances `ds` [m] from the start, which ascend; float64[3, n]."""
        ds = np.asarray(ds, dtype=float)
        pieces = int(np.ceil(self.length * self.sharpest / MOST_TURN)) + 1
        grid = np.union1d(ds, np.linspace(0.0, max(self.length, ds.max(initial=0.0)), pieces + 1))
        half, middle = 0.5 * np.diff(grid), 0.5 * (grid[1:] + grid[:-1])
        theta = self.turned(middle + np.multiply.outer(NODES, half))
        x = np.append(0.0, np.cumsum(half * weighted(np.cos(theta))))
        y = np.append(0.0, np.cumsum(half * weighted(np.sin(theta))))
        here = np.searchsorted(grid, ds)
        return np.array([self.x + x[here], self.y + y[here], self.turned(ds)])

    def turned(self, ds: np.ndarray) -> np.ndarray:
        """Heading [rad]: h + k_0 s + (k_1 - k_0) s²/(2 L)."""
        return self.heading + ds * (self.start + 0.5 * (self.end - self.start) * ds / self.length)

    @property
    def sharpest(self) -> float:
        """The greatest curvature [1/m], without its sign."""
        return max(abs(self.start), abs(self.end))


@dataclass(frozen=True)
class Cubic:
    """u(p) and v(p), coefficients a, b, c, d, from x, y [m] and heading [rad]; p = `rate` · s, or, of a poly3, p = u(s)."""

    s: float  # [m] along the road
    x: float
    y: float
    heading: float
    length: float  # [m]
    u: tuple[float, float, float, float]
    v: tuple[float, float, float, float]
    rate: float = 1.0
    by_arc: bool = False  # a poly3: p is not the distance, but the abscissa that lies at it

    def at(self, ds: np.ndarray) -> np.ndarray:
        """x, y [m] and heading [rad] at distances `ds` [m] from the start; float64[3, n]."""
        p = self.parameter(np.asarray(ds, dtype=float))
        u, v = cubic(self.u, p), cubic(self.v, p)
        c, s = np.cos(self.heading), np.sin(self.heading)
        heading = self.heading + np.unwrap(arctan2(slope(self.v, p), slope(self.u, p)))
        return np.array([self.x + u * c - v * s, self.y + u * s + v * c, heading])

    def parameter(self, ds: np.ndarray) -> np.ndarray:
        """p at distances [m]; of a poly3 the abscissa up to which its arc is that long."""
        if not self.by_arc:
            return self.rate * ds
        grid = np.linspace(0.0, self.length, max(2, int(self.length / FINE) + 1))
        half, middle = 0.5 * np.diff(grid), 0.5 * (grid[1:] + grid[:-1])
        speed = np.hypot(1.0, slope(self.v, middle + np.multiply.outer(NODES, half)))
        arc = np.append(0.0, np.cumsum(half * weighted(speed)))
        p = np.interp(ds, arc, grid)
        return p + (ds - np.interp(p, grid, arc)) / np.hypot(1.0, slope(self.v, p))

    @property
    def sharpest(self) -> float:
        """The greatest curvature [1/m], without its sign."""
        p = self.parameter(np.linspace(0.0, self.length, 64))
        du, dv, ddu, ddv = slope(self.u, p), slope(self.v, p), bow(self.u, p), bow(self.v, p)
        speed = np.maximum(np.hypot(du, dv), 1e-6)
        return float(np.max(np.abs(du * ddv - dv * ddu) / (speed * speed * speed)))


def weighted(values: np.ndarray) -> np.ndarray:
    """Mean over the places of Gauss, float64[place, n]; their sum is written out, since BLAS sums in another order elsewhere."""
    return sum((weight * value for weight, value in zip(WEIGHTS, values, strict=True)), start=np.zeros(values.shape[1:]))


def cubic(k, p):
    """a + b p + c p² + d p³."""
    return k[0] + p * (k[1] + p * (k[2] + p * k[3]))


def slope(k, p):
    """Its derivative."""
    return k[1] + p * (2.0 * k[2] + p * 3.0 * k[3])


def bow(k, p):
    """Its second derivative."""
    return 2.0 * k[2] + 6.0 * k[3] * p


@dataclass(frozen=True, eq=False)
class Profile:
    """Piecewise cubic: from `starts` [m] on holds the column of `k`, float64[4, n], in the distance from there; 0 before."""

    starts: np.ndarray
    k: np.ndarray

    def at(self, s: np.ndarray) -> np.ndarray:
        """Values at s [m]."""
        s = np.asarray(s, dtype=float)
        if not self.starts.size:
            return np.zeros_like(s)
        i = np.searchsorted(self.starts, s + 1e-9, side="right") - 1
        return np.where(i < 0, 0.0, cubic(self.k[:, i], s - self.starts[i]))

    def __bool__(self) -> bool:
        return bool(self.k.any())


NOTHING = Profile(np.zeros(0), np.zeros((4, 0)))


@dataclass(frozen=True)
class ReferenceLine:
    """The elements of a plan view, in order."""

    elements: tuple[Bend | Cubic, ...]

    @property
    def length(self) -> float:
        """Where the last element ends [m]."""
        return self.elements[-1].s + self.elements[-1].length

    def at(self, s: np.ndarray) -> np.ndarray:
        """x, y [m] and heading [rad] at stations s [m], which ascend; float64[3, n]. Where two elements meet, the next one counts."""
        s = np.asarray(s, dtype=float)
        of = np.maximum(np.searchsorted([each.s for each in self.elements], s + 1e-9, side="right") - 1, 0)
        return np.concatenate([each.at(s[of == i] - each.s) for i, each in enumerate(self.elements) if (of == i).any()], axis=1)

    def stations(self, length: float) -> np.ndarray:
        """Stations [m] so close that chords leave the line by no more than `SAGITTA`."""
        found = [np.array([0.0, length])]
        for each in self.elements:
            chord = np.clip(np.sqrt(8.0 * SAGITTA / max(each.sharpest, 1e-9)), SHORTEST, LONGEST)
            found.append(np.linspace(each.s, each.s + each.length, max(2, int(np.ceil(each.length / chord)) + 1)))
        s = np.unique(np.concatenate(found))
        return s[s <= length]

    def gaps(self) -> list[tuple[float, float, float]]:
        """Where elements meet: station [m], distance [m] and change of heading [rad] from one's end to the next one's start."""
        found = []
        for a, b in zip(self.elements, self.elements[1:], strict=False):
            x, y, heading = a.at(np.array([0.0, b.s - a.s]))[:, -1]
            turn = (b.heading - heading + np.pi) % (2.0 * np.pi) - np.pi
            if isinstance(b, Cubic):
                turn = (b.at(np.zeros(1))[2, 0] - heading + np.pi) % (2.0 * np.pi) - np.pi
            found.append((b.s, float(np.hypot(b.x - x, b.y - y)), float(abs(turn))))
        return found
