"""Shifting: the control unit of every gearbox, once a tick, and how a vehicle is put on the road."""

from math import cos, sin, sqrt

from studio.compiled import inlined, lean
from studio.model import body, gearbox
from studio.vehicle.command import RING, U_GEAR
from studio.vehicle.contact import HEIGHT, SLOPE_X, SLOPE_Y
from studio.vehicle.parameter import (
    CLUTCHED,
    CONVERTER,
    COUPLING,
    DRIVE_SHARE,
    FLUID_RATIO,
    G_DISENGAGE,
    G_DOWN_FULL,
    G_DOWN_LIGHT,
    G_ENGAGE,
    G_INERTIA,
    G_OPEN,
    G_RATIO,
    G_UP_FULL,
    G_UP_LIGHT,
    GEARS,
    IDLE,
    LIMIT,
    LOCK_UP,
    MASS,
    RADIUS,
    RIGID,
    STATIC_F,
    STATIC_R,
    H,
)  # fmt: skip
from studio.vehicle.state import (
    A_X,
    ACCELERATOR,
    ACTIVE,
    CLUTCH,
    CLUTCH_RATE,
    F_Z,
    GEAR,
    J_GEAR,
    NEXT_GEAR,
    NEXT_RATIO,
    OMEGA,
    OMEGA_E,
    OPEN_TIME,
    PEDAL_KEPT,
    PITCH,
    PSI,
    Q_W,
    Q_X,
    Q_Y,
    Q_Z,
    RATIO,
    RATIO_RATE,
    TORQUE_DRIVE,
    V_EAST,
    V_NORTH,
    V_UP,
    V_X,
    X,
    Y,
    Z,
)  # fmt: skip

CALM = 0.35  # [1] pedal position of calm driving


@inlined
def of_gear(quantity, gear, v, gears):
    """A row of the gearbox in a gear."""
    return gears[quantity * GEARS + int(gear) + 1, v]


@inlined
def top_gear(v, gears):
    """Highest gear that exists."""
    top = 1
    while top + 2 < GEARS and gears[G_RATIO * GEARS + top + 2, v] != 0.0:
        top += 1
    return top


@inlined
def output_speed(v, n, wheels, parameter):
    """Mean speed [rad/s] of the driven wheels, as the differentials have it."""
    front = 0.5 * (wheels[OMEGA, v] + wheels[OMEGA, n + v])
    rear = 0.5 * (wheels[OMEGA, 2 * n + v] + wheels[OMEGA, 3 * n + v])
    return parameter[DRIVE_SHARE, v] * front + (1.0 - parameter[DRIVE_SHARE, v]) * rear


@inlined
def scheduled(v, w_out, top, state, parameter, gears):
    """The gear of the schedule; one up only where it will be kept."""
    gear = int(state[GEAR, v])
    w_in = of_gear(G_RATIO, gear, v, gears) * w_out
    up = gearbox.threshold(of_gear(G_UP_LIGHT, gear, v, gears), of_gear(G_UP_FULL, gear, v, gears), state[PEDAL_KEPT, v])
    found = gearbox.automatic(gear, top, w_in, up, down_speed(v, gear, state[ACCELERATOR, v], gears))
    return gear if found > gear and not keeps(v, gear + 1, w_out, state, parameter, gears) else found


@inlined
def down_speed(v, gear, pedal, gears):
    """Speed [rad/s] below which a gear is left for a lower one."""
    return gearbox.threshold(of_gear(G_DOWN_LIGHT, gear, v, gears), of_gear(G_DOWN_FULL, gear, v, gears), pedal)


@lean
def keeps(v, gear, w_out, state, parameter, gears):
    """Whether a vehicle would keep the next higher gear on this slope with this pedal."""
    R, i = parameter[RADIUS, v], of_gear(G_RATIO, gear, v, gears)
    a_drive = state[TORQUE_DRIVE, v] / (R * parameter[MASS, v])
    time = of_gear(G_DISENGAGE, gear - 1, v, gears) + of_gear(G_OPEN, gear, v, gears) + of_gear(G_ENGAGE, gear, v, gears)
    interrupted = time if parameter[COUPLING, v] == CLUTCHED else 0.0
    fall = i / of_gear(G_RATIO, gear - 1, v, gears)
    w_down = down_speed(v, gear, gearbox.pedal_after(state[PEDAL_KEPT, v], fall), gears)
    return gearbox.can_hold(state[A_X, v], a_drive, fall, interrupted, w_out, i, R, w_down, state[ACCELERATOR, v])


@inlined
def wanted(v, w_out, request, state, parameter, gears):
    """The gear to be in: the requested one, else the schedule's, which begins forwards; never one that would do harm."""
    top = top_gear(v, gears)
    if request == request:
        gear = int(min(max(request, -1.0), GEARS - 2.0))
    elif state[GEAR, v] >= 1.0:
        gear = scheduled(v, w_out, top, state, parameter, gears)
    else:
        gear = first_gear_for(v, w_out, gears)
    w_wanted, w_present = abs(of_gear(G_RATIO, gear, v, gears) * w_out), abs(state[RATIO, v] * w_out)
    return gearbox.permitted(gear, int(state[GEAR, v]), top, state[V_X, v], w_wanted, w_present, parameter[LIMIT, v])


@lean
def begin(v, gear, tick, state, gears):
    """A shift begins: the clutch opens over the time of the gear that is left."""
    state[NEXT_GEAR, v] = gear
    state[NEXT_RATIO, v] = of_gear(G_RATIO, gear, v, gears)
    state[OPEN_TIME, v] = 0.0
    state[CLUTCH_RATE, v] = -gearbox.rate(of_gear(G_DISENGAGE, state[GEAR, v], v, gears), tick)


@lean
def engage(v, w_out, tick, state, parameter, gears):
    """The new gear is in, the clutch still open. Behind a converter the gears hand over within the time for closing.

    A motor without a clutch is brought to the speed of its gear before.
    """
    gear = state[NEXT_GEAR, v]
    state[GEAR, v] = gear
    state[J_GEAR, v] = of_gear(G_INERTIA, gear, v, gears)
    state[CLUTCH_RATE, v] = 0.0
    if parameter[COUPLING, v] == RIGID:
        state[OMEGA_E, v] = state[NEXT_RATIO, v] * w_out
    if parameter[COUPLING, v] == CONVERTER and state[RATIO, v] * state[NEXT_RATIO, v] > 0.0:
        rate = gearbox.rate(of_gear(G_ENGAGE, gear, v, gears), tick)
        state[RATIO_RATE, v] = rate * abs(state[NEXT_RATIO, v] - state[RATIO, v])
    else:
        state[RATIO, v] = state[NEXT_RATIO, v]


@lean
def shift(v, w_out, tick, state, parameter, gears):
    """One tick of a shift."""
    if state[CLUTCH, v] > 0.0 and parameter[COUPLING, v] != RIGID:
        return
    if parameter[COUPLING, v] == CLUTCHED:
        state[RATIO, v] = 0.0
    state[OPEN_TIME, v] += tick
    if state[OPEN_TIME, v] >= of_gear(G_OPEN, state[NEXT_GEAR, v], v, gears):
        engage(v, w_out, tick, state, parameter, gears)


@inlined
def drive(v, w_out, tick, state, parameter, gears):
    """One tick in gear: the clutch or lock-up closes or opens."""
    w_in = abs(state[RATIO, v] * w_out)
    closes = True
    if parameter[COUPLING, v] == CLUTCHED:
        closes = state[GEAR, v] != 0.0 and gearbox.clutch_closes(w_in, state[ACCELERATOR, v], parameter[IDLE, v], state[CLUTCH, v] >= 1.0)
    elif parameter[COUPLING, v] == CONVERTER:
        is_in = state[RATIO, v] == state[NEXT_RATIO, v]
        closes = is_in and gearbox.lock_up_closes(
            w_in, state[OMEGA_E, v], parameter[LOCK_UP, v], parameter[FLUID_RATIO, v], state[CLUTCH, v] > 0.0
        )
    quantity = G_ENGAGE if closes else G_DISENGAGE
    rate = gearbox.rate(of_gear(quantity, state[GEAR, v], v, gears), tick)
    state[CLUTCH_RATE, v] = rate if closes else -rate


@lean
def shifts(columns, k, tick, state, wheels, parameter, gears, commands):
    """Every gearbox decides, of the vehicles that have one."""
    n = state.shape[1]
    for v in columns:
        state[PEDAL_KEPT, v] = gearbox.kept(state[PEDAL_KEPT, v], state[ACCELERATOR, v], tick)
        w_out = output_speed(v, n, wheels, parameter)
        if state[NEXT_GEAR, v] != state[GEAR, v]:
            shift(v, w_out, tick, state, parameter, gears)
            continue
        w_road = max(w_out, state[V_X, v] / parameter[RADIUS, v])  # wheels that lock under the brakes ask for no lower gear
        gear = wanted(v, w_road, commands[U_GEAR, (k % RING) * n + v], state, parameter, gears)
        if gear != int(state[GEAR, v]):
            begin(v, gear, tick, state, gears)
        else:
            drive(v, w_out, tick, state, parameter, gears)


# --- on the road ---------------------------------------------------------------------------------------------------------


@lean
def first_gear_for(v, w_out, gears):
    """The highest gear that the schedule would keep at this speed of the driven wheels, pedal as for calm driving."""
    best = 1
    for gear in range(2, top_gear(v, gears) + 1):
        down = gearbox.threshold(of_gear(G_DOWN_LIGHT, gear, v, gears), of_gear(G_DOWN_FULL, gear, v, gears), CALM)
        if of_gear(G_RATIO, gear, v, gears) * w_out > down:
            best = gear
    return best


@lean
def stand(v, n, x, y, psi, state, ground, parameter):
    """Places a vehicle on the plane under its first wheel, level with it: orientation and height."""
    g_x, g_y = ground[SLOPE_X, v], ground[SLOPE_Y, v]
    n_z = 1.0 / sqrt(1.0 + g_x * g_x + g_y * g_y)
    turned = body.standing(g_x, g_y, cos(0.5 * psi), sin(0.5 * psi))
    state[Q_W, v], state[Q_X, v], state[Q_Y, v], state[Q_Z, v] = turned
    state[X, v], state[Y, v], state[PSI, v] = x, y, psi
    state[Z, v] = ground[HEIGHT, v] + g_x * x + g_y * y + parameter[H, v] / n_z
    R = body.rotation(state[Q_W, v], state[Q_X, v], state[Q_Y, v], state[Q_Z, v])
    state[PITCH, v] = -g_x * n_z * cos(psi) - g_y * n_z * sin(psi)
    state[V_EAST, v], state[V_NORTH, v], state[V_UP, v] = body.to_world(R, state[V_X, v], 0.0, 0.0)


@lean
def start(v, x, y, psi, speed, state, wheels, ground, parameter, gears):
    """Puts a vehicle on the road: rolling without slip, in the gear for its speed, springs at rest."""
    n = state.shape[1]
    state[:, v] = 0.0
    state[V_X, v] = speed
    state[ACTIVE, v] = 1.0
    stand(v, n, x, y, psi, state, ground, parameter)
    for corner in range(4):
        w = corner * n + v
        wheels[:, w] = 0.0
        wheels[OMEGA, w] = speed / parameter[RADIUS, v]
        wheels[F_Z, w] = parameter[STATIC_F, v] if corner < 2 else parameter[STATIC_R, v]
    start_engine(v, speed / parameter[RADIUS, v], state, parameter, gears)


@lean
def start_engine(v, w_out, state, parameter, gears):
    """Engine, clutch and gear for a speed of the driven wheels [rad/s]."""
    start_in_gear(v, first_gear_for(v, w_out, gears), w_out, state, parameter, gears)


@lean
def start_in_gear(v, gear, w_out, state, parameter, gears):
    """The same in a given gear."""
    i = of_gear(G_RATIO, gear, v, gears)
    w_in = i * w_out
    state[GEAR, v], state[NEXT_GEAR, v], state[RATIO, v], state[NEXT_RATIO, v] = gear, gear, i, i
    state[J_GEAR, v] = of_gear(G_INERTIA, gear, v, gears)
    state[OMEGA_E, v] = w_in if parameter[COUPLING, v] == RIGID else max(w_in, parameter[IDLE, v])
    locks = w_in > (parameter[LOCK_UP, v] if parameter[COUPLING, v] == CONVERTER else parameter[IDLE, v])
    state[CLUTCH, v] = 1.0 if locks or parameter[COUPLING, v] == RIGID else 0.0
