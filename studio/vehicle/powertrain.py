"""Actuators and powertrain of one vehicle, lane v of a tile: steering, brakes, engine, coupling, gearbox, wheel spins."""

from studio.compiled import inlined
from studio.model import brake, coupling, engine, steering, transmission, wheel
from studio.vehicle.command import U_APPLIED, U_APPLIED_BRAKE, U_BRAKE, U_DRIVE, U_ENGINE, U_PEDAL, U_STEER, U_STEER_TORQUE
from studio.vehicle.contact import PEAK, ROLLING, SPIN_SLOPE
from studio.vehicle.corner import at_axle
from studio.vehicle.parameter import (
    BRAKE_MAX,
    BRAKE_SHARE,
    CAPACITY,
    CLUTCHED,
    CONVERTER,
    COUPLING,
    CURVE,
    CURVE_0,
    D_STEER,
    DRAG,
    DRAG_SLOPE,
    DRIVE_SHARE,
    FLUID_1,
    FLUID_2,
    FLUID_3,
    FLUID_RATIO,
    IDLE,
    J_E,
    J_STEER,
    J_WF,
    J_WR,
    K_BRAKE,
    KNOT,
    LAUNCH,
    LIMIT,
    LOSS_SHARE,
    LOSS_TORQUE,
    PUMP_1,
    PUMP_2,
    PUMP_3,
    RADIUS,
    REGEN,
    RIGID,
    STEER_MAX,
    STEER_RATE,
    STEER_RATIO,
    TAU_BRAKE,
    TAU_DRIVE,
    TAU_STEER,
    TRAIL,
    TURBINE_1,
    TURBINE_2,
    TURBINE_3,
    UNASSISTED,
)  # fmt: skip
from studio.vehicle.state import (
    ACCELERATOR,
    CLUTCH,
    CLUTCH_RATE,
    DELTA,
    DELTA_RATE,
    F_X,
    F_Y,
    J_GEAR,
    KAPPA,
    M_Z,
    NEXT_RATIO,
    OMEGA,
    OMEGA_E,
    PRESSURE_F,
    PRESSURE_R,
    RATIO,
    RATIO_RATE,
    ROTATION,
    T_ENGINE,
    TORQUE_BRAKE,
    TORQUE_DRIVE,
)  # fmt: skip
from studio.vehicle.tile import LANES

# --- steering and brakes -------------------------------------------------------------------------------------------------


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
    held, held_rate = steering.by_angle(state[DELTA, v], command[U_STEER, v], parameter[TAU_STEER, v], parameter[STEER_RATE, v], dt)
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


# --- engine, coupling, gearbox -------------------------------------------------------------------------------------------


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
def for_wheels(v, T_wheels, w_in, i, T_ratio, parameter):
    """Engine torque [Nm] that brings the drive torque T_wheels [Nm] to the wheels: ratio, converter and losses undone."""
    T = T_wheels / ((i if i != 0.0 else 1.0) * T_ratio) + transmission.constant_loss(w_in, parameter[LOSS_TORQUE, v])
    return T / transmission.efficiency(T, parameter[LOSS_SHARE, v]) if i != 0.0 else 0.0


@inlined
def request(v, w_in, i, T_ratio, T_drag, T_curve, parameter, command):
    """Engine torque [Nm] that is asked for: directly, as a drive torque at the wheels, or by the pedal."""
    T_engine, T_wheels, pedal = command[U_ENGINE, v], command[U_DRIVE, v], command[U_PEDAL, v]
    by_wheels = for_wheels(v, T_wheels, w_in, i, T_ratio, parameter)
    by_pedal = engine.by_pedal(pedal if pedal == pedal else 0.0, T_drag, T_curve)
    return T_engine if T_engine == T_engine else (by_wheels if T_wheels == T_wheels else by_pedal)


@inlined
def engine_step(v, w_out, slip, T_p, T_t, T_cap, state, parameter, command, dt):
    """The engine's torque moves towards the request, bounded by what the engine can and the coupling should."""
    w, i = state[OMEGA_E, v], state[RATIO, v]
    T_drag = engine.drag(w, parameter[DRAG, v], parameter[DRAG_SLOPE, v])
    T_curve = full_curve(w, v, parameter)
    T_full = engine.full_load(w, T_curve, T_drag, parameter[LIMIT, v])
    T = request(v, i * w_out, i, torque_ratio(T_p, T_t, v, parameter), T_drag, T_curve, parameter, command)
    pedal = engine.pedal_for(T, T_drag, T_curve)
    slips = parameter[COUPLING, v] == CLUTCHED and state[CLUTCH, v] < 1.0
    w_next = abs(state[NEXT_RATIO, v] * w_out)
    w_wanted = max(w_next, launch_speed(v, pedal, parameter))
    T_slips = engine.governed(T, w, w_wanted, T_cap, parameter[J_E, v])
    is_out = i == 0.0 and w_next > 0.0
    T_slips = engine.matched(T_slips, w, w_next, parameter[J_E, v]) if is_out else T_slips
    T = T_slips if slips else T
    hands_over = parameter[COUPLING, v] == CONVERTER and w_next > abs(i * w_out)
    T = engine.matched(T, w, parameter[FLUID_RATIO, v] * w_next, parameter[J_E, v]) if hands_over else T
    T = engine.idled(T, w, parameter[IDLE, v], parameter[J_E, v])
    T_low = engine.lowest(w, T_drag, parameter[REGEN, v] * engine.taken_back(slip))
    state[ACCELERATOR, v] = pedal
    state[T_ENGINE, v] = engine.torque(state[T_ENGINE, v], T, T_low, T_full, parameter[TAU_DRIVE, v], dt)


@inlined
def converter_torques(v, w_in, state, parameter):
    """Torques of pump and turbine with their slopes; none in neutral, and none without a converter (zero coefficients)."""
    g = 1.0 if state[RATIO, v] != 0.0 else 0.0
    T_p, T_t, P_e, P_t, Q_e, Q_t = coupling.converter(
        state[OMEGA_E, v], w_in, parameter[PUMP_1, v], parameter[PUMP_2, v], parameter[PUMP_3, v], parameter[TURBINE_1, v],
        parameter[TURBINE_2, v], parameter[TURBINE_3, v], parameter[FLUID_1, v], parameter[FLUID_2, v], parameter[FLUID_3, v],
        parameter[FLUID_RATIO, v],
    )  # fmt: skip
    return g * T_p, g * T_t, g * P_e, g * P_t, g * Q_e, g * Q_t


@inlined
def launch_speed(v, pedal, parameter):
    """Engine speed [rad/s] that a slipping clutch wants at a pedal position: between idle and that of a full-load start."""
    return parameter[IDLE, v] + pedal * (parameter[LAUNCH, v] - parameter[IDLE, v])


@inlined
def clutch_capacity(v, state, parameter):
    """Torque [Nm] that clutch or lock-up can carry now; none in neutral."""
    u_c, T_cap, w_idle = state[CLUTCH, v], parameter[CAPACITY, v], parameter[IDLE, v]
    automated = coupling.capacity(u_c, T_cap, state[OMEGA_E, v], w_idle, launch_speed(v, state[ACCELERATOR, v], parameter))
    carried = automated if parameter[COUPLING, v] == CLUTCHED else u_c * T_cap
    return carried if state[RATIO, v] != 0.0 else 0.0


@inlined
def ratio_step(v, state, dt):
    """The ratio, which moves to the next one while the clutches of an automatic gearbox hand over."""
    change = state[RATIO_RATE, v] * dt
    i = state[RATIO, v] + min(max(state[NEXT_RATIO, v] - state[RATIO, v], -change), change)
    state[RATIO, v] = i
    return i


@inlined
def powertrain_step(v, w_out, slip, w_free, mobility, state, parameter, command, dt):
    """Engine, coupling and gearbox; returns the drive torque [Nm], sum of the wheels.

    w_out [rad/s] mean speed of the driven wheels, slip [1] their mean slip, w_free what the speed would be without drive, mobility
    its change per torque and time [1/(kg m²)].
    """
    i, J_g, J_e, w_e = ratio_step(v, state, dt), state[J_GEAR, v], parameter[J_E, v], state[OMEGA_E, v]
    w_in, B = i * w_out, i * i * mobility
    torques = converter_torques(v, w_in, state, parameter)
    T_cap = clutch_capacity(v, state, parameter)
    engine_step(v, w_out, slip, torques[0], torques[1], T_cap, state, parameter, command, dt)
    eta = transmission.efficiency(state[T_ENGINE, v], parameter[LOSS_SHARE, v])
    T_loss = transmission.constant_loss(w_in, parameter[LOSS_TORQUE, v])
    free = transmission.input_free(i * w_free, B, w_in, 0.0, J_g, dt)
    D_e, D_in, T_in = coupling.join(
        w_e, w_in, state[T_ENGINE, v], T_loss, T_cap, eta, J_e, free, transmission.input_mobility(B, J_g), torques, dt
    )
    state[CLUTCH, v] = min(max(state[CLUTCH, v] + dt * state[CLUTCH_RATE, v], 0.0), 1.0)
    state[OMEGA_E, v] = w_e + D_e if parameter[COUPLING, v] == RIGID else max(w_e + D_e, 0.0)
    T_out = transmission.efficiency(T_in, parameter[LOSS_SHARE, v]) * T_in - T_loss
    return transmission.output_torque(T_out, J_g, D_in / dt, i)


# --- wheels --------------------------------------------------------------------------------------------------------------


@inlined
def wheel_free(corner, v, T_drive, T_brake, wheels, contact, parameter, dt):
    """Spin [rad/s] of a wheel after dt without drive, and 1/inertia [1/(kg m²)] that it shows to a drive meanwhile.

    A wheel that stands, and is held by its brake against the drive torque T_drive [Nm] of the step before, shows none.
    """
    w, R = corner * LANES + v, parameter[RADIUS, v]
    I = wheel.implicit_inertia(parameter[at_axle(corner, J_WF, J_WR), v], R, contact[SPIN_SLOPE, w], dt)
    T_friction = T_brake + contact[ROLLING, w]
    stands = wheels[OMEGA, w] == 0.0 and abs(T_drive - R * wheels[F_X, w]) < T_friction
    return wheel.spin(wheels[OMEGA, w], wheels[F_X, w], 0.0, T_friction, R, I, dt), 0.0 if stands else 1.0 / I


@inlined
def wheel_turn(corner, v, T_drive, T_brake, wheels, contact, parameter, dt):
    """Spins a wheel on; its tyre force is corrected to the end of the step. Returns the change of its spin [rad/s].

    Where the correction would carry the force beyond its peak, the tyre slides: the peak is all there is to spin against.
    """
    w, R, omega = corner * LANES + v, parameter[RADIUS, v], wheels[OMEGA, corner * LANES + v]
    J, T_friction, peak = parameter[at_axle(corner, J_WF, J_WR), v], T_brake + contact[ROLLING, w], contact[PEAK, w]
    I = wheel.implicit_inertia(J, R, contact[SPIN_SLOPE, w], dt)
    new = wheel.spin(omega, wheels[F_X, w], T_drive, T_friction, R, I, dt)
    F = wheels[F_X, w] + contact[SPIN_SLOPE, w] * (new - omega)
    F_held = min(max(F, -peak), peak)
    sliding = wheel.spin(omega, F_held, T_drive, T_friction, R, J, dt)
    new = new if F_held == F else sliding
    wheels[OMEGA, w] = new
    wheels[ROTATION, w] += new * dt
    wheels[F_X, w] = F_held
    return new - omega


@inlined
def drive_step(v, T_front, T_rear, state, wheels, contact, parameter, command, dt):
    """Powertrain and wheel spins; returns the moment [Nm] about the body's y axis with which the wheels resist."""
    s_f, s_r, T = 0.5 * parameter[DRIVE_SHARE, v], 0.5 * (1.0 - parameter[DRIVE_SHARE, v]), state[TORQUE_DRIVE, v]
    o_1, m_1 = wheel_free(0, v, s_f * T, T_front, wheels, contact, parameter, dt)
    o_2, m_2 = wheel_free(1, v, s_f * T, T_front, wheels, contact, parameter, dt)
    o_3, m_3 = wheel_free(2, v, s_r * T, T_rear, wheels, contact, parameter, dt)
    o_4, m_4 = wheel_free(3, v, s_r * T, T_rear, wheels, contact, parameter, dt)
    mobility = s_f * s_f * (m_1 + m_2) + s_r * s_r * (m_3 + m_4)
    w_out = s_f * (wheels[OMEGA, v] + wheels[OMEGA, LANES + v]) + s_r * (wheels[OMEGA, 2 * LANES + v] + wheels[OMEGA, 3 * LANES + v])
    slip = s_f * (wheels[KAPPA, v] + wheels[KAPPA, LANES + v]) + s_r * (wheels[KAPPA, 2 * LANES + v] + wheels[KAPPA, 3 * LANES + v])
    w_free = s_f * (o_1 + o_2) + s_r * (o_3 + o_4)
    T = powertrain_step(v, w_out, slip, w_free, mobility, state, parameter, command, dt)
    T += command[U_APPLIED, v]
    state[TORQUE_DRIVE, v] = T
    front = wheel_turn(0, v, s_f * T, T_front, wheels, contact, parameter, dt)
    front += wheel_turn(1, v, s_f * T, T_front, wheels, contact, parameter, dt)
    rear = wheel_turn(2, v, s_r * T, T_rear, wheels, contact, parameter, dt)
    rear += wheel_turn(3, v, s_r * T, T_rear, wheels, contact, parameter, dt)
    return -(parameter[J_WF, v] * front + parameter[J_WR, v] * rear) / dt
