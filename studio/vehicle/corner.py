"""A corner of the vehicle: where its wheel stands on the road, what load it carries, and the slip it takes up.

Every function works on one wheel, column w = corner · LANES + lane of the tile's wheel rows, of the vehicle in lane v.
"""

from math import sqrt

from studio.compiled import inlined
from studio.model import body, steering, suspension, tyre, wheel
from studio.vehicle.contact import (
    ALPHA_USED,
    GAMMA,
    HEIGHT,
    KAPPA_USED,
    L_X,
    L_Y,
    L_Z,
    MU,
    N_X,
    N_Y,
    N_Z,
    PEAK,
    R_X,
    R_Y,
    R_Z,
    ROLLING,
    SLIP_SPIN,
    SLOPE_X,
    SLOPE_Y,
    SPIN_SLOPE,
    T_X,
    T_Y,
    T_Z,
)  # fmt: skip
from studio.vehicle.parameter import (
    C_ROLL,
    CAMBER_F,
    CAMBER_R,
    D_T,
    GAIN_F,
    GAIN_R,
    K_TF,
    K_TR,
    L_F,
    L_R,
    RADIUS,
    REST_AF,
    REST_AR,
    REST_DAMPING,
    REST_KF,
    REST_KR,
    STATIC_F,
    STATIC_R,
    TRACK_F,
    TRACK_R,
    H,
)  # fmt: skip
from studio.vehicle.state import (
    ALPHA,
    DELTA,
    F_X,
    F_Y,
    F_Z,
    KAPPA,
    M_Z,
    OMEGA,
    PITCH_RATE,
    Q_W,
    Q_X,
    Q_Y,
    Q_Z,
    ROLL_RATE,
    TRAVEL,
    TRAVEL_RATE,
    V_EAST,
    V_NORTH,
    V_UP,
    YAW_RATE,
    X,
    Y,
    Z,
)  # fmt: skip
from studio.vehicle.tile import LANES

UPRIGHT = 1e-12  # keeps the axes of a wheel finite that points at the road
OVERLOAD = 3.0  # [1] of the nominal load: beyond it no tyre is measured, and its forces stay what they are there


@inlined
def at_axle(corner, front, rear):
    """The row of the axle that a corner belongs to."""
    return front if corner < 2 else rear


@inlined
def side_of(corner):
    """1 on the left, -1 on the right."""
    return 1.0 if corner % 2 == 0 else -1.0


@inlined
def place(corner, v, parameter):
    """Position [m] of a wheel in the body's axes, forward and left."""
    x = parameter[L_F, v] if corner < 2 else -parameter[L_R, v]
    return x, 0.5 * side_of(corner) * parameter[at_axle(corner, TRACK_F, TRACK_R), v]


@inlined
def heading_of(corner, y, v, state, parameter):
    """Cosine and sine of a wheel's steer angle."""
    if corner < 2:
        return steering.wheel_direction(state[DELTA, v], parameter[L_F, v] + parameter[L_R, v], y)
    return 1.0, 0.0


@inlined
def road_plane(w, ground, R):
    """Normal of the road under a wheel in the body's axes, and 1/|(slope_x, slope_y, 1)|."""
    g_x, g_y = ground[SLOPE_X, w], ground[SLOPE_Y, w]
    scale = 1.0 / sqrt(1.0 + g_x * g_x + g_y * g_y)
    return body.to_body(R, -g_x * scale, -g_y * scale, scale), scale


@inlined
def road_distance(w, v, x, y, z, state, ground, R, scale):
    """Distance [m] of a wheel centre, at x, y, z in the body's axes, from the road's plane."""
    e, n, u = body.to_world(R, x, y, z)
    e, n, u = state[X, v] + e, state[Y, v] + n, state[Z, v] + u
    return (u - ground[HEIGHT, w] - ground[SLOPE_X, w] * e - ground[SLOPE_Y, w] * n) * scale


@inlined
def wheel_axes(c, s, n_x, n_y, n_z):
    """Heading of the wheel and left of it, in the road's plane, for the steer angle's cosine and sine."""
    l_x, l_y, l_z = -n_z * s, n_z * c, n_x * s - n_y * c
    scale = 1.0 / sqrt(l_x * l_x + l_y * l_y + l_z * l_z + UPRIGHT)
    l_x, l_y, l_z = l_x * scale, l_y * scale, l_z * scale
    return body.cross(l_x, l_y, l_z, n_x, n_y, n_z), (l_x, l_y, l_z)


@inlined
def load_step(corner, v, w, distance, rate, wheels, parameter):
    """F_z [N] of a wheel."""
    return suspension.tyre_load(
        parameter[at_axle(corner, STATIC_F, STATIC_R), v], parameter[at_axle(corner, K_TF, K_TR), v], parameter[D_T, v],
        parameter[RADIUS, v], distance, rate,
    )  # fmt: skip


@inlined
def slip_step(corner, v, w, v_x, v_y, wheels, contact, parameter, dt):
    """The contact patch takes up slip."""
    R, tau = parameter[RADIUS, v], parameter[REST_DAMPING, v]
    v_s = R * wheels[OMEGA, w] - v_x
    sliding = abs(v_s) + abs(v_x) + abs(v_y)
    bound_x = wheel.slip_bound(parameter[at_axle(corner, REST_KF, REST_KR), v], sliding)
    bound_y = wheel.slip_bound(parameter[at_axle(corner, REST_AF, REST_AR), v], sliding)
    kappa = wheel.bounded(wheel.uptake(wheels[KAPPA, w], v_s, v_x, dt), bound_x)
    alpha = wheel.bounded(wheel.uptake(wheels[ALPHA, w], v_y, v_x, dt), bound_y)
    gain = wheel.rest_gain(tau, v_x)
    wheels[KAPPA, w] = kappa
    wheels[ALPHA, w] = alpha
    contact[KAPPA_USED, w] = kappa + gain * v_s
    contact[ALPHA_USED, w] = alpha + gain * v_y
    contact[SLIP_SPIN, w] = wheel.slip_per_spin(R, v_x, gain, dt)


@inlined
def wheel_axis(corner, v, w, c, s, wheels, parameter):
    """The wheel's axis in the body's axes, to the left, leaning with static camber and travel (small angles)."""
    lean = parameter[at_axle(corner, CAMBER_F, CAMBER_R), v]
    lean += parameter[at_axle(corner, GAIN_F, GAIN_R), v] * wheels[TRAVEL, w]
    return -s, c, -side_of(corner) * lean


@inlined
def contact_arm(x, y, z, distance, axis, n_x, n_y, n_z):
    """Where a wheel touches the road, from the centre of gravity [m], its radius to there [m], and the sine of its camber.

    A leaning wheel stands on its own plane, not below its centre: down is the normal without its part along the axis.
    """
    sine = axis[0] * n_x + axis[1] * n_y + axis[2] * n_z
    radius = distance * (1.0 + 0.5 * sine * sine)
    down = distance * (1.0 + sine * sine)
    arm = x - down * (n_x - sine * axis[0]), y - down * (n_y - sine * axis[1]), z - down * (n_z - sine * axis[2])
    return arm, radius, sine


@inlined
def corner_step(corner, v, R, v_b, state, wheels, ground, contact, parameter, dt):
    """Fills the contact rows of one wheel."""
    w = corner * LANES + v
    x, y = place(corner, v, parameter)
    z = parameter[RADIUS, v] - parameter[H, v] + wheels[TRAVEL, w]
    (n_x, n_y, n_z), scale = road_plane(w, ground, R)
    d = road_distance(w, v, x, y, z, state, ground, R, scale)
    c, s = heading_of(corner, y, v, state, parameter)
    axis = wheel_axis(corner, v, w, c, s, wheels, parameter)
    (r_x, r_y, r_z), radius, sine = contact_arm(x, y, z, d, axis, n_x, n_y, n_z)
    u_x, u_y, u_z = body.cross(state[ROLL_RATE, v], state[PITCH_RATE, v], state[YAW_RATE, v], r_x, r_y, r_z)
    u_x, u_y, u_z = u_x + v_b[0], u_y + v_b[1], u_z + v_b[2] + wheels[TRAVEL_RATE, w]
    (t_x, t_y, t_z), (l_x, l_y, l_z) = wheel_axes(c, s, n_x, n_y, n_z)
    v_x = u_x * t_x + u_y * t_y + u_z * t_z
    v_y = u_x * l_x + u_y * l_y + u_z * l_z
    F = load_step(corner, v, w, radius, u_x * n_x + u_y * n_y + u_z * n_z, wheels, parameter)
    slip_step(corner, v, w, v_x, v_y, wheels, contact, parameter, dt)
    F = F if n_z > 0.0 else 0.0  # on its roof a vehicle has no wheel on the road
    wheels[F_Z, w] = F
    contact[GAMMA, w] = sine
    contact[ROLLING, w] = wheel.rolling_torque(parameter[C_ROLL, v], F, parameter[RADIUS, v], v_x)
    contact[T_X, w], contact[T_Y, w], contact[T_Z, w] = t_x, t_y, t_z
    contact[L_X, w], contact[L_Y, w], contact[L_Z, w] = l_x, l_y, l_z
    contact[N_X, w], contact[N_Y, w], contact[N_Z, w] = n_x, n_y, n_z
    contact[R_X, w], contact[R_Y, w], contact[R_Z, w] = r_x, r_y, r_z


@inlined
def attitude(v, state):
    """The rotation matrix of a vehicle."""
    return body.rotation(state[Q_W, v], state[Q_X, v], state[Q_Y, v], state[Q_Z, v])


@inlined
def corners_step(v, state, wheels, ground, contact, parameter, dt):
    """All four corners of a vehicle."""
    R = attitude(v, state)
    v_b = body.to_body(R, state[V_EAST, v], state[V_NORTH, v], state[V_UP, v])
    corner_step(0, v, R, v_b, state, wheels, ground, contact, parameter, dt)
    corner_step(1, v, R, v_b, state, wheels, ground, contact, parameter, dt)
    corner_step(2, v, R, v_b, state, wheels, ground, contact, parameter, dt)
    corner_step(3, v, R, v_b, state, wheels, ground, contact, parameter, dt)


@inlined
def tyre_step(t, side, w, wheels, ground, contact):
    """Forces of one wheel. Tyres are described as mounted on the left; on the right they are mirrored."""
    kappa, F = contact[KAPPA_USED, w], min(wheels[F_Z, w], OVERLOAD * t.LFZO * t.FNOMIN)
    f_x, f_y, m_z = tyre.forces(t, kappa, side * contact[ALPHA_USED, w], side * contact[GAMMA, w], F, ground[MU, w])
    wheels[F_X, w] = f_x
    wheels[F_Y, w] = side * f_y
    wheels[M_Z, w] = side * m_z
    contact[PEAK, w] = tyre.longitudinal_peak(t, F, ground[MU, w])
    contact[SPIN_SLOPE, w] = wheel.secant_stiffness(f_x, kappa, tyre.slip_stiffness(t, F)) * contact[SLIP_SPIN, w]
