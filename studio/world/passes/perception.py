"""Perception: what the units of this tick get to know, by sensor, by satellite and by radio. Three passes.

Sensors look at the true world and add their errors; messages are looked up in what the senders have sent.
"""

from math import atan2, nan, sqrt

from studio.compiled import inlined, lean
from studio.model import radio, satellite, sensor
from studio.model.random import (
    GPS_DRIFT,
    GPS_NOISE,
    MESSAGE_DELAY,
    MESSAGE_LOSS,
    RANGE_NOISE,
    RATE_NOISE,
    normal,
    normal_pair,
    uniform,
)  # fmt: skip
from studio.road.network.grid import COLUMNS
from studio.road.network.shadow import EYE, open_sky, walls_between
from studio.vehicle.command import RING, U
from studio.vehicle.parameter import FRONT
from studio.vehicle.state import A_X, ACTIVE, PSI, V_X, YAW_RATE, X, Y
from studio.world.passes.collision import reach_along
from studio.world.passes.neighbour import AT_X, AT_Y, COS, REAR_X, REAR_Y, SIN, within
from studio.world.table.street import BARRIER, O_HEADING, O_KIND, O_LENGTH, O_WIDTH, O_X, O_Y, OBJECT
from studio.world.table.unit import (
    AZIMUTH,
    BUILDINGS,
    CANYON,
    DELAY,
    DETECTED,
    DRIFT_EAST,
    DRIFT_NORTH,
    DRIFT_SIGMA,
    DRIFT_TIME,
    EXPONENT,
    GPS_EAST,
    GPS_NORTH,
    GPS_SIGMA,
    LOSS,
    LOSS_DISTANCE,
    M_ACCELERATION,
    M_INTENTION,
    M_SPEED,
    M_TRUE_X,
    M_TRUE_Y,
    M_X,
    M_Y,
    OPENING,
    PERIOD,
    RADIO_RANGE,
    RANGE,
    RANGE_RATE,
    RANGE_SIGMA,
    RATE_SIGMA,
    REACH,
    SENT,
    TARGET,
    VARIATION,
)  # fmt: skip

EARLY = 1e-9  # [s] a delay that is a whole number of ticks must not come a tick late by rounding
FIRST_LOOK = 30.0  # [m]
PAIR = 65536  # a link is numbered receiver · PAIR + sender


@inlined
def nearest_target(v, world, longest, state, parameter, sensor_set, grid, places, found):
    """Column of the nearest car in view and in the own corridor, with its place; -1 when there is none.

    Near cars are looked at first: where one is seen, none that is farther can be nearer.
    """
    kappa = sensor.own_curvature(state[V_X, v], state[YAW_RATE, v])
    best, best_forward, best_left = -1, sensor_set[REACH, v], 0.0
    x, y, c, s = places[AT_X, v], places[AT_Y, v], places[COS, v], places[SIN, v]
    for reach in (min(FIRST_LOOK, sensor_set[REACH, v]), sensor_set[REACH, v]):
        if best_forward < reach:
            break
        ahead = parameter[FRONT, v] + reach + longest
        bow = min(max(0.5 * kappa * reach * reach, -ahead), ahead)  # of the corridor at its end
        left, right = max(bow, 0.0) + sensor.CORRIDOR + longest, min(bow, 0.0) - sensor.CORRIDOR - longest
        for i in range(within(world, x, y, c, s, -longest, ahead, right, left, grid, places, found)):
            other = found[i]
            if other == v or state[ACTIVE, other] == 0.0:
                continue
            forward, aside = sensor.turned(places[REAR_X, other] - x, places[REAR_Y, other] - y, c, s)
            forward -= parameter[FRONT, v]
            if forward >= best_forward or not sensor.in_corridor(forward, aside, kappa):
                continue
            if sensor.in_view(forward, aside, sensor_set[REACH, v], 0.5 * sensor_set[OPENING, v]):
                best, best_forward, best_left = other, forward, aside
    return best, best_forward, best_left


@lean
def nearest_barrier(v, best, best_forward, best_left, first, count, state, parameter, sensor_set, table, standing):
    """The same among the barriers that stand there, of which the radar sees the near edge. A cone of plastic sends nothing back."""
    kappa = sensor.own_curvature(state[V_X, v], state[YAW_RATE, v])
    for i in range(first, first + count):
        if standing[i] == 0 or table[O_KIND, i] != BARRIER:
            continue
        forward, left = sensor.seen_from(state[X, v], state[Y, v], state[PSI, v], table[O_X, i], table[O_Y, i])
        forward -= parameter[FRONT, v] + reach_along(table[O_HEADING, i] - state[PSI, v], table[O_LENGTH, i], table[O_WIDTH, i])
        if forward >= best_forward or not sensor.in_corridor(forward, left, kappa):
            continue
        if sensor.in_view(forward, left, sensor_set[REACH, v], 0.5 * sensor_set[OPENING, v]):
            best, best_forward, best_left = OBJECT - i, forward, left
    return best, best_forward, best_left


@inlined
def closing_rate(v, other, forward, left, state, places):
    """Change of the distance [m/s] to a car, or an object at rest, seen in that direction."""
    distance = max(sqrt(forward * forward + left * left), 1e-6)
    c, s = places[COS, v], places[SIN, v]
    c_other, s_other, v_other = (places[COS, other], places[SIN, other], state[V_X, other]) if other >= 0 else (1.0, 0.0, 0.0)
    east, north = v_other * c_other - state[V_X, v] * c, v_other * s_other - state[V_X, v] * s
    ahead, aside = sensor.turned(east, north, c, s)
    return (ahead * forward + aside * left) / distance


@inlined
def forget(v, sensors):
    """No target until one is found."""
    sensors[DETECTED, v] = 0.0
    sensors[RANGE, v] = sensors[RANGE_RATE, v] = sensors[AZIMUTH, v] = nan
    sensors[TARGET, v] = -1.0


@lean
def sense(k, longest, state, parameter, sensor_set, world_of, number, entity, table, first_object, object_count, standing, seed, grid,
          places, found, sensors):  # fmt: skip
    """First pass: the front sensor of every car. A barrier that is nearer than the car takes its place."""
    for v in range(state.shape[1]):
        w = world_of[v]
        forget(v, sensors)
        if state[ACTIVE, v] == 0.0 or sensor_set[REACH, v] <= 0.0:
            continue
        other, forward, left = nearest_target(v, w, longest, state, parameter, sensor_set, grid, places, found)
        if object_count[w] > 0:
            other, forward, left = nearest_barrier(
                v, other, forward, left, first_object[w], object_count[w], state, parameter, sensor_set, table, standing
            )
        if other != -1:
            report(k, v, other, forward, left, state, sensor_set, entity[v], seed[w], places, sensors)
            sensors[TARGET, v] = number[other] if other >= 0 else other + first_object[w]


@inlined
def report(k, v, other, forward, left, state, sensor_set, unit, seed, places, sensors):
    """Writes a target with the sensor's errors."""
    noise_range = sensor_set[RANGE_SIGMA, v] * normal(seed, unit, RANGE_NOISE, k)
    noise_rate = sensor_set[RATE_SIGMA, v] * normal(seed, unit, RATE_NOISE, k)
    sensors[DETECTED, v] = 1.0
    sensors[RANGE, v] = max(sqrt(forward * forward + left * left) + noise_range, 0.0)
    sensors[RANGE_RATE, v] = closing_rate(v, other, forward, left, state, places) + noise_rate
    sensors[AZIMUTH, v] = atan2(left, forward)


@lean
def fix(k, tick, state, gps_set, world_of, entity, seed, place_of, shadow, sensors):
    """Second pass: where every car takes itself to be. A car without errors draws nothing."""
    tau, phi, frame = 0.0, 0.0, shadow.grid.frame
    for v in range(state.shape[1]):
        if state[ACTIVE, v] > 0.0 and (gps_set[DRIFT_SIGMA, v] > 0.0 or gps_set[GPS_SIGMA, v] > 0.0):
            if gps_set[DRIFT_TIME, v] != tau:  # most receivers are alike
                tau = gps_set[DRIFT_TIME, v]
                phi = satellite.kept(tick, tau) if k > 0 else 0.0
            place = place_of[world_of[v]]
            sky = open_sky(shadow, place, state[X, v], state[Y, v]) if frame[COLUMNS, place] > 0.0 else 1.0
            wander(k, v, sky, phi, gps_set, entity[v], seed[world_of[v]], sensors)


@inlined
def wander(k, v, sky, phi, gps_set, unit, seed, sensors):
    """The error of a satellite position at this tick; at the first one, phi = 0, the slow error is drawn as if it had long been running."""
    draw_east, draw_north = normal_pair(seed, unit, GPS_DRIFT, k)
    noise_east, noise_north = normal_pair(seed, unit, GPS_NOISE, k)
    sensors[DRIFT_EAST, v] = satellite.drift(sensors[DRIFT_EAST, v], phi, draw_east)
    sensors[DRIFT_NORTH, v] = satellite.drift(sensors[DRIFT_NORTH, v], phi, draw_north)
    sigma = satellite.spread(gps_set[DRIFT_SIGMA, v], gps_set[CANYON, v], sky)
    sensors[GPS_EAST, v] = sigma * sensors[DRIFT_EAST, v] + gps_set[GPS_SIGMA, v] * noise_east
    sensors[GPS_NORTH, v] = sigma * sensors[DRIFT_NORTH, v] + gps_set[GPS_SIGMA, v] * noise_north


@lean
def is_turn(k, unit, period):
    """Whether a unit sends at tick k: every `period` ticks, units spread over the period."""
    return (k + unit) % period == 0


@lean
def send(k, tick, state, command, radio_set, world_of, entity, sensors, sent):
    """Third pass, first half: the units whose turn it is broadcast what their car's bus and its receiver say."""
    n = state.shape[1]
    for v in range(n):
        period = int(round(radio_set[PERIOD, world_of[v]] / tick))
        if state[ACTIVE, v] > 0.0 and is_turn(k, entity[v], period):
            column = ((k + entity[v]) // period % RING) * n + v
            sent[SENT, column] = k * tick
            sent[M_X, column] = state[X, v] + sensors[GPS_EAST, v]
            sent[M_Y, column] = state[Y, v] + sensors[GPS_NORTH, v]
            sent[M_SPEED, column] = state[V_X, v]
            sent[M_ACCELERATION, column] = state[A_X, v]
            sent[M_INTENTION, column] = command[U, ((k - 1) % RING) * n + v]
            sent[M_TRUE_X, column] = state[X, v]
            sent[M_TRUE_Y, column] = state[Y, v]


@inlined
def may_arrive(time, tick, sent_at, w, radio_set):
    """Whether a message may come in at this tick, whatever is drawn."""
    soonest = radio.delay(radio_set[DELAY, w], radio_set[VARIATION, w], 0.0)
    latest = radio.delay(radio_set[DELAY, w], radio_set[VARIATION, w], 1.0)
    return sent_at + latest + EARLY > time - tick and sent_at + soonest - 2.0 * EARLY <= time


@inlined
def arrives(time, tick, number, sent_at, sender, receiver, w, radio_set, entity, seed):
    """Whether message `number` of the sender comes in at this tick: every message does so once."""
    link = entity[receiver] * PAIR + entity[sender]
    air = radio.delay(radio_set[DELAY, w], radio_set[VARIATION, w], uniform(seed, link, MESSAGE_DELAY, number))
    return time - tick < sent_at + air - EARLY <= time


@lean
def felt_distance(x0, y0, x1, y1, w, place, radio_set, shadow):
    """Distance [m] between two antennas, drawn out by the buildings between them."""
    distance = sqrt((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0))
    if radio_set[BUILDINGS, w] == 0.0 or distance > radio_set[RADIO_RANGE, w] or shadow.grid.frame[COLUMNS, place] == 0.0:
        return distance
    walls, inside = walls_between(shadow, place, x0, y0, EYE, x1, y1, EYE)
    return radio.felt_distance(distance, radio.attenuation(walls, inside), radio_set[EXPONENT, w])


@lean
def gets_through(number, column, sender, receiver, w, place, state, radio_set, entity, seed, sent, shadow):
    """Whether a message that comes in now is in range and not lost."""
    link = entity[receiver] * PAIR + entity[sender]
    distance = felt_distance(
        sent[M_TRUE_X, column], sent[M_TRUE_Y, column], state[X, receiver], state[Y, receiver], w, place, radio_set, shadow
    )
    draw = uniform(seed, link, MESSAGE_LOSS, number)
    return not radio.is_lost(distance, radio_set[RADIO_RANGE, w], radio_set[LOSS, w], radio_set[LOSS_DISTANCE, w], draw)


@lean
def receive(
    k, tick, state, radio_set, link_receiver, link_sender, world_of, entity, seed, place_of, shadow, sent, inbox
):  # fmt: skip
    """Third pass, second half: every link takes the newest of the messages that come in at this tick."""
    n = state.shape[1]
    for link in range(link_receiver.size):
        receiver, sender = link_receiver[link], link_sender[link]
        w = world_of[receiver]
        period = int(round(radio_set[PERIOD, w] / tick))
        newest = (k + entity[sender]) // period
        oldest = newest - int((radio_set[DELAY, w] + radio_set[VARIATION, w]) / radio_set[PERIOD, w]) - 2
        for number in range(newest, max(oldest, newest - RING, -1), -1):
            column = (number % RING) * n + sender
            sent_at = (number * period - entity[sender]) * tick
            if sent_at <= inbox[SENT, link]:
                break
            if not may_arrive(k * tick, tick, sent_at, w, radio_set):
                continue
            was_sent = abs(sent[SENT, column] - sent_at) < 0.5 * tick  # else it left before, and this is an older one
            if not was_sent or not arrives(k * tick, tick, number, sent_at, sender, receiver, w, radio_set, entity, seed[w]):
                continue
            if gets_through(number, column, sender, receiver, w, place_of[w], state, radio_set, entity, seed[w], sent, shadow):
                for row in range(inbox.shape[0]):
                    inbox[row, link] = sent[row, column]
                break
