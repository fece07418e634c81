"""Face to face: named cars that start towards each other on ground that a street's one lane gives to both directions.

Such ground is passed one after the other (passes/narrow.py), and who is on it does not go back: two that begin there would stand for ever.
"""

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import NamedTuple

from studio.road.network import Network
from studio.road.ways.meeting import meetings_of
from studio.road.ways.strand import driven
from studio.world.car import Car


class Standing(NamedTuple):
    """A car at its start: on which lane, and where its rear and its nose are on it [m]."""

    car: Car
    lane: int
    rear: float
    nose: float


def standoffs(cars: Sequence[Car], network: Network) -> Iterator[tuple[Car, Car]]:
    """Pairs of cars that start so, each once, in the order of the cars."""
    if not any(lane.facing >= 0 for lane in network.lanes):
        return
    starts = [each for car in cars for each in standing(car, network)]
    for one, other in combinations(starts, 2):
        if network.lanes[one.lane].facing == other.lane and is_face_to_face(one, other, network):
            yield one.car, other.car


def standing(car: Car, network: Network) -> Iterator[Standing]:
    """Where a car starts, if that is a lane of such a street."""
    body = car.model.values.body
    nose = car.station + body.front_distance + body.front_overhang
    for each in driven(network, car.path):
        is_lane = each.strand < len(network.lanes) and network.lanes[each.strand].facing >= 0
        if is_lane and each.enter <= nose and nose - body.length <= each.leave:
            on = each.start - each.enter
            yield Standing(car, each.strand, nose - body.length + on, nose + on)


def is_face_to_face(one: Standing, other: Standing, network: Network) -> bool:
    """Whether both are on the ground that their lanes share, each with the other before it."""
    met = meetings_of(network)
    for m in range(met.first[one.lane], met.first[one.lane + 1]):
        enter, leave, its_enter, its_leave = met.span[:, m]
        on_it = one.nose > enter and one.rear < leave and other.nose > its_enter and other.rear < its_leave
        # the other's nose, measured along the lane of the one
        if met.partner[m] == other.lane and on_it and enter + its_leave - other.nose > one.rear:
            return True
    return False
