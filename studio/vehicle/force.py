"""Forces and motion of one vehicle, lane v of a tile: what its four corners do to the body, and the new state of both."""

from studio.compiled import inlined
from studio.conventions import GRAVITY
from studio.model import aerodynamics, body, suspension
from studio.vehicle.contact import L_X, L_Y, L_Z, N_X, N_Y, N_Z, R_X, R_Y, R_Z, T_X, T_Y, T_Z
from studio.vehicle.corner import at_axle, attitude, place, side_of
from studio.vehicle.parameter import (
    ARB_F,
    ARB_R,
    AREA,
    C_D,
    D_F,
    D_R,
    D_T,
    J_X,
    J_Y,
    J_Z,
    K_F,
    K_R,
    L_F,
    L_R,
    LINK_F,
    LINK_R,
    M_UF,
    M_UR,
    MASS,
    MASS_S,
    STATIC_F,
    STATIC_R,
)  # fmt: skip
from studio.vehicle.state import (
    A_X,
    A_Y,
    A_Z,
    F_X,
    F_Y,
    F_Z,
    M_Z,
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

LYING = 0.3  # cosine of the tilt beyond which a vehicle lies on its side: it slides to a stop, and nothing more is claimed


@inlined
def sprung_load(corner, v, parameter):
    """Static load [N] of the spring at a corner: the wheel's load without its own weight."""
    return parameter[at_axle(corner, STATIC_F, STATIC_R), v] - parameter[at_axle(corner, M_UF, M_UR), v] * GRAVITY


@inlined
def suspension_force(corner, v, wheels, parameter):
    """Force [N] along the body's z axis that one wheel's spring, damper, bar and links put on the body."""
    w, other = corner * LANES + v, (corner + 1 - 2 * (corner % 2)) * LANES + v
    F_s = suspension.spring_force(
        sprung_load(corner, v, parameter), parameter[at_axle(corner, K_F, K_R), v], parameter[at_axle(corner, D_F, D_R), v],
        parameter[at_axle(corner, ARB_F, ARB_R), v], wheels[TRAVEL, w], wheels[TRAVEL_RATE, w], wheels[TRAVEL, other],
    )  # fmt: skip
    return F_s + suspension.link_force(side_of(corner), wheels[F_Y, w], parameter[at_axle(corner, LINK_F, LINK_R), v])


@inlined
def tyre_force(w, wheels, contact):
    """Force [N] of one tyre in the body's axes."""
    f_x, f_y, f_z = wheels[F_X, w], wheels[F_Y, w], wheels[F_Z, w]
    return (
        f_x * contact[T_X, w] + f_y * contact[L_X, w] + f_z * contact[N_X, w],
        f_x * contact[T_Y, w] + f_y * contact[L_Y, w] + f_z * contact[N_Y, w],
        f_x * contact[T_Z, w] + f_y * contact[L_Z, w] + f_z * contact[N_Z, w],
    )


@inlined
def corner_force(corner, v, wheels, contact, parameter):
    """What one wheel does to the body: force [N], moment [Nm], and the force [N] left on the wheel along z."""
    w = corner * LANES + v
    f_x, f_y, f_z = tyre_force(w, wheels, contact)
    V = suspension_force(corner, v, wheels, parameter)
    m_x, m_y, m_z = body.cross(contact[R_X, w], contact[R_Y, w], contact[R_Z, w], f_x, f_y, V)
    M = wheels[M_Z, w]
    return (f_x, f_y, V), (m_x + M * contact[N_X, w], m_y + M * contact[N_Y, w], m_z + M * contact[N_Z, w]), f_z - V


@inlined
def travel_step(corner, v, force, a_z, dp, dq, g_z, wheels, parameter, dt):
    """A wheel moves along the body's z axis, which itself accelerates with a_z [m/s²] and turns with dp, dq [rad/s²]."""
    w = corner * LANES + v
    x, y = place(corner, v, parameter)
    m_u = parameter[at_axle(corner, M_UF, M_UR), v]
    damping = parameter[at_axle(corner, D_F, D_R), v] + parameter[D_T, v]
    rate = suspension.travel_rate(wheels[TRAVEL_RATE, w], force + m_u * g_z, a_z + dp * y - dq * x, m_u, damping, dt)
    rate = 0.0 if -g_z < LYING * GRAVITY else rate
    wheels[TRAVEL_RATE, w] = rate
    wheels[TRAVEL, w] += dt * rate


@inlined
def move_step(v, R, a_x, a_y, a_z, dp, dq, dr, state, dt):
    """Velocities first, then position and orientation with the new ones."""
    e, n, u = body.to_world(R, a_x, a_y, a_z)
    lies = R[8] < LYING
    kept = body.sliding_share(state[V_EAST, v], state[V_NORTH, v], dt)
    turns = 0.0 if lies else 1.0
    state[A_X, v], state[A_Y, v], state[A_Z, v] = turns * a_x, turns * a_y, turns * a_z
    state[V_EAST, v] = kept * state[V_EAST, v] if lies else state[V_EAST, v] + dt * e
    state[V_NORTH, v] = kept * state[V_NORTH, v] if lies else state[V_NORTH, v] + dt * n
    state[V_UP, v] = 0.0 if lies else state[V_UP, v] + dt * u
    state[X, v] += dt * state[V_EAST, v]
    state[Y, v] += dt * state[V_NORTH, v]
    state[Z, v] += dt * state[V_UP, v]
    state[ROLL_RATE, v] = turns * (state[ROLL_RATE, v] + dt * dp)
    state[PITCH_RATE, v] = turns * (state[PITCH_RATE, v] + dt * dq)
    state[YAW_RATE, v] = turns * (state[YAW_RATE, v] + dt * dr)
    state[Q_W, v], state[Q_X, v], state[Q_Y, v], state[Q_Z, v] = body.turned(
        state[Q_W, v], state[Q_X, v], state[Q_Y, v], state[Q_Z, v], state[ROLL_RATE, v], state[PITCH_RATE, v],
        state[YAW_RATE, v], dt,
    )  # fmt: skip


@inlined
def wheel_weights(v, g_y, parameter):
    """Moment [Nm] about z of the wheels' own weight on a leaning body, which their loads answer at both axles."""
    return 2.0 * g_y * (parameter[M_UF, v] * parameter[L_F, v] - parameter[M_UR, v] * parameter[L_R, v])


@inlined
def forces_step(v, resistance, state, wheels, contact, parameter, dt):
    """Sums of forces and moments, accelerations, new state of body and wheels."""
    R = attitude(v, state)
    g_x, g_y, g_z = -GRAVITY * R[6], -GRAVITY * R[7], -GRAVITY * R[8]
    f_1, m_1, rest_1 = corner_force(0, v, wheels, contact, parameter)
    f_2, m_2, rest_2 = corner_force(1, v, wheels, contact, parameter)
    f_3, m_3, rest_3 = corner_force(2, v, wheels, contact, parameter)
    f_4, m_4, rest_4 = corner_force(3, v, wheels, contact, parameter)
    v_x = R[0] * state[V_EAST, v] + R[3] * state[V_NORTH, v] + R[6] * state[V_UP, v]
    air = aerodynamics.air_drag(parameter[C_D, v], parameter[AREA, v], v_x)
    a_x = (f_1[0] + f_2[0] + f_3[0] + f_4[0] - air) / parameter[MASS, v] + g_x
    a_y = (f_1[1] + f_2[1] + f_3[1] + f_4[1]) / parameter[MASS, v] + g_y
    a_z = (f_1[2] + f_2[2] + f_3[2] + f_4[2]) / parameter[MASS_S, v] + g_z
    dp, dq, dr = body.angular_acceleration(
        m_1[0] + m_2[0] + m_3[0] + m_4[0], m_1[1] + m_2[1] + m_3[1] + m_4[1] + resistance,
        m_1[2] + m_2[2] + m_3[2] + m_4[2] + wheel_weights(v, g_y, parameter),
        state[ROLL_RATE, v], state[PITCH_RATE, v], state[YAW_RATE, v], parameter[J_X, v], parameter[J_Y, v], parameter[J_Z, v],
    )  # fmt: skip
    move_step(v, R, a_x, a_y, a_z, dp, dq, dr, state, dt)
    travel_step(0, v, rest_1, a_z, dp, dq, g_z, wheels, parameter, dt)
    travel_step(1, v, rest_2, a_z, dp, dq, g_z, wheels, parameter, dt)
    travel_step(2, v, rest_3, a_z, dp, dq, g_z, wheels, parameter, dt)
    travel_step(3, v, rest_4, a_z, dp, dq, g_z, wheels, parameter, dt)
