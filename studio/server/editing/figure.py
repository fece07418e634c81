"""Where everything of a scenario lies on its map: what an editor lists, draws, and takes hold of.

items(setting)   →  Item, one for everything that can be chosen, group by group

Lengths in metres of the map, angles in radians, as everywhere.
"""

from collections.abc import Collection, Iterator
from functools import cache
from typing import Any

import numpy as np

from studio.kind.area import Area
from studio.kind.settings import inner
from studio.kind.stretch import Stretch
from studio.road.network import Network
from studio.road.network.curve import LOCK
from studio.road.ways import path as road_path
from studio.road.ways.detour import lane_line
from studio.road.ways.path import PATH_SPACING, PATH_X, PATH_Y, Path
from studio.road.ways.relief import height_at, relief_of
from studio.road.ways.route import connect
from studio.scenario import figures
from studio.scene.obstacle import SHAPES
from studio.server.editing.answer import Figure, Handle, Item
from studio.world.car import Car, footprint, pose
from studio.world.effect import Jam, Row, Slippery, Walk, beside
from studio.world.setting import Setting
from studio.world.site import Laid, Site
from studio.world.thing import headings

EVERY = 2.0  # [m] between points of a line that is drawn
ROUND = 32  # corners of a circle


def items(setting: Setting) -> list[Item]:
    """Everything that can be chosen, in the order of the file within each group."""
    named = [car for car in setting.cars if car.name in setting.scenario.vehicles]
    found = [vehicle(car, setting) for car in named]
    found += [each for site in setting.sites for each in entry(site, setting)]
    found += [station(name, setting) for name in setting.scenario.stations]
    return found + [route(name, setting) for name in setting.scenario.routes]


# -- vehicles, stations, routes ------------------------------------------------------------------------


def vehicle(car: Car, setting: Setting) -> Item:
    """A named car at its start; `line` is what it drives, from the start of its first road on."""
    path, outline = f"vehicles.{car.name}", footprint(car.name, car.model, car.path, car.station)
    x, y, heading = map(float, pose(car.path, car.station))
    body = Figure(
        path=path, shape="body", x=outline.x, y=outline.y, heading=heading, length=outline.length, width=outline.width,
        line=from_station(car.path, 0.0), colour=car.colour, anchor=(x, y), height=car.model.values.body.height,
        lift=lift(setting.network, x, y, float(height_at(car.path, np.array([car.station]))[0])),
    )  # fmt: skip
    road, lane, offset = on_lane(car.path, car.station, setting.network)
    given = setting.scenario.vehicles[car.name]
    return Item(
        path=path, group="vehicle", name=car.name, told=f"{car.model.name}, {car.speed:g} m/s", figures=[body],
        route=given.route, road=road, lane=lane, offset=offset, along=given.position.along, station=car.station,
    )  # fmt: skip


def lift(network: Network, x: float, y: float, height: float = 0.0) -> float:
    """How high above the land a place is drawn, on a road of this height [m]."""
    relief = relief_of(network)
    return 0.0 if relief is None else round(float(relief.at(*np.array([[x], [y], [height]]))[0][0]), 2)


def on_lane(path: Path, station: float, network: Network) -> tuple[str, int, float]:
    """Road, lane and station of the lane [m] at a station of a path."""
    here = [each for each in path.stations if each.s <= station] or [path.stations[0]]
    lane = network.lanes_of(here[-1].road)[here[-1].lane_index]
    offset = min(station - here[-1].s, lane.length)
    return here[-1].road, here[-1].lane_index, round(float(offset), 2)


def station(name: str, setting: Setting) -> Item:
    """A unit that stands at a place."""
    (x, y), path = setting.spots[name], f"stations.{name}"
    heading = setting.scenario.stations[name].heading
    figure = Figure(path=path, shape="point", x=x, y=y, heading=heading, anchor=(x, y), lift=lift(setting.network, x, y))
    return Item(path=path, group="station", name=name, told="road-side unit", figures=[figure])


def route(name: str, setting: Setting) -> Item:
    """A way; its handles are the roads that the file names, each at its middle."""
    roads, network = setting.scenario.routes[name].roads, setting.network
    users = [vehicle for vehicle, each in setting.scenario.vehicles.items() if each.route == name]
    lock = lock_of(setting, users)
    line = road_path.path(network, connect(network, roads, lock=lock), lock=lock)
    told = f"{line.length:.0f} m, {len(users)} {'vehicle' if len(users) == 1 else 'vehicles'}"
    figure = Figure(path=f"routes.{name}", shape="line", line=from_station(line, 0.0), handles=handles(roads, network))
    return Item(path=f"routes.{name}", group="route", name=name, told=told, figures=[figure])


def lock_of(setting: Setting, vehicles: Collection[str]) -> float:
    """The least lock [1/m] of some vehicles of a scenario; that of a car without any."""
    return min([LOCK, *(figures.lock(car.model.values) for car in setting.cars if car.name in vehicles)])


def handles(roads: list[str], network: Network) -> list[Handle]:
    """A point for every road that a route names, in the middle of it."""
    return [Handle(road=road, x=x, y=y) for road in roads for x, y in [middle(lane_line(network, network.lanes_of(road)[0]))]]


def middle(line: Path) -> tuple[float, float]:
    """The place half along a line."""
    x, y, _ = beside(line, 0.5 * line.length, 0.0)
    return round(x, 2), round(y, 2)


def from_station(path: Path, station: float) -> list[tuple[float, float]]:
    """The rest of a path from a station [m] on, with a point every two metres, and its end."""
    last = path.points.shape[1] - 1
    at = np.unique(np.append(np.arange(station, last, EVERY), last))
    grid = np.arange(last + 1) * PATH_SPACING
    return pairs(np.stack([np.interp(at, grid, path.points[row]) for row in (PATH_X, PATH_Y)]))


def pairs(line: np.ndarray) -> list[tuple[float, float]]:
    """A line as pairs of x and y, to the centimetre."""
    return [(x, y) for x, y in np.round(line.T, 2).tolist()]


# -- the script ----------------------------------------------------------------------------------------


def entry(site: Site, setting: Setting) -> Iterator[Item]:
    """An entry of the script, and each area that it waits for or that is jammed."""
    path, name = f"script.{site.name}", site.name
    figures = [*walks(site, path, setting.network), *stretches(site, path)]
    yield Item(path=path, group=group_of(site), name=name, told=site.text, figures=figures, vehicles=list(site.vehicles))
    for at, area in areas(site.entry, path):
        jammed = any(isinstance(each, Jam) for each in site.effects) and at.startswith(f"{path}.do")
        told = "radio is jammed here" if jammed else f"area of {name}"
        figure = Figure(path=at, shape="area", line=outline(area, setting.network), anchor=anchor(area))
        yield Item(path=at, group="radio" if jammed else "area", name=name, told=told, figures=[figure])


def group_of(site: Site) -> Any:
    """In which group of the list an entry stands: people and objects are what one sees, all else is an event."""
    for each in site.effects:
        if isinstance(each, Walk):
            return "person" if each.who in ("pedestrian", "cyclist") else "object"
        if isinstance(each, Row | Slippery):
            return "object" if isinstance(each, Row) else "friction"
    return "event"


def walks(site: Site, path: str, network: Network) -> Iterator[Figure]:
    """Whoever an entry brings, at the beginning of his line."""
    for each in site.effects:
        if isinstance(each, Walk):
            (x, y), *_ = each.line
            line = [(round(a, 2), round(b, 2)) for a, b in each.line] if each.speed > 0 else []
            yield Figure(
                path=path, shape="body", x=x, y=y, heading=headings(each.line)[0], length=each.size[0], width=each.size[1],
                line=line, looks=each.who, anchor=(x, y), height=tall(each.who), lift=lift(network, x, y),
            )  # fmt: skip


@cache
def tall(looks: str) -> float:
    """How high what looks so is in the scene [m]."""
    return round(float(SHAPES[looks]().vertices[:, 2].max()), 2)


def stretches(site: Site, path: str) -> Iterator[Figure]:
    """The stretches of road that an entry is about, as their outlines."""
    for each in site.laid:
        left, right = sides(each)
        stretch = each.effect.stretch
        stations = np.append(np.arange(stretch.start, stretch.end, EVERY), stretch.end)
        edge = [beside(each.line, float(s), left)[:2] for s in stations]
        edge += [beside(each.line, float(s), -right)[:2] for s in stations[::-1]]
        yield Figure(
            path=path, shape="patch", line=pairs(np.array(edge).T), anchor=beside(each.line, 0.5 * (stretch.start + stretch.end), 0.0)[:2]
        )


def sides(laid: Laid) -> tuple[float, float]:
    """How far [m] to the left and to the right of its line a stretch is drawn."""
    if isinstance(laid.effect, Slippery):
        return laid.effect.left, laid.effect.right
    if isinstance(laid.effect, Row):
        return laid.effect.offset + 0.4, 0.4 - laid.effect.offset
    return (1.75, 1.75) if isinstance(laid.effect.stretch, Stretch) else (1.6, 1.6)


def areas(part: Any, path: str) -> Iterator[tuple[str, Area]]:
    """The areas of an entry with their paths: of its conditions, however deep, and of what it does."""
    for field in ("when", "until", "do"):
        if (found := getattr(part, field)) is not None:
            yield from within(found, f"{path}.{field}")


def within(part: Any, path: str) -> Iterator[tuple[str, Area]]:
    """The areas of a condition or an action, and of the conditions in it."""
    yield from ((f"{path}.{name}", value) for name in type(part).model_fields if isinstance(value := getattr(part, name), Area))
    for name, each in inner(part):
        yield from within(each, f"{path}.{name}")


def outline(area: Area, network: Network) -> list[tuple[float, float]]:
    """The corners of an area [m]."""
    if area.corners:
        return [(x, y) for x, y in area.corners]
    if area.x is not None and area.y is not None and area.radius is not None:
        turn = np.linspace(0.0, 2.0 * np.pi, ROUND, endpoint=False)
        return pairs(np.stack([area.x + area.radius * np.cos(turn), area.y + area.radius * np.sin(turn)]))
    lane = network.lanes_of(str(area.road))[area.lane]
    line = lane_line(network, lane)
    stations = np.append(np.arange(area.start, area.end or line.length, EVERY), area.end or line.length)
    edge = [beside(line, float(s), 0.5 * lane.width)[:2] for s in stations]
    return pairs(np.array(edge + [beside(line, float(s), -0.5 * lane.width)[:2] for s in stations[::-1]]).T)


def anchor(area: Area) -> tuple[float, float] | None:
    """The middle of a circle; others have none."""
    return None if area.x is None or area.y is None else (area.x, area.y)
