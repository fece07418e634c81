"""The body: six degrees of freedom, orientation as a unit quaternion.

    m dv/dt = sum F,    J dw/dt = sum M - w x (J w),    dq/dt = q (0, w)/2        (Massow & Radusch 2018, Eqs. 13 to 15)

The velocity is kept in the world's axes, where no centrifugal terms arise that an explicit step could turn into energy;
rates w = (p, q, r) and inertias belong to the body's axes, which are taken as principal axes.
Source: W. Schiehlen, P. Eberhard, Technische Dynamik, 5th edition 2017, chapters 2 and 3.
"""

from math import sqrt

from studio.compiled import inlined
from studio.conventions import GRAVITY

SCRAPING = 0.5  # [1] friction of a body that lies on the road


@inlined
def rotation(q_w, q_x, q_y, q_z):
    """The nine entries, row by row, of the matrix that turns the body's axes into the world's."""
    return (
        1.0 - 2.0 * (q_y * q_y + q_z * q_z), 2.0 * (q_x * q_y - q_w * q_z), 2.0 * (q_x * q_z + q_w * q_y),
        2.0 * (q_x * q_y + q_w * q_z), 1.0 - 2.0 * (q_x * q_x + q_z * q_z), 2.0 * (q_y * q_z - q_w * q_x),
        2.0 * (q_x * q_z - q_w * q_y), 2.0 * (q_y * q_z + q_w * q_x), 1.0 - 2.0 * (q_x * q_x + q_y * q_y),
    )  # fmt: skip


@inlined
def to_world(R, x, y, z):
    """A vector of the body's axes in the world's."""
    return R[0] * x + R[1] * y + R[2] * z, R[3] * x + R[4] * y + R[5] * z, R[6] * x + R[7] * y + R[8] * z


@inlined
def to_body(R, x, y, z):
    """A vector of the world's axes in the body's."""
    return R[0] * x + R[3] * y + R[6] * z, R[1] * x + R[4] * y + R[7] * z, R[2] * x + R[5] * y + R[8] * z


@inlined
def standing(g_x, g_y, c, s):
    """Orientation of a body that is level with a plane rising by g_x to the east and g_y to the north, c and s of half its heading."""
    n_z = 1.0 / sqrt(1.0 + g_x * g_x + g_y * g_y)
    half = 1.0 / sqrt(2.0 * (1.0 + n_z))
    a, b, d = (1.0 + n_z) * half, g_y * n_z * half, -g_x * n_z * half  # turns the vertical into the normal
    return a * c, b * c + d * s, d * c - b * s, a * s


@inlined
def cross(a_x, a_y, a_z, b_x, b_y, b_z):
    """a x b."""
    return a_y * b_z - a_z * b_y, a_z * b_x - a_x * b_z, a_x * b_y - a_y * b_x


@inlined
def turned(q_w, q_x, q_y, q_z, p, q, r, dt):
    """The orientation after dt [s] at the rates p, q, r [rad/s], of unit length again."""
    h = 0.5 * dt
    w = q_w + h * (-q_x * p - q_y * q - q_z * r)
    x = q_x + h * (q_w * p + q_y * r - q_z * q)
    y = q_y + h * (q_w * q + q_z * p - q_x * r)
    z = q_z + h * (q_w * r + q_x * q - q_y * p)
    scale = 1.0 / sqrt(w * w + x * x + y * y + z * z)
    return w * scale, x * scale, y * scale, z * scale


@inlined
def sliding_share(v_x, v_y, dt):
    """Share [1] of a velocity [m/s] that is left after dt of sliding on sheet metal."""
    return max(1.0 - dt * SCRAPING * GRAVITY / sqrt(v_x * v_x + v_y * v_y + 1e-12), 0.0)


@inlined
def angular_acceleration(M_x, M_y, M_z, p, q, r, J_x, J_y, J_z):
    """dp/dt, dq/dt, dr/dt [rad/s²] from the moments [Nm] about the centre of gravity (Euler's equations)."""
    return (
        (M_x - (J_z - J_y) * q * r) / J_x,
        (M_y - (J_x - J_z) * r * p) / J_y,
        (M_z - (J_y - J_x) * p * q) / J_z,
    )
