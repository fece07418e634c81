"""Actuators: what a request becomes, after dead time, lag and limits.

    tau dT/dt = T_request(t - t_d) - T        (Massow & Radusch 2018, Eqs. 3 and 11)

The interface that drivers and applications use is a requested acceleration, as production cars offer it to their own
ACC. It is turned into torques by inverting the resistances of a car on the level:
F = m_eff u + F_air + F_roll, m_eff = m + sum J/R².
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


@inlined
def drive_torque(F, R, v, T_max, P_max):
    """Drive torque [Nm] at the wheels: what F asks, within torque and power; nothing when F brakes."""
    limit = min(T_max, P_max * R / max(abs(v), 1.0))
    return min(max(F * R, 0.0), limit)


@inlined
def brake_torque(F, R, T_max):
    """Brake torque [Nm] at the wheels, sum of all; zero when F drives."""
    return min(max(-F * R, 0.0), T_max)
