"""From settings to a world: the only place where names become indices.

build([settings])   →  World         arrays, one column per vehicle, world after world
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from studio.application.port import ACTUATORS
from studio.conventions import GRAVITY
from studio.kind.driver import Driver
from studio.model.driver import GAP_SHARES, reaction, sight_speed, temper
from studio.model.random import DRIVER_REACTION, normal
from studio.road.network import shadow
from studio.scenario.schema import REASONS, Intervention, Weather
from studio.vehicle.command import U_DRIVE
from studio.vehicle.fleet import Start, fleet, level_ground
from studio.vehicle.parameter import LOSS_SHARE, LOSS_TORQUE
from studio.vehicle.state import ACTIVE, CLUTCH, RATIO, T_ENGINE, TORQUE_DRIVE
from studio.world.beside import beside_of
from studio.world.board.crew import hosts
from studio.world.board.equipment import units_of
from studio.world.car import Car, pose
from studio.world.chart import chart_of
from studio.world.deed import deeds_of
from studio.world.effect import Slippery
from studio.world.facing import facing_of
from studio.world.line import Lines, detours_of, lines_of, starts, stops_of, table_of
from studio.world.mail import mail_of
from studio.world.obstacle import movers, obstacles_of
from studio.world.passes import ground
from studio.world.passes.control import wheel_torque
from studio.world.passes.entry import NOT_YET
from studio.world.passes.neighbour import neighbours
from studio.world.passes.percept import PLACES
from studio.world.passes.queue import queues
from studio.world.probe import reader_of
from studio.world.script import script_of
from studio.world.seat import seats
from studio.world.setting import Setting
from studio.world.snapshot import gather, origin_of
from studio.world.table.mind import (
    CHANGING,
    DRIVER,
    EXPECTED,
    GAP,
    MIND,
    MISJUDGED,
    NEEDED_COLLISION,
    NEEDED_RED,
    NEEDED_WAY,
    SEEN_FIRST_GAP,
    SEEN_GAP,
    SEEN_STOP,
    SIGHT,
    SPREAD,
    STATION,
    SURPRISED,
    WAY_STATION,
)  # fmt: skip
from studio.world.table.street import COLLISION, LINE_COUNT, LINE_DRIVE, LINE_DRIVES, LINE_FIRST, LINE_STOP, LINE_STOPS, PIECE
from studio.world.table.web import Web
from studio.world.web import web_of
from studio.world.world import Clock, Demand, Detours, Events, Lanes, Roads, Vehicles, World, Worlds

FIRST_HITS = 64  # collisions of a world that there is room for at first


def build(settings: Sequence[Setting]) -> World:
    """The world of a batch of settings. All share one clock."""
    clock = settings[0].scenario.clock
    cars = [replace(car, driver=car.driver.tempered()) for each in settings for car in each.cars]
    worlds = worlds_of(settings)
    vehicles = vehicles_of(cars, [each.scenario.weather for each in settings for _ in each.cars])
    draw_reactions(vehicles.drivers, worlds)
    lines = lines_of(settings)
    stops = stops_of(lines, starts(np.array([len(each.network.signals) for each in settings])))
    obstacles = obstacles_of(settings, lines)
    web, drives = web_of(settings, lines)
    table = table_of(lines, stops[0], obstacles.counts, drives)
    roads = roads_of(settings, lines, table, stops, web)
    units = units_of(settings, worlds, cars, obstacles.standing.size, clock.tick)
    detours = detours_of(settings, worlds, lines, table)
    hosted, open_inboxes = hosts(settings, units, clock.tick)
    world = World(
        clock=Clock(clock.tick, clock.step),
        vehicles=vehicles,
        worlds=worlds,
        roads=roads,
        units=units,
        events=events_of(settings),
        script=script_of(settings, worlds, lines, movers(settings, obstacles.first)),
        detours=detours,
        lanes=lanes_of(settings, lines, detours),
        demand=demand_of(settings, worlds),
        obstacles=obstacles,
        neighbours=neighbours(vehicles.parameter),
        queues=queues(vehicles.size),
        seats=seats([car.driver for car in cars]),
        hosted=hosted,
        open_inboxes=open_inboxes,
        names=tuple(each.names for each in settings),
        colours=tuple(car.colour for car in cars),
    )
    world.script.deeds = deeds_of(settings, world)
    world.script.mail = mail_of(world.units.posts)
    settle(world)
    world.origin = origin_of(settings, world)
    gather(world)
    world.script.reader = reader_of(world)
    return world


def worlds_of(settings: Sequence[Setting]) -> Worlds:
    """Which columns are whose."""
    counts = np.array([len(each.cars) for each in settings])
    return Worlds(
        of=np.repeat(np.arange(len(settings)), counts),
        number=np.concatenate([np.arange(count) for count in counts]),
        entity=np.concatenate([entities(each) for each in settings]),
        first=np.concatenate([[0], np.cumsum(counts)[:-1]]),
        count=counts,
        seed=seeds_of(settings, "sensors"),
        driver_seed=seeds_of(settings, "traffic"),
        satellite_seed=seeds_of(settings, "satellites"),
        radio_seed=seeds_of(settings, "radio"),
    )


def seeds_of(settings: Sequence[Setting], stream: Literal["traffic", "sensors", "satellites", "radio"]) -> np.ndarray:
    """The seed of a stream in each world."""
    return np.array([each.scenario.seed_of(stream) for each in settings], dtype=np.uint64)


def entities(each: Setting) -> np.ndarray:
    """Numbers by which chance tells the vehicles of a world apart.

    They hang on the names, so that the order of a file changes nothing; traffic comes last, so that more of it changes
    nothing for the others.
    """
    named = len(each.scenario.vehicles)
    number = {name: i for i, name in enumerate([*sorted(each.names[:named]), *each.names[named:]])}
    return np.array([number[name] for name in each.names])


def vehicles_of(cars: Sequence[Car], weathers: Sequence[Weather]) -> Vehicles:
    """State, parameters and minds at the start: on the path, rolling without slip; every car with its weather."""
    n = len(cars)
    starts = [Start(car.model, *pose(car.path, car.station), car.speed, car.is_light) for car in cars]
    mind = np.zeros((len(MIND), n))
    mind[STATION] = [car.station for car in cars]
    mind[GAP] = np.nan  # nobody has looked yet
    mind[[NEEDED_COLLISION, NEEDED_RED, NEEDED_WAY, WAY_STATION, SEEN_GAP, SEEN_FIRST_GAP, SEEN_STOP]] = np.inf
    mind[[MISJUDGED, CHANGING]] = 1.0
    made = fleet(starts, ground=ground_of(cars))
    made.state[ACTIVE, [car.is_outside for car in cars]] = 0.0
    return Vehicles(
        **vars(made),
        drivers=np.array([driver_rows(car, weather) for car, weather in zip(cars, weathers, strict=True)]).T.copy(),
        mind=mind,
        intents=np.zeros((PLACES, n)),
        returns=np.array([int(car.returns) for car in cars]),
        any_returns=any(car.returns or car.is_outside for car in cars),
        removed=np.zeros(n, dtype=np.int64),
        app_command=np.full((2 * len(ACTUATORS), n), np.nan),
    )


def demand_of(settings: Sequence[Setting], worlds: Worlds) -> Demand:
    """The sources of all worlds; nobody has come in yet."""
    sources = [(w, i, each) for w, setting in enumerate(settings) for i, each in enumerate(setting.sources)]
    cars = [[v for v, car in enumerate(settings[w].cars) if car.source == i] for w, i, _ in sources]
    due = [each.due for *_, each in sources]
    return Demand(
        column=np.array([worlds.first[w] + min(found, default=0) for (w, *_), found in zip(sources, cars, strict=True)], dtype=np.int64),
        cars=np.array([len(found) for found in cars], dtype=np.int64),
        first=np.concatenate([[0], np.cumsum([each.size for each in due])]).astype(np.int64),
        due=np.concatenate([np.zeros(0), *due]),
        gone=np.zeros(len(sources), dtype=np.int64),
        world=np.array([w for w, *_ in sources], dtype=np.int64),
        came=np.full(worlds.of.size, NOT_YET),
    )


def ground_of(cars: Sequence[Car]) -> np.ndarray:
    """The ground under the cars at their start: level where their paths are."""
    under = level_ground(len(cars))
    for v, car in enumerate(cars):
        if ground.is_raised(car.path):
            ground.touch_all(v, len(cars), float(car.station), car.path.points, 0, car.path.points.shape[1], under)
    return under


def at_start(setting: Setting) -> Vehicles:
    """The vehicles of a setting before it is built."""
    return vehicles_of(setting.cars, [setting.scenario.weather] * len(setting.cars))


def driver_rows(car: Car, weather: Weather) -> list[float]:
    """What a driver is like, how far one sees, how fast this lets him go, for what he overrules an application, and which gaps he takes."""
    own = [getattr(car.driver, row.name) for row in DRIVER[:SIGHT]]
    gap_share = temper(car.driver.aggressiveness, *GAP_SHARES)
    return [*own, weather.visibility, speed_within_sight(car.driver, weather), *minded(car.intervention), gap_share]


def draw_reactions(drivers: np.ndarray, worlds: Worlds) -> None:
    """Makes of medians the reaction times of single drivers: who is slow is so for what he expects and for what surprises him."""
    for v, (world, who) in enumerate(zip(worlds.of, worlds.entity, strict=True)):
        z = normal(worlds.driver_seed[world], who, DRIVER_REACTION, 0)
        drivers[[EXPECTED, SURPRISED], v] = [reaction(drivers[row, v], drivers[SPREAD, v], z) for row in (EXPECTED, SURPRISED)]


def speed_within_sight(driver: Driver, weather: Weather) -> float:
    """Speed [m/s] from which a driver stops within sight: braking in comfort, or as hard as the road lets."""
    return sight_speed(weather.visibility, min(driver.deceleration, weather.friction * GRAVITY))


def minded(intervention: Intervention) -> list[float]:
    """Whether a driver overrules an application for each of the reasons, and his reaction time [s]."""
    return [*(float(reason in intervention.reasons) for reason in REASONS), intervention.reaction_time]


def roads_of(settings: Sequence[Setting], lines: Lines, table: np.ndarray, stops, web: Web) -> Roads:
    """Points, the line that every vehicle is on, stop lines, strands, signals and surface.

    What is known of a point lies side by side in memory: it is asked for together.
    """
    _, stop_station, stop_link = stops
    raised = [ground.is_raised(car.path) for each in settings for car in each.cars]
    return Roads(
        points=np.asfortranarray(lines.points),
        chart=np.asfortranarray(chart_of(lines, settings)),
        path_first=table[LINE_FIRST, lines.base],
        path_count=table[LINE_COUNT, lines.base],
        raised=np.array(raised, dtype=np.int64),
        any_raised=any(raised),
        stop_first=table[LINE_STOP, lines.base],
        stop_count=table[LINE_STOPS, lines.base],
        stop_station=stop_station,
        stop_link=stop_link,
        web=web,
        drive_first=table[LINE_DRIVE, lines.base],
        drive_count=table[LINE_DRIVES, lines.base],
        **signals_of(settings),
        **surface_of(settings),
        **buildings_of(settings),
    )


def lanes_of(settings: Sequence[Setting], lines: Lines, detours: Detours) -> Lanes:
    """Everybody on his usual lanes."""
    beside, facing, n = beside_of(settings, lines, detours), facing_of(settings), len(lines.home)
    return Lanes(
        block=np.array([each.start for each in lines.home], dtype=np.int64),
        asked=np.full(n, -1),
        left_first=np.zeros(n, dtype=np.int64),
        left_count=np.zeros(n, dtype=np.int64),
        beside=beside,
        any_beside=bool((beside.home >= 0).any()),
        facing=facing,
        any_facing=bool((facing.lane >= 0).any()),
    )


def surface_of(settings: Sequence[Setting]) -> dict[str, Any]:
    """Weather per world, and the pieces of all slippery stretches."""
    placed = [(w, site) for w, each in enumerate(settings) for site in each.sites]
    found = [
        ground.pieces(each.effect, each.line, w, number)
        for number, (w, site) in enumerate(placed)
        for each in site.laid
        if isinstance(each.effect, Slippery)
    ]
    return {
        "weather": np.array([each.scenario.weather.friction for each in settings]),
        "pieces": np.concatenate([np.zeros((len(PIECE), 0)), *found], axis=1),
        "near": np.zeros(ground.MOST_NEAR, dtype=np.int64),
    }


def buildings_of(settings: Sequence[Setting]) -> dict[str, Any]:
    """The map of every world, and the buildings of all maps; worlds on the same map share them."""
    shadows = {id(each.network): shadow.shadow_of(each.network) for each in settings}
    number = {name: i for i, name in enumerate(shadows)}
    found = list(shadows.values())
    return {
        "place_of": np.array([number[id(each.network)] for each in settings]),
        "shadow": found[0] if len(found) == 1 else shadow.joined(found),
    }


def signals_of(settings: Sequence[Setting]) -> dict[str, Any]:
    """Signal programmes of all worlds, link after link."""
    all_signals = [each.network.signals for each in settings]
    phases = np.concatenate([[0], np.cumsum([signals.phase_end.size for signals in all_signals])[:-1]])
    shifted = [signals.first + base for signals, base in zip(all_signals, phases, strict=True)]

    def joined(name: str) -> np.ndarray:
        return np.concatenate([getattr(signals, name) for signals in all_signals])

    started = [np.full(len(signals), each.scenario.map.signal_start) for each, signals in zip(settings, all_signals, strict=True)]
    return {
        "signal_time": np.array([joined("cycle"), joined("offset") - np.concatenate(started)]),
        "signal_first": np.concatenate(shifted).astype(np.int64),
        "signal_count": joined("count"),
        "phase_end": joined("phase_end"),
        "phase_state": joined("phase_state"),
        "shown": np.zeros(joined("cycle").size, dtype=np.int64),
        "forced": np.full(joined("cycle").size, -1),
        "light_first": starts(np.array([len(signals) for signals in all_signals])),
    }


def events_of(settings: Sequence[Setting]) -> Events:
    """No collisions yet."""
    return Events(hits=np.zeros((len(COLLISION), FIRST_HITS * len(settings))), found=np.zeros(len(settings), dtype=np.int64))


def settle(world: World) -> None:
    """Past commands and actuators as if every car had kept its speed for long."""
    vehicles, n = world.vehicles, world.size
    for v in range(n):
        T = wheel_torque(v, 0.0, vehicles.state, vehicles.ground, vehicles.parameter)
        if vehicles.state[CLUTCH, v] >= 1.0:
            before_losses = T / vehicles.state[RATIO, v] + vehicles.parameter[LOSS_TORQUE, v]
            vehicles.state[T_ENGINE, v] = before_losses / (1.0 - vehicles.parameter[LOSS_SHARE, v])
        vehicles.state[TORQUE_DRIVE, v] = T
        vehicles.commands[U_DRIVE, v::n] = T
