"""From settings to a world: the only place where names become indices.

    build([settings])   →  World         arrays, one column per vehicle, world after world
"""

from collections.abc import Sequence

import numpy as np

from studio.application import registry
from studio.application.contract import ACTUATORS
from studio.application.host import Hosted, compiled_loop, first_memory, observation_rows, python_loop
from studio.road import conflict
from studio.scenario.schema import Friction
from studio.world import ground
from studio.world.change import Laid, changes_of
from studio.world.control import wheel_torque
from studio.world.fleet import Start, fleet
from studio.world.obstacle import obstacles_of
from studio.world.setting import Car, Setting, pose
from studio.world.state import *  # noqa: F403 - the names of the rows
from studio.world.world import Clock, Events, Roads, Units, Vehicles, World, Worlds

MOST_HITS = 64  # collisions that are reported per world


def build(settings: Sequence[Setting]) -> World:
    """The world of a batch of settings. All share one clock."""
    clock = settings[0].scenario.clock
    cars = [car for each in settings for car in each.cars]
    worlds = worlds_of(settings)
    vehicles = vehicles_of(cars)
    roads, paths = roads_of(settings, worlds)
    world = World(
        clock=Clock(clock.tick, clock.step),
        vehicles=vehicles,
        worlds=worlds,
        roads=roads,
        units=units_of(settings, worlds, cars),
        events=events_of(settings, worlds),
        changes=changes_of(settings, worlds, roads.points, paths),
        obstacles=obstacles_of(settings, [(w, car.path) for w, car in zip(worlds.of, cars, strict=True)]),
        hosted=hosts(settings, worlds),
        names=tuple(each.names for each in settings),
        colours=tuple(car.colour for car in cars),
    )
    settle(world)
    return world


def worlds_of(settings: Sequence[Setting]) -> Worlds:
    """Which columns are whose."""
    counts = np.array([len(each.cars) for each in settings])
    return Worlds(
        of=np.repeat(np.arange(len(settings)), counts),
        entity=np.concatenate([np.arange(count) for count in counts]),
        first=np.concatenate([[0], np.cumsum(counts)[:-1]]),
        count=counts,
        seed=np.array([each.scenario.seed for each in settings], dtype=np.uint64),
    )


def vehicles_of(cars: list[Car]) -> Vehicles:
    """State, parameters and minds at the start: on the path, rolling without slip."""
    n = len(cars)
    starts = [Start(car.model, *pose(car.path, car.station), car.speed) for car in cars]
    mind = np.zeros((len(MIND), n))
    mind[STATION] = [car.station for car in cars]
    return Vehicles(
        **vars(fleet(starts)),
        drivers=np.array([[getattr(car.driver, row.name) for row in DRIVER] for car in cars]).T.copy(),
        mind=mind,
        script=np.tile([[0.0], [-np.inf], [0.0]], n),
        returns=np.array([int(car.returns) for car in cars]),
        app_command=np.full((len(ACTUATORS), n), np.nan),
    )


def roads_of(settings: Sequence[Setting], worlds: Worlds) -> tuple[Roads, list[Laid]]:
    """Paths, stop lines, zones and signals; and which path has which points.

    Cars that share a path share its points, within a world whose roads change, else within the batch.
    """
    first_of, paths, start = {}, [], 0
    for w, each in enumerate(settings):
        for car in each.cars:
            key = (w if each.sites else -1, id(car.path))
            if key not in first_of:
                first_of[key] = start
                paths.append(Laid(w, car.path, start))
                start += car.path.points.shape[1]
    points = np.concatenate([laid.path.points for laid in paths], axis=1)
    cars = [car for each in settings for car in each.cars]
    keys = [(w if settings[w].sites else -1, id(car.path)) for w, car in zip(worlds.of, cars, strict=True)]
    path_first = np.array([first_of[key] for key in keys])
    path_count = np.array([car.path.points.shape[1] for car in cars])
    link_base = np.concatenate([[0], np.cumsum([len(each.network.signals) for each in settings])[:-1]])
    stops = [[(s, link + link_base[w]) for s, link in car.path.stop_lines] for w, car in zip(worlds.of, cars, strict=True)]
    counts = np.array([len(each) for each in stops])
    flat = np.array([stop for each in stops for stop in each]).reshape(-1, 2)
    pair, span = zones_of(settings, worlds, points, path_first, path_count)
    roads = Roads(
        points=points,
        path_first=path_first,
        path_count=path_count,
        stop_first=np.concatenate([[0], np.cumsum(counts)[:-1]]),
        stop_count=counts,
        stop_station=flat[:, 0].copy(),
        stop_link=flat[:, 1].astype(np.int64),
        zone_pair=pair,
        zone_span=span,
        **signals_of(settings),
        **surface_of(settings),
    )
    return roads, paths


def surface_of(settings: Sequence[Setting]) -> dict[str, np.ndarray]:
    """Weather per world, and the pieces of all slippery stretches."""
    placed = [(w, site) for w, each in enumerate(settings) for site in each.sites]
    found = [
        ground.pieces(site.change.do, site.line, w, number)
        for number, (w, site) in enumerate(placed)
        if isinstance(site.change.do, Friction)
    ]
    return {
        "weather": np.array([[getattr(each.scenario.weather, row.name) for row in WEATHER] for each in settings]).T.copy(),
        "pieces": np.concatenate([np.zeros((len(PIECE), 0)), *found], axis=1),
        "near": np.zeros(ground.MOST_NEAR, dtype=np.int64),
    }


def zones_of(settings: Sequence[Setting], worlds: Worlds, points, path_first, path_count):
    """Zones of every ordered pair of cars of one world; a pair of paths is looked at once."""
    known: dict[tuple[int, int], np.ndarray] = {}
    pairs, spans = [], []
    for first, count in zip(worlds.first, worlds.count, strict=True):
        for i in range(first, first + count):
            for j in range(first, first + count):
                if i == j:
                    continue
                key = (path_first[i], path_first[j])
                if key not in known:
                    known[key] = conflict.zones(points, path_first[i], path_count[i], path_first[j], path_count[j])
                pairs += [(i, j)] * len(known[key])
                spans.append(known[key])
    table = np.concatenate(spans) if spans else np.zeros((0, 4))
    return np.array(pairs, dtype=np.int64).reshape(-1, 2).T.copy(), table.T.copy()


def signals_of(settings: Sequence[Setting]) -> dict[str, np.ndarray]:
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
    }


def units_of(settings: Sequence[Setting], worlds: Worlds, cars: list[Car]) -> Units:
    """Sensors, radio, and a link for every car that listens to another."""
    n = len(cars)
    links = [link for w, each in enumerate(settings) for link in links_of(each, int(worlds.first[w]))]
    receiver, sender = np.array(links, dtype=np.int64).reshape(-1, 2).T.copy()
    sent = np.zeros((len(MESSAGE), RING * n))
    inbox = np.zeros((len(MESSAGE), len(links)))
    sent[SENT] = inbox[SENT] = -np.inf
    return Units(
        sensor_set=np.array([[getattr(car.sensor, row.name) for row in SENSOR_SET] for car in cars]).T.copy(),
        sensors=np.zeros((len(SENSOR), n)),
        radio_set=np.array([[getattr(each.scenario.radio, row.name) for row in RADIO_SET] for each in settings]).T.copy(),
        sent=sent,
        link_receiver=receiver,
        link_sender=sender,
        inbox=inbox,
    )


def links_of(each: Setting, first: int) -> list[tuple[int, int]]:
    """Receiver and sender columns, in the order of the groups."""
    return [
        (first + each.names.index(receiver), first + each.names.index(sender))
        for group in each.scenario.applications.values()
        for receiver, sender in zip(group.vehicles, group.listens_to, strict=False)
    ]


def events_of(settings: Sequence[Setting], worlds: Worlds) -> Events:
    """Triggers in the order of the file."""
    rows = [
        (trigger.time, first + each.names.index(trigger.vehicle), trigger.do.deceleration, trigger.do.duration, trigger.do.to_speed)
        for each, first in zip(settings, worlds.first, strict=True)
        for trigger in each.scenario.triggers.values()
    ]  # fmt: skip
    table = np.array(rows).reshape(-1, 5).T
    return Events(
        trigger_time=table[0].copy(),
        trigger_vehicle=table[1].astype(np.int64),
        trigger_script=table[2:].copy(),
        fired=np.zeros(table.shape[1], dtype=np.int64),
        hits=np.zeros((len(COLLISION), MOST_HITS * len(settings))),
        found=np.zeros(len(settings), dtype=np.int64),
    )


def hosts(settings: Sequence[Setting], worlds: Worlds) -> list[Hosted]:
    """Every application group of every world, with the links that its cars listen to."""
    found, link = [], 0
    for each, first in zip(settings, worlds.first, strict=True):
        for name, group in each.scenario.applications.items():
            heard = len(group.listens_to)
            columns = np.array([first + each.names.index(vehicle) for vehicle in group.vehicles], dtype=np.int64)
            links = np.arange(link, link + heard) if heard else np.full(columns.size, -1)
            found.append(hosted(name, group, columns, links))
            link += heard
    return found


def hosted(name: str, group, columns: np.ndarray, links: np.ndarray) -> Hosted:
    """One group on its host."""
    application = registry.find(group.application)
    values = [float(value) for value in application.parameters(group.parameters).values()]
    n = columns.size
    return Hosted(
        application=application,
        group=name,
        columns=columns,
        links=links,
        parameters=np.tile(np.array(values)[:, None], n),
        memory=np.tile(np.array(first_memory(application))[:, None], n),
        observed=np.zeros((len(observation_rows()), n)),
        run=compiled_loop(application) if application.compiled else python_loop(application),
    )


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
