"""Control: who commands what. Maneuvers of the script, applications and drivers share the actuators.

Order of precedence on pedals and wheel: a scripted maneuver, then the application, then the driver. A driver whose application
drives still brakes for a red light, for a car that merges first, and when a collision is near: an application need see none
of them. What an application does not command stays the driver's.

An acceleration is turned into torques by inverting the resistances: F = m_eff u + F_air + F_roll + m g sin(slope). The
engine gets F R as a request at the wheels, negative ones too; the brake gets what the powertrain does not do.
"""

from math import cos, inf, isnan, nan, sin

from studio.application.contract import ACTUATORS
from studio.compiled import inlined, lean
from studio.conventions import GRAVITY
from studio.model import actuator, aerodynamics
from studio.model.driver import NO_LIMIT
from studio.vehicle.command import RING, U_BRAKE, U_DRIVE, U_ENGINE, U_GEAR, U_PEDAL, U_STEER, U_STEER_TORQUE, U
from studio.vehicle.contact import SLOPE_X, SLOPE_Y
from studio.vehicle.parameter import AREA, C_D, C_ROLL, J_E, J_WF, J_WR, MASS, RADIUS, STEER_MAX
from studio.vehicle.state import A_X, ACCELERATOR, ACTIVE, CLUTCH, DELTA, J_GEAR, PSI, RATIO, TORQUE_DRIVE, V_X, YAW_RATE, X, Y
from studio.world.table.mind import (
    AHEAD_SPEED,
    DRIVES,
    GAP,
    SCRIPT_ACCELERATION,
    SCRIPT_STEERING,
    STEER_WISH,
    STEERS,
    STOPPING,
    V_DESIRED,
    WISH,
    YIELDING,
)  # fmt: skip
from studio.world.table.unit import DETECTED, GPS_EAST, GPS_NORTH, M_INTENTION, M_X, SENT

STRONGEST_BRAKE, STRONGEST_DRIVE = -10.0, 5.0  # [m/s²] bounds of the request interface
HOLD_SPEED = 0.2  # [m/s] below this a car that is not to drive is held by its brakes
EMERGENCY = 4.0  # [m/s²] a driver who would have to brake harder than this does not leave it to an application
EMERGENCY_GAIN = 1.2  # [1] and brakes a little more than is needed
NEAREST = 1.0  # [m] that are to be left
HOLD = 1.0  # [m/s²] by as much as this, beyond what the slope needs
(
    APP_ACCELERATION, APP_STEERING, APP_STEERING_TORQUE, APP_ACCELERATOR, APP_DRIVE, APP_ENGINE, APP_BRAKE, APP_GEAR,
) = range(len(ACTUATORS))  # fmt: skip


@inlined
def emergency(v, state, mind):
    """Acceleration [m/s²] with which a driver brakes when a collision is near, whatever assists; else nothing is asked.

    The deceleration that still avoids it is v²/(2 gap), v the closing speed [m/s]; the last of the gap is never driven into.
    """
    closing, gap = state[V_X, v] - mind[AHEAD_SPEED, v], mind[GAP, v] - NEAREST
    needed = closing * closing / (2.0 * max(gap, 0.01))
    asked = -EMERGENCY_GAIN * max(needed, EMERGENCY)
    return asked if closing >= 0.0 and (needed > EMERGENCY or gap < 0.0) else NO_LIMIT


@inlined
def safe(v, state, mind):
    """Acceleration [m/s²] that lights, cars which go first, and a near collision permit."""
    return min(emergency(v, state, mind), min(mind[STOPPING, v], mind[YIELDING, v]))


@inlined
def request(v, state, mind, app_acceleration):
    """Acceleration [m/s²] that application or driver ask for."""
    u = mind[WISH, v] if isnan(app_acceleration) else min(app_acceleration, safe(v, state, mind))
    return min(max(u, STRONGEST_BRAKE), STRONGEST_DRIVE)


@inlined
def grade(v, state, ground):
    """Rise of the road ahead [1]."""
    if ground[SLOPE_X, v] == 0.0 and ground[SLOPE_Y, v] == 0.0:
        return 0.0
    return ground[SLOPE_X, v] * cos(state[PSI, v]) + ground[SLOPE_Y, v] * sin(state[PSI, v])


@inlined
def effective_mass(v, state, parameter):
    """Mass [kg] with everything that spins; the engine counts while the clutch is closed."""
    joined = parameter[J_E, v] if state[CLUTCH, v] >= 1.0 else 0.0
    spinning = 2.0 * (parameter[J_WF, v] + parameter[J_WR, v]) + (joined + state[J_GEAR, v]) * state[RATIO, v] ** 2
    return parameter[MASS, v] + spinning / (parameter[RADIUS, v] * parameter[RADIUS, v])


@inlined
def wheel_torque(v, u, state, ground, parameter):
    """Torque [Nm] at the wheels that gives the acceleration u [m/s²]."""
    m = parameter[MASS, v]
    air = aerodynamics.air_drag(parameter[C_D, v], parameter[AREA, v], state[V_X, v])
    resistance = parameter[C_ROLL, v] * m * GRAVITY + m * GRAVITY * grade(v, state, ground)
    return actuator.wheel_force(u, effective_mass(v, state, parameter), air, resistance) * parameter[RADIUS, v]


@inlined
def brake_torque(v, T, state):
    """Torque [Nm] that is left to the brakes when T [Nm] is wanted at the wheels: what the powertrain does not take away.

    What still drives while the pedal is pressed is about to fade, and is not braked against.
    """
    fades = state[TORQUE_DRIVE, v] > 0.0 and state[ACCELERATOR, v] > 0.0
    return max((0.0 if fades else state[TORQUE_DRIVE, v]) - T, 0.0)


@inlined
def is_held(v, u, state):
    """Whether a car stands and is to stand."""
    return u <= 0.0 and abs(state[V_X, v]) < HOLD_SPEED


@lean
def holding_torque(v, state, ground, parameter):
    """Brake torque [Nm] that holds a standing car."""
    return parameter[MASS, v] * (HOLD + GRAVITY * abs(grade(v, state, ground))) * parameter[RADIUS, v]


@inlined
def pedals(v, column, u, state, ground, parameter, commands):
    """An acceleration becomes a drive and a brake request."""
    T = wheel_torque(v, u, state, ground, parameter)
    held = is_held(v, u, state)
    commands[U, column] = u
    commands[U_DRIVE, column] = nan if held else T
    commands[U_PEDAL, column] = commands[U_ENGINE, column] = nan
    commands[U_BRAKE, column] = holding_torque(v, state, ground, parameter) if held else brake_torque(v, T, state)


@inlined
def take_over(v, column, state, parameter, mind, app_command, commands):
    """Drive and brake that an application commands itself, unless the driver has to brake."""
    drives = not (isnan(app_command[APP_ACCELERATOR, v]) and isnan(app_command[APP_DRIVE, v]) and isnan(app_command[APP_ENGINE, v]))
    if drives and safe(v, state, mind) >= 0.0:
        commands[U_PEDAL, column] = app_command[APP_ACCELERATOR, v]
        commands[U_DRIVE, column] = app_command[APP_DRIVE, v]
        commands[U_ENGINE, column] = app_command[APP_ENGINE, v]
    if not isnan(app_command[APP_BRAKE, v]):
        others = commands[U_BRAKE, column] if safe(v, state, mind) < 0.0 else 0.0
        commands[U_BRAKE, column] = max(max(app_command[APP_BRAKE, v], 0.0), others)
    if drives or not isnan(app_command[APP_BRAKE, v]):
        T = state[TORQUE_DRIVE, v] - commands[U_BRAKE, column]
        commands[U, column] = T / (parameter[RADIUS, v] * effective_mass(v, state, parameter))


@inlined
def scripted(acceleration):
    """What a maneuver asks for [m/s²], within the bounds of the interface; what is not finite stays so, and ends the run as failed."""
    if not acceleration >= STRONGEST_BRAKE:
        return acceleration if isnan(acceleration) else STRONGEST_BRAKE
    return min(acceleration, STRONGEST_DRIVE)


@inlined
def steer(v, column, parameter, script, mind, app_command, commands):
    """Steering: a torque at the wheel, or an angle; the maneuver's, else the application's, else the driver's."""
    limit = parameter[STEER_MAX, v]
    if script[STEERS, v] != 0.0:
        angle = script[SCRIPT_STEERING, v]
        commands[U_STEER, column] = angle if isnan(angle) else min(max(angle, -limit), limit)
        commands[U_STEER_TORQUE, column] = nan
        return
    angle = mind[STEER_WISH, v] if isnan(app_command[APP_STEERING, v]) else app_command[APP_STEERING, v]
    commands[U_STEER, column] = min(max(angle, -limit), limit)
    commands[U_STEER_TORQUE, column] = app_command[APP_STEERING_TORQUE, v]


@lean
def command(k, state, ground, parameter, script, mind, app_command, commands):
    """Writes this tick's commands into the ring."""
    n = state.shape[1]
    for v in range(n):
        column = (k % RING) * n + v
        steer(v, column, parameter, script, mind, app_command, commands)
        commands[U_GEAR, column] = app_command[APP_GEAR, v]
        if state[ACTIVE, v] == 0.0:
            pedals(v, column, STRONGEST_BRAKE, state, ground, parameter, commands)
        elif script[DRIVES, v] != 0.0:
            pedals(v, column, scripted(script[SCRIPT_ACCELERATION, v]), state, ground, parameter, commands)
        else:
            pedals(v, column, request(v, state, mind, app_command[APP_ACCELERATION, v]), state, ground, parameter, commands)
            take_over(v, column, state, parameter, mind, app_command, commands)


@lean
def observe(time, tick, columns, links, state, mind, sensors, inbox, observed):
    """What the applications of one group see, in the order of an Observation's fields."""
    for j in range(columns.size):
        v = columns[j]
        observed[0, j] = time
        observed[1, j] = tick
        observed[2, j] = state[V_X, v]
        observed[3, j] = state[A_X, v]
        observed[4, j] = state[YAW_RATE, v]
        observed[5, j] = state[DELTA, v]
        observed[6, j] = mind[V_DESIRED, v]
        observed[7, j] = mind[WISH, v]
        observed[8, j] = state[X, v] + sensors[GPS_EAST, v]
        observed[9, j] = state[Y, v] + sensors[GPS_NORTH, v]
        for i in range(4):
            observed[10 + i, j] = sensors[i, v] if sensors[DETECTED, v] > 0.0 else 0.0
        observe_message(time, links[j], inbox, observed, j)


@lean
def observe_message(time, link, inbox, observed, j):
    """The newest message of the unit that car j listens to."""
    observed[14, j] = 0.0
    observed[15, j] = time
    if link >= 0 and inbox[SENT, link] > -inf:
        observed[14, j] = 1.0
        observed[15, j] = time - inbox[SENT, link]
        for i in range(M_X, M_INTENTION + 1):
            observed[15 + i, j] = inbox[i, link]
