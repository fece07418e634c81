"""The same figures of our traffic, measured as they are on roads: at a place of a motorway, and of those who stop and start in a town."""

from typing import Any, NamedTuple

import numpy as np

from studio.road import load
from studio.road.network import Network
from studio.scenario import setup
from studio.vehicle.parameter import LENGTH, MASS
from studio.vehicle.state import A_X, ACTIVE, V_X, X, Y
from studio.world.build import build
from studio.world.setting import setting
from studio.world.tick import tick
from studio.world.world import World
from tests.rush.place import SCENARIOS, prepared

AT = 4500.0  # [m] where is counted, of six kilometres
WARM, EVERY = 200.0, 5  # [s] until the first cars have passed there; ticks
ASIDE, STILL, GOES = 25.0, 0.1, 5.0  # [m] from the lane, [m/s], [m/s]
LITTLE, DENSE = 1500.0, 5100.0  # [1/h] on three lanes
FOLLOWS, LOOSE = 3.0, 5.0  # [s] who is nearer follows; who is farther drives freely
BIN = 0.2  # [s]


class Passage(NamedTuple):
    """Who has passed a place: when [s], on which lane from the kerb on, with what speed [m/s], by which number; 1 for a car, 0 for a truck."""

    time: np.ndarray
    lane: np.ndarray
    speed: np.ndarray
    is_car: np.ndarray


# -- on a motorway -------------------------------------------------------------------------------------


def motorway(rate: float, seconds: float, seed: int) -> Passage:
    """Everybody who passes a place of a motorway with three lanes, of a flow of so many an hour, 12 % of them trucks."""
    network = load(SCENARIOS / "motorway.xodr")
    world = build([setting(setup.complete(document(rate, seconds, seed), "motorway"), SCENARIOS, "motorway")])
    centres = np.array([place_on(network, lane.id) for lane in network.lanes_of("motorway")])
    found, last = [], np.full(world.size, np.nan)
    for k in range(round(seconds / world.clock.tick)):
        tick(world)
        if k % EVERY == 0:
            state = world.vehicles.state
            found += passed(world, centres, last, k * world.clock.tick)
            last = along(centres, state)
    return Passage(*np.array([each for each in found if each[0] > WARM]).T)


def document(rate: float, seconds: float, seed: int) -> dict[str, Any]:
    """The scenario."""
    return {
        "title": "likeness", "seed": seed, "map": {"file": "motorway.xodr"}, "clock": {"duration": seconds},
        "routes": {"way": {"roads": ["motorway"]}},
        "vehicles": {"own": {"route": "way", "position": {"along": 5800}, "speed": 20}},
        "traffic": {
            "dynamics": "light", "flows": {"all": {"route": "way", "rate": rate}}, "mix": {"ford_escort": 44, "bmw_320i": 44, "truck": 12},
            "spread": {"speed_factor": {"kind": "normal", "mean": 0.95, "deviation": 0.1}},
        },
    }  # fmt: skip


def place_on(network: Network, lane: int) -> tuple[float, float, float]:
    """Where the middle of a lane is at the place, and which way it leads [m, m, rad]."""
    centre = network.lanes[lane].centre
    s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(centre[:2])))])
    (x, y), (x1, y1) = ([np.interp(at, s, row) for row in centre[:2]] for at in (AT, AT + 1.0))
    return x, y, np.arctan2(y1 - y, x1 - x)


def along(centres: np.ndarray, state: np.ndarray) -> np.ndarray:
    """How far everybody is beyond the place [m]; not a number for who is far away."""
    x, y, heading = centres[0]
    dx, dy = state[X] - x, state[Y] - y
    here = np.hypot(dx, dy) < ASIDE
    return np.where(here & (state[ACTIVE] > 0), dx * np.cos(heading) + dy * np.sin(heading), np.nan)


def passed(world: World, centres: np.ndarray, last: np.ndarray, time: float) -> list[tuple]:
    """Who has just passed it."""
    state, now = world.vehicles.state, along(centres, world.vehicles.state)
    over = np.flatnonzero((last < 0.0) & (now >= 0.0))
    lanes = np.hypot(centres[:, 0, None] - state[X, over], centres[:, 1, None] - state[Y, over]).argmin(axis=0)
    speed = state[V_X, over]
    is_car = world.vehicles.parameter[LENGTH, over] < 6.0
    return list(zip(time - now[over] / np.maximum(speed, 1.0), lanes, speed, is_car, strict=True))


def headways(of: Passage) -> tuple[np.ndarray, np.ndarray]:
    """From front to front [s], of everybody but the first on his lane, and his speed."""
    order = np.lexsort([of.time, of.lane])
    time, lane = of.time[order], of.lane[order]
    same = np.diff(lane) == 0
    return np.diff(time)[same], of.speed[order][1:][same]


def most_frequent(values: np.ndarray) -> float:
    """The middle of the bin that holds most."""
    counts, edges = np.histogram(values, np.arange(0.0, 10.0, BIN))
    return float(edges[counts.argmax()] + 0.5 * BIN)


def shares(of: Passage) -> np.ndarray:
    """Of all who pass, lane by lane from the kerb on."""
    return np.bincount(of.lane.astype(int), minlength=3) / of.lane.size


def free_speed(of: Passage) -> float:
    """Mean of the cars that nobody is near before [km/h]."""
    order = np.lexsort([of.time, of.lane])
    time, lane = of.time[order], of.lane[order]
    free = np.concatenate([[False], (np.diff(lane) != 0) | (np.diff(time) > LOOSE)]) & (of.is_car[order] > 0)
    return 3.6 * float(of.speed[order][free].mean())


# -- in a town -----------------------------------------------------------------------------------------


def town(cars: int, seconds: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Of everybody who starts, his mean acceleration up to 5 m/s; of everybody who stops, his greatest deceleration from 5 m/s on [m/s²]."""
    world = build([prepared("grid", cars, seconds, seed)])
    starts, stops, slow = [], [], np.zeros(world.size)
    began, hardest = np.full(world.size, np.nan), np.full(world.size, np.nan)
    for k in range(round(seconds / world.clock.tick)):
        tick(world)
        state, time = world.vehicles.state, k * world.clock.tick
        v, a, there = state[V_X], state[A_X], state[ACTIVE] > 0
        slow = np.where(there & (v < STILL), slow + 1, 0)
        stopped = there & (slow == 1) & np.isfinite(hardest)
        stops += list(-hardest[stopped])
        fast = there & (v >= GOES)
        starts += list(GOES / (time - began[fast & np.isfinite(began)]))
        began = np.where(there & (v < STILL), time, np.where(fast | ~there, np.nan, began))
        hardest = np.where(fast, np.inf, np.where(there & (v >= STILL), np.minimum(hardest, a), np.nan))
    return np.array(starts), np.array(stops)
