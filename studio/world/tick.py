"""One tick of the world: the table of contents of the simulator.

At a tick everybody meets: the script goes on, lights change, drivers look around, sensors measure, messages arrive,
applications and drivers decide, commands go out. Between two ticks every vehicle integrates alone, in small steps; units that talk
faster than that hear, decide and send once or several times before.
"""

from collections.abc import Callable
from fractions import Fraction
from functools import cache, wraps
from math import nan
from typing import Any

from studio.bound import bound
from studio.vehicle import fleet
from studio.world import script
from studio.world.board.host import Fault, Hosted
from studio.world.board.post import taking_turns
from studio.world.passes import collision, control, entry, ground, lane, neighbour, percept, queue, traffic, zebra
from studio.world.table.mind import STATION
from studio.world.world import World

Refuse = Callable[[Fault], None]


def let_through(fault: Fault) -> None:
    """A kind that fails ends everything."""
    raise fault.error


def tick(world: World) -> None:
    """Advances the world by one tick. Raises ApplicationError when an application does."""
    meet(world)
    between(world)
    part(world)


def meet(world: World, refuse: Refuse = let_through) -> None:
    """What happens at one instant; afterwards everything that is known belongs to the same time.

    `refuse` is told of sensors, radios and applications that fail.
    """
    environment(world)
    gather(world)
    look(world)
    think(world)
    sense(world, refuse)
    communicate(world, refuse)
    applications(world, refuse)
    dispatch(world, refuse)
    act(world)


def between(world: World, refuse: Refuse = let_through) -> None:
    """Units whose cycle is shorter than the tick hear, decide and send at instants between two ticks.

    They know of themselves and around them what they knew at the tick, and what they command counts at the next one.
    """
    clock, hosted = world.clock, list(world.hosted)
    moments = instants(tuple(each.cycles for each in hosted))
    if not moments:
        return
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
    collide(world)
    recirculate(world)
    world.clock.k += 1


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
    if world.lanes.any_beside:
        go_over(world)
    if world.roads.any_raised:
        rise(world)
    lay_ground(world)
    if world.roads.shown.size:
        show_lights(world, world.clock.time)


@given
def go_over(world: World) -> tuple:
    """Who changes lanes."""
    v, r, d, b = world.vehicles, world.roads, world.detours, world.lanes
    lines = (r.path_first, r.path_count, r.stop_first, r.stop_count, *world.obstacles.swept, r.drive_first, r.drive_count)
    moving = (b.asked, b.block, b.left_first, b.left_count)
    fixed = (b.beside, world.script.phase, r.points)
    return lane.go_over, world.clock.tick, v.state, *moving, *fixed, *lines, d.base, d.work, d.choice, v.mind


@given
def rise(world: World) -> tuple:
    """Height and slope."""
    v, r = world.vehicles, world.roads
    return ground.rise, v.state, v.parameter, v.mind[STATION], r.points, r.path_first, r.path_count, r.raised, v.ground


@given
def lay_ground(world: World) -> tuple:
    """Friction."""
    v, r = world.vehicles, world.roads
    return ground.lay, v.state, v.parameter, world.worlds.of, r.weather, r.pieces, r.near, v.ground


@given
def show_lights(world: World) -> tuple:
    """What every light shows at a time [s]."""
    r = world.roads
    signals = (r.signal_time, r.signal_first, r.signal_count, r.phase_end, r.phase_state, r.forced, r.shown)
    return traffic.lights, *signals


@given
def gather(world: World) -> tuple:
    """All vehicles are sorted by place, so that everybody finds who is near."""
    v, g = world.vehicles, world.neighbours
    return neighbour.sort, v.state, v.parameter, world.worlds.of, g.grid, g.places


def look(world: World) -> None:
    """Drivers find themselves on their path and see who, or what, is ahead."""
    orient(world)
    line_up(world)
    mind_others(world)
    if world.obstacles.standing.size:
        mind_obstacles(world)
    if world.obstacles.movers.object.size:
        mind_movers(world)
    if world.obstacles.movers.zebra.size:
        let_cross(world, world.clock.time)
    if world.lanes.any_beside:
        choose_lanes(world, world.clock.k)


@given
def orient(world: World) -> tuple:
    """Where they are on their path."""
    v, r = world.vehicles, world.roads
    stops = (r.stop_first, r.stop_count, r.stop_station, r.stop_link, r.shown)
    places = world.neighbours.places
    return traffic.orient, world.clock.tick, v.state, v.parameter, places, r.points, r.path_first, r.path_count, *stops, v.drivers, v.mind


@given
def line_up(world: World) -> tuple:
    """Who is behind whom on every strand."""
    v, r, q, w = world.vehicles, world.roads, world.queues, world.worlds
    asked = (q.wanted, q.wanted_at, q.there, q.count)
    drives = (r.drive_first, r.drive_count, world.lanes.left_first, world.lanes.left_count, r.web)
    return queue.sort, v.state, v.parameter, v.mind, w.of, w.entity, *drives, q.first, q.place, q.at, *asked


@given
def mind_others(world: World) -> tuple:
    """Who is ahead on one's strands, and who comes where they meet others."""
    v, r, q, w, g = world.vehicles, world.roads, world.queues, world.worlds, world.neighbours
    paths, drives = (r.points, r.path_first, r.path_count), (r.drive_first, r.drive_count, r.web)
    numbers, queues = (w.of, w.number, w.entity), (q.first, q.place, q.at)
    return traffic.others, v.state, v.parameter, g.places, *paths, *numbers, *drives, *queues, v.drivers, v.mind


@given
def mind_obstacles(world: World) -> tuple:
    """What stands in the way."""
    v, o, w = world.vehicles, world.obstacles, world.worlds
    sweep = (o.sweep, o.sweep_first, o.sweep_count)
    return traffic.obstacles, v.state, v.parameter, *sweep, o.standing, o.first, w.of, v.drivers, v.mind


@given
def mind_movers(world: World) -> tuple:
    """Who walks or rides in the way."""
    v, r, o, w = world.vehicles, world.roads, world.obstacles, world.worlds
    paths, objects = (r.points, r.path_first, r.path_count), (o.movers.object, o.table, o.standing, o.first, o.count)
    return traffic.movers, v.state, v.parameter, *paths, *objects, w.of, v.drivers, v.mind


@given
def let_cross(world: World) -> tuple:
    """Who crosses on stripes, or is about to, at a time [s]."""
    v, r, o, w, m = world.vehicles, world.roads, world.obstacles, world.worlds, world.obstacles.movers
    paths, objects = (r.points, r.path_first, r.path_count), (o.table, o.standing, o.first, o.count, world.script.turned)
    walking, view = (m.object, m.speed, m.zebra_first, m.zebra_count, m.zebra), (world.neighbours.places, r.place_of, r.shadow)
    return zebra.let_cross, v.state, v.parameter, *paths, *objects, *walking, w.of, *view, v.drivers, v.mind


@given
def choose_lanes(world: World) -> tuple:
    """Who wants to change lanes at tick k."""
    v, r, q, w, d, b, g = world.vehicles, world.roads, world.queues, world.worlds, world.detours, world.lanes, world.neighbours
    numbers = (r.points, r.path_first, r.path_count, w.of, w.number, w.entity)
    moving = (b.asked, b.block, b.left_first, b.left_count, b.beside, world.script.phase)
    lines = (r.stop_first, r.stop_count, *world.obstacles.swept, r.drive_first, r.drive_count, d.base, d.work, d.choice)
    queues = (r.web, q.first, q.place, q.at, g.found)
    every = max(round(lane.EVERY / world.clock.tick), 1)
    return lane.choose, world.clock.tick, every, v.state, v.parameter, g.places, *numbers, *moving, *lines, *queues, v.drivers, v.mind


def think(world: World) -> None:
    """Drivers perceive whom they mind, decide, one kind after the other, and answer in their time."""
    v, clock = world.vehicles, world.clock
    perceive(world, clock.k, clock.time)
    world.unfit = sum([seats.decide(v.state, v.parameter, v.mind) for seats in world.seats])
    answer(world, clock.k, clock.time)


@given
def perceive(world: World) -> tuple:
    """What drivers take that to be which they mind, at tick k and a time [s]."""
    v, w, tick = world.vehicles, world.worlds, world.clock.tick
    chance = (w.of, w.entity, w.driver_seed)
    return percept.perceive, tick, percept.renewal(tick), v.state, v.parameter, *chance, v.drivers, v.mind


@given
def answer(world: World) -> tuple:
    """What their feet do at tick k and a time [s]."""
    v, tick = world.vehicles, world.clock.tick
    return percept.answer, tick, percept.stride(tick), v.state, v.drivers, v.mind, v.intents


def sense(world: World, refuse: Refuse = let_through) -> None:
    """Satellites tell where one is; units look at themselves and around."""
    u, clock = world.units, world.clock
    world.carry(clock.k, clock.tick)
    for each in u.mounted:
        for i, what in each.ask(clock.k, clock.time, world.view).items():
            refuse(u.blame(each, i, what))


def communicate(world: World, refuse: Refuse = let_through) -> None:
    """Beacons go out; what has come in is taken, and laid before the applications."""
    clock, u = world.clock, world.units
    for air in u.airs:
        air.turn(clock.time, u.world)
    for post in taking_turns(u.posts, clock.k):
        for fault in post.exchanged(clock.k, clock.time, u.airs[post.air], world.air):
            refuse(fault)
    lay(world, clock.time)


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


def applications(world: World, refuse: Refuse = let_through) -> None:
    """Every application sees and decides."""
    world.vehicles.app_command[:] = nan
    decide(world, world.clock.time, list(world.hosted), refuse)


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


def collide(world: World) -> None:
    """Contacts are found at the end of the tick; where there is no room for all of them, room is made, and the rest is added."""
    while contacts(world):
        world.events.grow()
        world.ready.clear()


def contacts(world: World) -> int:
    """Adds the contacts of now that are not known; how many of them found no room."""
    time = world.clock.time + world.clock.tick
    left = touch(world, time)
    return left + strike(world, time) if world.obstacles.standing.size else left


@given
def touch(world: World) -> tuple:
    """Vehicles that touch each other at a time [s]."""
    v, w, e, g = world.vehicles, world.worlds, world.events, world.neighbours
    near = (g.widest, v.state, v.parameter, w.of, w.number, g.grid, g.places, g.found)
    return collision.collide, *near, e.hits, e.found


@given
def strike(world: World) -> tuple:
    """Vehicles that touch an object."""
    v, w, e, o = world.vehicles, world.worlds, world.events, world.obstacles
    objects = (o.table, o.first, o.count, o.standing)
    return collision.strike, v.state, v.parameter, w.first, w.count, *objects, e.hits, e.found


def recirculate(world: World) -> None:
    """Traffic that has arrived comes in again, and whoever is due."""
    if world.vehicles.any_returns:
        come_in(world, world.clock.time)


@given
def come_in(world: World) -> tuple:
    """At the beginning of its path, at a time [s]."""
    v, r, w, q, d = world.vehicles, world.roads, world.worlds, world.queues, world.demand
    due, paths = (d.column, d.cars, d.first, d.due, d.gone, d.came), (r.points, r.path_first, r.path_count, r.raised)
    near = (r.drive_first, r.drive_count, r.web, w.of, q.first, q.place, q.at, world.neighbours.entered)
    return entry.let_in, v.returns, v.removed, *due, *paths, *near, v.drivers, v.state, v.wheels, v.ground, v.parameter, v.gears, v.mind
