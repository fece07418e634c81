"""Motion: one tick of all vehicles, tile by tile; in a tile all steps, and in a step four passes.

intake      commands that reach the actuators now
corners     body and wheels → loads, directions and slips at the four contact points          (corner.py)
tyres       slips → forces, wheel by wheel                                                     (corner.py, model/tyre.py)
bodies      forces → actuators, powertrain, wheel spins, new body state                        (powertrain.py, force.py)

Between the passes stand the rows of `contact`. No vehicle looks at another one here. Order within a step as in Massow &
Radusch 2018: aerodynamics and suspension, actuators, powertrain and wheels, forces on the body, new state.
"""

from math import asin, atan2, ceil, floor, pi

from studio.compiled import compiled, inlined
from studio.model import body
from studio.vehicle import tile as tiles
from studio.vehicle.command import (
    RING,
    U_APPLIED,
    U_APPLIED_BRAKE,
    U_BRAKE,
    U_DRIVE,
    U_ENGINE,
    U_PEDAL,
    U_STEER,
    U_STEER_TORQUE,
)  # fmt: skip
from studio.vehicle.contact import GROUND
from studio.vehicle.corner import attitude, corners_step, tyre_step
from studio.vehicle.force import forces_step
from studio.vehicle.parameter import DELAY_BRAKE, DELAY_DRIVE, PARAMETER
from studio.vehicle.powertrain import brake_step, drive_step, steer_step
from studio.vehicle.state import PITCH, PSI, ROLL, V_EAST, V_NORTH, V_UP, V_X, V_Y, VEHICLE, WHEEL
from studio.vehicle.tile import (
    COMMAND_AT,
    CONTACT_AT,
    CORNERS,
    GROUND_AT,
    LANES,
    PARAMETER_AT,
    STATE_AT,
    WHEEL_AT,
    tyre_at,
    window,
)  # fmt: skip

TICK_EPSILON = 1e-9  # a dead time that is a whole number of ticks must not fall one tick short by rounding
STATES, WHEELS, GROUNDS, PARAMETERS = len(VEHICLE), len(WHEEL), len(GROUND), len(PARAMETER)


# --- passes --------------------------------------------------------------------------------------------------------------


@inlined
def slot(tick_now, elapsed, delay, tick):
    """Slot of the ring with the commands that were in force `delay` [s] ago."""
    return (tick_now + int(floor((elapsed - delay) / tick + TICK_EPSILON))) & (RING - 1)


@inlined
def intake_step(v, column, n, parameter, commands, tick_now, elapsed, tick, command):
    """What was commanded a dead time ago reaches drive and brake; the rest comes at once."""
    now = (tick_now & (RING - 1)) * n + column
    then_drive = slot(tick_now, elapsed, parameter[DELAY_DRIVE, v], tick) * n + column
    then_brake = slot(tick_now, elapsed, parameter[DELAY_BRAKE, v], tick) * n + column
    command[U_STEER, v] = commands[U_STEER, now]
    command[U_STEER_TORQUE, v] = commands[U_STEER_TORQUE, now]
    command[U_APPLIED, v] = commands[U_APPLIED, now]
    command[U_APPLIED_BRAKE, v] = commands[U_APPLIED_BRAKE, now]
    command[U_DRIVE, v] = commands[U_DRIVE, then_drive]
    command[U_PEDAL, v] = commands[U_PEDAL, then_drive]
    command[U_ENGINE, v] = commands[U_ENGINE, then_drive]
    command[U_BRAKE, v] = commands[U_BRAKE, then_brake]


@compiled
def intake(columns, n, commands, tick_now, elapsed, tick, tile):
    """First pass; the lanes that fill up the last register take the last vehicle's commands."""
    parameter, command = window(tile, PARAMETER_AT, LANES), window(tile, COMMAND_AT, LANES)
    last = columns.size - 1
    for v in range(tiles.filled_lanes(columns.size)):
        intake_step(v, columns[min(v, last)], n, parameter, commands, tick_now, elapsed, tick, command)


@compiled
def corners(tile, lanes, dt):
    """Second pass."""
    state, wheels = window(tile, STATE_AT, LANES), window(tile, WHEEL_AT, CORNERS)
    ground, contact = window(tile, GROUND_AT, CORNERS), window(tile, CONTACT_AT, CORNERS)
    parameter = window(tile, PARAMETER_AT, LANES)
    for v in range(lanes):
        corners_step(v, state, wheels, ground, contact, parameter, dt)


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


@inlined
def body_step(v, state, wheels, contact, parameter, command, dt):
    """Actuators, powertrain and wheel spins; then the forces on the body and its new state."""
    steer_step(v, state, wheels, parameter, command, dt)
    T_front, T_rear = brake_step(v, state, parameter, command, dt)
    resistance = drive_step(v, T_front, T_rear, state, wheels, contact, parameter, command, dt)
    forces_step(v, resistance, state, wheels, contact, parameter, dt)


@compiled
def bodies(tile, lanes, dt):
    """Fourth pass."""
    state, wheels, contact = window(tile, STATE_AT, LANES), window(tile, WHEEL_AT, CORNERS), window(tile, CONTACT_AT, CORNERS)
    parameter, command = window(tile, PARAMETER_AT, LANES), window(tile, COMMAND_AT, LANES)
    for v in range(lanes):
        body_step(v, state, wheels, contact, parameter, command, dt)


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
    bodies(tile, lanes, dt)


@compiled
def steps_of(tick, dt):
    """Steps of one tick."""
    return int(ceil(tick / dt - TICK_EPSILON))


@compiled
def mark_broken(columns, tile, broken):
    """Marks the vehicles of a tile of which something is not finite; whether there are any.

    0 times a number is 0, and not a number where that is none; commands have been used and give room for the sums.
    """
    lanes, any_broken = tiles.filled_lanes(columns.size), False
    state, sums = window(tile, STATE_AT, LANES), window(tile, COMMAND_AT, LANES)
    for v in range(lanes):
        sums[0, v] = 0.0
    for row in range(STATES + 4 * WHEELS):
        for v in range(lanes):
            sums[0, v] += 0.0 * state[row, v]
    for v in range(columns.size):
        broken[columns[v]] = 0 if sums[0, v] == 0.0 else 1
        any_broken |= broken[columns[v]] != 0
    return any_broken


@compiled
def is_row_of(columns, count):
    """Whether the columns stand side by side."""
    return columns[count - 1] - columns[0] == count - 1


@compiled
def integrate_block(columns, front, rear, state, wheels, ground, parameter, tyres, commands, tick_now, tick, dt, steps, broken, tile):
    """All steps of one tick for the vehicles of one block."""
    n, count = state.shape[1], columns.size
    side_by_side = is_row_of(columns, count)
    tiles.load(state, columns, side_by_side, count, 1, STATES, STATE_AT, tile)
    tiles.load(wheels, columns, side_by_side, count, 4, WHEELS, WHEEL_AT, tile)
    tiles.load(ground, columns, side_by_side, count, 4, GROUNDS, GROUND_AT, tile)
    tiles.load(parameter, columns, side_by_side, count, 1, PARAMETERS, PARAMETER_AT, tile)
    for i in range(steps):
        intake(columns, n, commands, tick_now, i * dt, tick, tile)
        step(tyres, front, rear, tile, tiles.filled_lanes(count), dt)
    if mark_broken(columns, tile, broken):
        tiles.store_sound(state, columns, 1, STATES, STATE_AT, tile, broken)
        tiles.store_sound(wheels, columns, 4, WHEELS, WHEEL_AT, tile, broken)
    else:
        tiles.store(state, columns, side_by_side, count, 1, STATES, STATE_AT, tile)
        tiles.store(wheels, columns, side_by_side, count, 4, WHEELS, WHEEL_AT, tile)


@compiled
def integrate(blocks, order, state, wheels, ground, parameter, tyres, commands, tick_now, tick, dt, steps, broken, tile):
    """The first steps of a tick, usually all of them, for all blocks.

    A vehicle of which something is not finite afterwards is marked as broken, and stays in the arrays as it was before.
    """
    for b in range(blocks.shape[1]):
        columns = order[blocks[0, b] : blocks[0, b] + blocks[1, b]]
        integrate_block(
            columns, blocks[2, b], blocks[3, b], state, wheels, ground, parameter, tyres, commands, tick_now, tick, dt, steps,
            broken, tile,
        )  # fmt: skip
        for v in columns:
            if broken[v] == 0:
                derive(v, state)
