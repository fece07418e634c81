"""What will happen when, as far as it is known before the run; and what can never happen, with the reason.

A time that the file says is exact. That a vehicle passes a place is reckoned with the speeds that its route allows, on a free road: it
comes later when it meets others or a red light. Of one whose pedals or wheel the script takes nobody knows. Everything else depends on
what happens. What a kind itself says of never (`never` of a condition) is asked first, so that of a kind of one's own counts too.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import shapely

from studio.kind import registry
from studio.kind.settings import references
from studio.road.ways.path import PATH_SPACING, PATH_SPEED, PATH_X, PATH_Y
from studio.scenario.schema import moment_of
from studio.server.editing.answer import Turn
from studio.server.editing.figure import outline
from studio.world.car import Car
from studio.world.effect import Place, Placement, Walk
from studio.world.setting import Setting
from studio.world.site import Site

ASIDE = 1.5  # [m] that a car may be beside the line of its route
SLOWEST = 2.0  # [m/s] below which nobody is expected to drive on


class Guess(NamedTuple):
    """When a condition holds for the first time [s], whether the file says so itself, and why never."""

    time: float | None = None
    is_exact: bool = False
    never: str = ""


NOBODY_KNOWS = Guess()


class Outlook:
    """The script of one setting, looked at before it is run."""

    def __init__(self, setting: Setting) -> None:
        self.setting = setting
        self.place = Place(setting.scenario, setting.network, setting.locks)
        self.cars = {car.name: car for car in setting.cars}
        self.sites = {site.name: site for site in setting.sites}
        self.known: dict[str, Guess] = {}

    def turns(self) -> list[Turn]:
        """One for each entry, in the order of the file."""
        return [self.turn(site) for site in self.setting.sites]

    def turn(self, site: Site) -> Turn:
        """When an entry begins and ends."""
        begins = self.begin(site.name)
        until = self.when(site.entry.until) if site.entry.until is not None else NOBODY_KNOWS
        ends = begins.time if site.is_momentary else soonest_of(until.time, lasts(begins.time, site.entry.do))
        why = words(site.entry.when)
        return Turn(
            entry=site.name, told=site.text, begins=begins.time, ends=ends, is_exact=begins.is_exact, why=why, never=begins.never
        )  # fmt: skip

    def begin(self, entry: str) -> Guess:
        """When an entry begins."""
        if entry not in self.known:
            self.known[entry] = NOBODY_KNOWS  # what waits for itself is refused elsewhere
            self.known[entry] = self.when(self.sites[entry].entry.when)
        return self.known[entry]

    def when(self, condition: Any) -> Guess:
        """When a condition holds for the first time."""
        if (moment := moment_of(condition)) is not None:
            return self.within_run(Guess(moment, is_exact=True), "")
        if never := self.place.never(condition):
            return Guess(never=never)
        look: Callable[[Any], Guess] | None = getattr(self, f"when_{condition.kind}", None)
        return look(condition) if look else NOBODY_KNOWS

    def within_run(self, guess: Guess, what: str) -> Guess:
        """A guess, or never when the run is over before."""
        if guess.time is None or guess.time < self.place.duration:
            return guess
        return Guess(never=f"{what or 'its time'} comes at {guess.time:.0f} s, and the run ends at {self.place.duration:g} s")

    # -- conditions of which more is known -----------------------------------------------------------

    def when_passed(self, condition: Any) -> Guess:
        """A vehicle comes by a station of its route."""
        station = self.station_of(condition)
        soonest = self.soonest(condition.vehicle, station)
        return self.within_run(Guess(soonest), f"{condition.vehicle} at the earliest")

    def when_in_area(self, condition: Any) -> Guess:
        """The first station of a route that lies in an area, or a line of somebody who moves."""
        corners = shapely.Polygon(outline(condition.area, self.setting.network)).buffer(ASIDE)
        if condition.vehicle not in self.cars:
            return NOBODY_KNOWS if self.walk(condition.vehicle).intersects(corners) else Guess(never=never_in(condition.vehicle))
        car = self.cars[condition.vehicle]
        inside = shapely.contains_xy(corners, car.path.points[PATH_X], car.path.points[PATH_Y])
        first = 0.0 if self.is_placed(car.name) else car.station
        stations = np.flatnonzero(inside) * PATH_SPACING
        ahead = stations[stations >= first - PATH_SPACING]
        if not ahead.size:
            if self.is_led(car.name):
                return NOBODY_KNOWS
            return Guess(never=passed_already(car.name) if stations.size else never_in(car.name))
        return self.within_run(Guess(self.soonest(car.name, float(ahead[0]))), f"{car.name} at the earliest")

    def when_after(self, condition: Any) -> Guess:
        """Some time after another entry."""
        other = self.begin(condition.entry)
        if other.never:
            return Guess(never=f"{condition.entry} never begins: {other.never}")
        if condition.turn != "begins" or other.time is None:
            return NOBODY_KNOWS
        return self.within_run(Guess(other.time + condition.delay, other.is_exact), f"{condition.delay:g} s after {condition.entry}")

    def when_all_of(self, condition: Any) -> Guess:
        """Not before the last of them, never when one is never."""
        found = [self.when(each) for each in condition.of]
        if never := next((each.never for each in found if each.never), ""):
            return Guess(never=never)
        times = [each.time for each in found if each.time is not None]
        return Guess(max(times)) if len(times) == len(found) else NOBODY_KNOWS

    def when_any_of(self, condition: Any) -> Guess:
        """The first of them, never when all are never."""
        found = [self.when(each) for each in condition.of]
        if all(each.never for each in found):
            return Guess(never="; ".join(each.never for each in found))
        possible = [each for each in found if not each.never]
        return min(possible, key=lambda each: each.time or 0.0) if all(each.time is not None for each in possible) else NOBODY_KNOWS

    def when_later(self, condition: Any) -> Guess:
        """Some time after another condition."""
        return self.delayed(condition, condition.delay)

    def when_lasting(self, condition: Any) -> Guess:
        """It has to hold for some time first."""
        return self.delayed(condition, condition.duration)

    def delayed(self, condition: Any, delay: float) -> Guess:
        """A time after another condition at the earliest."""
        other = self.when(condition.of)
        if other.never or other.time is None:
            return other
        return self.within_run(Guess(other.time + delay), "this at the earliest")

    # -- roads and times -----------------------------------------------------------------------------

    def station_of(self, condition: Any) -> float:
        """The station [m] that a condition names, on the path of its vehicle: that begins where the vehicle's first road does."""
        car = self.cars[condition.vehicle]
        first = car.path.stations[0].road
        whole = self.place.route(self.setting.scenario.vehicles[car.name].route)
        joined = next((each.s for each in whole.stations if each.road == first), 0.0)
        return condition.along - joined

    def soonest(self, vehicle: str, station: float) -> float | None:
        """The time [s] at which a vehicle comes to a station when nothing keeps it; None when the script puts it elsewhere or drives it."""
        if self.is_placed(vehicle):
            return None
        car = self.cars[vehicle]
        if station <= car.station:
            return 0.0
        if self.is_led(vehicle):
            return None
        return float(np.interp(station - car.station, *travelled(car)))

    def is_placed(self, vehicle: str) -> bool:
        """Whether an entry puts the vehicle elsewhere."""
        return any(isinstance(each, Placement) and each.vehicle == vehicle for site in self.setting.sites for each in site.effects)

    def is_led(self, vehicle: str) -> bool:
        """Whether an entry takes the pedals or the wheel of the vehicle: it may come sooner then, or elsewhere."""
        return any(
            hasattr(registry.find("action", site.entry.do.kind).module, "act")
            and any(each.what == "vehicle" and each.name == vehicle for each in references(site.entry.do))
            for site in self.setting.sites
        )

    def walk(self, entry: str) -> shapely.LineString:
        """The line of somebody whom an entry brings."""
        (found,) = [each for each in self.sites[entry].effects if isinstance(each, Walk)]
        return shapely.LineString(found.line if len(found.line) > 1 else found.line * 2)


def travelled(car: Car) -> tuple[np.ndarray, np.ndarray]:
    """Metres that a car has driven on its path at the speeds that this allows, and the times [s] at which it has."""
    first = int(car.station)
    speeds = np.maximum(car.path.points[PATH_SPEED, first:], SLOWEST) * (
        car.driver.speed_factor if hasattr(car.driver, "speed_factor") else 1.0
    )
    times = np.concatenate([[0.0], np.cumsum(2.0 * PATH_SPACING / (speeds[1:] + speeds[:-1]))])
    return np.arange(times.size) * PATH_SPACING, times


def lasts(begins: float | None, action: Any) -> float | None:
    """When an action is over at the latest [s], as far as it says how long it takes."""
    duration = getattr(action, "duration", None)
    return None if begins is None or not isinstance(duration, float | int) else begins + duration


def soonest_of(*times: float | None) -> float | None:
    """The first of some times [s] that are known."""
    return min((time for time in times if time is not None), default=None)


def words(condition: Any) -> str:
    """A condition in words: what its kind is called, and what it is set to."""
    title = registry.find("condition", condition.kind).title
    shown = [f"{name} {value:g}" if isinstance(value, float) else f"{value}" for name, value in plain(condition)]
    return f"{title}: {', '.join(shown)}" if shown else title


def plain(part: Any) -> list[tuple[str, Any]]:
    """The settings of a condition that are numbers or texts."""
    values = ((name, getattr(part, name)) for name in type(part).model_fields if name != "kind")
    return [(name, value) for name, value in values if isinstance(value, float | str)]


def never_in(name: str) -> str:
    """The area is beside the way."""
    return f"the way of {name} does not cross the area"


def passed_already(name: str) -> str:
    """The area is behind the start."""
    return f"{name} starts behind the area"
