"""Motion: one step of all vehicles, in three passes over flat arrays.

corners     body → loads, velocities and slips of the four wheels
tyres       slips → forces, wheel by wheel
bodies      forces → wheel spins, actuators, new body state

Between the passes stand the rows of `contact`. No vehicle looks at another one here.
"""

from math import ceil, cos, floor, sin

from numba.np.unsafe.ndarray import to_fixed_tuple

from studio.compiled import compiled
from studio.conventions import GRAVITY
from studio.model import actuator, tyre, vehicle, wheel
from studio.model.tyre import Tyre
from studio.world.state import *  # noqa: F403 - the names of the rows

TYRE_FIELDS = len(Tyre._fields)
TICK_EPSILON = 1e-9  # a dead time that is a whole number of ticks must not fall one tick short by rounding
COASTING = 0.02  # [m/s] below this rolling resistance fades out


@compiled
def place(corner, L_f, L_r, track_f, track_r):
    """Position [m] of a wheel centre in the body's axes."""
    x = L_f if corner < 2 else -L_r
    half = 0.5 * (track_f if corner < 2 else track_r)
    return x, half if corner % 2 == 0 else -half


@compiled
def static_axle(corner, m, L_f, L_r, h, a_x):
    """Load [N] of the axle that the corner belongs to."""
    if corner < 2:
        return vehicle.axle_load(m, L_r, L_f + L_r, h, a_x, -1.0)
    return vehicle.axle_load(m, L_f, L_f + L_r, h, a_x, 1.0)


@compiled
def wheel_load(corner, v, state, parameter):
    """F_z [N] of one wheel: half of its axle, plus or minus the lateral transfer, never negative."""
    m, h = parameter[MASS, v], parameter[H, v]
    axle = static_axle(corner, m, parameter[L_F, v], parameter[L_R, v], h, state[TRANSFER_X, v])
    share = parameter[ROLL_SHARE, v] if corner < 2 else 1.0 - parameter[ROLL_SHARE, v]
    track = parameter[TRACK_F, v] if corner < 2 else parameter[TRACK_R, v]
    transfer = vehicle.side_transfer(m, h, state[TRANSFER_Y, v], share, track)
    return max(0.5 * axle - transfer if corner % 2 == 0 else 0.5 * axle + transfer, 0.0)


@compiled
def corner_step(corner, v, w, state, parameter, wheels, contact):
    """Fills the contact rows of wheel column w."""
    x, y = place(corner, parameter[L_F, v], parameter[L_R, v], parameter[TRACK_F, v], parameter[TRACK_R, v])
    delta = vehicle.ackermann(state[DELTA, v], parameter[L_F, v] + parameter[L_R, v], y) if corner < 2 else 0.0
    v_x, v_y = vehicle.corner_velocity(state[V_X, v], state[V_Y, v], state[YAW_RATE, v], x, y, delta)
    contact[F_Z, w] = wheel_load(corner, v, state, parameter)
    contact[DELTA_W, w] = delta
    contact[V_XW, w] = v_x
    contact[KAPPA, w] = wheel.slip_ratio(v_x, wheels[OMEGA, w], parameter[RADIUS, v])
    contact[ALPHA, w] = wheel.slip_tangent(v_x, v_y)


@compiled
def corners(state, parameter, wheels, contact):
    """First pass."""
    n = state.shape[1]
    for corner in range(4):
        for v in range(n):
            if state[ACTIVE, v] > 0.0:
                corner_step(corner, v, corner * n + v, state, parameter, wheels, contact)


@compiled
def coefficients(tyres, k):
    """Coefficients of tyre k; one row of the table per field, in the order of the fields."""
    return Tyre(*to_fixed_tuple(tyres[:, k], TYRE_FIELDS))


@compiled
def tyre_step(t, w, mu, contact):
    """Forces of wheel column w."""
    kappa, alpha, F_z = contact[KAPPA, w], contact[ALPHA, w], contact[F_Z, w]
    F_x, F_y = tyre.forces(t, kappa, alpha, 0.0, F_z, mu)
    contact[F_X, w] = F_x
    contact[F_Y, w] = F_y
    contact[SECANT, w] = wheel.secant_stiffness(F_x, kappa, tyre.slip_stiffness(t, F_z))


@compiled
def tyre_pass(state, parameter, tyres, tyre_of, contact):
    """Second pass."""
    n = state.shape[1]
    for k in range(tyres.shape[1]):
        t = coefficients(tyres, k)
        for corner in range(4):
            for v in range(n):
                if tyre_of[v] == k and state[ACTIVE, v] > 0.0:
                    tyre_step(t, corner * n + v, parameter[FRICTION, v], contact)


@compiled
def delayed(command, row, v, n, tick_now, elapsed, delay, tick):
    """The command that reaches an actuator now: the one that was in force `delay` [s] ago."""
    k = tick_now + int(floor((elapsed - delay) / tick + TICK_EPSILON))
    return command[row, (k % RING) * n + v]


@compiled
def actuator_step(v, n, state, parameter, command, tick_now, elapsed, tick, dt):
    """Steering, drive and brake move towards what reaches them now."""
    T_drive = delayed(command, U_DRIVE, v, n, tick_now, elapsed, parameter[DELAY_DRIVE, v], tick)
    T_brake = delayed(command, U_BRAKE, v, n, tick_now, elapsed, parameter[DELAY_BRAKE, v], tick)
    delta = command[U_STEER, (tick_now % RING) * n + v]
    state[TORQUE_DRIVE, v] = actuator.lag(state[TORQUE_DRIVE, v], T_drive, parameter[TAU_DRIVE, v], dt)
    state[TORQUE_BRAKE, v] = actuator.lag(state[TORQUE_BRAKE, v], T_brake, parameter[TAU_BRAKE, v], dt)
    state[DELTA, v] = actuator.rate_limited(
        state[DELTA, v], delta, parameter[TAU_STEER, v], parameter[STEER_RATE, v], dt
    )


@compiled
def axle_half(share_front, corner):
    """Part of a torque sum that one wheel gets: half of its axle's share."""
    return 0.5 * (share_front if corner < 2 else 1.0 - share_front)


@compiled
def wheel_step(corner, v, w, state, parameter, wheels, contact, dt):
    """Spins wheel column w on; its tyre force is corrected to the end of the step."""
    R = parameter[RADIUS, v]
    T_drive = state[TORQUE_DRIVE, v] * axle_half(parameter[DRIVE_SHARE, v], corner)
    T_brake = state[TORQUE_BRAKE, v] * axle_half(parameter[BRAKE_SHARE, v], corner)
    fade = min(abs(contact[V_XW, w]) / COASTING, 1.0)
    T_roll = parameter[C_ROLL, v] * contact[F_Z, w] * R * fade
    omega, F_x = wheel.spin(
        wheels[OMEGA, w], contact[V_XW, w], contact[F_X, w], contact[SECANT, w], parameter[J_W, v], R,
        T_drive, T_brake, T_roll, dt,
    )  # fmt: skip
    wheels[OMEGA, w] = omega
    wheels[ROTATION, w] += omega * dt
    contact[F_X, w] = F_x


@compiled
def sum_of_forces(v, n, state, parameter, contact):
    """Forces [N] and yaw moment [Nm] of the four wheels on the body."""
    X_sum, Y_sum, N_sum = 0.0, 0.0, 0.0
    for corner in range(4):
        w = corner * n + v
        x, y = place(corner, parameter[L_F, v], parameter[L_R, v], parameter[TRACK_F, v], parameter[TRACK_R, v])
        f_x, f_y = vehicle.body_force(contact[F_X, w], contact[F_Y, w], contact[DELTA_W, w])
        X_sum += f_x
        Y_sum += f_y
        N_sum += x * f_y - y * f_x
    return X_sum, Y_sum, N_sum


@compiled
def body_step(v, n, state, parameter, contact, dt):
    """Newton and Euler in the plane; velocities first, then positions with the new velocities."""
    X_sum, Y_sum, N_sum = sum_of_forces(v, n, state, parameter, contact)
    X_sum -= vehicle.air_drag(parameter[C_D, v], parameter[AREA, v], state[V_X, v])
    a_x, a_y = X_sum / parameter[MASS, v], Y_sum / parameter[MASS, v]
    v_x, v_y, r = state[V_X, v], state[V_Y, v], state[YAW_RATE, v]
    state[V_X, v] = v_x + dt * (a_x + v_y * r)
    state[V_Y, v] = v_y + dt * (a_y - v_x * r)
    state[YAW_RATE, v] = r + dt * N_sum / parameter[J_Z, v]
    state[A_X, v] = a_x
    state[A_Y, v] = a_y
    state[TRANSFER_X, v] = vehicle.sprung(state[TRANSFER_X, v], a_x, parameter[TAU_SPRUNG, v], dt)
    state[TRANSFER_Y, v] = vehicle.sprung(state[TRANSFER_Y, v], a_y, parameter[TAU_SPRUNG, v], dt)
    move(v, state, dt)


@compiled
def move(v, state, dt):
    """Position and heading with the new velocities."""
    state[PSI, v] += dt * state[YAW_RATE, v]
    c, s = cos(state[PSI, v]), sin(state[PSI, v])
    state[X, v] += dt * (state[V_X, v] * c - state[V_Y, v] * s)
    state[Y, v] += dt * (state[V_X, v] * s + state[V_Y, v] * c)


@compiled
def bodies(state, parameter, wheels, contact, command, tick_now, elapsed, tick, dt):
    """Third pass."""
    n = state.shape[1]
    for v in range(n):
        if state[ACTIVE, v] > 0.0:
            actuator_step(v, n, state, parameter, command, tick_now, elapsed, tick, dt)
            for corner in range(4):
                wheel_step(corner, v, corner * n + v, state, parameter, wheels, contact, dt)
            body_step(v, n, state, parameter, contact, dt)


@compiled
def integrate(state, parameter, tyres, tyre_of, wheels, contact, command, tick_now, tick, dt):
    """All steps of one tick."""
    for i in range(int(ceil(tick / dt - TICK_EPSILON))):
        corners(state, parameter, wheels, contact)
        tyre_pass(state, parameter, tyres, tyre_of, contact)
        bodies(state, parameter, wheels, contact, command, tick_now, i * dt, tick, dt)


@compiled
def rolling_force(m, c_roll):
    """Rolling resistance [N] of a car on the level."""
    return c_roll * m * GRAVITY
