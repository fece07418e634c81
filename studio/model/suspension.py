"""Suspension and vertical tyre, wheel by wheel; x is the travel from the static position, compression positive.

    F_s = F_0 + k x + d dx/dt + k_a (x - x_other)         spring, damper, anti-roll bar (Massow & Radusch 2018, Eq. 4)
    F_z = F_z0 + k_t (R - d_road) - d_t ddist/dt, >= 0    tyre: a wheel may leave the ground
    m_u (d²x/dt² + a_body) = F_z - F_s - F_link           the wheel along the body's z axis

A lateral force reaches the body along the links, through the roll centre at height h_rc: seen from the wheel they push
it down or up by F_link = -side F_y 2 h_l/T. The wheels' own inertia acts at their centres and never goes through the
springs; both add up to the lever h_l = (m_s h_rc + m_u R)/m of an axle.
Source: M. Mitschke, H. Wallentowitz, Dynamik der Kraftfahrzeuge, 5th edition 2014, chapters 23 and 24.
"""

from studio.compiled import inlined


@inlined
def spring_force(F_0, k, d, k_a, x, x_rate, x_other):
    """F_s [N] of spring, damper and anti-roll bar on the body, upwards."""
    return F_0 + k * x + d * x_rate + k_a * (x - x_other)


@inlined
def link_force(side, F_y, ratio):
    """F_link [N] on the body, upwards; side 1 left, -1 right; ratio = 2 h_l/T [1]."""
    return -side * F_y * ratio


@inlined
def tyre_load(F_z0, k_t, d_t, R, distance, distance_rate):
    """F_z [N] of a tyre whose wheel centre is `distance` [m] from the road; it cannot be compressed beyond its radius."""
    return max(F_z0 + k_t * min(R - distance, R) - d_t * distance_rate, 0.0)


@inlined
def travel_rate(x_rate, force, a_body, m_u, damping, dt):
    """dx/dt [m/s] after dt under the force [N] on the wheel; implicit in the damping [N s/m] of spring and tyre."""
    return x_rate + dt * (force / m_u - a_body) / (1.0 + dt * damping / m_u)
