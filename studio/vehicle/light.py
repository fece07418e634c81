"""Light vehicles: one tick of all of them, each in one step of a tick (model/light.py).

They stand in the same arrays as full ones, and fill the same rows as far as they know them. They have no engine speed and no gears but
forward, neutral and reverse; their wheels roll without slip, and what single tyres transmit is not known.
"""

from math import asin, atan2, isfinite, sqrt
from typing import NamedTuple

from studio.compiled import inlined, lean
from studio.conventions import GRAVITY
from studio.model import aerodynamics, body, engine, light, wheel
from studio.model.elementary import cos, sin
from studio.model.gearbox import WALKING
from studio.rows import Role, Table
from studio.vehicle.command import RING, U_BRAKE, U_DRIVE, U_GEAR, U_PEDAL, U_STEER
from studio.vehicle.contact import HEIGHT, MU, SLOPE_X, SLOPE_Y
from studio.vehicle.motion import slot
from studio.vehicle.parameter import (
    AREA,
    BRAKE_MAX,
    C_D,
    C_ROLL,
    DELAY_BRAKE,
    DELAY_DRIVE,
    K_BRAKE,
    L_F,
    L_R,
    MASS,
    RADIUS,
    STATIC_F,
    STATIC_R,
    STEER_MAX,
    STEER_RATE,
    TAU_BRAKE,
    TAU_DRIVE,
    TAU_STEER,
    H,
)  # fmt: skip
from studio.vehicle.state import (
    A_X,
    A_Y,
    ACCELERATOR,
    BEND,
    BEND_BEGUN,
    DELTA,
    DELTA_RATE,
    GEAR,
    NEXT_GEAR,
    OMEGA,
    OMEGA_E,
    PITCH,
    PRESSURE_F,
    PRESSURE_R,
    PSI,
    Q_W,
    Q_X,
    Q_Y,
    Q_Z,
    ROLL,
    ROTATION,
    T_ENGINE,
    TORQUE_BRAKE,
    TORQUE_DRIVE,
    V_EAST,
    V_NORTH,
    V_UP,
    V_X,
    V_Y,
    YAW_RATE,
    X,
    Y,
    Z,
)  # fmt: skip

UNKNOWN = (OMEGA_E, T_ENGINE)  # rows of the state that a light vehicle has no values for
KNOTS, KNOT_SPEED = 32, 2.5  # of the force over speed, and [m/s] from one to the next

LIGHT = Table("light", Role.PARAMETER, per="light vehicle")
EFFECTIVE_MASS = LIGHT.row("effective_mass", "kg", "with the wheels, which turn")
UNDERSTEER = LIGHT.row("understeer", "rad s²/m", "slip angle of the front axle less that of the rear per lateral acceleration")
REAR_SLIP = LIGHT.row("rear_slip", "rad s²/m", "slip angle of the rear axle per lateral acceleration")
YAW_TIME = LIGHT.row("yaw_time", "s²/m", "in each half of which a bend is taken up, per speed, without understeer")
ALONG = LIGHT.row("adhesion_along", "1", "greatest force along over the load, friction 1")
ACROSS = LIGHT.row("adhesion_across", "1", "greatest force across over the load, friction 1")
TRACTION = LIGHT.row("traction", "1", "part of the weight that counts for the drive")
BACKWARDS = LIGHT.row("force_backwards", "N", "greatest of the drive in reverse")
FORCE_0 = LIGHT.block("force", KNOTS, "N", "greatest of the drive at speeds 2.5 m/s apart, from standstill")


class Motion(NamedTuple):
    """What a step makes of a light vehicle, in the units of the rows of the same names."""

    steering: float
    brake_pressure: float
    drive_torque: float
    speed: float
    bend_begun: float
    bend: float
    yaw_rate: float
    heading: float
    lateral_speed: float
    x: float
    y: float
    acceleration: float
    lateral_acceleration: float


# --- along ---------------------------------------------------------------------------------------------------------------


@inlined
def greatest_force(j, v_x, rows):
    """Force [N] that the drive of light vehicle j can give at a speed [m/s]."""
    at = min(abs(v_x) * (1.0 / KNOT_SPEED), KNOTS - 1.001)
    i = int(at)
    return rows[FORCE_0 + i, j] + (at - i) * (rows[FORCE_0 + i + 1, j] - rows[FORCE_0 + i, j])


@inlined
def gear_of(v, request, state):
    """-1, 0 or 1: as requested, forwards when nothing is; nobody changes between forward and reverse at speed."""
    wanted = 1.0 if request != request else min(max(request, -1.0), 1.0)
    harms = wanted * state[GEAR, v] < 0.0 and abs(state[V_X, v]) > WALKING
    return state[GEAR, v] if harms else float(int(wanted))


@inlined
def asked_torque(v, column, gear, most, commands):
    """Drive torque [Nm] at the wheels that is asked for, by itself or by the pedal, of `most` that there is."""
    T, pedal = commands[U_DRIVE, column], commands[U_PEDAL, column]
    by_pedal = gear * engine.by_pedal(pedal if pedal == pedal else 0.0, 0.0, most)
    T = T if T == T else by_pedal
    return min(max(T, -most if gear < 0.0 else 0.0), most if gear > 0.0 else 0.0)


@inlined
def friction_of(v, n, ground, parameter):
    """Friction [1] under a vehicle: the mean of its wheels by their loads at rest."""
    front = parameter[STATIC_F, v] * (ground[MU, v] + ground[MU, n + v])
    rear = parameter[STATIC_R, v] * (ground[MU, 2 * n + v] + ground[MU, 3 * n + v])
    return (front + rear) / (2.0 * (parameter[STATIC_F, v] + parameter[STATIC_R, v]))


# --- across, and where it goes -------------------------------------------------------------------------------------------


@inlined
def step(v, j, n, now, drive_at, brake_at, rises, dt, state, ground, parameter, rows, commands):
    """One vehicle after dt: all that changes by itself. `rises` is the sine of the slope ahead; the last three are columns of commands."""
    p, v_x, bend, psi = parameter, state[V_X, v], state[BEND, v], state[PSI, v]
    R, m, m_eff, L = p[RADIUS, v], p[MASS, v], rows[EFFECTIVE_MASS, j], p[L_F, v] + p[L_R, v]
    gear = gear_of(v, commands[U_GEAR, now], state)
    most = R * (greatest_force(j, v_x, rows) if gear > 0.0 else rows[BACKWARDS, j])
    # What the actuators do meanwhile, on average.
    delta = light.turned(state[DELTA, v], commands[U_STEER, now], p[TAU_STEER, v], p[STEER_RATE, v], dt)
    delta = min(max(delta, -p[STEER_MAX, v]), p[STEER_MAX, v])
    T = light.taken_up(state[TORQUE_DRIVE, v], asked_torque(v, drive_at, gear, most, commands), p[TAU_DRIVE, v], dt)
    T_brake = min(max(commands[U_BRAKE, brake_at], 0.0), p[BRAKE_MAX, v])
    P = light.taken_up(state[PRESSURE_F, v], T_brake / p[K_BRAKE, v], p[TAU_BRAKE, v], dt)
    # What the tyres can of it.
    mu, N = friction_of(v, n, ground, p), m * GRAVITY
    along, across = rows[ALONG, j] * mu * N, rows[ACROSS, j] * mu * N
    F_drive = 0.5 * (state[TORQUE_DRIVE, v] + T) / R
    F_drive = min(max(F_drive, -rows[TRACTION, j] * along), rows[TRACTION, j] * along)
    F_brake = 0.5 * (state[PRESSURE_F, v] + P) * p[K_BRAKE, v] / R
    asked = light.bend(0.5 * (state[DELTA, v] + delta), L, rows[UNDERSTEER, j], v_x)
    f_x, force = (abs(F_drive) + F_brake) / along, m * v_x * v_x
    s = light.share(f_x, force * asked / across)
    # Speed.
    air = aerodynamics.air_drag(p[C_D, v], p[AREA, v], v_x)
    F_roll = wheel.rolling_torque(p[C_ROLL, v], N, 1.0, v_x)
    speed = light.speed_after(v_x, (s * F_drive - air - N * rises) / m_eff, (s * F_brake + F_roll) / m_eff, dt)
    v_mean = 0.5 * (v_x + speed)
    # Bend, heading and place: the rear axle goes along its course, the body leans into the bend by its slip.
    tau = light.bend_time(v_mean, L, rows[UNDERSTEER, j], rows[YAW_TIME, j])
    begun = light.taken_up(state[BEND_BEGUN, v], s * asked, tau, dt)
    kappa = light.taken_up(bend, 0.5 * (state[BEND_BEGUN, v] + begun), tau, dt)
    widest = light.left_across(s * f_x) * across / max(force, 1.0)
    kappa = min(max(kappa, -widest), widest)
    before, after = light.leant(v_x, bend, rows[REAR_SLIP, j]), light.leant(speed, kappa, rows[REAR_SLIP, j])
    turn = v_mean * 0.5 * (bend + kappa) * dt
    psi_new, course = psi + turn + after - before, psi - before + 0.5 * turn
    r = speed * kappa + (after - before) / dt
    v_y = p[L_R, v] * r - speed * after
    way = v_mean * dt * (1.0 - 0.5 * rises * rises)
    x = state[X, v] + way * cos(course) + p[L_R, v] * (cos(psi_new) - cos(psi))
    y = state[Y, v] + way * sin(course) + p[L_R, v] * (sin(psi_new) - sin(psi))
    a_x = (speed - v_x) / dt - r * v_y
    a_y = (v_y - state[V_Y, v]) / dt + r * speed
    return Motion(delta, P, T, speed, begun, kappa, r, psi_new, v_y, x, y, a_x, a_y), gear, most


@inlined
def is_sound(m):
    """Whether all of it is finite."""
    return isfinite(m.steering + m.brake_pressure + m.drive_torque + m.speed + m.bend_begun + m.bend + m.heading + m.x + m.y)


# --- the rows that others read -------------------------------------------------------------------------------------------


@inlined
def put(v, n, m, gear, most, dt, state, wheels, parameter):
    """Writes a step down, but for the attitude."""
    state[DELTA_RATE, v] = (m.steering - state[DELTA, v]) / dt
    state[DELTA, v], state[BEND_BEGUN, v], state[BEND, v] = m.steering, m.bend_begun, m.bend
    state[PRESSURE_F, v], state[PRESSURE_R, v] = m.brake_pressure, m.brake_pressure
    state[TORQUE_BRAKE, v] = parameter[K_BRAKE, v] * m.brake_pressure
    state[TORQUE_DRIVE, v] = m.drive_torque
    state[ACCELERATOR, v] = engine.pedal_for(abs(m.drive_torque), 0.0, most)
    state[GEAR, v], state[NEXT_GEAR, v] = gear, gear
    state[X, v], state[Y, v], state[PSI, v] = m.x, m.y, m.heading
    state[YAW_RATE, v], state[V_X, v], state[V_Y, v] = m.yaw_rate, m.speed, m.lateral_speed
    state[A_X, v], state[A_Y, v] = m.acceleration, m.lateral_acceleration
    spin = m.speed / parameter[RADIUS, v]
    for corner in range(4):
        wheels[ROTATION, corner * n + v] += 0.5 * (wheels[OMEGA, corner * n + v] + spin) * dt
        wheels[OMEGA, corner * n + v] = spin


@inlined
def stand(v, n, g_x, g_y, state, ground, parameter):
    """Attitude, height and velocity in the world of a vehicle on the plane between its axles."""
    half = 0.5 * state[PSI, v]
    c, s = cos(half), sin(half)
    state[Q_W, v], state[Q_X, v], state[Q_Y, v], state[Q_Z, v] = body.standing(g_x, g_y, c, s)
    R = body.rotation(state[Q_W, v], state[Q_X, v], state[Q_Y, v], state[Q_Z, v])
    is_level = g_x == 0.0 and g_y == 0.0
    state[PITCH, v] = 0.0 if is_level else -asin(min(max(R[6], -1.0), 1.0))
    state[ROLL, v] = 0.0 if is_level else atan2(R[7], R[8])
    level = 0.5 * (ground[HEIGHT, v] + ground[HEIGHT, 2 * n + v])
    state[Z, v] = level + g_x * state[X, v] + g_y * state[Y, v] + parameter[H, v] / R[8]
    state[V_EAST, v], state[V_NORTH, v], state[V_UP, v] = body.to_world(R, state[V_X, v], state[V_Y, v], 0.0)


@inlined
def slopes(v, n, ground):
    """Rise of the road to the east and to the north [1], the mean of both axles' planes."""
    w = 2 * n + v
    return 0.5 * (ground[SLOPE_X, v] + ground[SLOPE_X, w]), 0.5 * (ground[SLOPE_Y, v] + ground[SLOPE_Y, w])


@inlined
def rise(g_x, g_y, psi):
    """Sine of the slope ahead."""
    ahead = 0.0 if g_x == 0.0 and g_y == 0.0 else g_x * cos(psi) + g_y * sin(psi)
    return ahead / sqrt(1.0 + ahead * ahead)


# --- a tick --------------------------------------------------------------------------------------------------------------


@inlined
def moved(j, columns, tick_now, tick, state, ground, parameter, rows, commands):
    """What a tick makes of light vehicle j. Dead times are looked back over from the middle of the tick."""
    v, n = columns[j], state.shape[1]
    now, middle = (tick_now & (RING - 1)) * n + v, 0.5 * tick
    drive_at = slot(tick_now, middle, parameter[DELAY_DRIVE, v], tick) * n + v
    brake_at = slot(tick_now, middle, parameter[DELAY_BRAKE, v], tick) * n + v
    g_x, g_y = slopes(v, n, ground)
    rises = rise(g_x, g_y, state[PSI, v])
    return step(v, j, n, now, drive_at, brake_at, rises, tick, state, ground, parameter, rows, commands)


@lean
def move(columns, state, wheels, ground, parameter, rows, commands, tick_now, tick, broken):
    """All light vehicles, whose columns are given, to the end of tick `tick_now` of length `tick` [s].

    One of which something is not finite is marked as broken, and stays as it was.
    """
    n = state.shape[1]
    for j in range(columns.size):
        v = columns[j]
        m, gear, most = moved(j, columns, tick_now, tick, state, ground, parameter, rows, commands)
        broken[v] = 0 if is_sound(m) else 1
        if broken[v] == 0:
            put(v, n, m, gear, most, tick, state, wheels, parameter)
            g_x, g_y = slopes(v, n, ground)
            stand(v, n, g_x, g_y, state, ground, parameter)


@lean
def attempt(j, columns, state, ground, parameter, rows, commands, tick_now, tick):
    """What a tick would make of light vehicle j."""
    m, _, _ = moved(j, columns, tick_now, tick, state, ground, parameter, rows, commands)
    return m
