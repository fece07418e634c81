"""Reads OpenStreetMap: the file's content, the part of it that is kept, and the plan of that part."""

import itertools
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from studio.errors import MapError
from studio.road.assembly.plan import Plan, Wish
from studio.road.formats import osm
from studio.road.formats.correction import Corrections
from studio.road.formats.identity import named, shown
from studio.road.network import Connection, Net
from studio.road.network.report import Spot

ENDINGS = tuple(osm.FORMATS)
ATTRIBUTION = "© OpenStreetMap contributors"
DRAWN = "Drawn by Cooperative ADAS Studio"  # no data of others
GENERATED = f'generator="{osm.GENERATOR}"'.encode()
LICENCE = "Open Database License (ODbL) 1.0"
SHORTEST_RADIUS = 50.0  # [m]

read = osm.read


class Part(NamedTuple):
    """A wish that can be met."""

    radius: float | None
    box: osm.Box | None
    parking_aisles: bool
    corrections: Corrections


def attribution(path: Path) -> str:
    """Who made the map: its mappers, or the studio itself."""
    try:
        return DRAWN if GENERATED in osm.head(path) else ATTRIBUTION
    except OSError as error:
        raise MapError(f"{path}: the map file cannot be read ({error.strerror or error})") from None


def licence(path: Path) -> str:
    """What others may do with the map."""
    return "MIT" if attribution(path) == DRAWN else LICENCE


def part(path: Path, wish: Wish) -> Part:
    """The part that is asked for; raises MapError when it is none."""
    if wish.radius is not None and not wish.radius >= SHORTEST_RADIUS:
        raise MapError(f"{path}: radius must be at least {SHORTEST_RADIUS:g} m (got {wish.radius!r})")
    box = None if wish.bbox is None else osm.bounding_box(wish.bbox)
    if box is not None and wish.radius is not None:
        raise MapError(f"{path}: a radius and a bbox exclude each other; give one of them")
    return Part(wish.radius, box, wish.parking_aisles, wish.corrections)


def plan(path: Path, data: bytes, kept: Part, progress: Callable[[str], None]) -> Plan:
    """The plan of a part. What is needed only here is imported only here: a kept map opens at once."""
    from studio.road.assembly import audit, elevation, level, narrow, shared, storey, stub, turn
    from studio.road.assembly.alignment import aligned
    from studio.road.assembly.priority import mapped_law
    from studio.road.assembly.side import drive_side
    from studio.road.formats import vocabulary
    from studio.road.formats.country import country_at
    from studio.road.scenery import scenery
    from studio.road.scenery.site import Site

    found = osm.survey(path, data, parking_aisles=kept.parking_aisles, corrections=kept.corrections)
    box = clipped(path, found, kept.radius, kept.box)
    ids = itertools.count(10**15)  # above every OpenStreetMap id
    box, cut = cut_ways(path, found, box, kept.radius, ids)
    vocabulary.tell(cut, found.nodes, found.notes)
    country = country_at(*box.centre)
    side = drive_side(cut, country)
    left_hand = side.side == "left"
    ways = tagged(cut, found, country.name, left_hand)
    progress("building lanes and junctions")
    raw, forks, bans = lanes_of(path, found, ways, box, ids, left_hand)
    smooth = narrow.drivable(aligned(raw), lambda each: end_of(raw, each, ways, box), found.notes)
    stub.tell(smooth, lambda each: end_of(smooth, each, ways, box), found.notes)
    smooth = shared.brought_together(smooth, cut, found.notes)
    grid = elevation.grid_of(cut, box)
    land = elevation.mapped_heights(found, grid, cut, box)
    storeys = storey.storeys(land, cut, grid, found.notes)
    net = of_ways(level.with_levels(elevation.with_heights(smooth, cut, grid, land, storeys), cut, grid), ways)
    return Plan(
        net=net,
        signalled=signalled(found, ways, box, net),
        scenery=scenery(found, Site(box, ways, net, left_hand)),
        origin=box.centre,
        bounds=box.bounds(),
        attribution=DRAWN if found.drawn_here else ATTRIBUTION,
        licence="MIT" if found.drawn_here else LICENCE,
        law=mapped_law(net, ways, found.nodes, box, country=country.name, left_hand=left_hand),
        report=lambda network: audit.report(network, found, ways, box, raw, turns=turn.count(net, forks), side=side, country=country.name),
        bans=bans,
    )


def end_of(net: Net, connection: Connection, ways: list, box) -> Spot:
    """Where a connection begins, with the mapped way that leads there."""
    lane = net.lanes[connection.from_lane]
    mapped = {way.id: way.mapped for way in ways}
    origins = [mapped[way] for way in net.origins.get(lane.road, ()) if way in mapped]
    element = named("way", origins[-1]) if origins else ""
    longitude, latitude = box.degrees(lane.centre[:, -1:])[0]
    return Spot(element or f"road {lane.road}", latitude, longitude, element)


def clipped(path: Path, found, radius: float | None, bbox: osm.Box | None):
    """The part of the map that is kept; raises MapError that names the file."""
    try:
        return osm.clip_box(found, radius=radius, bbox=bbox)
    except MapError as error:
        raise MapError(f"{path}: {error.message}") from None


def cut_ways(path: Path, found, box, radius: float | None, ids) -> tuple:
    """The part that is kept, and the ways within it; raises MapError when there is none.

    Where no road is within a radius of the middle of what is mapped, the middle of the roads is taken.
    """
    ways = [piece for way in found.ways for piece in osm.cut(way, box, ids)]
    if not ways and radius is not None:
        box = osm.around_roads(found, radius)
        ways = [piece for way in found.ways for piece in osm.cut(way, box, ids)]
        what = f"the {radius:g} m around {box.centre[0]:.5f}°, {box.centre[1]:.5f}°"
        source = "no road lies that near to the middle of what is mapped"
        found.notes.guess("part", what, Spot("the middle of the roads", *box.centre), source=source, sure="medium")
    if not ways:
        raise MapError(f"{path}: there are no roads for cars within the part that is kept; try a larger radius or another bbox")
    return box, ways


def tagged(ways: list, found, country: str, left_hand: bool) -> list:
    """The ways with limits, lane counts and widths that netconvert reads; what was guessed is noted in `found`."""
    from studio.road.assembly import cross_section
    from studio.road.formats import limit

    limited = [limit.limited(way, country, found.notes) for way in ways]
    return [cross_section.mended(way, found.notes, left_hand=left_hand) for way in limited]


def lanes_of(path: Path, found, ways: list, box, ids, left_hand: bool):
    """Lanes and junctions, their arrows mended; the forks that have arrows; what must not be driven one after another."""
    from studio.road.assembly import bend, restriction, turn
    from studio.road.formats import netconvert

    clean = osm.clean_xml(found, bend.rounded(ways, box, ids))
    net = netconvert.convert(clean, box.projection, source=path, left_hand=left_hand)
    net, bans = restriction.restricted(net, found.restrictions, ways, box, found.notes)
    forks = turn.forks(net, ways, box, found.notes, left_hand=left_hand)
    return turn.mended(net, forks, left_hand=left_hand), forks, bans


def signalled(found, ways: list, box, net) -> frozenset[int]:
    """The lanes that end at a mapped signal, those at the map's edge too."""
    from studio.road.network.signals import dead_ends

    mapped = list(osm.mapped_signals(found, ways, box).values())
    return net.signalled | dead_ends(net.lanes, net.roads, net.connections, mapped)


def of_ways(net: Net, ways: list) -> Net:
    """The network whose roads know the mapped ways that they are made of."""
    mapped = {way.id: way.mapped for way in ways}
    names = {road: dict.fromkeys(shown(mapped[way]) for way in net.origins.get(road, ()) if way in mapped) for road in net.roads}
    return replace(net, roads={name: replace(road, ways=tuple(names[name])) for name, road in net.roads.items()})
