"""Cooperative emergency lane change: the car beside brakes, so that the own one can go around an obstacle that it cannot stop before.

The situation of D. Massow, I. Radusch, Journal of Advanced Transportation 2018, Figure 1. Every car has this application; which part it
takes follows from what it sees and hears:

    sees something slow in its lane, nearer than it can stop     asks   → committed → evades → done
    is asked, and sees the asking car beside itself              weighs → yields    → resumes                or refuses
    hears one of these from its own lane, ahead of itself        brakes → resumes

    REQUEST  who asks to the side, until a deadline; where it sees the other one       repeated until it is answered
    ACCEPT   with the braking that is offered, which begins at once; or REJECT         repeated until a commitment is heard, or the deadline
    COMMIT   begins to steer as soon as the other has fallen back by then              repeated until it is done
    DONE     in the other lane; or ABORT: brakes instead                               repeated for a while

Who hears any of it, has a car ahead and drives behind the sender in the sender's lane brakes with it: the followers of A with A, those
of B with B, nobody else. Every message tells the sender's place, its way, and how many lanes the map has on either side of it; two are in
one lane when one of these numbers is the same, since a lane that begins or ends changes the other. Whose receiver is too poor for lanes,
TOLD_APART standard deviations of it being more than half a lane, says so, and takes every lane for the own one: to brake is safer than to
guess.

Afterwards the car keeps the other lane and its gap, and is free for a next maneuver, as it is after one that was aborted. To which side the
next one goes the map says: back to where it came from, or to the other side where there is no lane.

All of it carries the number that who asked has given it. The safe default is to brake: when nobody answers in time or one refuses, when
the other one was heard to brake but is not seen to, and where braking alone is enough. Who has accepted and hears no commitment until
GRACE after the deadline goes on as before.

How slippery the road is only its sensor (`road_condition`) tells it, which may be wrong: DOUBT standard deviations less are taken; where it
gives nothing, the road is taken to be dry. No more is asked of the tyres than that: not of A across and along, not of B, which offers what
it can do, not of who brakes along. Where the road does not give `lateral`, the way aside takes longer, and A begins it only when it will
be past the obstacle in time; else it brakes.

What is in the way counts when the sensor is sure of it (`confidence`) and has been for `recognition`. The way aside is the quintic of
studio/model/evasion.py, within `lateral` m/s²; it may brake meanwhile, within what the tyres have left of `grip`. It begins when the other
one, braking as it has told, will have fallen back by LONG_MARGIN at the moment at which both would come within SIDE_MARGIN.
It is followed as in the action change_lane, by the lane's markings, which the car keeps seeing from the other lane.
"""

from math import atan, copysign, cos, floor, sin
from typing import Annotated, NamedTuple

from studio.application.contract import (
    ACCELERATION,
    STEERING,
    Clock,
    Command,
    Inbox,
    Notice,
    Outbox,
    Own,
    Targets,
    accelerate,
    also,
    leave,
    steer,
)
from studio.compiled import compiled
from studio.kind.settings import Part, number
from studio.kinds.message.maneuver import ABORT, ACCEPT, COMMIT, DONE, REJECT, REQUEST, Payload
from studio.model import evasion
from studio.model.evasion import BRAKE_LAG, LONG_MARGIN, SIDE_MARGIN

KIND = "application"
TITLE = "Cooperative emergency lane change (CELC)"
COMMANDS = ACCELERATION | STEERING
NOTICES = ("Obstacle: braking", "Obstacle: going around it", "A car beside evades: braking", "Braking with the car ahead")
(
    IDLE, ASKING, COMMITTED, EVADING, ASIDE, BRAKING,  # of who asks
    WEIGHING, YIELDING, REFUSING,  # of who is asked
    FOLLOWING, RESUMING,  # of who follows, and of all who have braked for another one
) = (float(stage) for stage in range(11))  # fmt: skip
SHOWN = (0, 0, 2, 2, 0, 1, 0, 3, 0, 4, 0)  # notice of each stage
SAID = (0, REQUEST, COMMIT, COMMIT, DONE, ABORT, 0, ACCEPT, REJECT, 0, 0)  # step of the protocol that is told in each stage
TOLD_FOR = 0.5  # [s] an end is repeated
LENGTH, WIDTH = 4.3, 1.8  # [m] of the own car
BEHIND, BEFORE = -14.0, 8.0  # [m] middles of cars ahead of the own front bumper that stand in the way of a lane change
CORRIDOR = 1.2  # [m] to each side of the middle of the lane: what comes in there is in the way
SAME = 3.0  # [m] within which both see each other where the other says; more by what the positions may be wrong
TOLD_APART = 2.0  # [1] standard deviations of the position within half a lane, so that 95 % of all lanes are right
UNKNOWN = -1.0  # lanes, where the position is too poor
SURE = 0.25  # [s] after the other one's brakes should have acted, it must be seen
RESERVE = 0.07  # [s] between commitment and wheels: it is repeated thrice, and the other one may be later than it has told
TURN_LAG, YAW_LAG = 0.01, 0.0065  # [s], [s²/m] per speed, by which a car takes up a bend late; estimated for the electric compact
OMEGA = 3.0  # [1/s] both poles of the error
STANDS, SLOWEST = 0.3, 3.0  # [m/s]
ENOUGH, RESUMED = 6.0, 4.0  # [m] to who has gone ahead; [s] until it is the driver's again
EARLY = 1e-6  # [s]
DRY = 9.8  # [m/s²] that tyres have on a dry test track; estimated for the electric compact, whose least is 0.99 g, of the axles across
ACROSS = 0.85  # [1] of what the tyres have is used across: the outer ones do more than their part
LEAST = 0.05  # [1] no road is taken to be more slippery: wet ice
SETTLING = 0.1  # [s] over which what the sensor tells is smoothed
DOUBT = 2.0  # [1] standard deviations by which the road is taken to be worse
CLEAR = WIDTH + SIDE_MARGIN  # [m] aside where the car is past an obstacle as wide as itself
GRACE = 0.3  # [s] in which a commitment that was given at the last moment may still come
AGAIN = 1.5  # [m/s²] with which it goes on after it has braked for another one
RESUME_HEADWAY, RESUME_GAP = 1.5, 3.0  # [s], [m]


class Parameters(Part):
    """What is tuned."""

    side: float = number(
        -1.0,
        unit="1",
        title="Side",
        description="to go to first: -1 right, 1 left, 0 none; the other one where the map has no lane there",
        ge=-1,
        le=1,
    )
    width: float = number(3.5, unit="m", title="Width", description="from the middle of one lane to that of the other", ge=2, le=5)
    slow: float = number(5.0, unit="m/s", title="Slow", description="what is slower along the road counts as an obstacle", ge=0, le=30)
    confidence: float = number(0.9, unit="1", title="Confidence", description="of the sensor that there is something", ge=0, le=1)
    recognition: float = number(0.06, unit="s", title="Recognition", description="that it must have been seen", ge=0, le=2)
    lateral: float = number(6.0, unit="m/s²", title="Lateral acceleration", description="of the evasion, at most", ge=1, le=10)
    grip: float = number(8.0, unit="m/s²", title="Grip", description="that the tyres have in all directions together", ge=1, le=12)
    evasion_braking: float = number(0.0, unit="m/s²", title="Braking while evading", description="within the grip", ge=0, le=10)
    braking: float = number(8.0, unit="m/s²", title="Emergency braking", ge=1, le=10)
    yielding: float = number(6.0, unit="m/s²", title="Braking for another one", description="that is offered", ge=1, le=10)
    room: float = number(2.5, unit="m", title="Room behind", description="refuses when somebody is closer behind", ge=0, le=50)
    processing: float = number(0.05, unit="s", title="Weighing", description="time to answer a request", ge=0, le=1)
    patience: float = number(0.4, unit="s", title="Patience", description="to wait for an answer; then it brakes", ge=0.02, le=5)
    repetition: float = number(0.02, unit="s", title="Repetition", description="of what is told", ge=0.005, le=0.5)
    always: bool = number(False, unit="1", title="Evades always", description="where braking alone would do, too")
    cooperates: bool = number(True, unit="1", title="Cooperates", description="answers requests, and brakes with others")
    steer_gain: float = number(1.0, unit="1", title="Feed-forward of the steering", description="against a neutral car", ge=0, le=2)
    wheelbase: float = number(2.765, unit="m", title="Wheelbase", ge=1, le=7)
    understeer: float = number(
        0.002, unit="rad s²/m", title="Understeer", description="more angle per lateral acceleration", ge=-0.02, le=0.02
    )


class Memory(NamedTuple):
    """How far it is, and what was agreed on."""

    stage: Annotated[float, "1"] = 0.0
    since: Annotated[float, "s", "when the stage began"] = 0.0
    identity: Annotated[float, "1", "number of the maneuver"] = 0.0
    asking: Annotated[float, "1", "unit that has asked; -1 the own one"] = -1.0
    deadline: Annotated[float, "s", "by which it must be agreed on, on the own clock"] = 0.0
    sent: Annotated[float, "s", "when the last message was"] = -1.0
    begin: Annotated[float, "s", "when the wheels turn"] = 0.0
    braked: Annotated[float, "s", "when the other one's brakes act"] = 0.0
    offered: Annotated[float, "m/s²", "braking that was agreed on"] = 0.0
    home: Annotated[float, "m", "offset of the lane in which it drives from its first one, to the left"] = 0.0
    goal: Annotated[float, "m", "offset of the lane to which it goes"] = 0.0
    place: Annotated[float, "m", "offset at which the way aside began, to the left"] = 0.0
    first: Annotated[float, "m", "distance at which the obstacle was recognised"] = -1.0
    closed: Annotated[float, "1", "number of the last maneuver that is over"] = 0.0
    road: Annotated[float, "m/s²", "that the tyres have on this road, as far as it can be told"] = 9.8


class Sees(NamedTuple):
    """What it sees: ahead, around, of its lane and of its road; and what it hears."""

    clock: Clock
    own: Own
    front: Annotated[Targets, "object_sensor", 8]
    around: Annotated[Targets, "blind_spot", 8]
    lane: Annotated[Targets, "lane_markings", 1]
    road: Annotated[Targets, "digital_map", 1]
    condition: Annotated[Targets, "road_condition", 1]
    heard: Annotated[Inbox, "maneuver", 4]


class Log(NamedTuple):
    """What is recorded."""

    stage: Annotated[float, "1"] = (
        0.0  # 1 asks, 2 committed, 3 evades, 4 aside, 5 brakes, 6 weighs, 7 yields, 8 refuses, 9 follows, 10 resumes
    )
    confidence: Annotated[float, "1"] = 0.0  # of the obstacle
    distance: Annotated[float, "m"] = 0.0  # to it, at which it was recognised
    aside: Annotated[float, "m"] = 0.0  # where the way aside has the car, to the left
    road: Annotated[float, "m/s²"] = 0.0  # that the tyres are taken to have


class Does(NamedTuple):
    """What it does."""

    command: Command
    send: Annotated[Outbox, "maneuver", 1]
    notice: Notice
    log: Log


class Obstacle(NamedTuple):
    """What is in the way: how far it is, how sure the sensor is of it, and since when; gap to and rate of whoever is ahead, slow or not."""

    is_there: bool
    distance: float
    confidence: float
    lasted: float
    gap: float
    rate: float


class Beside(NamedTuple):
    """Cars in the way of the lane change: how many; of the foremost where its middle is and how fast it comes, and its length."""

    count: int
    ahead: float
    left: float
    rate: float
    length: float


@compiled
def lag(v):
    """By how much [s] the car is behind the way of its steering."""
    return TURN_LAG + YAW_LAG * v


@compiled
def road_of(sees, before):
    """What the tyres have on this road [m/s²], by the sensor and less by its doubt; as before where it tells nothing."""
    told = sees.condition.target[0]
    return DRY * max(told.friction - DOUBT * told.sigma, LEAST) if sees.condition.count > 0 else before


@compiled
def felt(m, sees):
    """The road that is counted on: it stays the same from a request to the end of the way aside, and while another one counts on it."""
    is_bound = m.stage in (ASKING, COMMITTED, EVADING, WEIGHING, YIELDING)
    share = 0.0 if is_bound else min(sees.clock.tick / SETTLING, 1.0)
    road = m.road + share * (road_of(sees, m.road) - m.road)
    return Memory(
        m.stage, m.since, m.identity, m.asking, m.deadline, m.sent, m.begin, m.braked, m.offered, m.home, m.goal, m.place, m.first,
        m.closed, road,
    )  # fmt: skip


@compiled
def across(p, m):
    """Lateral acceleration [m/s²] of the way aside on this road."""
    return min(p.lateral, ACROSS * m.road)


@compiled
def is_in_time(p, m, v, wait, distance):
    """Whether the way aside, begun after `wait` [s], leads past what is so far [m] away; a road that gives `lateral` is not asked."""
    if across(p, m) >= p.lateral:
        return True
    T = evasion.change_time(p.width, across(p, m))
    return v * (wait + lag(v) + T * evasion.moment(CLEAR / p.width)) <= distance


@compiled
def offset_of(sees, before):
    """Where the car is beside the middle of its first lane [m], to the left; as before where no lane is marked."""
    lane = sees.lane.target[0]
    return 0.5 * (lane.right - lane.left) if sees.lane.count > 0 else before


@compiled
def lanes_of(sees):
    """Lanes to the left and to the right of the own one [1], UNKNOWN where the position is too poor for that."""
    road = sees.road.target[0]
    if sees.road.count == 0 or TOLD_APART * road.sigma > 0.5 * road.width:
        return UNKNOWN, UNKNOWN
    return road.lanes_left, road.lanes_right


@compiled
def side_of(p, m, sees):
    """The side to go to: the wanted one, or back after an evasion; the other one, or none, where the map has no lane there."""
    wanted = p.side if m.home == 0.0 else copysign(1.0, -m.home)
    left, right = lanes_of(sees)
    if wanted == 0.0 or left < 0.0 or (left if wanted > 0.0 else right) > 0.0:
        return wanted
    return -wanted if (right if wanted > 0.0 else left) > 0.0 else 0.0


@compiled
def look_ahead(p, sees, offset):
    """The nearest slow thing in the lane whose middle is `offset` [m] to the right, and the nearest of all in the own corridor."""
    is_there, distance, sure, lasted, gap, rate = False, 1e6, 0.0, 0.0, 1e6, 0.0
    for i in range(sees.front.count):
        target = sees.front.target[i]
        x, y = target.range * cos(target.azimuth), target.range * sin(target.azimuth)
        if abs(y) < CORRIDOR and x < gap:
            gap, rate = x, target.rate
        is_slow = sees.own.speed + target.rate < p.slow
        if is_slow and abs(y + offset) < CORRIDOR and x < distance:
            is_there, distance, sure, lasted = True, x, target.existence, target.lasted
    return Obstacle(is_there, distance, sure, lasted, gap, rate)


@compiled
def look_aside(side, sees):
    """Who is beside on a side: the foremost counts, and how many there are."""
    count, ahead, left, rate, length = 0, -1e6, 0.0, 0.0, LENGTH
    for i in range(sees.around.count):
        target = sees.around.target[i]
        if side * target.left > 0.5 * WIDTH and BEHIND < target.ahead < BEFORE and abs(target.left) < 6.0:
            count += 1
            if target.ahead > ahead:
                ahead, left, rate, length = target.ahead, target.left, target.rate, target.length
    return Beside(count, ahead, left, rate, length)


@compiled
def fallen_back(beside):
    """How far the front of the car beside is behind the own rear [m]."""
    return -LENGTH - beside.ahead - 0.5 * beside.length


@compiled
def answer(memory, heard):
    """What those asked say to the own request: how many accept, whether one refuses, and the least braking and the newest time of it."""
    accepted, refused, offered, age = 0, False, 1e6, 1e6
    for i in range(heard.count):
        message = heard.message[i]
        if message.received and message.payload.identity == memory.identity:
            refused = refused or message.payload.step == REJECT
            if message.payload.step == ACCEPT:
                accepted, offered, age = accepted + 1, min(offered, -message.payload.acceleration), min(age, message.age)
    return accepted, refused, offered, age


@compiled
def plan(p, m, time, v, age, offered, beside):
    """When the wheels are to turn, and when the other one's brakes act [s]."""
    T, braked = evasion.change_time(p.width, across(p, m)), time - age + BRAKE_LAG
    overlap = evasion.moment(min(max((abs(beside.left) - WIDTH - SIDE_MARGIN) / p.width, 0.0), 1.0))
    lost = 0.5 * p.evasion_braking * (T * overlap) ** 2  # what the own braking takes of the way that the other one falls back
    clear = braked + evasion.clearing_time(LONG_MARGIN - fallen_back(beside) + lost, offered)
    return max(time, clear - T * overlap - lag(v)) + RESERVE, braked


@compiled
def is_braking(p, time, memory, beside):
    """Whether the other one is seen to brake as it has told, as soon as that can be seen."""
    since = time - memory.braked
    return since < SURE or beside.count == 0 or beside.rate < -0.4 * memory.offered * since


@compiled
def entered(m, stage, time):
    """Another stage, from now on."""
    return Memory(
        stage, time, m.identity, m.asking, m.deadline, -1.0, m.begin, m.braked, m.offered, m.home, m.goal, m.place, m.first,
        m.closed, m.road,
    )  # fmt: skip


@compiled
def alone(m):
    """Without a maneuver: what is done now is of none that was before, and nothing is said of it."""
    return Memory(m.stage, m.since, 0.0, -1.0, 0.0, -1.0, 0.0, 0.0, 0.0, m.home, m.home, 0.0, m.first, m.closed, m.road)


@compiled
def over(m, stage, time):
    """The maneuver is over: nothing more of it is minded."""
    closed = m.identity if m.identity != 0.0 else m.closed
    return Memory(stage, time, 0.0, -1.0, 0.0, -1.0, 0.0, 0.0, m.offered, m.home, m.home, 0.0, m.first, closed, m.road)


@compiled
def free(m):
    """The stage of who is in no maneuver: one that has gone aside keeps its lane by itself."""
    return ASIDE if m.home != 0.0 else IDLE


@compiled
def arrived(m, time):
    """The other lane is the own one now."""
    return Memory(
        ASIDE, time, m.identity, m.asking, m.deadline, -1.0, m.begin, m.braked, m.offered, m.goal, m.goal, m.place, m.first,
        m.closed, m.road,
    )  # fmt: skip


@compiled
def number_of(time, own):
    """A number that no other maneuver has: the millisecond, and behind the point the place of who asks, which is nobody else's."""
    place = own.gps_x + 0.618 * own.gps_y
    return float(int(1000.0 * time)) + 1.0 + place - floor(place)


@compiled
def recognised(p, m, sees, obstacle, beside, side):
    """What is done about an obstacle: braking where that is enough or all there is, going around it where nobody is beside, else asking."""
    time, goal = sees.clock.time, m.home + side * p.width
    is_useless = side == 0.0 or not is_in_time(p, m, sees.own.speed, 0.0, obstacle.distance)
    stage = BRAKING if is_useless else ASKING if beside.count > 0 else EVADING
    identity, deadline = number_of(time, sees.own), time + p.patience
    return Memory(stage, time, identity, -1.0, deadline, -1.0, time, 0.0, 0.0, m.home, goal, 0.0, obstacle.distance, m.closed, m.road)


@compiled
def is_recognised(p, obstacle):
    """Whether the sensor is sure enough, for long enough."""
    return obstacle.is_there and obstacle.confidence >= p.confidence and obstacle.lasted >= p.recognition


@compiled
def must_evade(p, m, v, distance):
    """Whether braking alone is not enough, or is not wanted."""
    return p.always or evasion.stopping_distance(v, min(p.braking, m.road), BRAKE_LAG, BRAKE_LAG) + LONG_MARGIN > distance


@compiled
def must_brake(p, m, v, distance):
    """Whether half of all braking is needed to stand in time: the driver would have begun."""
    return v * v > min(p.braking, m.road) * max(distance - LONG_MARGIN, 0.1)


@compiled
def as_asking(p, m, sees, obstacle, beside, side, offset):
    """The part of who has an obstacle before him."""
    time, v = sees.clock.time, sees.own.speed
    if m.stage in (IDLE, ASIDE) and is_recognised(p, obstacle) and v > SLOWEST:
        if must_evade(p, m, v, obstacle.distance):
            new = recognised(p, m, sees, obstacle, beside, side)
            return new if new.stage != EVADING else started(new, time, offset)
        return entered(alone(m), BRAKING, time) if must_brake(p, m, v, obstacle.distance) else m
    if m.stage == ASKING:
        accepted, refused, offered, age = answer(m, sees.heard)
        if refused or time > m.deadline:
            return entered(m, BRAKING, time)
        if accepted >= max(beside.count, 1):
            begin, braked = plan(p, m, time, v, age, offered, beside)
            if not is_in_time(p, m, v, begin - time, obstacle.distance):
                return entered(m, BRAKING, time)
            return Memory(
                COMMITTED, time, m.identity, -1.0, m.deadline, -1.0, begin, braked, offered, m.home, m.goal, 0.0, m.first,
                m.closed, m.road,
            )  # fmt: skip
    if m.stage == COMMITTED and not is_braking(p, time, m, beside):
        return entered(m, BRAKING, time)
    if m.stage == COMMITTED and time >= m.begin:
        return started(m, time, offset)
    if m.stage == EVADING and time > m.since + evasion.change_time(p.width, across(p, m)) + lag(v):
        return arrived(m, time)
    if m.stage == BRAKING and v < STANDS and not obstacle.is_there:
        return over(m, free(m), time)
    return m


@compiled
def started(m, time, offset):
    """The wheels turn."""
    return Memory(
        EVADING, time, m.identity, -1.0, m.deadline, -1.0, time, m.braked, m.offered, m.home, m.goal, offset, m.first,
        m.closed, m.road,
    )  # fmt: skip


@compiled
def before(sees, message):
    """How far the sender is ahead [m] along the own road, by both satellite positions; since it sent it has come as far as the own car."""
    along, told = sees.road.target[0].heading, message.payload
    apart = (told.x - sees.own.gps_x) * cos(along) + (told.y - sees.own.gps_y) * sin(along)
    return apart + sees.own.speed * message.age


@compiled
def is_there_as_told(sees, message, other):
    """Whether the car that is seen beside is the one that asks: both see each other where the other says, and satellites place it there."""
    is_seen = other.count > 0 and abs(message.payload.ahead + other.ahead + 0.5 * (other.length + LENGTH)) < SAME
    unsure = SAME + 3.0 * sees.road.target[0].sigma
    return is_seen and (sees.road.count == 0 or abs(before(sees, message) - other.ahead - 0.5 * LENGTH) < unsure)


@compiled
def is_in_one_lane(sees, told):
    """Whether the sender is in the own lane, as far as both know: the numbers of lanes on one side are the same."""
    left, right = lanes_of(sees)
    return left < 0.0 or told.lanes_left < 0.0 or left == told.lanes_left or right == told.lanes_right


@compiled
def is_ahead(sees, message):
    """Whether the sender is ahead on the own road, on its way in the same direction; without a map it is taken to be."""
    if sees.road.count == 0:
        return True
    told = message.payload
    is_same_way = told.lanes_left < 0.0 or cos(told.heading - sees.road.target[0].heading) > 0.0
    return is_same_way and before(sees, message) > 0.0


@compiled
def called(p, m, sees, obstacle):
    """The part of who is free and hears of a maneuver: weighs when asked, brakes when behind in the same lane."""
    time = sees.clock.time
    for i in range(sees.heard.count):
        message = sees.heard.message[i]
        told, identity = message.payload, message.payload.identity
        if not message.received or message.age > TOLD_FOR or identity == m.closed:
            continue
        is_asked = told.step == REQUEST and is_there_as_told(sees, message, look_aside(-told.side, sees))
        follows = (
            (told.step in (REQUEST, ACCEPT, ABORT)) and obstacle.gap < 100.0 and is_ahead(sees, message) and is_in_one_lane(sees, told)
        )
        if is_asked or follows:
            stage, offered = WEIGHING if is_asked else FOLLOWING, -told.acceleration
            return Memory(
                stage, time, identity, message.sender, told.deadline, -1.0, 0.0, 0.0, offered, m.home, m.home, 0.0, m.first,
                m.closed, m.road,
            )  # fmt: skip
    return m


@compiled
def last_step(m, heard):
    """The step of the maneuver that was heard last, 0 when none of it was for a while."""
    step = 0.0
    for i in range(heard.count):
        message = heard.message[i]
        if message.received and message.age <= TOLD_FOR and message.payload.identity == m.identity:
            step = max(step, message.payload.step)
    return step


@compiled
def is_pressed(p, sees):
    """Whether somebody is so close behind that he would not be able to follow the braking."""
    for i in range(sees.around.count):
        target = sees.around.target[i]
        behind = -LENGTH - target.ahead - 0.5 * target.length
        if abs(target.left) < CORRIDOR and -0.5 * LENGTH < behind < p.room:
            return True
    return False


@compiled
def as_asked(p, m, sees, obstacle):
    """The part of who brakes for another one."""
    time, heard = sees.clock.time, sees.heard
    if m.stage == WEIGHING and time - m.since >= p.processing:
        return entered(m, REFUSING if is_pressed(p, sees) else YIELDING, time)
    if m.stage == REFUSING and time - m.since > TOLD_FOR:
        return over(m, free(m), time)
    if m.stage == YIELDING:
        step, gap = last_step(m, heard), obstacle.gap
        is_off = step in (DONE, ABORT) or (step < COMMIT and time > m.deadline + GRACE)
        return over(m, RESUMING, time) if is_off or (time - m.since > 1.0 and gap > ENOUGH and gap < 30.0) else m
    if m.stage == FOLLOWING and not obstacle.is_there and last_step(m, heard) in (0, DONE):
        return over(m, RESUMING, time)
    if m.stage == RESUMING and time - m.since > RESUMED:
        return over(m, free(m), time)
    return m


@compiled
def drive_on(own, obstacle):
    """Acceleration [m/s²] of who goes on: to the set speed, behind whoever is ahead (R. Rajamani's Eq. 6.18, as in acc)."""
    u = min(0.5 * (own.set_speed - own.speed), AGAIN)
    behind = (obstacle.rate + 0.2 * (obstacle.gap - RESUME_GAP - RESUME_HEADWAY * own.speed)) / RESUME_HEADWAY
    return max(min(u, behind), -8.0) if obstacle.gap < 1e5 else u


@compiled
def way_aside(p, m, time):
    """Offset [m], its rate [m/s] and second derivative [m/s²] of the way aside at a time [s]; without an evasion it is the own lane."""
    if m.stage != EVADING:
        return m.home, 0.0, 0.0
    T, W = evasion.change_time(p.width, across(p, m)), m.goal - m.place
    u = (time - m.begin) / T
    return m.place + W * evasion.share(u), W / T * evasion.slope(u), W / (T * T) * evasion.bend(u)


@compiled
def steering(p, m, sees, offset):
    """Road wheel angle [rad]: what the bend takes, ahead of the car's lag, and what brings the car back to the way."""
    time, v, lane = sees.clock.time, max(sees.own.speed, SLOWEST), sees.lane.target[0]
    y, dy, _ = way_aside(p, m, time - lag(v))
    bend = way_aside(p, m, time)[2] / (v * v)
    error = 2.0 * OMEGA / v * (lane.heading - dy / v) + OMEGA * OMEGA / (v * v) * (offset - y)
    kappa = p.steer_gain * bend + (lane.curvature - error if sees.lane.count > 0 else 0.0)
    return min(max(atan((p.wheelbase + p.understeer * v * v) * kappa), -0.6), 0.6)


@compiled
def evading(p, m, own, time):
    """Acceleration [m/s²] while going around: no more braking than the tyres have left, by the way and by what the car does."""
    used = max(abs(way_aside(p, m, time)[2]), abs(own.yaw_rate * own.speed))
    return -min(p.evasion_braking, evasion.left_over(min(p.grip, m.road), used))


@compiled
def speeding(p, m, sees, obstacle):
    """What is asked of drive and brakes in each stage; nothing where the driver does it."""
    stage = int(m.stage)
    if stage == EVADING:
        return accelerate(evading(p, m, sees.own, sees.clock.time))
    if stage in (ASKING, COMMITTED):
        return accelerate(0.0)
    if stage == BRAKING:
        return accelerate(-min(p.braking, m.road))
    if stage == YIELDING:
        return accelerate(-min(p.yielding, m.road))
    if stage == FOLLOWING:
        return accelerate(-min(max(m.offered, 0.0), p.braking, m.road))
    return accelerate(drive_on(sees.own, obstacle)) if stage in (ASIDE, RESUMING) or m.home != 0.0 else leave()


@compiled
def command(p, m, sees, obstacle, offset):
    """What is asked of the car: a driver would steer back to the lane of his route, so one that has left it steers by itself."""
    asked = speeding(p, m, sees, obstacle)
    return also(asked, steer(steering(p, m, sees, offset))) if m.stage in (EVADING, ASIDE) or m.home != 0.0 else asked


@compiled
def message_of(p, m, sees, beside, side):
    """What the car says of the maneuver, and where it is."""
    stage, own = int(m.stage), sees.own
    offered, (left, right) = min(p.yielding if stage == YIELDING else p.braking, m.road), lanes_of(sees)
    return Payload(
        SAID[stage] * 1.0, m.identity, m.asking, -1.0, m.deadline, side, LONG_MARGIN, -offered, max(beside.ahead, -1e3),
        own.gps_x, own.gps_y, sees.road.target[0].heading, left, right,
    )  # fmt: skip


@compiled
def is_said(p, m, time):
    """Whether a message goes out now: again and again, and for a while at the end."""
    has_ended = m.stage in (ASIDE, BRAKING)
    is_of_a_maneuver = SAID[int(m.stage)] > 0 and m.identity != 0.0 and (not has_ended or time - m.since <= TOLD_FOR)
    return is_of_a_maneuver and time - m.sent >= p.repetition - EARLY


@compiled
def said(m, time):
    """A message has gone out."""
    return Memory(
        m.stage, m.since, m.identity, m.asking, m.deadline, time, m.begin, m.braked, m.offered, m.home, m.goal, m.place, m.first,
        m.closed, m.road,
    )  # fmt: skip


@compiled
def decide(parameters, memory, sees):
    """One moment."""
    p, m, time = parameters, felt(memory, sees), sees.clock.time
    offset = offset_of(sees, m.home)
    side = copysign(1.0, m.goal - m.home) if m.goal != m.home else side_of(p, m, sees)
    obstacle, beside = look_ahead(p, sees, offset - m.home), look_aside(side, sees)
    m = as_asking(p, m, sees, obstacle, beside, side, offset)
    if p.cooperates and (m.stage in (IDLE, RESUMING) or (m.stage == ASIDE and time - m.since > TOLD_FOR)):
        m = called(p, m, sees, obstacle)
    m = as_asked(p, m, sees, obstacle)
    says = is_said(p, m, time)
    if says:
        m = said(m, time)
    log = Log(m.stage, obstacle.confidence, m.first, way_aside(p, m, time)[0] if m.stage in (EVADING, ASIDE) else 0.0, m.road)
    does = Does(
        command(p, m, sees, obstacle, offset),
        Outbox(1 if says else 0, (message_of(p, m, sees, beside, side),)),
        Notice(SHOWN[int(m.stage)]),
        log,
    )
    return m, does
