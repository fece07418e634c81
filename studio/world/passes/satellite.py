"""Satellite receivers: where every car takes itself to be, with a slow error and white noise (studio/model/satellite.py)."""

from studio.compiled import inlined, lean
from studio.model import satellite
from studio.model.random import GPS_DRIFT, GPS_NOISE, normal_pair
from studio.road.network.grid import COLUMNS
from studio.road.network.shadow import open_sky
from studio.vehicle.state import ACTIVE, X, Y
from studio.world.table.unit import CANYON, DRIFT_EAST, DRIFT_NORTH, DRIFT_SIGMA, DRIFT_TIME, GPS_EAST, GPS_NORTH, GPS_SIGMA


@lean
def fix(k, tick, state, gps_set, world_of, entity, seed, place_of, shadow, found):
    """Where every car takes itself to be. A car without errors draws nothing."""
    tau, phi, frame = 0.0, 0.0, shadow.grid.frame
    for v in range(state.shape[1]):
        if state[ACTIVE, v] > 0.0 and (gps_set[DRIFT_SIGMA, v] > 0.0 or gps_set[GPS_SIGMA, v] > 0.0):
            if gps_set[DRIFT_TIME, v] != tau:  # most receivers are alike
                tau = gps_set[DRIFT_TIME, v]
                phi = satellite.kept(tick, tau) if k > 0 else 0.0
            place = place_of[world_of[v]]
            sky = open_sky(shadow, place, state[X, v], state[Y, v]) if frame[COLUMNS, place] > 0.0 else 1.0
            wander(k, v, sky, phi, gps_set, entity[v], seed[world_of[v]], found)


@inlined
def wander(k, v, sky, phi, gps_set, unit, seed, found):
    """The error of a satellite position at this tick; at the first one, phi = 0, the slow error is drawn as if it had long been running."""
    draw_east, draw_north = normal_pair(seed, unit, GPS_DRIFT, k)
    noise_east, noise_north = normal_pair(seed, unit, GPS_NOISE, k)
    found[DRIFT_EAST, v] = satellite.drift(found[DRIFT_EAST, v], phi, draw_east)
    found[DRIFT_NORTH, v] = satellite.drift(found[DRIFT_NORTH, v], phi, draw_north)
    sigma = satellite.spread(gps_set[DRIFT_SIGMA, v], gps_set[CANYON, v], sky)
    found[GPS_EAST, v] = sigma * found[DRIFT_EAST, v] + gps_set[GPS_SIGMA, v] * noise_east
    found[GPS_NORTH, v] = sigma * found[DRIFT_NORTH, v] + gps_set[GPS_SIGMA, v] * noise_north
