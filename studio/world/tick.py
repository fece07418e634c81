"""One tick of the world: the table of contents of the simulator.

At a tick everybody meets: the script goes on, lights change, drivers look around, sensors measure, messages arrive,
applications and drivers decide, commands go out. Between two ticks every vehicle integrates alone, in small steps.
"""

from collections.abc import Callable

from studio.application.host import Hosted
from studio.errors import ApplicationError
from studio.vehicle import fleet
from studio.world import script
from studio.world.passes import collision, control, ground, neighbour, perception, queue, traffic
from studio.world.table.mind import STATION
from studio.world.world import World

Refuse = Callable[[Hosted, ApplicationError], None]


def let_through(_hosted: Hosted, error: ApplicationError) -> None:
    """An application that fails ends everything."""
    raise error


def tick(world: World) -> None:
    """Advances the world by one tick. Raises ApplicationError when an application does."""
    meet(world)
    part(world)


def meet(world: World, refuse: Refuse = let_through) -> None:
    """What happens at one instant; afterwards everything that is known belongs to the same time.

    `refuse` is told of applications that fail.
    """
    environment(world)
    gather(world)
    look(world)
    sense(world)
    communicate(world)
    think(world)
    applications(world, refuse)
    act(world)


def part(world: World) -> None:
    """What happens until the next instant."""
    move(world)
    collide(world)
    recirculate(world)
    world.clock.k += 1


def environment(world: World) -> None:
    """The script, lights, and the ground under the wheels."""
    v, r, time = world.vehicles, world.roads, world.clock.time
    script.turn(world)
    ground.rise(v.state, v.parameter, v.mind[STATION], r.points, r.path_first, r.path_count, r.raised, v.ground)
    ground.lay(v.state, v.parameter, world.worlds.of, r.weather, r.pieces, r.near, v.ground)
    traffic.lights(time, r.signal_time, r.signal_first, r.signal_count, r.phase_end, r.phase_state, r.shown)


def gather(world: World) -> None:
    """All vehicles are sorted by place, so that everybody finds who is near."""
    v, g = world.vehicles, world.neighbours
    neighbour.sort(v.state, v.parameter, world.worlds.of, g.grid, g.places)


def look(world: World) -> None:
    """Drivers find themselves on their path and see who, or what, is ahead."""
    v, r, o, c, q, w = world.vehicles, world.roads, world.obstacles, world.roads.conflicts, world.queues, world.worlds
    traffic.orient(
        v.state, v.parameter, world.neighbours.places, r.points, r.path_first, r.path_count, r.stop_first, r.stop_count, r.stop_station,
        r.stop_link, r.shown, v.drivers, v.mind,
    )  # fmt: skip
    queue.sort(v.state, v.mind, c.queue, q.first, q.order, q.before, q.slowest)
    traffic.meetings(
        v.state, v.parameter, world.neighbours.places, r.points, r.path_first, r.path_count, w.of, w.number, world.neighbours.longest,
        c.track, c.queue_of, c.partner_first, c.partner, c.zone_first, c.zone_span, q.first, q.order, q.slowest, v.drivers, v.mind,
    )  # fmt: skip
    if o.standing.size:
        traffic.obstacles(v.state, v.parameter, o.sweep, o.sweep_first, o.sweep_count, o.standing, o.first, w.of, v.drivers, v.mind)


def sense(world: World) -> None:
    """Sensors measure, satellites tell where one is."""
    v, u, w, o, r, g, clock = world.vehicles, world.units, world.worlds, world.obstacles, world.roads, world.neighbours, world.clock
    perception.sense(
        clock.k, g.longest, v.state, v.parameter, u.sensor_set, w.of, w.number, w.entity, o.table, o.first, o.count, o.standing,
        w.seed, g.grid, g.places, g.found, u.sensors,
    )  # fmt: skip
    perception.fix(clock.k, clock.tick, v.state, u.gps_set, w.of, w.entity, w.seed, r.place_of, r.shadow, u.sensors)


def communicate(world: World) -> None:
    """Units send, and take what has reached them."""
    v, u, w, r, clock = world.vehicles, world.units, world.worlds, world.roads, world.clock
    perception.send(clock.k, clock.tick, v.state, v.commands, u.radio_set, w.of, w.entity, u.sensors, u.sent)
    perception.receive(
        clock.k, clock.tick, v.state, u.radio_set, u.link_receiver, u.link_sender, w.of, w.entity, w.seed, r.place_of, r.shadow,
        u.sent, u.inbox,
    )  # fmt: skip


def think(world: World) -> None:
    """Drivers decide."""
    v = world.vehicles
    traffic.decide(v.state, v.parameter, v.drivers, v.mind)


def applications(world: World, refuse: Refuse = let_through) -> None:
    """Every application sees its observation and decides."""
    for hosted in world.hosted:
        observe(world, hosted)
        try:
            hosted.decide(world.vehicles.app_command)
        except ApplicationError as error:
            refuse(hosted, error)


def observe(world: World, hosted: Hosted) -> None:
    """What the cars of one group see, row by row as `observation_rows` names them."""
    v, u, clock = world.vehicles, world.units, world.clock
    control.observe(clock.time, clock.tick, hosted.columns, hosted.links, v.state, v.mind, u.sensors, u.inbox, hosted.observed)


def act(world: World) -> None:
    """Maneuvers, applications and drivers command the actuators."""
    v, clock = world.vehicles, world.clock
    script.act(world)
    control.command(clock.k, v.state, v.ground, v.parameter, world.script.commands, v.mind, v.app_command, v.commands)


def move(world: World) -> None:
    """Gearboxes decide, and every vehicle integrates to the next tick."""
    fleet.advance(world.vehicles, world.clock.k, world.clock.tick, world.clock.step)


def collide(world: World) -> None:
    """Contacts are found at the end of the tick."""
    v, w, e, o, g = world.vehicles, world.worlds, world.events, world.obstacles, world.neighbours
    time = world.clock.time + world.clock.tick
    collision.collide(time, g.widest, v.state, v.parameter, w.of, w.number, g.grid, g.places, g.found, e.hits, e.found)
    if o.standing.size:
        collision.strike(time, v.state, v.parameter, w.first, w.count, o.table, o.first, o.count, o.standing, e.hits, e.found)


def recirculate(world: World) -> None:
    """Traffic that has arrived comes in again."""
    v, r, w, g = world.vehicles, world.roads, world.worlds, world.neighbours
    traffic.recirculate(
        v.returns, r.points, r.path_first, r.path_count, r.raised, w.of, g.grid, g.places, g.found, g.entered, v.state, v.wheels,
        v.ground, v.parameter, v.gears, v.mind,
    )  # fmt: skip
