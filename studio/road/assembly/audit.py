"""Looks at a finished network and counts what became of the map."""

from collections import defaultdict

import numpy as np
import shapely

from studio.road.assembly.priority import counts
from studio.road.formats import osm
from studio.road.formats.identity import named
from studio.road.formats.osm import Box, Survey
from studio.road.formats.way import Way, spot_of
from studio.road.network import Net, Network
from studio.road.network.outline import junction_form
from studio.road.network.report import (
    BuildingCount,
    CrossingCount,
    DriveSide,
    LimitCount,
    Notes,
    ParkingCount,
    Report,
    SignalCount,
    Spot,
    TurnCount,
    UprightCount,
)
from studio.road.scenery import USUAL_HEIGHT, has_height, is_told_by_parts, shape_form

INSIDE = 1.0  # [m] beyond a junction's edge a signal still stands inside
NEAR = 15.0  # [m] a stop line is that near to its mapped signal


def report(
    network: Network, found: Survey, ways: list[Way], box: Box, raw: Net, *, turns: TurnCount, side: DriveSide, country: str,
) -> Report:  # fmt: skip
    """The report of an import: counts, and the guesses and gaps noted on the way.

    Lane kilometres are counted in `raw`, from junction to junction as they are mapped, before turns have got their room.
    """
    notes = found.notes
    note_lanes(network, ways, raw.origins, notes)
    note_closed(network, ways, raw.origins, notes)
    signals = count_signals(network, found, ways, box, notes)
    buildings = count_buildings(network, found, box, notes)
    return Report(
        drive_side=side,
        country=country,
        lane_km=sum(lane.length for lane in raw.lanes if not lane.internal) / 1000.0,
        junctions=len(network.junctions),
        signals=signals,
        right_of_way=counts(network.connections),
        turn_lanes=turns,
        speed_limits=count_limits(raw, ways, notes),
        buildings=buildings,
        parking=count_parking(network, found, box),
        crossings=count_crossings(network),
        uprights=UprightCount(len(network.scenery.walls), len(network.scenery.posts), network.scenery.trees.shape[1]),
        guesses=tuple(notes.guesses),
        skipped=tuple(notes.skipped),
        corrected=tuple(notes.corrected),
    )


def note_lanes(network: Network, ways: list[Way], origins: dict[str, tuple[int, ...]], notes: Notes) -> None:
    """Notes the number of lanes where it is not mapped, and every width, which netconvert sets."""
    built = defaultdict(int)
    for road, names in origins.items():
        for way in names:
            built[way, road.startswith("-")] = max(built[way, road.startswith("-")], len(network.roads[road].lanes))
    for way in ways:
        if not any(key in way.tags for key in ("lanes", "lanes:forward", "turn:lanes", "turn:lanes:forward")):
            there, back = built[way.id, False], built[way.id, True]
            what = f"{there} lanes" if not back else f"{there} lanes one way, {back} the other"
            if there or back:
                notes.guess("lanes", what, spot_of(way), source=f"highway={way.tags['highway']}", sure="medium", key="lanes")


def note_closed(network: Network, ways: list[Way], origins: dict[str, tuple[int, ...]], notes: Notes) -> None:
    """Notes every road with lanes that cars keep out of."""
    by_id = {way.id: way for way in ways}
    for road, names in origins.items():
        lanes = network.lanes_of(road) if road in network.roads and not network.roads[road].internal else ()
        closed, mapped = sum(not lane.open for lane in lanes), [by_id[name] for name in names if name in by_id]
        if closed and mapped:
            notes.skip("closed lane", f"{closed} of {len(lanes)} lanes", spot_of(mapped[0]), "kept for buses or bicycles")


# -- signals ---------------------------------------------------------------------------------------


def count_signals(network: Network, found: Survey, ways: list[Way], box: Box, notes: Notes) -> SignalCount:
    """How many mapped signals have a stop line near; the others are noted with the reason."""
    mapped, links, placed = osm.mapped_signals(found, ways, box), network.signals, 0
    junctions = junction_form(network)
    for node, (x, y) in mapped.items():
        away = np.hypot(links.link_x - x, links.link_y - y).min(initial=np.inf)
        placed += away <= NEAR
        if away > NEAR:
            longitude, latitude = box.degrees(np.array([[x], [y]]))[0]
            inside = junctions.distance(shapely.Point(x, y)) < INSIDE
            reason = f"stands inside a junction; the nearest stop line is {away:.0f} m away" if inside else "no lane leads to it"
            notes.skip("signal", "traffic signal", Spot(named("node", node), latitude, longitude, named("node", node)), reason)
    return SignalCount(len(mapped), int(placed), len(set(links.programme.tolist())))


# -- limits, buildings, parking --------------------------------------------------------------------


def count_limits(raw: Net, ways: list[Way], notes: Notes) -> LimitCount:
    """Ways by whether their limit is mapped, and lane kilometres by limit."""
    guessed = sum(guess.kind == "speed limit" for guess in notes.guesses)
    length = defaultdict(float)
    for lane in raw.lanes:
        if not lane.internal:
            length[round(lane.speed * 3.6)] += lane.length / 1000.0
    return LimitCount(len(ways) - guessed, guessed, {str(limit): round(length[limit], 3) for limit in sorted(length)})


def count_buildings(network: Network, found: Survey, box: Box, notes: Notes) -> BuildingCount:
    """How many buildings stand, and how many heights are mapped; each guessed height is noted."""
    bounds = shapely.box(*box.bounds())
    shapes = [shape for shape in found.shapes if osm.area_kind(shape.tags) in ("building", "part")]
    forms = [shape_form(shape, box) for shape in shapes]
    parts = shapely.STRtree([form for shape, form in zip(shapes, forms, strict=True) if osm.area_kind(shape.tags) == "part"])
    mapped = guessed = 0
    for shape, form in zip(shapes, forms, strict=True):
        if form.is_empty or not bounds.contains(form.centroid):
            continue
        if has_height(shape.tags):
            mapped += 1
        elif osm.area_kind(shape.tags) == "part" or not is_told_by_parts(form, parts):
            guessed += 1
            longitude, latitude = shape.rings[0][0]
            spot = Spot(shape.tags.get("name", "") or "building", latitude, longitude, shape.element)
            notes.guess("height", f"{USUAL_HEIGHT:g} m", spot, source="no height or levels", sure="low", key="height")
    return BuildingCount(len(network.scenery.buildings), mapped, guessed)


def count_parking(network: Network, found: Survey, box: Box) -> ParkingCount:
    """Parking areas and spaces in the box."""
    inside = [kind for kind, (longitude, latitude) in found.parking if box.west < longitude < box.east and box.south < latitude < box.north]
    return ParkingCount(inside.count("parking"), inside.count("parking_space"), network.scenery.along_kerbs)


def count_crossings(network: Network) -> CrossingCount:
    """Crossings by what is painted and whether there are lights."""
    crossings = network.scenery.crossings
    marks = [crossing.marking for crossing in crossings]
    return CrossingCount(len(crossings), marks.count("zebra"), sum(crossing.signalled for crossing in crossings), marks.count("none"))
