"""Deeds: what actions do to the world besides the road, put in their place in its arrays.

Some are done once, as their entry begins. The others hold while their entry acts: cells of an array have the value of the last entry that
began and still acts, else their own. These follow from the phases of the script, and are made anew whenever one turns.

deeds_of(settings, world)   →  Deeds
hold(world)                 what follows from the phases
begin(world)                what is done once by those that begin now
jam(world)                  who is in a region that is jammed
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial

import numpy as np

from studio.conventions import GRAVITY
from studio.kind import registry
from studio.kind.area import Area
from studio.kind.number import numbers
from studio.model.driver import sight_speed
from studio.road.network import Network
from studio.road.network.signals import AMBER, GREEN, RED, RED_AMBER
from studio.road.ways.path import PATH_HEADING, PATH_SPACING, PATH_X, PATH_Y
from studio.vehicle.command import U_BRAKE, U_DRIVE, U
from studio.vehicle.shift import start
from studio.vehicle.state import ACTIVE, TORQUE_DRIVE
from studio.world.effect import Delay, Drop, Jam, Lights, Placement, Removal, SensorFault, Switch, Tune, WeatherChange
from studio.world.find import corners
from studio.world.passes.control import wheel_torque
from studio.world.passes.ground import touch_all
from studio.world.setting import Setting
from studio.world.site import joined_at
from studio.world.table.mind import BRAKE_COMFORT, SIGHT, SIGHT_SPEED, STATION
from studio.world.table.street import ACTING
from studio.world.table.unit import ADDED, DROPS, FAILS, JAMMED, NOISE, TRUE_X, TRUE_Y
from studio.world.world import Deeds, Held, Once, Region, World

SHOWN = {"red": RED, "red_amber": RED_AMBER, "green": GREEN, "amber": AMBER}
Found = Iterator[Held | Once | Region]


# -- while a world runs --------------------------------------------------------------------------------


def hold(world: World) -> None:
    """Every cell has its own value, or that of the last entry that acts on it."""
    s = world.script
    for each in s.deeds.held:
        getattr(each.owner, each.field)[each.index] = each.base
    for each in sorted((each for each in s.deeds.held if s.phase[each.entry] == ACTING), key=lambda each: s.turned[0, each.entry]):
        getattr(each.owner, each.field)[each.index] = each.value
    for w in s.deeds.weathers:
        see(world, world.columns(w), float(world.roads.weather[w]))


def see(world: World, columns: slice, friction: float) -> None:
    """The speed from which drivers stop within sight: braking in comfort, or as hard as the road lets."""
    drivers = world.vehicles.drivers[:, columns]
    for v in range(drivers.shape[1]):
        drivers[SIGHT_SPEED, v] = sight_speed(drivers[SIGHT, v], min(drivers[BRAKE_COMFORT, v], friction * GRAVITY))


def begin(world: World) -> None:
    """What is done once by entries that begin at this tick."""
    for each in world.script.deeds.once:
        if world.script.turned[0, each.entry] == world.clock.time:
            each.do(world)


def jam(world: World) -> None:
    """Units in a region that is jammed hear nothing."""
    u, s = world.units, world.script
    for each in s.deeds.regions:
        u.trouble[JAMMED, each.units] = 0.0
    for each in s.deeds.regions:
        if s.phase[each.entry] == ACTING:
            x, y = u.now[TRUE_X, each.units], u.now[TRUE_Y, each.units]
            u.trouble[JAMMED, each.units[inside(x, y, each)]] = 1.0


def inside(x: np.ndarray, y: np.ndarray, region: Region) -> np.ndarray:
    """Which places [m] are in a circle, or within corners: a ray to the east crosses their sides an odd number of times."""
    if region.radius > 0.0:
        return np.hypot(x - region.x, y - region.y) <= region.radius
    found = np.zeros(x.shape, dtype=bool)
    for (x_a, y_a), (x_b, y_b) in zip(region.corners, [*region.corners[1:], region.corners[0]], strict=True):
        crossed = (y_a > y) != (y_b > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            found ^= crossed & (x < x_a + (x_b - x_a) * (y - y_a) / (y_b - y_a))
    return found


# -- vehicles that come and go -------------------------------------------------------------------------


def put(world: World, v: int, station: float, speed: float) -> None:
    """A vehicle stands on its path at a station [m], or rolls there with a speed [m/s], as if it had done so for long."""
    c, r, n = world.vehicles, world.roads, world.size
    first, count = int(r.path_first[v]), int(r.path_count[v])
    grid = np.arange(count) * PATH_SPACING
    x, y, heading = (float(np.interp(station, grid, r.points[row, first : first + count])) for row in (PATH_X, PATH_Y, PATH_HEADING))
    if r.raised[v]:
        touch_all(v, n, station, r.points, first, count, c.ground)
    start(v, x, y, heading, speed, c.state, c.wheels, c.ground, c.parameter, c.gears)
    c.mind[STATION, v], c.removed[v] = station, 0
    T = wheel_torque(v, 0.0, c.state, c.ground, c.parameter)
    c.state[TORQUE_DRIVE, v] = c.commands[U_DRIVE, v::n] = T
    c.commands[[U, U_BRAKE], v::n] = 0.0


def take_away(world: World, v: int) -> None:
    """A vehicle takes no part any more."""
    world.vehicles.state[ACTIVE, v], world.vehicles.removed[v] = 0.0, 1


def drop(world: World, unit: int, count: float) -> None:
    """The next messages of a unit reach nobody."""
    world.units.trouble[DROPS, unit] = count


# -- at the start --------------------------------------------------------------------------------------


def deeds_of(settings: Sequence[Setting], world: World) -> Deeds:
    """All of all worlds."""
    entry, weathers = 0, set()
    found: list[Held | Once | Region] = []
    for w, setting in enumerate(settings):
        for site in setting.sites:
            for effect in site.effects:
                if type(effect) in MADE:
                    found += MADE[type(effect)](effect, entry, w, setting, world)
                    weathers |= {w} if isinstance(effect, WeatherChange) else set()
            entry += 1
    return Deeds(
        held=[each for each in found if isinstance(each, Held)],
        once=[each for each in found if isinstance(each, Once)],
        regions=[each for each in found if isinstance(each, Region)],
        weathers=sorted(weathers),
    )


def held(entry: int, owner, field: str, index, value) -> Held:
    """Cells of an array of the world, and what they are by themselves."""
    return Held(entry, owner, field, index, value, np.array(getattr(owner, field)[index]))


def weather(of: WeatherChange, entry: int, w: int, _setting: Setting, world: World) -> Found:
    """Other friction everywhere, another sight for all drivers."""
    if of.friction is not None:
        yield held(entry, world.roads, "weather", w, of.friction)
    if of.visibility is not None:
        yield held(entry, world.vehicles, "drivers", (SIGHT, world.columns(w)), of.visibility)


def lights(of: Lights, entry: int, w: int, setting: Setting, world: World) -> Found:
    """All lights at the end of a road."""
    lanes = setting.network.lanes
    here = np.array([lanes[lane].road == of.road for lane in setting.network.signals.link_lane], dtype=bool)
    yield held(entry, world.roads, "forced", int(world.roads.light_first[w]) + np.flatnonzero(here), SHOWN[of.shows])


def region(of: Jam, entry: int, w: int, setting: Setting, world: World) -> Found:
    """Where nothing is heard."""
    units = np.flatnonzero(world.units.world == w)
    yield Region(entry, units, *shape(of.area, setting.network))


def shape(area: Area, network: Network) -> tuple[float, float, float, list[tuple[float, float]]]:
    """A circle, or corners."""
    if area.x is not None and area.y is not None and area.radius is not None:
        return area.x, area.y, area.radius, []
    return 0.0, 0.0, 0.0, corners(area, network)


def delay(of: Delay, entry: int, w: int, _setting: Setting, world: World) -> Found:
    """What one unit sends, or everybody, comes later."""
    yield held(entry, world.units, "trouble", (ADDED, units_named(of.unit, w, world)), of.delay)


def dropping(of: Drop, entry: int, w: int, _setting: Setting, world: World) -> Found:
    """The next messages of one unit."""
    yield Once(entry, partial(drop, unit=world.units.number(of.unit, w), count=float(of.count)))


def units_named(unit: str | None, w: int, world: World) -> np.ndarray:
    """One unit of a world, or all of them."""
    return np.flatnonzero(world.units.world == w) if unit is None else np.array([world.units.number(unit, w)])


def fault(of: SensorFault, entry: int, w: int, _setting: Setting, world: World) -> Found:
    """One sensor of a unit, or all of them."""
    unit = world.units.number(of.unit, w)
    for each in world.units.mounted:
        columns = np.flatnonzero((each.unit == unit) & np.array([of.sensor in (None, name) for name in each.names], dtype=bool))
        if columns.size:
            yield held(entry, each, "health", (FAILS, columns), float(of.fails))
            yield held(entry, each, "health", (NOISE, columns), of.noise)


def switch(of: Switch, entry: int, w: int, _setting: Setting, world: World) -> Found:
    """A group of applications on one unit, or on all of its own."""
    for hosted, columns in hosts_named(of.group, of.unit, w, world):
        yield held(entry, hosted, "stopped", columns, 1)


def tune(of: Tune, entry: int, w: int, setting: Setting, world: World) -> Found:
    """Other parameters for the same."""
    group = setting.scenario.applications[of.group]
    module = registry.find("application", group.application).module
    values = np.array(numbers(module.Parameters.model_validate(group.parameters | of.parameters)), dtype=float)
    for hosted, columns in hosts_named(of.group, of.unit, w, world):
        yield held(entry, hosted, "parameters", (slice(None), columns), values[:, None])


def hosts_named(group: str, unit: str | None, w: int, world: World) -> Iterator[tuple]:
    """Where a group is hosted, and in which columns."""
    wanted = None if unit is None else world.units.number(unit, w)
    for hosted in world.hosted:
        for each in hosted.groups:
            if (each.world, each.name) == (w, group):
                columns = np.arange(each.cars.start, each.cars.stop)
                yield hosted, columns if wanted is None else columns[hosted.unit[columns] == wanted]


def placing(of: Placement, entry: int, w: int, setting: Setting, world: World) -> Found:
    """A vehicle is put somewhere."""
    station = of.along - joined_at(of.vehicle, setting.scenario, setting.network, setting.lock_of(of.vehicle))
    yield Once(entry, partial(put, v=world.column(of.vehicle, w), station=station, speed=of.speed))


def removing(of: Removal, entry: int, w: int, _setting: Setting, world: World) -> Found:
    """A vehicle is taken away."""
    yield Once(entry, partial(take_away, v=world.column(of.vehicle, w)))


MADE: dict[type, Callable[..., Found]] = {
    WeatherChange: weather, Lights: lights, Jam: region, Delay: delay, Drop: dropping, SensorFault: fault, Switch: switch, Tune: tune,
    Placement: placing, Removal: removing,
}  # fmt: skip
