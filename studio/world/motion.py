"""Motion: one tick of all vehicles, tile by tile; in a tile all steps, and in a step four passes.

intake      commands that reach the actuators now
corners     body and wheels → loads, directions and slips at the four contact points
tyres       slips → forces, wheel by wheel
bodies      forces → actuators, powertrain, wheel spins, new body state

Between the passes stand the rows of `contact`. No vehicle looks at another one here. Order within a step as in Massow &
Radusch 2018: aerodynamics and suspension, actuators, powertrain and wheels, forces on the body, new state.
"""

from math import asin, atan2, ceil, floor, pi, sqrt

from studio.compiled import compiled, inlined
from studio.conventions import GRAVITY
from studio.model import aerodynamics, body, brake, coupling, engine, steering, suspension, transmission, tyre, wheel
from studio.world import tile as tiles
from studio.world.state import *  # noqa: F403 - the names of the rows
from studio.world.tile import COMMAND_AT, CONTACT_AT, CORNERS, GROUND_AT, LANES, PARAMETER_AT, STATE_AT, WHEEL_AT, tyre_at, window

TICK_EPSILON = 1e-9  # a dead time that is a whole number of ticks must not fall one tick short by rounding
RIGID, CLUTCHED, CONVERTER = 0.0, 1.0, 2.0  # kinds of coupling
OVERLOAD = 3.0  # [1] of the nominal load: beyond it no tyre is measured, and its forces stay what they are there


# --- intake --------------------------------------------------------------------------------------------------------------


@compiled
def slot(tick_now, elapsed, delay, tick):
    """Slot of the ring with the commands that were in force `delay` [s] ago."""
    return (tick_now + int(floor((elapsed - delay) / tick + TICK_EPSILON))) % RING


@compiled
def intake(columns, count, n, parameter, commands, tick_now, elapsed, tick, tile):
    """First pass: what was commanded a dead time ago reaches drive and brake; the rest comes at once."""
    for lane in range(count):
        v = columns[lane]
        now = (tick_now % RING) * n + v
        then_drive = slot(tick_now, elapsed, parameter[DELAY_DRIVE, v], tick) * n + v
        then_brake = slot(tick_now, elapsed, parameter[DELAY_BRAKE, v], tick) * n + v
        for row in (U_STEER, U_STEER_TORQUE, U_APPLIED, U_APPLIED_BRAKE):
            tile[(COMMAND_AT + row) * LANES + lane] = commands[row, now]
        for row in (U_DRIVE, U_PEDAL, U_ENGINE):
            tile[(COMMAND_AT + row) * LANES + lane] = commands[row, then_drive]
        tile[(COMMAND_AT + U_BRAKE) * LANES + lane] = commands[U_BRAKE, then_brake]
    for lane in range(count, tiles.filled_lanes(count)):
        for row in range(len_command):
            tile[(COMMAND_AT + row) * LANES + lane] = tile[(COMMAND_AT + row) * LANES + count - 1]


len_command = len(COMMAND)


# --- corners -------------------------------------------------------------------------------------------------------------


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
    scale = 1.0 / sqrt(l_x * l_x + l_y * l_y + l_z * l_z)
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


@compiled
def corners(tile, lanes, dt):
    """Second pass."""
    state, wheels = window(tile, STATE_AT, LANES), window(tile, WHEEL_AT, CORNERS)
    ground, contact = window(tile, GROUND_AT, CORNERS), window(tile, CONTACT_AT, CORNERS)
    parameter = window(tile, PARAMETER_AT, LANES)
    for v in range(lanes):
        corners_step(v, state, wheels, ground, contact, parameter, dt)


# --- tyres ---------------------------------------------------------------------------------------------------------------


@inlined
def tyre_step(t, side, w, wheels, ground, contact):
    """Forces of one wheel. Tyres are described as mounted on the left; on the right they are mirrored."""
    kappa, F = contact[KAPPA_USED, w], min(wheels[F_Z, w], OVERLOAD * t.LFZO * t.FNOMIN)
    f_x, f_y, m_z = tyre.forces(t, kappa, side * contact[ALPHA_USED, w], side * contact[GAMMA, w], F, ground[MU, w])
    wheels[F_X, w] = f_x
    wheels[F_Y, w] = side * f_y
    wheels[M_Z, w] = side * m_z
    contact[SPIN_SLOPE, w] = wheel.secant_stiffness(f_x, kappa, tyre.slip_stiffness(t, F)) * contact[SLIP_SPIN, w]


@compiled
def tyre_pass(t, corner, lanes, side, tile):
    """Third pass, one corner; the windows begin at its first wheel."""
    wheels, ground = window(tile, WHEEL_AT + corner, CORNERS), window(tile, GROUND_AT + corner, CORNERS)
    contact = window(tile, CONTACT_AT + corner, CORNERS)
    for w in range(lanes):
        tyre_step(t, side, w, wheels, ground, contact)


@compiled
def all_tyres(tyres, front, rear, tile, lanes):
    """Third pass."""
    f, r = tyre_at(tyres, front), tyre_at(tyres, rear)
    tyre_pass(f, 0, lanes, 1.0, tile)
    tyre_pass(f, 1, lanes, -1.0, tile)
    tyre_pass(r, 2, lanes, 1.0, tile)
    tyre_pass(r, 3, lanes, -1.0, tile)


# --- bodies: actuators ---------------------------------------------------------------------------------------------------


@inlined
def steer_step(v, state, wheels, parameter, command, dt):
    """The road wheel angle moves: under the torque at the steering wheel if one is commanded, else towards the angle."""
    T, limit = command[U_STEER_TORQUE, v], parameter[STEER_MAX, v]
    M = steering.kingpin_moment(wheels[M_Z, v], wheels[F_Y, v], parameter[TRAIL, v])
    M += steering.kingpin_moment(wheels[M_Z, LANES + v], wheels[F_Y, LANES + v], parameter[TRAIL, v])
    free, rate = steering.by_torque(
        state[DELTA, v], state[DELTA_RATE, v], T, M, parameter[STEER_RATIO, v], parameter[J_STEER, v],
        parameter[D_STEER, v], parameter[UNASSISTED, v], dt,
    )  # fmt: skip
    held, held_rate = steering.by_angle(
        state[DELTA, v], command[U_STEER, v], parameter[TAU_STEER, v], parameter[STEER_RATE, v], dt
    )
    by_torque = T == T
    delta = free if by_torque else held
    state[DELTA_RATE, v] = 0.0 if abs(delta) > limit else (rate if by_torque else held_rate)
    state[DELTA, v] = min(max(delta, -limit), limit)


@inlined
def brake_step(v, state, parameter, command, dt):
    """Pressures move; returns the brake torque [Nm] of one front and one rear wheel."""
    K, T_max, tau, share = parameter[K_BRAKE, v], parameter[BRAKE_MAX, v], parameter[TAU_BRAKE, v], parameter[BRAKE_SHARE, v]
    applied = command[U_APPLIED_BRAKE, v]
    state[PRESSURE_F, v] = brake.pressure(state[PRESSURE_F, v], command[U_BRAKE, v], K, T_max, tau, dt)
    state[PRESSURE_R, v] = brake.pressure(state[PRESSURE_R, v], command[U_BRAKE, v], K, T_max, tau, dt)
    front = brake.axle_torque(state[PRESSURE_F, v], K, share) + share * applied
    rear = brake.axle_torque(state[PRESSURE_R, v], K, 1.0 - share) + (1.0 - share) * applied
    state[TORQUE_BRAKE, v] = front + rear
    return 0.5 * front, 0.5 * rear


# --- bodies: powertrain --------------------------------------------------------------------------------------------------


@inlined
def full_curve(w_e, v, parameter):
    """Full-load torque [Nm] before drag and rev limit: the sum of hinges."""
    T = parameter[CURVE_0, v]
    for k in range(CURVE - 1):
        T += parameter[CURVE_0 + 1 + k, v] * max(w_e - k * parameter[KNOT, v], 0.0)
    return T


@inlined
def torque_ratio(T_p, T_t, v, parameter):
    """By how much a converter multiplies now [1]; 1 for everything else."""
    multiplies = parameter[COUPLING, v] == CONVERTER and T_t > T_p and T_p > 1.0
    return min(T_t / (T_p if multiplies else 1.0), 3.0) if multiplies else 1.0


@inlined
def request(v, i, T_ratio, T_drag, T_full, command):
    """Engine torque [Nm] that is asked for: directly, as a drive torque at the wheels, or by the pedal."""
    T_engine, T_wheels, pedal = command[U_ENGINE, v], command[U_DRIVE, v], command[U_PEDAL, v]
    in_gear = i != 0.0
    by_wheels = T_wheels / ((i if in_gear else 1.0) * T_ratio) if in_gear else 0.0
    by_pedal = engine.by_pedal(pedal if pedal == pedal else 0.0, T_drag, T_full)
    return T_engine if T_engine == T_engine else (by_wheels if T_wheels == T_wheels else by_pedal)


@inlined
def engine_step(v, w_out, T_p, T_t, T_cap, state, parameter, command, dt):
    """The engine's torque moves towards the request, bounded by what the engine can and the coupling should."""
    w, i = state[OMEGA_E, v], state[RATIO, v]
    T_drag = engine.drag(w, parameter[DRAG, v], parameter[DRAG_SLOPE, v])
    T_full = engine.full_load(w, full_curve(w, v, parameter), T_drag, parameter[LIMIT, v])
    T = request(v, i, torque_ratio(T_p, T_t, v, parameter), T_drag, T_full, command)
    pedal = engine.pedal_for(T, T_drag, T_full)
    slips = parameter[COUPLING, v] == CLUTCHED and state[CLUTCH, v] < 1.0
    w_wanted = max(abs(state[NEXT_RATIO, v] * w_out), parameter[IDLE, v] + pedal * (parameter[LAUNCH, v] - parameter[IDLE, v]))
    T = engine.governed(T, w, w_wanted, T_cap) if slips else T
    T = engine.idled(T, w, parameter[IDLE, v])
    T_low = engine.lowest(w, T_drag, parameter[REGEN, v])
    state[ACCELERATOR, v] = pedal
    state[T_ENGINE, v] = engine.torque(state[T_ENGINE, v], T, T_low, T_full, parameter[TAU_DRIVE, v], dt)


@inlined
def converter_torques(v, w_in, state, parameter):
    """Torques [Nm] of pump and turbine; none in neutral, and none without a converter, whose coefficients are zero."""
    T_p, T_t = coupling.converter(
        state[OMEGA_E, v], w_in, parameter[PUMP_1, v], parameter[PUMP_2, v], parameter[PUMP_3, v], parameter[TURBINE_1, v],
        parameter[TURBINE_2, v], parameter[TURBINE_3, v], parameter[FLUID_1, v], parameter[FLUID_2, v], parameter[FLUID_3, v],
        parameter[FLUID_RATIO, v],
    )  # fmt: skip
    in_gear = state[RATIO, v] != 0.0
    return T_p if in_gear else 0.0, T_t if in_gear else 0.0


@inlined
def clutch_capacity(v, state, parameter):
    """Torque [Nm] that clutch or lock-up can carry now; none in neutral."""
    T_cap = coupling.capacity(
        state[CLUTCH, v], parameter[CAPACITY, v], state[OMEGA_E, v],
        parameter[IDLE, v] if parameter[COUPLING, v] == CLUTCHED else 0.0,
    )  # fmt: skip
    return T_cap if state[RATIO, v] != 0.0 else 0.0


@inlined
def powertrain_step(v, w_out, w_free, mobility, state, parameter, command, dt):
    """Engine, coupling and gearbox; returns the drive torque [Nm], sum of the wheels.

    w_out [rad/s] mean speed of the driven wheels, w_free what it would be without drive, mobility its change per torque
    and time [1/(kg m²)].
    """
    i, J_g, J_e = state[RATIO, v], state[J_GEAR, v], parameter[J_E, v]
    w_in, A, B = i * w_out, i * w_free, i * i * mobility
    T_p, T_t = converter_torques(v, w_in, state, parameter)
    T_cap = clutch_capacity(v, state, parameter)
    engine_step(v, w_out, T_p, T_t, T_cap, state, parameter, command, dt)
    T_e = state[T_ENGINE, v]
    eta = transmission.efficiency(T_e, parameter[LOSS_SHARE, v])
    T_loss = transmission.constant_loss(w_in, parameter[LOSS_TORQUE, v])
    free = transmission.input_free(A, B, w_in, eta * T_t - T_loss, J_g, dt)
    T_c = coupling.clutch(T_cap, state[OMEGA_E, v], T_e - T_p, J_e, free, eta * transmission.input_mobility(B, J_g), dt)
    T = eta * (T_t + T_c) - T_loss
    w_in_new = transmission.input_free(A, B, w_in, T, J_g, dt)
    state[CLUTCH, v] = min(max(state[CLUTCH, v] + dt * state[CLUTCH_RATE, v], 0.0), 1.0)
    w_e = state[OMEGA_E, v] + dt * (T_e - T_p - T_c) / J_e
    state[OMEGA_E, v] = w_e if parameter[COUPLING, v] == RIGID else max(w_e, 0.0)
    return transmission.output_torque(T, J_g, (w_in_new - w_in) / dt, i)


# --- bodies: wheels ------------------------------------------------------------------------------------------------------


@inlined
def wheel_free(corner, v, T_brake, wheels, contact, parameter, dt):
    """Spin [rad/s] of a wheel after dt without drive, and 1/inertia [1/(kg m²)] that it shows meanwhile."""
    w, R = corner * LANES + v, parameter[RADIUS, v]
    I = wheel.implicit_inertia(parameter[at_axle(corner, J_WF, J_WR), v], R, contact[SPIN_SLOPE, w], dt)  # noqa: E741
    return wheel.spin(wheels[OMEGA, w], wheels[F_X, w], 0.0, T_brake + contact[ROLLING, w], R, I, dt), 1.0 / I


@inlined
def wheel_turn(corner, v, T_drive, T_brake, mobility, wheels, contact, parameter, dt):
    """Spins a wheel on; its tyre force is corrected to the end of the step. Returns the change of its spin [rad/s]."""
    w, R, omega = corner * LANES + v, parameter[RADIUS, v], wheels[OMEGA, corner * LANES + v]
    new = wheel.spin(omega, wheels[F_X, w], T_drive, T_brake + contact[ROLLING, w], R, 1.0 / mobility, dt)
    wheels[OMEGA, w] = new
    wheels[ROTATION, w] += new * dt
    wheels[F_X, w] += contact[SPIN_SLOPE, w] * (new - omega)
    return new - omega


@inlined
def drive_step(v, T_front, T_rear, state, wheels, contact, parameter, command, dt):
    """Powertrain and wheel spins; returns the moment [Nm] about the body's y axis with which the wheels resist."""
    o_1, m_1 = wheel_free(0, v, T_front, wheels, contact, parameter, dt)
    o_2, m_2 = wheel_free(1, v, T_front, wheels, contact, parameter, dt)
    o_3, m_3 = wheel_free(2, v, T_rear, wheels, contact, parameter, dt)
    o_4, m_4 = wheel_free(3, v, T_rear, wheels, contact, parameter, dt)
    s_f, s_r = 0.5 * parameter[DRIVE_SHARE, v], 0.5 * (1.0 - parameter[DRIVE_SHARE, v])
    w_out = s_f * (wheels[OMEGA, v] + wheels[OMEGA, LANES + v]) + s_r * (wheels[OMEGA, 2 * LANES + v] + wheels[OMEGA, 3 * LANES + v])
    mobility = s_f * s_f * (m_1 + m_2) + s_r * s_r * (m_3 + m_4)
    T = powertrain_step(v, w_out, s_f * (o_1 + o_2) + s_r * (o_3 + o_4), mobility, state, parameter, command, dt)
    T += command[U_APPLIED, v]
    state[TORQUE_DRIVE, v] = T
    front = wheel_turn(0, v, s_f * T, T_front, m_1, wheels, contact, parameter, dt)
    front += wheel_turn(1, v, s_f * T, T_front, m_2, wheels, contact, parameter, dt)
    rear = wheel_turn(2, v, s_r * T, T_rear, m_3, wheels, contact, parameter, dt)
    rear += wheel_turn(3, v, s_r * T, T_rear, m_4, wheels, contact, parameter, dt)
    return -(parameter[J_WF, v] * front + parameter[J_WR, v] * rear) / dt


# --- bodies: forces and motion -------------------------------------------------------------------------------------------


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
    wheels[TRAVEL_RATE, w] = rate
    wheels[TRAVEL, w] += dt * rate


@inlined
def move_step(v, R, a_x, a_y, a_z, dp, dq, dr, state, dt):
    """Velocities first, then position and orientation with the new ones."""
    e, n, u = body.to_world(R, a_x, a_y, a_z)
    state[A_X, v], state[A_Y, v], state[A_Z, v] = a_x, a_y, a_z
    state[V_EAST, v] += dt * e
    state[V_NORTH, v] += dt * n
    state[V_UP, v] += dt * u
    state[X, v] += dt * state[V_EAST, v]
    state[Y, v] += dt * state[V_NORTH, v]
    state[Z, v] += dt * state[V_UP, v]
    state[ROLL_RATE, v] += dt * dp
    state[PITCH_RATE, v] += dt * dq
    state[YAW_RATE, v] += dt * dr
    state[Q_W, v], state[Q_X, v], state[Q_Y, v], state[Q_Z, v] = body.turned(
        state[Q_W, v], state[Q_X, v], state[Q_Y, v], state[Q_Z, v], state[ROLL_RATE, v], state[PITCH_RATE, v],
        state[YAW_RATE, v], dt,
    )  # fmt: skip


@inlined
def forces_step(v, resistance, state, wheels, contact, parameter, dt):
    """Sums of forces and moments, accelerations, new state of body and wheels."""
    R = attitude(v, state)
    f_1, m_1, rest_1 = corner_force(0, v, wheels, contact, parameter)
    f_2, m_2, rest_2 = corner_force(1, v, wheels, contact, parameter)
    f_3, m_3, rest_3 = corner_force(2, v, wheels, contact, parameter)
    f_4, m_4, rest_4 = corner_force(3, v, wheels, contact, parameter)
    v_x = R[0] * state[V_EAST, v] + R[3] * state[V_NORTH, v] + R[6] * state[V_UP, v]
    air = aerodynamics.air_drag(parameter[C_D, v], parameter[AREA, v], v_x)
    g_x, g_y, g_z = -GRAVITY * R[6], -GRAVITY * R[7], -GRAVITY * R[8]
    a_x = (f_1[0] + f_2[0] + f_3[0] + f_4[0] - air) / parameter[MASS, v] + g_x
    a_y = (f_1[1] + f_2[1] + f_3[1] + f_4[1]) / parameter[MASS, v] + g_y
    a_z = (f_1[2] + f_2[2] + f_3[2] + f_4[2]) / parameter[MASS_S, v] + g_z
    dp, dq, dr = body.angular_acceleration(
        m_1[0] + m_2[0] + m_3[0] + m_4[0], m_1[1] + m_2[1] + m_3[1] + m_4[1] + resistance, m_1[2] + m_2[2] + m_3[2] + m_4[2],
        state[ROLL_RATE, v], state[PITCH_RATE, v], state[YAW_RATE, v], parameter[J_X, v], parameter[J_Y, v], parameter[J_Z, v],
    )  # fmt: skip
    move_step(v, R, a_x, a_y, a_z, dp, dq, dr, state, dt)
    travel_step(0, v, rest_1, a_z, dp, dq, g_z, wheels, parameter, dt)
    travel_step(1, v, rest_2, a_z, dp, dq, g_z, wheels, parameter, dt)
    travel_step(2, v, rest_3, a_z, dp, dq, g_z, wheels, parameter, dt)
    travel_step(3, v, rest_4, a_z, dp, dq, g_z, wheels, parameter, dt)


@compiled
def drives(tile, lanes, dt):
    """Fourth pass, first half: actuators, powertrain, wheel spins. The wheels' resistance waits in a row of `contact`."""
    state, wheels, contact = window(tile, STATE_AT, LANES), window(tile, WHEEL_AT, CORNERS), window(tile, CONTACT_AT, CORNERS)
    parameter, command = window(tile, PARAMETER_AT, LANES), window(tile, COMMAND_AT, LANES)
    for v in range(lanes):
        steer_step(v, state, wheels, parameter, command, dt)
        T_front, T_rear = brake_step(v, state, parameter, command, dt)
        contact[SLIP_SPIN, v] = drive_step(v, T_front, T_rear, state, wheels, contact, parameter, command, dt)


@compiled
def bodies(tile, lanes, dt):
    """Fourth pass, second half: forces on the body, new state."""
    state, wheels, contact = window(tile, STATE_AT, LANES), window(tile, WHEEL_AT, CORNERS), window(tile, CONTACT_AT, CORNERS)
    parameter = window(tile, PARAMETER_AT, LANES)
    for v in range(lanes):
        forces_step(v, contact[SLIP_SPIN, v], state, wheels, contact, parameter, dt)


# --- a tick --------------------------------------------------------------------------------------------------------------


@compiled
def derive(v, state):
    """Angles and velocities in the body's axes, as everything outside of here reads them."""
    R = attitude(v, state)
    turn = atan2(R[3], R[0]) - state[PSI, v]
    state[PSI, v] += turn - 2.0 * pi * floor(turn / (2.0 * pi) + 0.5)
    state[PITCH, v] = -asin(min(max(R[6], -1.0), 1.0))
    state[ROLL, v] = atan2(R[7], R[8])
    state[V_X, v], state[V_Y, v], _ = body.to_body(R, state[V_EAST, v], state[V_NORTH, v], state[V_UP, v])


@compiled
def step(tyres, front, rear, tile, lanes, dt):
    """One step of a tile, after the intake."""
    corners(tile, lanes, dt)
    all_tyres(tyres, front, rear, tile, lanes)
    drives(tile, lanes, dt)
    bodies(tile, lanes, dt)


@compiled
def is_row_of(columns, count):
    """Whether the columns stand side by side."""
    return columns[count - 1] - columns[0] == count - 1


@compiled
def integrate_block(columns, front, rear, state, wheels, ground, parameter, tyres, commands, tick_now, tick, dt, tile):
    """All steps of one tick for the vehicles of one block."""
    n, count = state.shape[1], columns.size
    side_by_side = is_row_of(columns, count)
    tiles.load(state, columns, side_by_side, count, 1, len_state, STATE_AT, tile)
    tiles.load(wheels, columns, side_by_side, count, 4, len_wheel, WHEEL_AT, tile)
    tiles.load(ground, columns, side_by_side, count, 4, len_ground, GROUND_AT, tile)
    tiles.load(parameter, columns, side_by_side, count, 1, len_parameter, PARAMETER_AT, tile)
    for i in range(int(ceil(tick / dt - TICK_EPSILON))):
        intake(columns, count, n, parameter, commands, tick_now, i * dt, tick, tile)
        step(tyres, front, rear, tile, tiles.filled_lanes(count), dt)
    tiles.store(state, columns, side_by_side, count, 1, len_state, STATE_AT, tile)
    tiles.store(wheels, columns, side_by_side, count, 4, len_wheel, WHEEL_AT, tile)


len_state, len_wheel, len_ground, len_parameter = len(VEHICLE), len(WHEEL), len(GROUND), len(PARAMETER)


@compiled
def integrate(blocks, order, state, wheels, ground, parameter, tyres, commands, tick_now, tick, dt, tile):
    """All steps of one tick for all blocks."""
    for b in range(blocks.shape[1]):
        columns = order[blocks[0, b] : blocks[0, b] + blocks[1, b]]
        integrate_block(
            columns, blocks[2, b], blocks[3, b], state, wheels, ground, parameter, tyres, commands, tick_now, tick, dt, tile
        )
        for v in columns:
            derive(v, state)
