"""Parking by itself: a car that is handed over at the gate of a garage drives to the space that it is given, and comes back on call.

Outside its driver drives, and stops before the gate while the garage has no space for it. With the first order it is the application's:
along the aisle as far as its permit reaches, backward into the space, and on call out again and through the other gate, where the driver
has it back. Where it is it knows from the garage's cameras, by message, and from its own speed and yaw rate between
(studio/garage/tracker.py). When no fix has come for `blind` seconds, no order for as long, or somebody walks on its way, it stands."""

from math import atan2, cos, floor, sin
from typing import Annotated, NamedTuple

from studio.application.contract import (
    ACCELERATION,
    BRAKE_TORQUE,
    DRIVE_TORQUE,
    GEAR,
    STEERING,
    Clock,
    Command,
    Inbox,
    Outbox,
    Own,
    accelerate,
    also,
    brake,
    drive,
    leave,
    shift,
    steer,
)
from studio.garage import plan, tracker
from studio.garage.plan import Plan, Pose
from studio.garage.way import Car, Way, nearest
from studio.kind.settings import Part, number
from studio.kinds.message.parking_order import COME_BACK, DRIVE_IN, MOST
from studio.kinds.message.parking_status import COMING_BACK, DRIVING_IN, GIVEN_BACK, OUTSIDE, PARKED, Payload

KIND = "application"
TITLE = "Automated parking (PACE): a car in a garage"
COMMANDS = ACCELERATION | STEERING | DRIVE_TORQUE | BRAKE_TORQUE | GEAR
STANDS = 0.03  # [m/s]
STOP = 5.0  # [m] before the gate, where the front waits for the garage
SLOW_DOWN = 1.0  # [m/s²] to that stop
ROLLING = 0.015  # [1] resistance of the tyres
SLOW, AGAIN = 0.1, 0.6  # [m/s] with which it stands; [m] that must be free before somebody, that it moves off again
BACKWARD = 5.0  # [1/s] gain on the speed there
HARD, SOFT = 6.0, 3.0  # [m/s²] for who steps in its way nearer than from where it would stop softly; and twice how softly that is
TURNED = 0.04  # [rad] from what the wheels are to be at before the car moves off
EARLY = 1e-6  # [s]


class Parameters(Part):
    """The car, and how it drives."""

    wheelbase: float = number(2.765, unit="m", title="Wheelbase", ge=1.5, le=3.5)
    length: float = number(4.261, unit="m", title="Length", ge=2, le=4.8)
    width: float = number(1.809, unit="m", title="Width", ge=1.2, le=2.0)
    front_overhang: float = number(0.84, unit="m", title="Front overhang", ge=0.2, le=1.2)
    radius: float = number(4.6, unit="m", title="Radius", description="of the rear axle in its turns", ge=3, le=8)
    mass: float = number(1850.0, unit="kg", title="Mass", description="with what spins, for driving backward", ge=500, le=3500)
    wheel: float = number(0.34, unit="m", title="Radius of the wheels", ge=0.2, le=0.5)
    speed: float = number(2.5, unit="m/s", title="Speed in the aisles", ge=0.5, le=8)
    blind: float = number(2.0, unit="s", title="Blind", description="it drives on for, without a fix or an order", ge=0.1, le=10)
    margin: float = number(1.0, unit="m", title="Margin", description="to a person on the way", ge=0.2, le=5)
    repetition: float = number(0.1, unit="s", title="Repetition", description="of its status", ge=0.02, le=1)


class Memory(NamedTuple):
    """How far it is."""

    ticket: Annotated[float, "1", "number that it goes by"] = 0.0
    phase: Annotated[float, "1"] = OUTSIDE
    x: Annotated[float, "m", "of the rear axle"] = 0.0
    y: Annotated[float, "m"] = 0.0
    heading: Annotated[float, "rad"] = 0.0
    fixes: Annotated[float, "1", "how many have come"] = 0.0
    fixed: Annotated[float, "s", "when the last one was made"] = -10.0
    ordered: Annotated[float, "s", "when the last order came"] = -10.0
    space: Annotated[float, "1"] = -1.0
    permit: Annotated[float, "m", "station that the front may reach"] = -1e3
    point: Annotated[float, "1", "of its way"] = 0.0
    sent: Annotated[float, "s", "when the last status was"] = -1.0
    groups: Annotated[float, "1", "the deck, as the garage tells it"] = 0.0
    together: Annotated[float, "1"] = 0.0
    space_length: Annotated[float, "m"] = 0.0
    space_width: Annotated[float, "m"] = 0.0
    aisle: Annotated[float, "m"] = 0.0


class Sees(NamedTuple):
    """Its bus, and the garage."""

    clock: Clock
    own: Own
    heard: Annotated[Inbox, "parking_order", 1]


class Log(NamedTuple):
    """What is recorded."""

    phase: Annotated[float, "1"] = 0.0  # 0 outside, 1 drives in, 2 parked, 3 comes back, 4 given back
    space: Annotated[float, "1"] = -1.0
    x: Annotated[float, "m"] = 0.0  # where it takes the middle of its outline to be
    y: Annotated[float, "m"] = 0.0
    heading: Annotated[float, "rad"] = 0.0
    aside: Annotated[float, "m"] = 0.0  # to the left of its way, as it takes it
    left: Annotated[float, "m"] = 0.0  # of the way that it is on


class Does(NamedTuple):
    """Commands, its status."""

    command: Command
    send: Annotated[Outbox, "parking_status", 1]
    log: Log


def car_of(p: Parameters) -> Car:
    """What ways depend on."""
    return Car(p.wheelbase, p.length, p.width, p.front_overhang, p.radius)


def deck_of(m: Memory) -> Plan:
    """The deck before it, as it was told; one without spaces before that."""
    return Plan(int(m.groups), int(m.together), m.space_length, m.space_width, m.aisle)


def with_plan(m: Memory, sees: Sees) -> Memory:
    """With the plan that the garage tells."""
    told = sees.heard.message[0]
    if sees.heard.count == 0 or not told.received:
        return m
    a = told.payload
    return m._replace(groups=a.groups, together=a.together, space_length=a.space_length, space_width=a.space_width, aisle=a.aisle)


def ticket_of(time: float, own: Own) -> float:
    """A number that no other car has: the millisecond, and behind the point its place."""
    place = own.gps_x + 0.618 * own.gps_y
    return float(int(1000.0 * time)) + 1.0 + place - floor(place)


def place_of(m: Memory, sees: Sees) -> int:
    """Where the newest orders tell of this car; -1 where they do not."""
    told = sees.heard.message[0]
    if sees.heard.count == 0 or not told.received:
        return -1
    return next((i for i in range(min(int(told.payload.count), MOST)) if told.payload.ticket[i] == m.ticket), -1)


def located(p: Parameters, m: Memory, sees: Sees, i: int) -> Memory:
    """With the motion of this tick, and with a new fix."""
    own, time = sees.own, sees.clock.time
    at = tracker.reckoned(Pose(m.x, m.y, m.heading), own.speed, own.yaw_rate, sees.clock.tick)
    fixes, made = m.fixes, m.fixed
    if i >= 0 and sees.heard.message[0].payload.is_seen[i] > 0.0:
        told = sees.heard.message[0]
        age = told.age + told.payload.age
        if time - age > m.fixed + EARLY + 0.02 and age < tracker.LATEST:
            fix = tracker.reckoned(
                Pose(told.payload.x[i], told.payload.y[i], told.payload.heading[i]), own.speed, own.yaw_rate, age
            )  # fmt: skip
            at, fixes, made = tracker.fixed(at, fix, car_of(p).middle, m.fixes), m.fixes + 1.0, time - age
    return m._replace(x=at.x, y=at.y, heading=at.heading, fixes=fixes, fixed=made)


def ordered(m: Memory, sees: Sees, i: int) -> Memory:
    """With the garage's orders, where they are new."""
    if i < 0:
        return m
    told = sees.heard.message[0]
    at, order = sees.clock.time - told.age, told.payload.order[i]
    if order == DRIVE_IN and m.phase == OUTSIDE and m.fixes > 3.0:
        m = m._replace(phase=DRIVING_IN, point=0.0)
    if order == COME_BACK and m.phase == PARKED:
        m = m._replace(phase=COMING_BACK, point=0.0)
    return m._replace(ordered=at, space=told.payload.space[i], permit=told.payload.permit[i])


def persons(sees: Sees) -> list[tuple[float, float]]:
    """Whom the cameras see [m]."""
    told = sees.heard.message[0].payload
    return [(told.person_x[j], told.person_y[j]) for j in range(int(told.persons))]


def pushed(p: Parameters, u: float, gear: float, v: float) -> Command:
    """What drives and brakes for an acceleration u [m/s²] in the direction of the gear; backward by torques."""
    if gear > 0.0:
        return accelerate(u)
    force = p.mass * (u + ROLLING * 9.81) if u > 0.0 else p.mass * u
    T = force * p.wheel
    pushes = also(drive(-max(T, 0.0)), brake(max(-T, 0.0)))
    return also(pushes, shift(-1.0)) if abs(v) < 0.9 else pushes


def driven(p: Parameters, m: Memory, sees: Sees) -> tuple[Memory, Command, Way, float]:
    """One moment on its way: the point of it, the command, the way, and the offset."""
    car, time, own = car_of(p), sees.clock.time, sees.own
    way, profile, last = tracker.profile(deck_of(m), int(m.space), car, m.phase == COMING_BACK, p.speed)
    at, k = Pose(m.x, m.y, m.heading), int(m.point)
    if k == 0 and m.phase == DRIVING_IN:
        k = int(nearest(way, m.x, m.y, 0, 2000))
    k = nearest(way, m.x, m.y, k)
    end = int(last[k])
    left = tracker.left_of(way, k, end, at)
    if left < tracker.THERE and abs(own.speed) < STANDS and end + 1 < way.x.size:
        k = end + 1
        end = int(last[k])
        left = tracker.left_of(way, k, end, at)
    left = 1e3 if m.phase == COMING_BACK and end + 1 == way.x.size else left  # the driver goes on from there
    clear = tracker.before_persons(way, k, end, car, persons(sees), p.margin)
    free = min(tracker.permitted(way, k, car, m.permit), clear)
    knows = time - m.fixed < p.blind and time - m.ordered < p.blind
    g, v = float(way.direction[k]), float(way.direction[k]) * own.speed
    angle = tracker.wheels(way, k, at, own.speed, p.wheelbase)
    wanted = tracker.allowed(min(max(profile[k], 0.15), p.speed), min(left, free)) if knows else 0.0
    wanted = 0.0 if abs(own.speed) < SLOW and clear < AGAIN else wanted
    is_turned = abs(own.speed) > STANDS or abs(own.steering - angle) < TURNED
    gain = 2.0 if g > 0.0 else BACKWARD  # torques know nothing of a converter that creeps
    u = min(max(gain * (wanted - v), -2.0), 0.8) if is_turned and wanted > 0.02 else -1.5
    u = -HARD if v > 0.3 and clear < v * v / SOFT else u
    return m._replace(point=float(k)), also(pushed(p, u, g, own.speed), steer(angle)), way, tracker.error(way, k, *at)[0]


def waiting(deck: Plan, sees: Sees) -> Command:
    """Before the gate, with the driver at the wheel: it stops there."""
    left, v = -deck.gate - STOP - sees.own.gps_x - 2.3, sees.own.speed
    is_near = deck.groups > 0 and abs(sees.own.gps_y + deck.radius) < 4.0 and -25.0 < -left < 6.0
    return accelerate(-min(v * v / (2.0 * max(left, 0.2)) + 0.3, 3.0)) if is_near and v * v > 2.0 * SLOW_DOWN * max(left, 0.0) else leave()


def arrived(m: Memory, way: Way, sees: Sees) -> Memory:
    """The next phase at the end of a way."""
    is_at_end = int(m.point) >= way.x.size - 3
    if m.phase == DRIVING_IN and is_at_end and abs(sees.own.speed) < STANDS:
        return m._replace(phase=PARKED)
    return m._replace(phase=GIVEN_BACK) if m.phase == COMING_BACK and is_at_end else m


def middle(p: Parameters, m: Memory) -> tuple[float, float]:
    """Where it takes the middle of its outline to be [m]."""
    ahead = car_of(p).middle
    return m.x + ahead * cos(m.heading), m.y + ahead * sin(m.heading)


def status(p: Parameters, m: Memory, sees: Sees) -> Payload:
    """What the garage is told."""
    car, is_outside = car_of(p), m.phase in (OUTSIDE, GIVEN_BACK) and m.fixes < 1.0
    x, y = middle(p, m)
    if is_outside:
        x, y = sees.own.gps_x, sees.own.gps_y
    rear = plan.station(deck_of(m), m.x, m.y) - car.rear if m.fixes > 0.0 else -1e3
    return Payload(m.ticket, m.phase, x, y, float(rear), *car)


def decide(parameters, memory, sees):
    """One tick."""
    p, m, time = parameters, memory, sees.clock.time
    m = with_plan(m if m.ticket else m._replace(ticket=ticket_of(time, sees.own)), sees)
    deck = deck_of(m)
    i = place_of(m, sees)
    m = ordered(located(p, m, sees, i), sees, i)
    command, log = leave(), Log(m.phase, m.space, 0.0, 0.0, 0.0, 0.0, 0.0)
    if m.phase in (DRIVING_IN, COMING_BACK):
        m, command, way, aside = driven(p, m, sees)
        m = arrived(m, way, sees)
        x, y = middle(p, m)
        log = Log(m.phase, m.space, x, y, atan2(sin(m.heading), cos(m.heading)), aside, way.length - float(way.driven[int(m.point)]))
    elif m.phase == OUTSIDE:
        command = waiting(deck, sees)
    if m.phase == PARKED:
        command = also(accelerate(-1.0), steer(0.0))
    is_near = m.phase != GIVEN_BACK or plan.station(deck, m.x, m.y) < deck.leaves + 15.0
    says = is_near and time - m.sent >= p.repetition - EARLY
    m = m._replace(sent=time if says else m.sent)
    return m, Does(command, Outbox(1 if says else 0, (status(p, m, sees),)), log)
