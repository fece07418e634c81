"""Traffic-jam warning: who has come to a jam tells those far behind, and they slow down before they see it; behind a car it is an ACC.

A car that is slower than `slow` where the map allows twice as much, for `lasting`, sends a warning (DENM, cause 1, traffic) every
`repetition`, with its place and its speed v_j; it counts for VALID. Who hears one from d ahead on its way drives no faster than lets it
come to v_j with no more than `comfort` b, MARGIN before the jam,

    v(d) = sqrt(v_j² + 2 b (d - MARGIN)),

the nearest of all jams first. It needs a radio that reaches far: a car at 120 km/h that brakes with 2 m/s² takes 280 m to a walking pace,
more than a radar sees, and `radio: {kind: cellular}` reaches any distance. Nearer than MARGIN the radar takes over, as in acc (R. Rajamani,
Vehicle Dynamics and Control, 2012, Eq. 6.18). What is ahead is told by the map's heading at the own place, so up to `reach` along a road
that does not turn back.
"""

from math import cos, sin, sqrt
from typing import Annotated, NamedTuple

from studio.application.contract import ACCELERATION, Clock, Command, Inbox, Notice, Outbox, Own, Targets, accelerate
from studio.compiled import compiled
from studio.kind.settings import Part, number
from studio.kinds.application.acc import cruise, keep_gap
from studio.kinds.message.denm import TRAFFIC, Payload

KIND = "application"
TITLE = "Traffic-jam warning"
COMMANDS = ACCELERATION
NOTICES = ("Traffic jam ahead",)
VALID = 10.0  # [s] that a warning counts after it was sent
MARGIN = 60.0  # [m] before the jam, whose end moves between two warnings; estimated
ASIDE = 500.0  # [m] to the side: what is farther is taken for another road; estimated
FAR = 1e6  # [m]
EARLY = 1e-6  # [s] by which times give way


class Parameters(Part):
    """What is tuned."""

    warns: bool = number(True, unit="1", title="Warns", description="tells others of a jam in which it is")
    minds: bool = number(True, unit="1", title="Minds warnings", description="slows down for a jam that it is told of")
    slow: float = number(
        8.0, unit="m/s", title="Slow", description="below this it is a jam, where the map allows twice as much", ge=0, le=30
    )
    lasting: float = number(2.0, unit="s", title="Lasting", description="that it must have been slow", ge=0, le=60)
    repetition: float = number(1.0, unit="s", title="Repetition", ge=0.02, le=10)
    reach: float = number(1500.0, unit="m", title="Reach", description="to a jam that is minded", ge=50, le=20_000)
    comfort: float = number(2.0, unit="m/s²", title="Comfortable deceleration", ge=0.3, le=5)
    headway: float = number(1.2, unit="s", title="Time headway", ge=0.2, le=5)
    standstill: float = number(2.0, unit="m", title="Standstill distance", ge=0, le=20)
    gap_gain: float = number(0.1, unit="1/s", title="Gap gain", ge=0.01, le=2)
    cruise_gain: float = number(0.5, unit="1/s", title="Cruise gain", ge=0.05, le=3)
    acceleration_max: float = number(2.0, unit="m/s²", title="Strongest acceleration", ge=0.1, le=5)
    deceleration_max: float = number(8.0, unit="m/s²", title="Strongest deceleration", ge=0.1, le=10)


class Memory(NamedTuple):
    """For how long it is slow, and what it has told."""

    slow: Annotated[float, "s", "for which it has been slow"] = 0.0
    sent: Annotated[float, "s", "when the last warning was sent"] = -1e6
    event: Annotated[float, "1", "number of the jam that it tells of"] = 0.0


class Sees(NamedTuple):
    """Its bus, the car ahead, the road, and warnings of anybody."""

    clock: Clock
    own: Own
    front: Annotated[Targets, "front_radar", 1]
    road: Annotated[Targets, "digital_map", 1]
    heard: Annotated[Inbox, "denm", 8]


class Log(NamedTuple):
    """What is recorded."""

    distance: Annotated[float, "m", "to the jam that is minded; 0 for none"] = 0.0
    speed: Annotated[float, "m/s", "that it allows"] = 0.0
    tells: Annotated[float, "1", "while it is in a jam itself, and says so"] = 0.0


class Does(NamedTuple):
    """What it does."""

    command: Command
    send: Annotated[Outbox, "denm", 1]
    notice: Notice
    log: Log


@compiled
def ahead_of(sees, told):
    """How far an event is ahead [m] on the own way; FAR where it is behind, or aside."""
    along = sees.road.target[0].heading
    east, north = told.x - sees.own.gps_x, told.y - sees.own.gps_y
    before, left = east * cos(along) + north * sin(along), north * cos(along) - east * sin(along)
    return before if before > MARGIN and abs(left) < ASIDE else FAR


@compiled
def is_valid(message, time):
    """Whether a warning of a jam still counts."""
    told = message.payload
    return message.received and told.cause == TRAFFIC and time < told.detected + told.validity


@compiled
def nearest(sees, reach):
    """How far the nearest jam within reach is ahead [m], and how fast it is [m/s]; FAR for none."""
    least, speed = FAR, 0.0
    for i in range(sees.heard.count):
        if is_valid(sees.heard.message[i], sees.clock.time):
            d = ahead_of(sees, sees.heard.message[i].payload)
            if d < least and d <= reach:
                least, speed = d, sees.heard.message[i].payload.speed
    return least, speed


@compiled
def allowed(v_j, d, b):
    """The speed [m/s] from which one comes to v_j [m/s] with b [m/s²], MARGIN before what is d [m] ahead."""
    return sqrt(v_j * v_j + 2.0 * b * max(d - MARGIN, 0.0))


@compiled
def wish(p, sees, d, v_j):
    """Acceleration [m/s²]: to the set speed, no faster than the jam allows, behind whoever is ahead."""
    own = sees.own
    u = cruise(p.cruise_gain, own.set_speed, own.speed)
    if d < FAR and own.speed > v_j:
        limit = allowed(v_j, d, p.comfort)
        slope = p.comfort if own.speed > 0.95 * limit else 0.0  # on the way down the limit falls by b
        u = min(u, p.cruise_gain * (limit - own.speed) - slope)
    if sees.front.count > 0:
        u = min(u, keep_gap(p, own.speed, sees.front.target[0]))
    return min(max(u, -p.deceleration_max), p.acceleration_max)


@compiled
def decide(parameters, memory, sees):
    """One tick."""
    p, own, time = parameters, sees.own, sees.clock.time
    is_slow = own.speed < p.slow and sees.road.count > 0 and sees.road.target[0].limit >= 2.0 * p.slow
    slow = memory.slow + sees.clock.tick if is_slow else 0.0
    tells = p.warns and slow > p.lasting
    event = memory.event if not tells or memory.slow > p.lasting else memory.event + 1.0
    sends = tells and time - memory.sent >= p.repetition - EARLY
    d, v_j = nearest(sees, p.reach) if p.minds and sees.road.count > 0 else (FAR, 0.0)
    told = Payload(event, TRAFFIC * 1.0, own.gps_x, own.gps_y, own.speed, time, VALID)
    log = Log(d if d < FAR else 0.0, allowed(v_j, d, p.comfort) if d < FAR else 0.0, 1.0 if tells else 0.0)
    does = Does(accelerate(wish(p, sees, d, v_j)), Outbox(1 if sends else 0, (told,)), Notice(1 if d < FAR else 0), log)
    return Memory(slow, time if sends else memory.sent, event), does
