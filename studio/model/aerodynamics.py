"""Aerodynamics: drag along the body's x axis."""

from studio.compiled import inlined
from studio.conventions import AIR_DENSITY


@inlined
def air_drag(c_d, A, v_x):
    """F_air [N] against the motion (Massow & Radusch 2018, Eq. 12); c_d [1], A [m²], v_x [m/s]."""
    return 0.5 * AIR_DENSITY * c_d * A * v_x * abs(v_x)
