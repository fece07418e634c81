"""What units know of themselves: bus and satellite receiver of a vehicle, the place of a station."""

from studio.compiled import inlined, lean
from studio.model.random import BUS_NOISE, normal
from studio.vehicle.command import RING, U
from studio.vehicle.parameter import FRONT, H
from studio.vehicle.state import A_X, ACTIVE, DELTA, PSI, V_X, YAW_RATE, X, Y, Z
from studio.world.passes.neighbour import COS, SIN
from studio.world.passes.satellite import fix
from studio.world.table.mind import COMMANDS_DRIVE, DRIVER_HAS, INTERVENTION_HAS, V_DESIRED
from studio.world.table.unit import (
    BUMPER,
    COSINE,
    GPS_EAST,
    GPS_NORTH,
    HEADING,
    OWN_ACCELERATION,
    OWN_REQUEST,
    OWN_SET_SPEED,
    OWN_SPEED,
    OWN_STEERING,
    OWN_X,
    OWN_Y,
    OWN_YAW_RATE,
    PRESENT,
    SINE,
    SPEED_NOISE,
    STEERING_NOISE,
    TRUE_SPEED,
    TRUE_X,
    TRUE_Y,
    TRUE_Z,
)  # fmt: skip


@lean
def carry(vehicle, fixed, state, parameter, mind, commands, places, gps_set, world_of, entity, seed, bus_seed, place_of, shadow, satellite,
          now, tick, k):  # fmt: skip
    """Satellites tell vehicles where they are, and every unit on a vehicle goes with it; stations stay as they are."""
    fix(k, tick, state, gps_set, world_of, entity, seed, place_of, shadow, satellite)
    n = state.shape[1]
    for u in range(vehicle.size):
        v = vehicle[u]
        if v < 0:
            continue
        now[TRUE_X, u], now[TRUE_Y, u], now[HEADING, u] = state[X, v], state[Y, v], state[PSI, v]
        now[TRUE_Z, u] = state[Z, v] - parameter[H, v]
        now[COSINE, u], now[SINE, u] = places[COS, v], places[SIN, v]
        now[TRUE_SPEED, u] = state[V_X, v]
        now[BUMPER, u], now[PRESENT, u] = parameter[FRONT, v], state[ACTIVE, v]
        now[OWN_SPEED, u], now[OWN_ACCELERATION, u] = state[V_X, v], state[A_X, v]
        now[OWN_YAW_RATE, u], now[OWN_STEERING, u] = state[YAW_RATE, v], state[DELTA, v]
        blur(k, u, entity[v], bus_seed[world_of[v]], fixed, now)
        now[OWN_SET_SPEED, u] = mind[V_DESIRED, v]
        now[OWN_REQUEST, u] = now[OWN_ACCELERATION, u] if is_driven(v, mind) else commands[U, ((k - 1) % RING) * n + v]
        now[OWN_X, u] = state[X, v] + satellite[GPS_EAST, v]
        now[OWN_Y, u] = state[Y, v] + satellite[GPS_NORTH, v]


@inlined
def is_driven(v, mind):
    """Whether a person has the pedals: what he wants, and has made of what he sees, stands on no bus."""
    return mind[COMMANDS_DRIVE, v] == DRIVER_HAS or mind[COMMANDS_DRIVE, v] == INTERVENTION_HAS


@inlined
def blur(k, u, unit, seed, fixed, now):
    """Puts noise on the signals of a unit's bus; one without noise draws nothing."""
    for row in range(SPEED_NOISE, STEERING_NOISE + 1):
        if fixed[row, u] > 0.0:
            now[OWN_SPEED + row - SPEED_NOISE, u] += fixed[row, u] * normal(seed, unit, BUS_NOISE, k, row)
