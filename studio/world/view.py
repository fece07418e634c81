"""What kinds are given: the world as a sensor sees it, the way of a message, and the words they answer with.

A sensor looks at the true world and makes its own errors. `around` finds who is near; `look` and `glimpse` tell which bodies can be seen,
and what of them; `friction_on` tells how slippery the ground is; `report` writes a target down; random numbers come from `draw` and
`draw_normal`, each with a number of its own, 0 to 15, and one that tells the targets apart. A radio draws with `chance`, `chances` and
`chance_normal`, which count likewise.
"""

from math import cos, sin
from typing import Any, NamedTuple

from numba import literal_unroll

from studio.compiled import inlined
from studio.model.random import normal, normals, uniform, uniforms
from studio.vehicle.state import V_X, YAW_RATE
from studio.world.passes.ground import friction_on as friction_on
from studio.world.passes.neighbour import within
from studio.world.passes.sight import glimpse as glimpse
from studio.world.passes.sight import is_on_other_level as is_on_other_level
from studio.world.passes.sight import look as look
from studio.world.passes.sight import target as target
from studio.world.table.unit import BUMPER, COSINE, HEADING, SINE, TRUE_X, TRUE_Y

MISSHAPEN = -1.0  # in place of a count
PAIR = 65536  # a link is numbered receiver · PAIR + sender
LATE, LOST = range(2)  # draws of the studio for a sensor: its delay, whether a look fails
OF_THE_STUDIO = 2**32 - 1  # tells them from those of a kind


class View(NamedTuple):
    """The world at one tick. Arrays are [row, vehicle], [row, unit], [row, object].

    Rows are constants: of `state` those of studio/vehicle/state.py (V_X, ACTIVE), of `parameter` of studio/vehicle/parameter.py (LENGTH),
    of `places` of studio/world/passes/neighbour.py (REAR_X), of `unit` of studio/world/table/unit.py, of `table` of
    studio/world/table/street.py. The glossary in the reference lists them all.
    """

    k: int  # ticks since the start
    time: float  # [s]
    tick: float  # [s]
    longest: float  # [m] no part of a vehicle is farther from its centre of gravity
    state: Any
    parameter: Any
    world_of: Any  # per vehicle
    number: Any  # per vehicle, within its world
    unit: Any
    unit_world: Any
    unit_vehicle: Any  # the vehicle that a unit is mounted on; -1 for a station
    entity: Any  # per unit, as chance tells them apart
    seed: Any  # per world
    grid: Any
    places: Any
    found: Any  # vehicles that `around` has found
    table: Any  # objects on the road
    first_object: Any  # per world
    object_count: Any
    standing: Any  # per object, 1 while it stands there
    place_of: Any  # per world, number of its map
    shadow: Any  # the buildings
    mind: Any  # what drivers know, [row, vehicle]: of the own vehicle's lane and path, for sensors that see these
    points: Any  # of all paths, [row, point]
    chart: Any  # of the roads under these points, [row, point]
    path_first: Any  # per vehicle
    path_count: Any
    stop_first: Any  # stop lines of each vehicle's path
    stop_count: Any
    stop_station: Any  # [m] on the path
    stop_link: Any
    shown: Any  # what each light shows
    sight: Any  # bodies that `look` has seen
    receiver: Any  # settings of the satellite receivers, [row, vehicle]
    satellite: Any  # their errors, and the sky that they have
    weather: Any  # friction of the roads, per world
    pieces: Any  # of slippery stretches, [row, piece]


class Me(NamedTuple):
    """The sensor that is asked, and the unit that it is mounted on."""

    sensor: int  # its column in `out`
    unit: int
    vehicle: int  # -1 on a station
    world: int
    x: float  # [m]
    y: float  # [m]
    heading: float  # [rad]
    cosine: float  # of the heading
    sine: float
    front: float  # [m] from x, y to the front of the unit
    speed: float  # [m/s]
    yaw_rate: float  # [rad/s]
    stream: int  # of its random numbers
    width: int  # numbers of one Reading
    noise: float  # factor on its noise, 1 when it is well
    eye_x: float  # [m] where it is mounted
    eye_y: float
    eye_heading: float  # [rad] that it looks along
    eye_cosine: float
    eye_sine: float


class Way(NamedTuple):
    """The way of one message to one receiver, at the moment of sending. Tests give what they are about."""

    distance: float = 0.0  # [m] from antenna to antenna
    walls: float = 0.0  # [1] walls of buildings that it passes
    inside: float = 0.0  # [m] within buildings
    size: float = 0.0  # [bytes]
    speed: float = 0.0  # [m/s] of the receiver
    approach: float = 0.0  # [m/s] at which both come nearer to each other; negative while they part
    time: float = 0.0  # [s] since the start
    from_x: float = 0.0  # [m] the sender's antenna
    from_y: float = 0.0  # [m]
    from_height: float = 0.0  # [m] above the road
    to_x: float = 0.0  # [m] the receiver's antenna
    to_y: float = 0.0  # [m]
    to_height: float = 0.0  # [m]
    from_load: float = 0.0  # [1] share of the last tenth of a second in which the channel was busy, where the sender is
    load: float = 0.0  # [1] likewise, where the receiver is
    wait: float = 0.0  # [s] as `admit` or `wait` of the radio gave it; 0 for a radio with neither
    from_place: float = 0.0  # what `place` of the radio gave, where the sender is
    to_place: float = 0.0  # likewise, where the receiver is
    table: Any = ()  # what `table` of the radio gave
    decks: float = 0.0  # [1] roads between the two, where one is on a bridge or in a tunnel and the other is not


class Draw(NamedTuple):
    """Chance's part in one message on one link: by these numbers it is told apart. `chance` and the like draw from it."""

    seed: int = 0
    receiver: int = 0
    sender: int = 0
    stream: int = 0  # the first of those of this kind of message
    number: int = 0  # of the message among those of its sender
    common: int = 0  # the first stream of the radio, for what does not hang on the kind of message


class Sent(NamedTuple):
    """One message before it goes out."""

    time: float  # [s]
    x: float  # [m] the sender's antenna
    y: float  # [m]
    size: float  # [bytes]
    load: float = 0.0  # [1] share of the last tenth of a second in which the channel was busy, where the sender is


class Spot(NamedTuple):
    """Where a unit is, for what a radio knows of a place."""

    x: float  # [m]
    y: float  # [m]
    seed: int
    common: int  # the first stream of the radio


class Turn(NamedTuple):
    """The moment at which a unit is asked whether a message is due."""

    time: float  # [s] on its own clock
    gap: float  # [s] least time between two messages, as the congestion control of the radio says; 0 without
    load: float  # [1] share of the last tenth of a second in which the channel was busy


class Transmission(NamedTuple):
    """What becomes of a message: a cause (world/table/cause.py), RECEIVED or why it is lost; the delay [s] of one that is received."""

    lost: int
    delay: float


@inlined
def chance(draw, number):
    """A number in (0, 1); `number`, 0 to 15, tells the draws about one message on one link apart."""
    return uniform(draw.seed, draw.receiver * PAIR + draw.sender, draw.stream + number, draw.number)


@inlined
def chances(draw, number):
    """Four numbers like those of `chance`, from 32 bits each, for about the cost of one."""
    return uniforms(draw.seed, draw.receiver * PAIR + draw.sender, draw.stream + number, draw.number)


@inlined
def chances_of_message(draw, number):
    """Four numbers that all receivers of a message share; `number` is none that is drawn for one receiver."""
    return uniforms(draw.seed, draw.sender, draw.stream + number, draw.number)


@inlined
def chance_normal(draw, number):
    """A number of the standard normal distribution; `number`, 0 to 15, tells the draws about one message on one link apart."""
    return normal(draw.seed, draw.receiver * PAIR + draw.sender, draw.stream + number, draw.number)


@inlined
def chance_of_pair(draw, number, step):
    """A number in (0, 1) that hangs on the two units and a whole number `step`, and neither on the message nor on who sends."""
    return uniform(draw.seed, pair_of(draw), draw.common + number, step)


@inlined
def normal_of_pair(draw, number, step):
    """A number of the standard normal distribution, drawn as `chance_of_pair` does."""
    return normal(draw.seed, pair_of(draw), draw.common + number, step)


@inlined
def pair_of(draw):
    """The number of a pair of units, the same in both directions."""
    return max(draw.receiver, draw.sender) * PAIR + min(draw.receiver, draw.sender)


@inlined
def about(view, unit, sensor, stream, width, noise):
    """Who is asked; its eye is where its unit is."""
    u, v, w = view.unit, view.unit_vehicle[unit], view.unit_world[unit]
    x, y, c, s = u[TRUE_X, unit], u[TRUE_Y, unit], u[COSINE, unit], u[SINE, unit]
    speed, yaw_rate = (view.state[V_X, v], view.state[YAW_RATE, v]) if v >= 0 else (0.0, 0.0)
    return Me(
        sensor, unit, v, w, x, y, u[HEADING, unit], c, s, u[BUMPER, unit], speed, yaw_rate, stream, width, noise,
        x, y, u[HEADING, unit], c, s,
    )  # fmt: skip


@inlined
def placed(me, sensor, settings):
    """The sensor with the column that it writes into."""
    return Me(
        sensor, me.unit, me.vehicle, me.world, me.x, me.y, me.heading, me.cosine, me.sine, me.front, me.speed, me.yaw_rate, me.stream,
        me.width, me.noise, me.eye_x, me.eye_y, me.eye_heading, me.eye_cosine, me.eye_sine,
    )  # fmt: skip


@inlined
def looking(me, sensor, settings):
    """The same with its eye where it is mounted, and turned as it is."""
    ahead, left, c, s = me.front + settings.forward, settings.left, me.cosine, me.sine
    if settings.yaw != 0.0:
        a, b = cos(settings.yaw), sin(settings.yaw)
        c, s = me.cosine * a - me.sine * b, me.sine * a + me.cosine * b
    return Me(
        sensor, me.unit, me.vehicle, me.world, me.x, me.y, me.heading, me.cosine, me.sine, me.front, me.speed, me.yaw_rate, me.stream,
        me.width, me.noise, me.x + ahead * me.cosine - left * me.sine, me.y + ahead * me.sine + left * me.cosine,
        me.heading + settings.yaw, c, s,
    )  # fmt: skip


@inlined
def around(view, me, back, ahead, right, left):
    """How many vehicles of this world have their centre of gravity in a box around the unit: `view.found[0]` and so on, in order.

    The box reaches from `back` to `ahead` along its heading and from `right` to `left` across [m]; behind and right are negative. The
    unit's own vehicle is among them.
    """
    return within(me.world, me.x, me.y, me.cosine, me.sine, back, ahead, right, left, view.grid, view.places, view.found)


@inlined
def draw(view, me, number, about=0):
    """A number in (0, 1); `number`, 0 to 15, tells the draws of one tick apart, and `about` those for several targets."""
    return uniform(view.seed[me.world], view.entity[me.unit], me.stream + number, view.k, about)


@inlined
def draw_normal(view, me, number, about=0):
    """Noise: a number of the standard normal distribution, times a factor when the sensor is not well; numbered like those of `draw`."""
    return me.noise * normal(view.seed[me.world], view.entity[me.unit], me.stream + number, view.k, about)


@inlined
def draw_four(view, me, number, about=0):
    """Four numbers like those of `draw_normal`, for about the cost of one."""
    a, b, c, d = normals(view.seed[me.world], view.entity[me.unit], me.stream + number, view.k, about)
    return me.noise * a, me.noise * b, me.noise * c, me.noise * d


@inlined
def report(out, me, slot, reading):
    """Writes down target `slot`, 0, 1, ...; a whole Reading. One too many is not written, and one of another size makes the run fail."""
    row = 1 + slot * me.width
    if len(reading) != me.width:
        out[0, me.sensor] = MISSHAPEN
    for value in literal_unroll(reading):
        if row < out.shape[0]:
            out[row, me.sensor] = value * 1.0
        row += 1
