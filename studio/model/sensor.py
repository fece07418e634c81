"""The own driving corridor, in which a radar with target selection looks for the car ahead.

The corridor is the arc that the own motion predicts, y = kappa x²/2 with kappa = r/v: a car on the next lane of a bend
is not the car ahead.
"""

from math import cos, sin

from studio.compiled import compiled

CORRIDOR = 1.7  # [m] half width: half a lane
V_CURVE = 2.0  # [m/s] below this the yaw rate says nothing about the path


@compiled
def seen_from(x, y, psi, x_other, y_other):
    """Position [m] of a point in the axes of an observer at x, y, psi: forward and left."""
    return turned(x_other - x, y_other - y, cos(psi), sin(psi))


@compiled
def turned(dx, dy, c, s):
    """A direction of the world in the axes of an observer whose heading has the cosine c and the sine s: forward and left."""
    return dx * c + dy * s, dy * c - dx * s


@compiled
def own_curvature(v, r):
    """Curvature [1/m] of the own path from speed [m/s] and yaw rate [rad/s]."""
    return r / v if v > V_CURVE else 0.0


@compiled
def in_corridor(forward, left, kappa):
    """Whether a point lies on the own predicted path."""
    return abs(left - 0.5 * kappa * forward * forward) < CORRIDOR
