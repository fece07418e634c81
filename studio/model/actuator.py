"""Actuators: what a request becomes, after dead time, lag and limits.

    tau dT/dt = T_request(t - t_d) - T        (Massow & Radusch 2018, Eqs. 3 and 11)

The interface that drivers and most applications use is a requested acceleration, as production cars offer it to their own
ACC. It is turned into a force by inverting the resistances: F = m_eff u + F_air + F_roll, m_eff = m + sum J/R².
"""

from studio.compiled import inlined


@inlined
def lag(value, request, tau, dt):
    """First-order lag, exact for any dt against tau in the sense of never overshooting."""
    return value + (request - value) * dt / (tau + dt)


@inlined
def rate_limited(value, request, tau, rate, dt):
    """First-order lag whose speed of change is limited to `rate` per second."""
    change = (request - value) * dt / (tau + dt)
    return value + min(max(change, -rate * dt), rate * dt)


@inlined
def wheel_force(u, m_eff, F_air, F_roll):
    """Force [N] at the ground that gives the acceleration u [m/s²]."""
    return m_eff * u + F_air + F_roll
