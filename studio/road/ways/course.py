"""Where a lane leads: its successors with the ways through junctions, the road followed ahead, the light at its end."""

from typing import NamedTuple

from studio.compiled import compiled
from studio.road.network import Network
from studio.road.network.index import (
    CYCLE,
    LANE_LENGTH,
    LIGHT,
    NONE,
    OFFSET,
    PHASE_COUNT,
    PHASE_FIRST,
    STEP_BACK,
    STEP_COUNT,
    STEP_FIRST,
    STEP_NEXT,
    STEP_TO,
    VIA_COUNT,
    VIA_FIRST,
    index_of,
)
from studio.road.network.signals import signal_state
from studio.road.ways.frenet import Place

MOST_HOPS = 10_000  # lanes of no length must not keep one going for ever


class Step(NamedTuple):
    """How a lane is left: onto the road's lane `to`, over the lanes `via`; `back` where that is a turn back."""

    to: int
    via: tuple[int, ...]
    back: bool


def successors(network: Network, lane: int) -> tuple[Step, ...]:
    """How a lane may be left, the straightest way first, turning back last."""
    index = index_of(network)
    first, count = index.spans[[STEP_FIRST, STEP_COUNT], lane]
    steps = index.steps[:, first : first + count].T.tolist()
    return tuple(
        Step(step[STEP_TO], tuple(index.via[step[VIA_FIRST] : step[VIA_FIRST] + step[VIA_COUNT]].tolist()), bool(step[STEP_BACK]))
        for step in steps
    )


def ahead(network: Network, place: Place, distance: float) -> tuple[Place, float]:
    """The place that lies `distance` [m] ahead, straight on at every fork, and what is left of it where the road ends [m]."""
    lane, s, left = follow(index_of(network), place.lane, float(place.s), float(distance))
    return Place(lane, s, place.d), left


def light(network: Network, lane: int, t: float) -> int | None:
    """What the signal at the end of a lane shows at time t [s], as `studio.road.network.signals` names it; None without one."""
    shown = light_at_end(index_of(network), lane, float(t))
    return None if shown == NONE else int(shown)


@compiled
def straight_on(index, lane):
    """The step straight on from the end of a lane; NONE where nothing but a turn back leads on."""
    first = index.spans[STEP_FIRST, lane]
    if index.spans[STEP_COUNT, lane] == 0 or index.steps[STEP_BACK, first] == 1:
        return NONE
    return first


@compiled
def follow(index, lane, s, distance):
    """Lane and s [m] of the place `distance` [m] ahead, straight on at forks, and what is left where the road ends [m]."""
    for _ in range(MOST_HOPS):
        room = index.lanes[LANE_LENGTH, lane] - s
        if distance <= room:
            return lane, s + distance, 0.0
        step = straight_on(index, lane)
        if step == NONE:
            break
        lane, s, distance = index.steps[STEP_NEXT, step], 0.0, distance - room
    return lane, index.lanes[LANE_LENGTH, lane], distance - (index.lanes[LANE_LENGTH, lane] - s)


@compiled
def light_at_end(index, lane, t):
    """What the signal at the end of a lane shows at time t [s]; NONE without one."""
    link = index.spans[LIGHT, lane]
    if link == NONE:
        return NONE
    return signal_state(
        t, index.light_time[CYCLE, link], index.light_time[OFFSET, link], index.light_span[PHASE_FIRST, link],
        index.light_span[PHASE_COUNT, link], index.phase_end, index.phase_state,
    )  # fmt: skip
