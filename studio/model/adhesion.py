"""Adhesion: how much of what it can transmit a tyre does.

With the greatest forces along and across the wheel at its load, D_x and D_y (model/tyre.py):

    u = √((F_x/D_x)² + (F_y/D_y)²)

1 is the ellipse of what a tyre can transmit in combined slip (H. B. Pacejka, Tyre and Vehicle Dynamics, 2nd edition 2006, 1.2). The
magic formula's own combined forces stay near it, not exactly on it.
"""

from math import sqrt

from studio.compiled import compiled
from studio.model import tyre

SMALL = 1e-9  # [N] a wheel in the air transmits nothing of nothing


@compiled(forceinline=True)
def lateral_peak(t, F_z, mu):
    """Bound of |F_y0| [N]: D_y and |S_Vy|, camber left aside."""
    y = tyre.lateral_factors(t, 0.0, tyre.load_change(t, F_z), mu)
    return F_z * (abs(y.mu) + abs(y.S_V))


@compiled(forceinline=True)
def used(t, F_x, F_y, F_z, mu):
    """u [1] of forces and load [N], on a road with friction mu [1] relative to the tyre's test track."""
    x = F_x / (tyre.longitudinal_peak(t, F_z, mu) + SMALL)
    y = F_y / (lateral_peak(t, F_z, mu) + SMALL)
    return sqrt(x * x + y * y)
