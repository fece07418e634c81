"""Control: who commands what. Maneuvers of the script, applications and drivers share the actuators.

Order of precedence on pedals and wheel: a scripted maneuver, then the application, then the driver. What an application does not
command stays the driver's. He overrules it only where the scenario says so (intervention.py).

An acceleration is turned into torques by inverting the resistances: F = m_eff u + F_air + F_roll + m g sin(slope). The
engine gets F R as a request at the wheels, negative ones too; the brake gets what the powertrain cannot do: what a motor takes back is
bounded by what it can, and by what the wheels that it brakes hold (studio/model/engine.py).
"""

from math import cos, isnan, nan, sin

from studio.application.port import ACTUATORS
from studio.compiled import inlined, lean
from studio.conventions import GRAVITY
from studio.model import actuator, aerodynamics, engine, transmission
from studio.model.driver import NO_LIMIT
from studio.model.gearbox import WALKING
from studio.vehicle.command import RING, U_BRAKE, U_DRIVE, U_ENGINE, U_GEAR, U_PEDAL, U_STEER, U_STEER_TORQUE, U
from studio.vehicle.contact import SLOPE_X, SLOPE_Y
from studio.vehicle.parameter import (
    AREA,
    C_D,
    C_ROLL,
    DRAG,
    DRAG_SLOPE,
    IDLE,
    J_E,
    J_WF,
    J_WR,
    LOSS_SHARE,
    LOSS_TORQUE,
    MASS,
    RADIUS,
    REGEN,
    STEER_MAX,
)  # fmt: skip
from studio.vehicle.state import ACCELERATOR, ACTIVE, CLUTCH, J_GEAR, OMEGA_E, PSI, RATIO, TORQUE_DRIVE, V_X
from studio.world.passes.intervention import attended, is_minding, let_go
from studio.world.table.mind import (
    COMMANDS_BRAKE,
    COMMANDS_DRIVE,
    COMMANDS_GEAR,
    COMMANDS_WHEEL,
    DRIVER_HAS,
    DRIVES,
    GEARBOX_HAS,
    INTERVENTION_HAS,
    SCRIPT_ACCELERATION,
    SCRIPT_HAS,
    SCRIPT_STEERING,
    STEER_WISH,
    STEERS,
    WISH,
)  # fmt: skip

STRONGEST_BRAKE, STRONGEST_DRIVE = -10.0, 5.0  # [m/s²] bounds of the request interface
HOLD_SPEED = 0.2  # [m/s] below this a car that is not to drive is held by its brakes
IDLING = 1.05  # times the idle speed, below which an engine only idles
HOLD = 1.0  # [m/s²] by as much as this, beyond what the slope needs
(
    APP_ACCELERATION, APP_STEERING, APP_STEERING_TORQUE, APP_ACCELERATOR, APP_DRIVE, APP_ENGINE, APP_BRAKE, APP_GEAR,
) = range(len(ACTUATORS))  # fmt: skip
AUTHORS = len(ACTUATORS)  # behind them, row by row, the number of the application that commands each


@inlined
def drives(v, app_command):
    """Whether an application commands the powertrain itself."""
    return not (isnan(app_command[APP_ACCELERATOR, v]) and isnan(app_command[APP_DRIVE, v]) and isnan(app_command[APP_ENGINE, v]))


@inlined
def has_pedals(v, app_command):
    """Whether an application commands anything that pedals are for."""
    return drives(v, app_command) or not (isnan(app_command[APP_ACCELERATION, v]) and isnan(app_command[APP_BRAKE, v]))


@lean
def permitted(v, time, is_left_alone, state, parameter, drivers, mind, app_command):
    """Acceleration [m/s²] that the driver permits the application; one that asks for torques is taken to ask for any."""
    if is_left_alone or not has_pedals(v, app_command):
        let_go(v, mind)
        return NO_LIMIT
    asked = app_command[APP_ACCELERATION, v]
    return attended(v, time, NO_LIMIT if isnan(asked) else asked, state, parameter, drivers, mind)


@inlined
def request(v, limit, mind, app_acceleration):
    """Acceleration [m/s²] that application or driver ask for, and the driver permits."""
    u = mind[WISH, v] if isnan(app_acceleration) else app_acceleration
    return min(max(min(u, limit), STRONGEST_BRAKE), STRONGEST_DRIVE)


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
def driven_slip(v, state, parameter):
    """Slip [1] of the driven wheels, by the engine's speed, which is theirs while clutch and gear join them."""
    turning = parameter[RADIUS, v] * state[OMEGA_E, v] / state[RATIO, v]
    return (turning - state[V_X, v]) / max(state[V_X, v], WALKING)


@inlined
def least_joined(v, state, parameter):
    """Torque [Nm] at the wheels with the pedal lifted, or with all that a motor takes back, but for what turns with the engine."""
    w = state[OMEGA_E, v]
    taken_back = parameter[REGEN, v] * engine.taken_back(driven_slip(v, state, parameter))
    T = engine.lowest(w, engine.drag(w, parameter[DRAG, v], parameter[DRAG_SLOPE, v]), taken_back)
    carried = transmission.efficiency(T, parameter[LOSS_SHARE, v]) * T - transmission.constant_loss(w, parameter[LOSS_TORQUE, v])
    return carried * state[RATIO, v]


@inlined
def least_torque(v, state, parameter):
    """Torque [Nm] at the wheels that is left when no drive is asked for: known where engine and wheels are one, else as it is now.

    What still drives though the wheels turn faster than an idling engine, or while the engine turns faster than it would idle with the
    pedal pressed, is about to fade. An idling engine creeps on, whatever share of its own drag is asked for.
    """
    if state[CLUTCH, v] >= 1.0 and state[RATIO, v] > 0.0:
        return least_joined(v, state, parameter)
    idles = state[ACCELERATOR, v] == 0.0 or state[OMEGA_E, v] < IDLING * parameter[IDLE, v]
    creeps = idles and state[RATIO, v] * state[V_X, v] < parameter[IDLE, v] * parameter[RADIUS, v]
    return 0.0 if state[TORQUE_DRIVE, v] > 0.0 and not creeps else state[TORQUE_DRIVE, v]


@inlined
def brake_torque(v, T, state, parameter):
    """Torque [Nm] that is left to the brakes when T [Nm] is wanted at the wheels: what the powertrain cannot take away."""
    return max(least_torque(v, state, parameter) - T, 0.0)


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
    commands[U_BRAKE, column] = holding_torque(v, state, ground, parameter) if held else brake_torque(v, T, state, parameter)


@inlined
def take_over(v, column, limit, state, parameter, app_command, commands):
    """Drive and brake that an application commands itself, unless the driver has to brake."""
    driven, braked = drives(v, app_command), not isnan(app_command[APP_BRAKE, v])
    if driven and limit >= 0.0:
        commands[U_PEDAL, column] = app_command[APP_ACCELERATOR, v]
        commands[U_DRIVE, column] = app_command[APP_DRIVE, v]
        commands[U_ENGINE, column] = app_command[APP_ENGINE, v]
    if braked:
        others = commands[U_BRAKE, column] if limit < 0.0 else 0.0
        commands[U_BRAKE, column] = max(max(app_command[APP_BRAKE, v], 0.0), others)
    if driven or braked:
        T = state[TORQUE_DRIVE, v] - commands[U_BRAKE, column]
        commands[U, column] = T / (parameter[RADIUS, v] * effective_mass(v, state, parameter))


@inlined
def steer(v, column, parameter, script, mind, app_command, commands):
    """Steering: a torque at the wheel, or an angle; the maneuver's, else the application's, else the driver's."""
    limit = parameter[STEER_MAX, v]
    if script[STEERS, v] != 0.0:
        angle = script[SCRIPT_STEERING, v]
        commands[U_STEER, column] = min(max(angle, -limit), limit)
        commands[U_STEER_TORQUE, column] = nan
        return
    angle = mind[STEER_WISH, v] if isnan(app_command[APP_STEERING, v]) else app_command[APP_STEERING, v]
    commands[U_STEER, column] = min(max(angle, -limit), limit)
    commands[U_STEER_TORQUE, column] = app_command[APP_STEERING_TORQUE, v]


@inlined
def has(row, otherwise, v, app_command):
    """Number of the application that commands an actuator, else of who has it without one."""
    return otherwise if isnan(app_command[row, v]) else app_command[AUTHORS + row, v]


@inlined
def has_wheel(v, script, app_command):
    """Who steers: a torque goes before an angle."""
    angle = has(APP_STEERING, DRIVER_HAS, v, app_command)
    return SCRIPT_HAS if script[STEERS, v] != 0.0 else has(APP_STEERING_TORQUE, angle, v, app_command)


@inlined
def has_pedals_now(v, limit, mind, app_command):
    """Who has the acceleration: application or driver, or the driver who permits less than they ask for."""
    asked = mind[WISH, v] if isnan(app_command[APP_ACCELERATION, v]) else app_command[APP_ACCELERATION, v]
    overrules = limit < NO_LIMIT and (limit < asked or drives(v, app_command))
    return INTERVENTION_HAS if overrules else has(APP_ACCELERATION, DRIVER_HAS, v, app_command)


@inlined
def has_drive(v, limit, otherwise, app_command):
    """Who has the powertrain: who commands it itself, an engine before a drive torque before the pedal, unless the driver has to brake."""
    if limit < 0.0:
        return otherwise
    pedal = has(APP_ACCELERATOR, otherwise, v, app_command)
    return has(APP_ENGINE, has(APP_DRIVE, pedal, v, app_command), v, app_command)


@inlined
def has_brake(v, column, limit, otherwise, app_command, commands):
    """Who has the brake: who commands it itself, unless the driver brakes harder; read once the commands are written."""
    harder = limit < 0.0 and commands[U_BRAKE, column] > max(app_command[APP_BRAKE, v], 0.0)
    return otherwise if harder else has(APP_BRAKE, otherwise, v, app_command)


@inlined
def tell_who(v, column, limit, is_scripted, script, mind, app_command, commands):
    """Writes down who has wheel, brake, drive and gear."""
    mind[COMMANDS_WHEEL, v] = has_wheel(v, script, app_command)
    mind[COMMANDS_GEAR, v] = has(APP_GEAR, GEARBOX_HAS, v, app_command)
    if is_scripted:
        mind[COMMANDS_DRIVE, v] = mind[COMMANDS_BRAKE, v] = SCRIPT_HAS
        return
    who = has_pedals_now(v, limit, mind, app_command)
    mind[COMMANDS_DRIVE, v] = has_drive(v, limit, who, app_command)
    mind[COMMANDS_BRAKE, v] = has_brake(v, column, limit, who, app_command, commands)


@lean
def command(state, ground, parameter, script, drivers, mind, app_command, commands, k, time):
    """Writes this tick's commands into the ring."""
    n = state.shape[1]
    for v in range(n):
        column, is_active = (k % RING) * n + v, state[ACTIVE, v] != 0.0
        is_scripted = is_active and script[DRIVES, v] != 0.0
        limit = NO_LIMIT
        if is_minding(v, drivers):
            limit = permitted(v, time, is_scripted or not is_active, state, parameter, drivers, mind, app_command)
        steer(v, column, parameter, script, mind, app_command, commands)
        commands[U_GEAR, column] = app_command[APP_GEAR, v]
        if not is_active:
            pedals(v, column, STRONGEST_BRAKE, state, ground, parameter, commands)
        elif is_scripted:
            u = min(max(script[SCRIPT_ACCELERATION, v], STRONGEST_BRAKE), STRONGEST_DRIVE)
            pedals(v, column, u, state, ground, parameter, commands)
        else:
            pedals(v, column, request(v, limit, mind, app_command[APP_ACCELERATION, v]), state, ground, parameter, commands)
            take_over(v, column, limit, state, parameter, app_command, commands)
        if is_active:
            tell_who(v, column, limit, is_scripted, script, mind, app_command, commands)
