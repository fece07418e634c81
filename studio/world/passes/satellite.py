"""Satellite receivers: where every car takes itself to be, with a slow error and white noise (studio/model/satellite.py)."""

from studio.compiled import inlined, lean
from studio.model import satellite
from studio.model.random import GPS_NOISE, normals
from studio.road.network.grid import COLUMNS
from studio.road.network.shadow import open_sky
from studio.vehicle.state import ACTIVE, X, Y
from studio.world.table.unit import CANYON, DRIFT_EAST, DRIFT_NORTH, DRIFT_SIGMA, DRIFT_TIME, GPS_EAST, GPS_NORTH, GPS_SIGMA, SKY


@lean
def fix(k, tick, state, gps_set, world_of, entity, seed, place_of, shadow, found):
    """Where every car takes itself to be. A car without errors draws nothing."""
    tau, phi = 0.0, 0.0
    for v in range(state.shape[1]):
        if state[ACTIVE, v] > 0.0 and (gps_set[DRIFT_SIGMA, v] > 0.0 or gps_set[GPS_SIGMA, v] > 0.0):
            if gps_set[DRIFT_TIME, v] != tau:  # most receivers are alike
                tau = gps_set[DRIFT_TIME, v]
                phi = satellite.kept(tick, tau) if k > 0 else 0.0
            if found[SKY, v] == 0.0 or satellite.looks_up((k - 1) * tick, k * tick, entity[v]):
                found[SKY, v] = sky_over(shadow, place_of[world_of[v]], state[X, v], state[Y, v])
            wander(k, v, phi, gps_set, entity[v], seed[world_of[v]], found)


@inlined
def sky_over(shadow, place, x, y):
    """Share of the sky that is open."""
    return open_sky(shadow, place, x, y) if shadow.grid.frame[COLUMNS, place] > 0.0 else 1.0


@inlined
def wander(k, v, phi, gps_set, unit, seed, found):
    """The error of a satellite position at this tick; at the first one, phi = 0, the slow error is drawn as if it had long been running."""
    draw_east, draw_north, noise_east, noise_north = normals(seed, unit, GPS_NOISE, k)
    found[DRIFT_EAST, v] = satellite.drift(found[DRIFT_EAST, v], phi, draw_east)
    found[DRIFT_NORTH, v] = satellite.drift(found[DRIFT_NORTH, v], phi, draw_north)
    sigma = satellite.spread(gps_set[DRIFT_SIGMA, v], gps_set[CANYON, v], found[SKY, v])
    found[GPS_EAST, v] = sigma * found[DRIFT_EAST, v] + gps_set[GPS_SIGMA, v] * noise_east
    found[GPS_NORTH, v] = sigma * found[DRIFT_NORTH, v] + gps_set[GPS_SIGMA, v] * noise_north
