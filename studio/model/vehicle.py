"""The vehicle: dual-track, seven degrees of freedom (x, y, yaw, four wheel spins), with load transfer.

    m (dv_x/dt - v_y r) = sum F_x - F_air,    m (dv_y/dt + v_x r) = sum F_y,    J_z dr/dt = sum (x F_y - y F_x)

F_x, F_y of each wheel are turned from the wheel's axes into the body's. Loads follow the filtered accelerations
(load_transfer below) as a sprung body does with its own time constant; they do not oscillate.
Source: M. Mitschke, H. Wallentowitz, Dynamik der Kraftfahrzeuge, 5th edition 2014, chapters 20 and 24.
"""

from math import atan, cos, sin, tan

from studio.compiled import compiled
from studio.conventions import AIR_DENSITY, GRAVITY


@compiled
def air_drag(c_d, A, v_x):
    """F_air [N] against the motion (Massow & Radusch 2018, Eq. 12); c_d [1], A [m²], v_x [m/s]."""
    return 0.5 * AIR_DENSITY * c_d * A * v_x * abs(v_x)


@compiled
def ackermann(delta, L, side_y):
    """Angle [rad] of a front wheel at lateral position side_y [m] (left positive) for the mean angle delta [rad].

    Both wheel axles point at one centre: tan(delta_side) = tan(delta)/(1 - side_y tan(delta)/L), L wheelbase [m].
    """
    return atan(tan(delta) / (1.0 - side_y * tan(delta) / L))


@compiled
def axle_load(m, distance, L, h, a_x, sign):
    """Load of one axle [N]: its static share m g distance/L, plus or minus m a_x h/L.

    distance [m] from the centre of gravity to the OTHER axle, h [m] height of the centre of gravity,
    sign -1 for the front axle, +1 for the rear.
    """
    return m * (GRAVITY * distance + sign * h * a_x) / L


@compiled
def side_transfer(m, h, a_y, share, track):
    """Load [N] that moves from the left to the right wheel of an axle which carries `share` of the roll moment."""
    return m * h * a_y * share / track


@compiled
def corner_velocity(v_x, v_y, r, x, y, delta):
    """Velocity [m/s] of the wheel centre at (x, y) [m] in the axes of a wheel turned by delta [rad]."""
    u = v_x - r * y
    w = v_y + r * x
    return u * cos(delta) + w * sin(delta), w * cos(delta) - u * sin(delta)


@compiled
def body_force(F_x, F_y, delta):
    """Force of a wheel [N] in the body's axes."""
    return F_x * cos(delta) - F_y * sin(delta), F_x * sin(delta) + F_y * cos(delta)


@compiled
def sprung(angle, target, tau, dt):
    """First-order approach of a body angle or an acceleration to its static value, time constant tau [s]."""
    return angle + (target - angle) * dt / (tau + dt)
