"""The wheel: its slip, and its spin under drive, brake and tyre force.

    J domega/dt = T_drive - T_roll - T_brake - R F_x        (Massow & Radusch 2018, Eq. 1)

At low speed the tyre turns this into a stiff spring: dF_x/domega = C R/|v_x|. The spin is therefore stepped implicitly
in the tyre force, with the secant stiffness C = F_x/kappa, which is positive on both sides of the peak.
The brake is friction: it can hold a wheel, never turn it backwards.
"""

from math import copysign

from studio.compiled import compiled

V_LOW = 2.0  # [m/s] slip is taken over at least this speed, so that a standing car is held by a stiff viscous tyre
SLIP_SMALL = 1e-3  # [1] below this slip the secant is taken as the slope at the origin


@compiled
def slip_speed(v_x):
    """Speed that slips are related to [m/s]."""
    return max(abs(v_x), V_LOW)


@compiled
def slip_ratio(v_x, omega, R):
    """kappa [1] of a wheel of radius R [m] that moves with v_x [m/s] in its own plane."""
    return (R * omega - v_x) / slip_speed(v_x)


@compiled
def slip_tangent(v_x, v_y):
    """alpha* [1], the tangent of the side-slip angle."""
    return v_y / slip_speed(v_x)


@compiled
def secant_stiffness(F_x, kappa, K_x):
    """C [N]: F_x over kappa, never below zero."""
    if abs(kappa) < SLIP_SMALL:
        return K_x
    return max(F_x / kappa, 0.0)


@compiled
def spin(omega, v_x, F_x, C, J, R, T_drive, T_brake, T_roll, dt):
    """omega [rad/s] after dt [s], and the tyre force F_x [N] that goes with it.

    J [kg m²] inertia, R [m] radius, torques [Nm] at the wheel; T_brake and T_roll are magnitudes that oppose the spin.
    """
    slope = C * R / slip_speed(v_x)  # dF_x/domega [N s]
    inertia = J + dt * R * slope
    free = omega + dt * (T_drive - R * F_x) / inertia
    held = dt * (T_brake + T_roll) / inertia
    omega_new = free - copysign(min(held, abs(free)), free)
    return omega_new, F_x + slope * (omega_new - omega)
