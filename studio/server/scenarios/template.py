"""Templates: scenarios to begin with, each laid on a way through whichever map is there.

A template is a function that gets the scenario of one car on a trip, and adds to it; its docstring is what the page says of it.
"""

import inspect
from collections.abc import Callable
from typing import Any, NamedTuple

from studio.errors import MapError, Problem, UnknownError, nearest, short
from studio.road import load
from studio.road.library.place import attribution, licence
from studio.road.ways.trip import Trip, trip
from studio.server.maps import Maps, a_drive, as_file
from studio.world.setting import USUAL_RADIUS

Document = dict[str, Any]
COLOURS = ("#d55e00", "#0072b2", "#3a3a3a", "#009e73", "#cc79a7")
FOLLOWERS = 4
LENGTH, STANDSTILL = 4.7, 2.5  # [m] a car, and how it stands behind another
COOPERATIVE, ALONE = 0.6, 1.2  # [s] headways of CACC and ACC: they start as they want to drive, and no measure is one of settling down
CITY = {"reasons": ["red_light", "right_of_way"]}  # what applications do not see, and drivers do
AHEAD = 60.0  # [m] that the first car has before it at least


class Template(NamedTuple):
    """A scenario to begin with."""

    name: str
    title: str
    description: str
    laid: Callable[[Document, Trip], Document]


def one_car(document: Document, found: Trip) -> Document:
    """One car, no application. The emptiest scenario that can be run: add what you need."""
    return document


def following(document: Document, found: Trip) -> Document:
    """A car follows another with adaptive cruise control. After 15 s the one ahead brakes hard, then drives on."""
    named = cars(document, found, ["lead", "ego"])
    brake = {"when": {"kind": "time", "at": 15.0}, "do": braking("lead")}
    return named | {"applications": {"acc": {"application": "acc", "units": ["ego"]}}, "script": {"hard_brake": brake}} | GOALS


def platoon(document: Document, found: Trip) -> Document:
    """Four cars follow a fifth with cooperative adaptive cruise control. After 20 s the first one brakes hard, then drives on."""
    followers = [f"follower_{i + 1}" for i in range(FOLLOWERS)]
    named = cars(document, found, ["leader", *followers], COOPERATIVE)
    group = {"application": "cacc", "units": followers, "listens_to": ["leader", *followers[:-1]], "parameters": {"headway": COOPERATIVE}}
    brake = {"when": {"kind": "time", "at": 20.0}, "do": braking("leader")}
    return named | {"applications": {"platoon": group}, "script": {"hard_brake": brake}} | GOALS


def in_traffic(document: Document, found: Trip) -> Document:
    """A car with adaptive cruise control among twenty others, which follow their lanes and stop at red."""
    named = cars(document, found, ["ego"])
    return (
        named
        | {"applications": {"acc": {"application": "acc", "units": ["ego"]}}, "traffic": {"count": 20}}
        | {"goals": {"collisions": {"most": 0}}}
    )


def stepping_out(document: Document, found: Trip) -> Document:
    """Somebody runs into the road from behind a parked van when a car comes near; its driver brakes in time, or not."""
    speed = found.speed
    corner = round(found.start + 40.0 + 2.0 * speed, 1)
    check_room(found, corner - found.start)
    named = cars(document, found, ["ego"])
    named["vehicles"]["ego"]["sensors"] = {"front": {"kind": "front_radar"}, "around": {"kind": "object_sensor"}}
    van = {"do": mover("box", [[corner, -3.6]]) | {"length": 5.0, "width": 1.9}}
    child = {
        "when": {"kind": "distance", "vehicle": "ego", "other": "van", "distance": round(15.0 + speed, 1)},
        "do": mover("pedestrian", [[corner + 4.0, -3.4], [corner + 4.0, 7.0]]) | {"speed": 2.2, "stays": False},
    }
    return named | {"script": {"van": van, "child": child}} | GOALS


GOALS = {"goals": {"min_ttc": {"least": 1.2}, "collisions": {"most": 0}}}
TITLES = {
    one_car: "One car",
    following: "Two cars, ACC",
    platoon: "Platoon, CACC",
    in_traffic: "A car in traffic",
    stepping_out: "Somebody steps out",
}


def templates() -> list[Template]:
    """All templates, the emptiest first."""
    return [Template(laid.__name__, title, inspect.getdoc(laid) or "", laid) for laid, title in TITLES.items()]


def find(name: str) -> Template:
    """A template; raises UnknownError."""
    known = {each.name: each for each in templates()}
    if name not in known:
        problem = Problem("template", "does not exist", short(name), remedy=nearest(name, known))
        raise UnknownError(f"There is no template {short(name)}.", [problem])
    return known[name]


def text(template: str, maps: Maps, place: str, title: str) -> str:
    """The file of a template on a map, under a title if one is given. Raises UnknownError or MapError."""
    found, path = find(template), maps.find(place)
    way = trip(load(path) if path.is_dir() else load(path, radius=USUAL_RADIUS))
    document = found.laid(a_drive(place, way), way)
    said = f"{found.description} The way of {way.length:.0f} m through the map {place} was drawn by lot."
    titled = {"title": title or f"{found.title} in {place}"[:120], "description": said}
    return as_file(document | titled, attribution(path), licence(path))


# -- parts -------------------------------------------------------------------------------------------


def cars(document: Document, found: Trip, names: list[str], headway: float = ALONE) -> Document:
    """The scenario with these cars one behind the other with a headway [s], the first ahead."""
    gap = LENGTH + STANDSTILL + headway * found.speed
    check_room(found, gap * (len(names) - 1))
    placed = {
        name: {
            "route": "trip",
            "position": {"along": round(found.start + gap * (len(names) - 1 - i), 1)},
            "speed": round(found.speed, 2),
            "colour": COLOURS[i],
        }
        | ({"intervention": CITY} if i or len(names) == 1 else {})
        for i, name in enumerate(names)
    }
    return document | {"vehicles": placed}


def check_room(found: Trip, needed: float) -> None:
    """Raises MapError where a way is too short."""
    if found.length < needed + AHEAD:
        allowed = f"at least {needed + AHEAD:.0f} m"
        problem = Problem(
            "map", "has no way that is long enough", f"{found.length:.0f} m", allowed, "take another map, or another template"
        )
        raise MapError("This template does not fit on this map.", [problem])


def braking(vehicle: str) -> dict[str, Any]:
    """A hard brake."""
    return {"kind": "brake", "vehicle": vehicle, "deceleration": 6.0, "duration": 5.0, "to_speed": 3.0}


def mover(who: str, line: list[list[float]]) -> dict[str, Any]:
    """Something at stations along the trip and metres to the left of its middle."""
    return {"kind": "mover", "who": who, "route": "trip", "line": line}
