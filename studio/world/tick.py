"""One tick of the world: the table of contents of the simulator.

At a tick everybody meets: the script goes on, lights change, drivers look around, sensors measure, messages arrive,
applications and drivers decide, commands go out. Between two ticks every vehicle integrates alone, in small steps; units that talk
faster than that hear, decide and send once or several times before.
"""

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache, partial, update_wrapper, wraps
from math import nan
from typing import Any

from studio.bound import Chain, Link, bound, step
from studio.compiled import lean
from studio.vehicle import fleet
from studio.world import script
from studio.world.board.air import Air, turned
from studio.world.board.host import Fault, Hosted
from studio.world.board.log import is_full
from studio.world.board.own import carry
from studio.world.board.post import Post, draw_lots, taking_turns
from studio.world.board.post import lay as lay_open
from studio.world.board.sensing import Mounted
from studio.world.passes import collision, control, entry, ground, lane, neighbour, oncoming, percept, queue, traffic, zebra
from studio.world.seat import Seats
from studio.world.table.mind import STATION
from studio.world.world import Units, World

Refuse = Callable[[Fault], None]


def let_through(fault: Fault) -> None:
    """A kind that fails ends everything."""
    raise fault.error


def let_pass(found: Any, refuse: Refuse) -> None:
    """What passes of the world itself return says nothing; what they raise ends everything."""
    if isinstance(found, BaseException):
        raise found


def tick(world: World) -> None:
    """Advances the world by one tick. Raises ApplicationError when an application does."""
    meet(world)
    between(world)
    part(world)


def meet(world: World, refuse: Refuse = let_through) -> None:
    """What happens at one instant; afterwards everything that is known belongs to the same time.

    `refuse` is told of sensors, radios and applications that fail.
    """
    world.unfit = 0
    script.turn(world)
    MEETING(world, refuse)
    dispatch(world, refuse)
    act(world)


def between(world: World, refuse: Refuse = let_through) -> None:
    """Units whose cycle is shorter than the tick hear, decide and send at instants between two ticks.

    They know of themselves and around them what they knew at the tick, and what they command counts at the next one.
    """
    if all(each.cycles == 1 for each in world.hosted):
        return
    clock, hosted = world.clock, list(world.hosted)
    moments = instants(tuple(each.cycles for each in hosted))
    commands = world.vehicles.app_command.copy()
    for share, places in moments:
        time = clock.time + share * clock.tick
        listen(world, time)
        decide(world, time, [hosted[place] for place in places], refuse)
        dispatch(world, refuse)
    world.vehicles.app_command[:] = commands


@cache
def instants(cycles: tuple[int, ...]) -> list[tuple[float, list[int]]]:
    """When between two ticks somebody decides, as shares of a tick, and who, of several that decide so often within each."""
    shares = sorted({Fraction(i, count) for count in cycles for i in range(1, count)})
    return [(float(share), [place for place, count in enumerate(cycles) if (share * count).denominator == 1]) for share in shares]


def part(world: World) -> None:
    """What happens until the next instant."""
    move(world)
    AFTERWARDS(world)
    world.clock.k += 1


class Passes:
    """Passes of a tick in a row: `links` tell of a world which, and with which arrays, that stay where they are; they are bound once."""

    __name__: str

    def __init__(self, *links: Callable[[World], Iterator[Link]]) -> None:
        self.links = links
        update_wrapper(self, links[0])

    def __add__(self, other: "Passes") -> "Passes":
        return Passes(*self.links, *other.links)

    def __call__(self, world: World, refuse: Refuse = let_through) -> None:
        """All of them at this tick; `refuse` is told of kinds that fail."""
        chain = world.ready.get(self)
        if chain is None:
            chain = world.ready[self] = Chain([link for links in self.links for link in links(world)])
        chain(world.clock.k, world.clock.time, refuse)


def link(function: Any, *arguments: Any, takes: tuple[str, ...] = (), tell: Callable[..., None] = let_pass) -> Link:
    """A pass with its arrays; `takes` is what it is given besides, "k" and "time". One that cannot be compiled raises that in its turn."""
    try:
        return Link(step(function, *arguments, takes=takes), tell)
    except Exception as error:
        return stop(partial(raise_to, tell, error))


def raise_to(tell: Callable[..., None], error: Exception, found: Any, refuse: Refuse) -> None:
    """What would be raised if it were called."""
    try:
        raise error
    except Exception as again:
        tell(again, refuse)


def stop(tell: Callable[..., None]) -> Link:
    """Something that is no compiled code, in its turn."""
    return Link(step(halt), tell)


@lean
def halt():
    """Has something to tell."""
    return True


def given(arguments: Callable[[World], tuple]) -> Callable:
    """A pass with arrays that stay where they are: `arguments` tells of a world which pass, and which arrays; they are given to it once."""

    @wraps(arguments)
    def call(world: World, *now: float) -> Any:
        run = world.ready.get(call)
        if run is None:
            run = world.ready[call] = bound(*arguments(world), then=now)
        return run(*now)

    return call


def environment(world: World) -> None:
    """The script, lights, and the ground under the wheels."""
    script.turn(world)
    surroundings(world)


@Passes
def surroundings(world: World) -> Iterator[Link]:
    """Who changes lanes, height and slope, friction, what every light shows."""
    v, r = world.vehicles, world.roads
    if world.lanes.any_beside:
        yield go_over(world)
    if r.any_raised:
        yield link(ground.rise, v.state, v.parameter, v.mind[STATION], r.points, r.path_first, r.path_count, r.raised, v.ground)
    yield link(ground.lay, v.state, v.parameter, world.worlds.of, r.weather, r.pieces, r.near, v.ground)
    if r.shown.size:
        signals = (r.signal_time, r.signal_first, r.signal_count, r.phase_end, r.phase_state, r.forced, r.shown)
        yield link(traffic.lights, *signals, takes=("time",))


def go_over(world: World) -> Link:
    """Who wanted to change lanes does."""
    v, r, d, b = world.vehicles, world.roads, world.detours, world.lanes
    lines = (r.path_first, r.path_count, r.stop_first, r.stop_count, *world.obstacles.swept, r.drive_first, r.drive_count)
    moving = (b.asked, b.block, b.left_first, b.left_count)
    fixed = (b.beside, world.script.phase, r.points)
    return link(lane.go_over, world.clock.tick, v.state, *moving, *fixed, *lines, d.base, d.work, d.choice, v.mind)


@Passes
def gather(world: World) -> Iterator[Link]:
    """All vehicles are sorted by place, so that everybody finds who is near."""
    v, g = world.vehicles, world.neighbours
    yield link(neighbour.sort, v.state, v.parameter, world.worlds.of, g.grid, g.places)


@Passes
def look(world: World) -> Iterator[Link]:
    """Drivers find themselves on their path and see who, or what, is ahead."""
    yield orient(world)
    yield line_up(world)
    yield mind_others(world)
    if world.obstacles.standing.size:
        yield mind_obstacles(world)
    if world.obstacles.movers.object.size:
        yield mind_movers(world)
    if world.obstacles.movers.zebra.size:
        yield let_cross(world)
    if world.lanes.facing.watched.any():
        yield link(lane.idle, world.clock.tick, world.vehicles.state, world.lanes.facing.watched, world.vehicles.mind)
    if world.lanes.any_beside:
        yield choose_lanes(world)
    if world.lanes.any_facing:
        yield pass_by(world)


def orient(world: World) -> Link:
    """Where they are on their path."""
    v, r = world.vehicles, world.roads
    stops = (r.stop_first, r.stop_count, r.stop_station, r.stop_link, r.shown)
    places = world.neighbours.places
    return link(
        traffic.orient, world.clock.tick, v.state, v.parameter, places, r.points, r.path_first, r.path_count, *stops, v.drivers, v.mind
    )


def line_up(world: World) -> Link:
    """Who is behind whom on every strand."""
    v, r, q, w = world.vehicles, world.roads, world.queues, world.worlds
    asked = (q.wanted, q.wanted_at, q.there, q.count)
    drives = (r.drive_first, r.drive_count, world.lanes.left_first, world.lanes.left_count, r.web)
    return link(queue.sort, v.state, v.parameter, v.mind, w.of, w.entity, *drives, q.first, q.place, q.at, *asked)


def mind_others(world: World) -> Link:
    """Who is ahead on one's strands, and who comes where they meet others."""
    v, r, q, w, g = world.vehicles, world.roads, world.queues, world.worlds, world.neighbours
    paths, drives = (r.points, r.path_first, r.path_count), (r.drive_first, r.drive_count, r.web)
    numbers, queues = (w.of, w.number, w.entity), (q.first, q.place, q.at)
    return link(traffic.others, v.state, v.parameter, g.places, *paths, *numbers, *drives, *queues, v.drivers, v.mind)


def mind_obstacles(world: World) -> Link:
    """What stands in the way."""
    v, o, w = world.vehicles, world.obstacles, world.worlds
    sweep = (o.sweep, o.sweep_first, o.sweep_count)
    return link(traffic.obstacles, v.state, v.parameter, *sweep, o.standing, o.first, w.of, v.drivers, v.mind)


def mind_movers(world: World) -> Link:
    """Who walks or rides in the way."""
    v, r, o, w = world.vehicles, world.roads, world.obstacles, world.worlds
    paths, objects = (r.points, r.path_first, r.path_count), (o.movers.object, o.table, o.standing, o.first, o.count)
    return link(traffic.movers, v.state, v.parameter, *paths, *objects, w.of, v.drivers, v.mind)


def let_cross(world: World) -> Link:
    """Who crosses on stripes, or is about to."""
    v, r, o, w, m = world.vehicles, world.roads, world.obstacles, world.worlds, world.obstacles.movers
    paths, objects = (r.points, r.path_first, r.path_count), (o.table, o.standing, o.first, o.count, world.script.turned)
    walking, view = (m.object, m.speed, m.zebra_first, m.zebra_count, m.zebra), (world.neighbours.places, r.place_of, r.shadow)
    own = (v.state, v.parameter, *paths, *objects, *walking, w.of, *view, v.drivers, v.mind)
    return link(zebra.let_cross, *own, takes=("time",))


def choose_lanes(world: World) -> Link:
    """Who wants to change lanes."""
    v, r, q, w, d, b, g = world.vehicles, world.roads, world.queues, world.worlds, world.detours, world.lanes, world.neighbours
    numbers = (r.points, r.path_first, r.path_count, w.of, w.number, w.entity)
    moving = (b.asked, b.block, b.left_first, b.left_count, b.beside, world.script.phase)
    lines = (r.stop_first, r.stop_count, *world.obstacles.swept, r.drive_first, r.drive_count, d.base, d.work, d.choice)
    queues = (r.web, q.first, q.place, q.at, g.found)
    every = max(round(lane.EVERY / world.clock.tick), 1)
    own = (every, v.state, v.parameter, g.places, *numbers, *moving, *lines, *queues, v.drivers, v.mind)
    return link(lane.choose, *own, takes=("k",))


def pass_by(world: World) -> Link:
    """Who passes on the oncoming lane what stands."""
    v, r, q, w, o, g = world.vehicles, world.roads, world.queues, world.worlds, world.obstacles, world.neighbours
    numbers = (r.points, r.path_first, r.path_count, w.of, w.number, w.first, w.entity, r.drive_first, r.drive_count)
    things = (o.sweep, o.sweep_first, o.sweep_count, o.table, o.standing, o.first, world.lanes.facing)
    view = (r.web, q.first, q.place, q.at, r.place_of, r.shadow)
    every = max(round(oncoming.EVERY / world.clock.tick), 1)
    own = (world.clock.tick, every, v.state, v.parameter, g.places, *numbers, *things, *view, v.drivers, v.mind)
    return link(oncoming.pass_by, *own, takes=("k",))


@Passes
def think(world: World) -> Iterator[Link]:
    """Drivers perceive whom they mind, decide, one kind after the other, and answer in their time."""
    v, w, tick = world.vehicles, world.worlds, world.clock.tick
    chance = (w.of, w.entity, w.driver_seed)
    own = (tick, percept.renewal(tick), v.state, v.parameter, *chance, v.drivers, v.mind)
    yield link(percept.perceive, *own, takes=("k", "time"))
    for seats in world.seats:
        yield link(seats.run, seats.columns, seats.settings, v.state, v.parameter, v.mind, tell=partial(wishes, world, seats))
    yield link(percept.answer, tick, percept.stride(tick), v.state, v.drivers, v.mind, v.intents, takes=("k", "time"))


def wishes(world: World, seats: Seats, unfit: Any, refuse: Refuse) -> None:
    """So many of the wishes of some drivers are no numbers. Raises KindError with the traceback of one that raises."""
    if isinstance(unfit, BaseException):
        raise seats.raised() from unfit
    world.unfit += unfit


@Passes
def sense(world: World) -> Iterator[Link]:
    """Satellites tell where one is; units look at themselves and around."""
    v, u, w, r, g = world.vehicles, world.units, world.worlds, world.roads, world.neighbours
    cars = (u.vehicle, u.fixed, v.state, v.parameter, v.mind, v.commands, g.places, u.gps_set, w.of, w.entity, w.satellite_seed)
    yield link(carry, *cars, w.seed, r.place_of, r.shadow, u.satellite, u.now, world.clock.tick, takes=("k",))
    for each in u.mounted:
        yield link(each.run, *world.view, *each.arrays, takes=("k", "time"), tell=partial(blame, u, each))


def blame(u: Units, each: Mounted, faults: Any, refuse: Refuse) -> None:
    """Sensors of one kind have done something wrong."""
    for i, what in (each.raised() if isinstance(faults, BaseException) else each.wrong()).items():
        refuse(u.blame(each, i, what))


@Passes
def communicate(world: World) -> Iterator[Link]:
    """Beacons go out; what has come in is taken, and laid before the applications."""
    u = world.units
    for air in u.airs:
        if air.is_loaded:
            yield link(turned, air.since, air.busy, air.load, takes=("time",), tell=partial(assess, air, u))
    if draw_lots(u.posts):
        yield stop(partial(exchange_by_lot, world))
    else:
        for post in u.posts:
            yield from exchange(world, post)
    for inbox in world.open_inboxes:
        yield link(lay_open, *inbox.arrays, takes=("time",))


def assess(air: Air, units: Units, is_over: Any, refuse: Refuse) -> None:
    """A window of the load is over: congestion control looks at it."""
    let_pass(is_over, refuse)
    if air.assess:
        air.assess(air.settings, units.world, air.load, air.control, air.gap)


def exchange(world: World, post: Post) -> Iterator[Link]:
    """One kind of message."""
    air = world.units.airs[post.air]
    own = (*post.of_exchange(air), *post.given(air, world.air))
    yield link(is_full, *post.log.filling, tell=partial(put_away, post))
    yield link(post.exchange, *own, takes=("k", "time"), tell=partial(blame_post, post))


def put_away(post: Post, is_full: Any, refuse: Refuse) -> None:
    """There is no more room to write down what comes of messages."""
    let_pass(is_full, refuse)
    post.log.put_away()


def blame_post(post: Post, error: Any, refuse: Refuse) -> None:
    """A message or radio raises."""
    for fault in post.raised():
        refuse(fault)


def exchange_by_lot(world: World, found: Any, refuse: Refuse) -> None:
    """All kinds of messages, in an order that is drawn."""
    clock, u = world.clock, world.units
    for post in taking_turns(u.posts, clock.k):
        for fault in post.exchanged(clock.k, clock.time, u.airs[post.air], world.air):
            refuse(fault)


def lay(world: World, time: float) -> None:
    """What everybody has heard is laid before the applications that hear everybody."""
    for each in world.open_inboxes:
        each.lay(time)


def listen(world: World, time: float) -> None:
    """What has come in between two ticks is taken, and laid before the applications."""
    for post in world.units.posts:
        post.received(time)
    lay(world, time)


def dispatch(world: World, refuse: Refuse = let_through) -> None:
    """The radio decides about what applications have sent."""
    for post in taking_turns(world.units.posts, world.clock.k):
        for fault in post.dispatched(world.units.airs[post.air], world.air):
            refuse(fault)


@Passes
def applications(world: World) -> Iterator[Link]:
    """Every application sees and decides, the highest priority last."""
    around = world.units.fixed, world.units.now, world.vehicles.app_command
    yield link(clear, world.vehicles.app_command)
    for hosted in world.hosted:
        tell = partial(decided if hosted.is_compiled else decide_now, world, hosted)
        yield link(hosted.run, *around, *hosted.given(world.clock.tick), takes=("time",), tell=tell) if hosted.is_compiled else stop(tell)


@lean
def clear(commands):
    """Nobody commands anything."""
    commands[:] = nan


def decided(world: World, hosted: Hosted, faults: Any, refuse: Refuse) -> None:
    """Something went wrong in an application."""
    is_raised = isinstance(faults, BaseException)
    for fault in [hosted.raised(faults)] if is_raised else hosted.faults(world.clock.time, world.clock.tick):
        refuse(fault)


def decide_now(world: World, hosted: Hosted, found: Any, refuse: Refuse) -> None:
    """An application that runs as Python sees and decides."""
    decide(world, world.clock.time, [hosted], refuse)


MEETING = surroundings + gather + look + think + sense + communicate + applications


def decide(world: World, time: float, which: list[Hosted], refuse: Refuse) -> None:
    """Some applications see and decide, the highest priority last."""
    u, tick = world.units, world.clock.tick
    for hosted in which:
        for fault in hosted.decide(time, tick, (u.fixed, u.now, world.vehicles.app_command)):
            refuse(fault)


def act(world: World) -> None:
    """Maneuvers, applications and drivers command the actuators."""
    script.act(world)
    command(world, world.clock.k, world.clock.time)


@given
def command(world: World) -> tuple:
    """Actuators at tick k and a time [s]."""
    v = world.vehicles
    return control.command, v.state, v.ground, v.parameter, world.script.commands, v.drivers, v.mind, v.app_command, v.commands


def move(world: World) -> None:
    """Gearboxes decide, and every vehicle integrates to the next tick."""
    fleet.advance(world.vehicles, world.clock.k, world.clock.tick, world.clock.step)


@Passes
def collide(world: World) -> Iterator[Link]:
    """Contacts are found at the end of the tick: vehicles that touch each other, or an object."""
    v, w, e, g, o = world.vehicles, world.worlds, world.events, world.neighbours, world.obstacles
    near, objects = (w.of, w.number, g.grid, g.places, g.found), (w.first, w.count, o.table, o.first, o.count, o.standing)
    own = (world.clock.tick, g.widest, v.state, v.parameter, *near, *objects, e.hits, e.found)
    yield link(collision.contacts, *own, takes=("time",), tell=partial(find_room, world))


def find_room(world: World, left: Any, refuse: Refuse) -> None:
    """There is no room for some contacts: room is made, and the rest is added."""
    let_pass(left, refuse)
    world.events.grow()
    world.ready.clear()
    collide(world, refuse)


@Passes
def recirculate(world: World) -> Iterator[Link]:
    """Traffic that has arrived comes in again at the beginning of its path, and whoever is due."""
    v, r, w, q, d = world.vehicles, world.roads, world.worlds, world.queues, world.demand
    due, paths = (d.column, d.cars, d.first, d.due, d.gone, d.came), (r.points, r.path_first, r.path_count, r.raised)
    near = (r.drive_first, r.drive_count, r.web, w.of, q.first, q.place, q.at, world.neighbours.entered)
    moved = (v.drivers, v.state, v.wheels, v.ground, v.parameter, v.gears, v.mind)
    if v.any_returns:
        yield link(entry.let_in, v.returns, v.removed, *due, *paths, *near, *moved, takes=("time",))


AFTERWARDS = collide + recirculate
