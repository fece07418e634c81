"""The same figures of our traffic, measured as they are on roads: at a place of a motorway, and of those who stop and start in a town."""

from typing import Any, NamedTuple

import numpy as np

import studio
from studio.road import load
from studio.road.network import Network, curve
from studio.scenario import setup
from studio.vehicle.parameter import LENGTH
from studio.vehicle.state import A_X, ACTIVE, V_X, X, Y
from studio.world.build import build
from studio.world.setting import setting
from studio.world.tick import tick
from studio.world.world import World
from tests.rush.place import SCENARIOS, prepared

AT = 4500.0  # [m] where is counted, of six kilometres
WARM, EVERY = 200.0, 5  # [s] until the first cars have passed there; ticks
AROUND, STILL, GOES = 25.0, 0.1, 8.0  # [m] from the place, [m/s], [m/s]
LITTLE, DENSE = 1500.0, 5100.0  # [1/h] on three lanes
FOLLOWS, LOOSE = 3.0, 5.0  # [s] who is nearer follows; who is farther drives freely
BIN = 0.2  # [s]


class Passage(NamedTuple):
    """Who has passed a place: when [s], on which lane from the kerb on, with what speed [m/s]; 1 for a car, 0 for a truck."""

    time: np.ndarray
    lane: np.ndarray
    speed: np.ndarray
    is_car: np.ndarray


# -- on a motorway -------------------------------------------------------------------------------------


def motorway(rate: float, seconds: float, seed: int) -> Passage:
    """Everybody who passes a place of a motorway with three lanes, of a flow of so many an hour, 12 % of them trucks."""
    network = load(SCENARIOS / "motorway.xodr")
    world = build([setting(setup.complete(document(rate, seconds, seed), "motorway"), SCENARIOS, "motorway")])
    place = place_on(network)
    found, last = [], np.full(world.size, np.nan)
    for k in range(round(seconds / world.clock.tick)):
        tick(world)
        if k % EVERY == 0:
            state = world.vehicles.state
            found += passed(world, place, last, k * world.clock.tick)
            last = seen_from(place, state)[0]
    return Passage(*np.array([each for each in found if each[0] > WARM]).T)


def document(rate: float, seconds: float, seed: int) -> dict[str, Any]:
    """The scenario."""
    return {
        "title": "likeness", "seed": seed, "map": {"file": "motorway.xodr"}, "clock": {"duration": seconds},
        "routes": {"way": {"roads": ["motorway"]}},
        "vehicles": {"own": {"route": "way", "position": {"along": 5800}, "speed": 20}},
        "traffic": {
            "dynamics": "light", "lane_changes": True, "flows": {"all": {"route": "way", "rate": rate}},
            "mix": {"ford_escort": 44, "bmw_320i": 44, "truck": 12},
        },
    }  # fmt: skip


def place_on(network: Network) -> tuple[float, float, float, np.ndarray]:
    """Where the lane at the kerb is at the place, which way it leads [m, m, rad], and how far to the left the lanes are there [m]."""
    centres = [lane.centre[:2] for lane in network.lanes_of("motorway")]
    s = curve.stations(centres[0])
    (x, y), (x1, y1) = ([np.interp(at, s, row) for row in centres[0]] for at in (AT, AT + 1.0))
    offsets = [np.hypot(*(curve.resampled(each, 0.5) - np.array([[x], [y]]))).min() for each in centres]
    return x, y, np.arctan2(y1 - y, x1 - x), np.array(offsets)


def seen_from(place: tuple, state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How far everybody is beyond the place and to the left of the lane at the kerb [m]; not a number for who is far away."""
    x, y, heading, _ = place
    dx, dy = state[X] - x, state[Y] - y
    here = (np.hypot(dx, dy) < AROUND) & (state[ACTIVE] > 0)
    along, aside = dx * np.cos(heading) + dy * np.sin(heading), dy * np.cos(heading) - dx * np.sin(heading)
    return np.where(here, along, np.nan), aside


def passed(world: World, place: tuple, last: np.ndarray, time: float) -> list[tuple]:
    """Who has just passed it."""
    state = world.vehicles.state
    now, aside = seen_from(place, state)
    over = np.flatnonzero((last < 0.0) & (now >= 0.0))
    lanes, speed = np.abs(place[3][:, None] - aside[over]).argmin(axis=0), state[V_X, over]
    is_car = world.vehicles.parameter[LENGTH, over] < 6.0
    return list(zip(time - now[over] / np.maximum(speed, 1.0), lanes, speed, is_car, strict=True))


def headways(of: Passage) -> np.ndarray:
    """From front to front [s], of everybody but the first on his lane."""
    order = np.lexsort([of.time, of.lane])
    time, lane = of.time[order], of.lane[order]
    return np.diff(time)[np.diff(lane) == 0]


def most_frequent(values: np.ndarray) -> float:
    """The middle of the bin that holds most."""
    counts, edges = np.histogram(values, np.arange(0.0, 10.0, BIN))
    return float(edges[counts.argmax()] + 0.5 * BIN)


def shares(of: Passage) -> np.ndarray:
    """Of all who pass, lane by lane from the kerb on."""
    return np.bincount(of.lane.astype(int), minlength=3) / of.lane.size


def car_speed(of: Passage) -> float:
    """Mean of the cars [km/h]."""
    return 3.6 * float(of.speed[of.is_car > 0].mean())


# -- in a town -----------------------------------------------------------------------------------------


def town(cars: int, seconds: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Mean accelerations of those who start, up to 8 m/s, and greatest decelerations of those who stop, from 8 m/s on [m/s²]."""
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


def best_start() -> float:
    """Mean acceleration up to 8 m/s that the cars of this traffic can do [m/s²]."""
    driven = studio.drive("ford_escort", {"time_s": [0, 10], "throttle": [1, 1]})
    return GOES / float(driven["time_s"][np.argmax(driven["vx_mps"] >= GOES)])


# -- all of it -----------------------------------------------------------------------------------------


def figures(seconds: float, cars: int, seed: int) -> dict[str, float]:
    """All figures by name, as `published` has them."""
    little, dense = (motorway(rate, WARM + seconds, seed) for rate in (LITTLE, DENSE))
    sparse, near = headways(little), headways(dense)
    starts, stops = town(cars, seconds, seed)
    return {
        "mean speed of cars, little traffic": car_speed(little),
        "headway that is most frequent, little traffic": most_frequent(sparse),
        "headway that is most frequent, dense traffic": most_frequent(near),
        "mean headway of followers, dense traffic": float(near[near < FOLLOWS].mean()),
        "median headway below 5 s, dense traffic": float(np.median(near[near < LOOSE])),
        "share of the lane at the kerb, dense over little traffic": float(shares(dense)[0] / shares(little)[0]),
        "share of the lane at the median, dense over little traffic": float(shares(dense)[2] / shares(little)[2]),
        "acceleration from rest over what the car can do": float(starts.mean()) / best_start(),
        "greatest deceleration before a stop, 85 of 100": float(np.quantile(stops, 0.85)),
    }
