"""Control: who commands what. Triggers start scripted maneuvers; maneuver, application and driver share the actuators.

Order of precedence on the pedals: a scripted maneuver, then the application, then the driver. A driver whose application
keeps the gap still brakes for a red light and for a car that merges first: an application sees neither.
"""

from math import inf, isnan

from studio.compiled import compiled
from studio.model import actuator, vehicle
from studio.world.motion import rolling_force
from studio.world.state import *  # noqa: F403 - the names of the rows

STRONGEST_BRAKE, STRONGEST_DRIVE = -10.0, 5.0  # [m/s²] bounds of the request interface


@compiled
def fire(time, trigger_time, trigger_vehicle, trigger_script, fired, script):
    """Starts the maneuvers whose time has come."""
    for i in range(trigger_time.size):
        if fired[i] == 0 and time >= trigger_time[i] - 1e-9:
            fired[i] = 1
            v = trigger_vehicle[i]
            script[SCRIPT_BRAKE, v] = trigger_script[SCRIPT_BRAKE, i]
            script[SCRIPT_UNTIL, v] = time + trigger_script[SCRIPT_UNTIL, i]
            script[SCRIPT_SPEED, v] = trigger_script[SCRIPT_SPEED, i]


@compiled
def is_scripted(v, time, state, script):
    """Whether a maneuver commands the pedals; it ends with its time, or once its speed is reached."""
    if time >= script[SCRIPT_UNTIL, v] - 1e-9:
        return False
    if state[V_X, v] <= script[SCRIPT_SPEED, v]:
        script[SCRIPT_UNTIL, v] = -inf
        return False
    return True


@compiled
def request(v, time, state, script, mind, app_acceleration):
    """Acceleration [m/s²] that reaches the actuators."""
    if is_scripted(v, time, state, script):
        return -script[SCRIPT_BRAKE, v]
    u = mind[WISH, v]
    if not isnan(app_acceleration):
        u = min(app_acceleration, min(mind[STOPPING, v], mind[YIELDING, v]))
    return min(max(u, STRONGEST_BRAKE), STRONGEST_DRIVE)


@compiled
def torques(v, u, state, parameter):
    """Drive and brake torque [Nm] that give the acceleration u on the level."""
    R, m = parameter[RADIUS, v], parameter[MASS, v]
    m_eff = m + 4.0 * parameter[J_W, v] / (R * R)
    air = vehicle.air_drag(parameter[C_D, v], parameter[AREA, v], state[V_X, v])
    F = actuator.wheel_force(u, m_eff, air, rolling_force(m, parameter[C_ROLL, v]))
    drive = actuator.drive_torque(F, R, state[V_X, v], parameter[DRIVE_MAX, v], parameter[POWER_MAX, v])
    return drive, actuator.brake_torque(F, R, parameter[BRAKE_MAX, v])


@compiled
def command(k, time, state, parameter, script, mind, app_command, commands):
    """Writes this tick's commands into the ring."""
    n = state.shape[1]
    for v in range(n):
        column = (k % RING) * n + v
        u = request(v, time, state, script, mind, app_command[0, v])
        drive, brake = torques(v, u, state, parameter)
        steer = mind[STEER_WISH, v] if isnan(app_command[1, v]) else app_command[1, v]
        steer = min(max(steer, -parameter[STEER_MAX, v]), parameter[STEER_MAX, v])
        commands[U, column] = u
        commands[U_STEER, column] = steer
        commands[U_DRIVE, column] = drive
        commands[U_BRAKE, column] = brake


@compiled
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
        for i in range(4):
            observed[8 + i, j] = sensors[i, v] if sensors[DETECTED, v] > 0.0 else 0.0
        observe_message(time, links[j], inbox, observed, j)


@compiled
def observe_message(time, link, inbox, observed, j):
    """The newest message of the unit that car j listens to."""
    observed[12, j] = 0.0
    observed[13, j] = time
    if link >= 0 and inbox[SENT, link] > -inf:
        observed[12, j] = 1.0
        observed[13, j] = time - inbox[SENT, link]
        for i in range(1, 6):
            observed[13 + i, j] = inbox[i, link]
