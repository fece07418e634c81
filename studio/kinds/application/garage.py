"""A garage that parks the cars that are handed over to it: it sees them with its cameras, gives them spaces, and lets them drive.

It is a unit without a vehicle. At every look of the cameras it
    finds       its cars among what they see, each next to where the car takes itself to be; who is short is a person, who stands in a
                space and is nobody's has taken it
    takes in    the first of the queue at the gate, when a space that it gets into and the ground under it are free, and says which space
    calls back  who has been parked for `stay`
    replaces    the space of who comes in, when a stranger stands in it and the car is still in the aisle; else it has the car wait
    grants      tiles of the aisle, to those ahead first: to whom asks for no more than is free and safe (studio/garage/reservation.py);
                who pulls out of a space gets all that it needs for it at once; when it has waited for `patience` nobody else is let there
    tells       all of it, to everybody

All aisles are one-way and every car asks for tiles ahead of those that it holds: tiles are taken in the order of their numbers, which
alone excludes a circle of cars that wait for each other. That all can arrive is looked up all the same, for any other plan.
"""

from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from pydantic import Field

from studio.application.contract import Clock, Inbox, Outbox, Own, Targets
from studio.garage import allocation, plan, reservation, way
from studio.garage.plan import Plan
from studio.garage.way import Car
from studio.kind.settings import Part, number
from studio.kinds.message.parking_order import COME_BACK, DRIVE_IN, MOST, NONE, PERSONS, Payload, Twelve
from studio.kinds.message.parking_status import GIVEN_BACK, OUTSIDE
from studio.kinds.message.parking_status import PARKED as IS_PARKED
from studio.kinds.message.parking_status import Payload as Status
from studio.kinds.sensor.deck_cameras import Reading as Target

KIND = "application"
TITLE = "Garage that parks cars (PACE)"
FIRST_COME = 1  # place of this allocation in its list
TILE, BEFORE = 2.5, 10.0  # [m] of the aisle; [m] before the gate at which the first one begins
COMING, PARKED, CALLED, LEAVING = 1.0, 2.0, 3.0, 4.0  # states of a car; 0 the place is free
NEAR = 1.6  # [m] between where a car takes itself to be and where the cameras see it
QUEUE = 3.5  # [m] likewise outside, by satellite
SHORT = 1.4  # [m] who is shorter is a person
AHEAD = 9.0  # [m] that are granted before the front: enough to stop on
SLACK = 0.4  # [m] that a permit ends before its tile
LATE = 5.0  # [m] before it turns in, a car may be given another space
SILENT = 1.5  # [s] after which a status counts no more
OUT = 12.0  # [m] beyond the gate a car is out of the way
EARLY = 1e-6  # [s]


class Parameters(Part):
    """How it works."""

    allocation: Literal["optimal", "first_come"] = Field(
        "optimal", title="Allocation", description="the queue so that nobody waits for who turns in before him, or each the nearest space"
    )
    spaces: int = number(60, unit="1", title="Spaces", description="that it gives away, the lowest numbers first", ge=1, le=800)
    zones: int = number(3, unit="1", title="Zones", description="in which cars turn in side by side, by the optimal allocation", ge=1, le=6)
    stay: float = number(60.0, unit="s", title="Stay", description="from parked until called back", ge=0, le=36_000)
    patience: float = number(15.0, unit="s", title="Patience", description="of who wants to pull out", ge=0, le=600)
    period: float = number(0.06, unit="s", title="Period", description="of its orders", ge=0.02, le=1)
    groups: int = number(5, unit="1", title="Groups", description="of spaces in each of the four rows of the deck", ge=1, le=20)
    together: int = number(3, unit="1", title="Spaces of a group", description="between two pillars", ge=1, le=10)
    space_length: float = number(5.0, unit="m", title="Length of a space", ge=4, le=7)
    space_width: float = number(2.5, unit="m", title="Width of a space", ge=2, le=4)
    aisle: float = number(6.0, unit="m", title="Width of the aisles", ge=4, le=10)


class Memory(NamedTuple):
    """Its cars."""

    sent: Annotated[float, "s"] = -1.0
    ticket: Annotated[Twelve, "1"] = NONE
    state: Annotated[Twelve, "1", "1 comes in, 2 parked, 3 called, 4 leaves"] = NONE
    space: Annotated[Twelve, "1"] = NONE
    since: Annotated[Twelve, "s", "when the state began"] = NONE
    low: Annotated[Twelve, "1", "first tile that it holds"] = NONE
    high: Annotated[Twelve, "1", "last one"] = NONE
    served: Annotated[float, "1", "cars that have left"] = 0.0


class Sees(NamedTuple):
    """The cameras, and the cars."""

    clock: Clock
    own: Own
    deck: Annotated[Targets, "deck_cameras", 24]
    heard: Annotated[Inbox, "parking_status", 40]


class Log(NamedTuple):
    """What is recorded."""

    inside: Annotated[float, "1"] = 0.0
    queue: Annotated[float, "1"] = 0.0
    served: Annotated[float, "1"] = 0.0
    persons: Annotated[float, "1"] = 0.0
    groups: Annotated[float, "1"] = 0.0  # the plan of the deck, as its parameters have it
    together: Annotated[float, "1"] = 0.0
    space_length: Annotated[float, "m"] = 0.0
    space_width: Annotated[float, "m"] = 0.0
    aisle: Annotated[float, "m"] = 0.0


class Does(NamedTuple):
    """Orders."""

    send: Annotated[Outbox, "parking_order", 1]
    log: Log


class Guest:
    """A car that it has taken in, while it decides."""

    def __init__(self, deck: Plan, ticket: float, state: float, space: float, since: float, low: float, high: float) -> None:
        self.deck, self.ticket, self.state, self.space, self.since = deck, ticket, state, int(space), since
        self.low, self.high = int(low), int(high)
        self.status: Status | None = None
        self.target: Any = None

    @property
    def holds(self) -> frozenset[int]:
        """Its tiles."""
        return frozenset(range(self.low, self.high + 1)) if self.state in (COMING, LEAVING) else frozenset()

    @property
    def car(self) -> Car:
        """What its ways depend on."""
        assert self.status is not None
        return car_of(self.status)

    @property
    def front(self) -> float:
        """Station [m] of its front."""
        return self.status.rear + self.status.length if self.status else -1e3

    def enter(self, state: float, time: float) -> None:
        """Another state."""
        self.state, self.since = state, time

    def turn(self) -> tuple[int, int]:
        """Tiles from beside its space to where its front is when it turns in or out."""
        s, car = way.turning_in(self.deck, self.space, self.car)[0], self.car
        return tile(plan.spaces(self.deck)[self.space].station - 2.5), tile(s + car.wheelbase + car.front + 0.6)

    def goal(self) -> int:
        """The last tile that it asks for."""
        return self.turn()[1] if self.state == COMING else tile(self.deck.whole + OUT)


def car_of(told: Status) -> Car:
    """What a car tells of itself."""
    return Car(told.wheelbase, told.length, told.width, told.front, told.radius)


def tile(s: float) -> int:
    """The tile at a station [m]."""
    return max(int((s + BEFORE) // TILE), 0)


def deck_of(p: Parameters) -> Plan:
    """The deck that it is in."""
    return Plan(int(p.groups), int(p.together), float(p.space_length), float(p.space_width), float(p.aisle))


def guests_of(m: Memory, deck: Plan) -> list[Guest]:
    """Who is there."""
    rows = zip(m.ticket, m.state, m.space, m.since, m.low, m.high, strict=True)
    return [Guest(deck, *row) for row in rows if row[1] != 0.0]


def statuses(sees: Sees) -> dict[float, Status]:
    """What the cars have told lately, by ticket."""
    heard = [sees.heard.message[i] for i in range(sees.heard.count)]
    return {each.payload.ticket: each.payload for each in heard if each.received and each.age < SILENT}


def seen(sees: Sees) -> list:
    """What the cameras see."""
    return [sees.deck.target[i] for i in range(sees.deck.count)]


def find(guests: list[Guest], told: dict[float, Status], targets: list) -> None:
    """The guests' words, and where the cameras have them."""
    free = [each for each in targets if each.length >= SHORT]
    for guest in guests:
        guest.status = told.get(guest.ticket)
        if guest.status is None:
            continue
        reach = NEAR if guest.status.rear > -500.0 else QUEUE
        best = min(free, key=lambda each, at=guest.status: away(each, at), default=None)
        if best is not None and away(best, guest.status) < reach:
            guest.target = best
            free.remove(best)


def away(target, status: Status) -> float:
    """Between a target and where a car takes itself to be [m]."""
    return float(np.hypot(target.x - status.x, target.y - status.y))


def strangers(guests: list[Guest], targets: list) -> list:
    """Whom the cameras see, who is no person and nobody's."""
    own = [each.target for each in guests if each.target is not None]
    return [each for each in targets if each.length >= SHORT and not any(each is one for one in own)]


def stands_in(deck: Plan, number: int, target) -> bool:
    """Whether somebody stands in a space."""
    it = plan.spaces(deck)[number]
    return abs(target.x - it.x) < 0.48 * deck.width and abs(target.y - it.y) < 0.48 * deck.length


def taken(deck: Plan, guests: list[Guest], targets: list) -> set[int]:
    """Spaces that are given away, or in which somebody stands."""
    others = strangers(guests, targets)
    strange = {i for i in range(deck.spaces) if any(stands_in(deck, i, each) for each in others)}
    return strange | {each.space for each in guests}


def queue_of(deck: Plan, told: dict[float, Status], guests: list[Guest]) -> list[Status]:
    """Who waits outside, the first one first."""
    known = {each.ticket for each in guests}
    waits = [each for each in told.values() if each.phase == OUTSIDE and each.ticket not in known and each.x < -deck.gate + 3.0]
    return sorted(waits, key=lambda each: abs(each.x + deck.gate) + abs(each.y + deck.radius))


def choose(p: Parameters, queue: list[Status], free: list[int], first: int) -> int:
    """The space of the first in the queue."""
    depth = np.array([plan.spaces(deck_of(p))[each].station for each in free])
    if int(p.allocation) == FIRST_COME:
        return free[int(np.argmin(depth))]
    cars = min(len(queue), len(free))
    return free[int(allocation.optimal(allocation.queued(cars, depth, first, int(p.zones)))[0])]


def chosen(p: Parameters, queue: list[Status], free: list[int], first: int, car: Car) -> int | None:
    """The same among the spaces that the first one gets into; nothing where it gets into none."""
    left = list(free)
    while left:
        number = choose(p, queue, left, first)
        if way.fits(deck_of(p), number, car):
            return number
        left.remove(number)
    return None


def is_at_gate(deck: Plan, target) -> bool:
    """Whether somebody is before the gate, or in it."""
    return -deck.gate - 11.0 < target.x < -deck.gate + 1.0 and abs(target.y + deck.radius) < 2.0


def take_in(p: Parameters, m: Memory, time: float, guests: list[Guest], queue: list[Status], targets: list) -> None:
    """The first of the queue, when the cameras see it at the gate and there is room."""
    deck = deck_of(p)
    free = sorted(set(range(min(int(p.spaces), deck.spaces))) - taken(deck, guests, targets))
    own = [id(each.target) for each in guests]
    there = [each for each in targets if each.length >= SHORT and is_at_gate(deck, each) and id(each) not in own]
    if not queue or not free or not there or len(guests) == MOST:
        return
    first = max(there, key=lambda each: each.x)
    status = min(queue, key=lambda each: away(first, each))
    under = frozenset(range(tile(-1e3), tile(first.x + deck.gate + 0.5 * status.length + 0.5) + 1))
    if away(first, status) > QUEUE or any(under & each.holds for each in guests):
        return
    number = chosen(p, queue, free, int(m.served) + len(guests), car_of(status))
    if number is not None:
        guest = Guest(deck, status.ticket, COMING, number, time, min(under), max(under))
        guest.status, guest.target = status, first
        guests.append(guest)


def move_on(p: Parameters, time: float, guests: list[Guest]) -> float:
    """What has changed since the last look; how many have left."""
    left = 0.0
    for guest in list(guests):
        status, left_at = guest.status, guest.deck.whole + OUT
        if status is None:
            continue
        if guest.state == COMING and status.phase == IS_PARKED:
            guest.enter(PARKED, time)
        elif guest.state in (COMING, LEAVING) and status.rear > -500.0:
            behind = tile(status.rear - 0.3)
            guest.low = max(guest.low, min(behind, guest.turn()[0]) if guest.state == COMING else behind)
        if guest.state == PARKED and time - guest.since >= p.stay:
            guest.enter(CALLED, time)
        if guest.state == LEAVING and (status.rear > left_at or (status.phase == GIVEN_BACK and status.rear > left_at - 1.0)):
            guests.remove(guest)
            left += 1.0
    return left


def give_another(p: Parameters, guests: list[Guest], targets: list) -> list:
    """Another space for who finds a stranger in his own, the next one on his way; who is in the way where there is none, or too late."""
    others, blocked = strangers(guests, targets), []
    for guest in (each for each in guests if each.state == COMING and each.status):
        there = [each for each in others if stands_in(guest.deck, guest.space, each)]
        if there and not replaced(p, guest, guests, targets):
            blocked += there
    return blocked


def replaced(p: Parameters, guest: Guest, guests: list[Guest], targets: list) -> bool:
    """Whether it has another space now: while it is in the aisle, one that it has not passed."""
    deck, at = guest.deck, guest.status.rear + guest.car.rear if guest.status else 0.0
    if at > way.turning_in(deck, guest.space, guest.car)[0] - LATE:
        return False
    free = set(range(min(int(p.spaces), deck.spaces))) - taken(deck, guests, targets)
    ahead = sorted((plan.spaces(deck)[each].station, each) for each in free if plan.spaces(deck)[each].station > at + LATE)
    number = next((each for _, each in ahead if way.fits(deck, each, guest.car)), None)
    guest.space = guest.space if number is None else number
    return number is not None


def steps(guest: Guest, held: frozenset[int]) -> list[frozenset[int]]:
    """The rest of its way: what it holds, with the next tile, and tile by tile to its goal."""
    ahead = range(guest.high + 1, guest.goal() + 1)
    return [held, *([held | {guest.high + 1}] if ahead else []), *(frozenset((n - 1, n)) for n in ahead[1:])]


def grant(p: Parameters, time: float, guests: list[Guest]) -> None:
    """Tiles, to those ahead first; then to who has been called, who has waited longest first."""
    moving = sorted((each for each in guests if each.state in (COMING, LEAVING) and each.status), key=lambda each: -each.high)
    called = sorted((each for each in guests if each.state == CALLED and each.status), key=lambda each: each.since)
    claims = [(each, frozenset(range(each.turn()[0], each.turn()[1] + 1))) for each in called]
    kept = frozenset().union(*(tiles for each, tiles in claims if time - each.since > p.patience))
    for guest in moving:
        barred, goal = (kept if not guest.holds & kept else frozenset()), min(guest.goal(), tile(guest.front + AHEAD))
        while guest.high < goal and guest.high + 1 not in barred and may(guest, moving):
            guest.high += 1
    for guest, tiles in claims:
        others = [each for each in guests if each.state in (COMING, LEAVING)]
        if not any(tiles & each.holds for each in others):
            guest.enter(LEAVING, time)
            guest.low, guest.high = min(tiles), max(tiles)


def may(guest: Guest, moving: list[Guest]) -> bool:
    """Whether a car may have the next tile."""
    ways = [steps(each, each.holds) for each in moving]
    return reservation.grants(ways, [0] * len(moving), moving.index(guest))


def padded(values: list[float], size: int) -> Any:
    """A tuple of so many numbers, the rest 0."""
    return tuple([float(each) for each in values] + [0.0] * (size - len(values)))


def orders(deck: Plan, sees: Sees, guests: list[Guest], targets: list, blocked: list) -> Payload:
    """What is told."""
    blind = Target(0.0, 0.0, 0.0, 0.0)
    at = [guest.target or blind for guest in guests]
    short = [*(each for each in targets if each.length < SHORT), *blocked][:PERSONS]
    return Payload(
        count=float(len(guests)),
        age=sees.deck.age,
        ticket=padded([guest.ticket for guest in guests], MOST),
        x=padded([each.x for each in at], MOST),
        y=padded([each.y for each in at], MOST),
        heading=padded([each.heading for each in at], MOST),
        is_seen=padded([guest.target is not None for guest in guests], MOST),
        order=padded([{COMING: DRIVE_IN, LEAVING: COME_BACK}.get(guest.state, 0.0) for guest in guests], MOST),
        space=padded([guest.space for guest in guests], MOST),
        permit=padded([(guest.high + 1) * TILE - BEFORE - SLACK for guest in guests], MOST),
        persons=float(len(short)),
        person_x=padded([each.x for each in short], PERSONS),
        person_y=padded([each.y for each in short], PERSONS),
        groups=float(deck.groups),
        together=float(deck.together),
        space_length=deck.length,
        space_width=deck.width,
        aisle=deck.aisle,
    )


def remembered(m: Memory, time: float, guests: list[Guest], served: float) -> Memory:
    """What is kept."""
    rows = {name: padded([getattr(guest, name) for guest in guests], MOST) for name in ("ticket", "state", "space", "since", "low", "high")}
    return Memory(sent=time, served=m.served + served, **rows)


def decide(parameters, memory, sees):
    """One tick."""
    p, m, time = parameters, memory, sees.clock.time
    if m.sent >= 0.0 and time - m.sent < p.period - EARLY:
        return m, Does(Outbox(0, (Payload(),)), Log(sum(each != 0.0 for each in m.state) * 1.0, 0.0, m.served, 0.0, *deck_of(p)))
    deck = deck_of(p)
    guests, told, targets = guests_of(m, deck), statuses(sees), seen(sees)
    find(guests, told, targets)
    served = move_on(p, time, guests)
    queue = queue_of(deck, told, guests)
    take_in(p, m, time, guests, queue, targets)
    blocked = give_another(p, guests, targets)
    grant(p, time, guests)
    payload = orders(deck, sees, guests, targets, blocked)
    log = Log(float(len(guests)), float(len(queue)), m.served + served, payload.persons, *deck)
    return remembered(m, time, guests, served), Does(Outbox(1, (payload,)), log)
