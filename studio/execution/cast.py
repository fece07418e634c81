"""Cast: of every vehicle its model and dynamics, what its driver is like, and its way, as far as somebody has to know it after the run."""

from collections.abc import Sequence
from typing import Any, NamedTuple

from studio.road.network import Network
from studio.road.ways.path import PATH_SLOPE, Path
from studio.world.car import Car
from studio.world.setting import Setting


class Manned(NamedTuple):
    """A vehicle with its driver: the name of its model, the driver's kind and settings, the number of its way, how it moves; and the span
    that it was validated for, where its file says so: lowest and highest value of each quantity."""

    model: str
    driver: dict[str, Any]
    way: int
    dynamics: str = "full"  # or light
    validated: dict[str, list[float]] | None = None


class Leg(NamedTuple):
    """From `along` on, a way runs on a lane of a road that begins at `begin` and is `length` long [m]; what follows is the junction."""

    along: float
    begin: float
    lane: str
    length: float
    junction: str


class Way(NamedTuple):
    """A path from lane to lane, and its slope [1] every metre; no slopes where all of it is level."""

    legs: tuple[Leg, ...]
    slopes: tuple[float, ...]

    def place(self, station: float) -> tuple[str, float, float]:
        """Lane, position on it [m] and slope [1] at a station [m]: in a junction that, and how far behind the lane."""
        leg = next((each for each in reversed(self.legs) if each.along <= station), self.legs[0])
        on, slope = station - leg.begin, self.slopes[min(max(int(station), 0), len(self.slopes) - 1)] if self.slopes else 0.0
        return (leg.lane, on, slope) if on <= leg.length else (leg.junction, on - leg.length, slope)


class Cast(NamedTuple):
    """All vehicles by name, the ways of all, and where the map's (0, 0) lies: latitude and longitude [deg]."""

    manned: dict[str, Manned]
    ways: tuple[Way, ...]
    origin: tuple[float, float]


NOBODY = Cast({}, (), (0.0, 0.0))


def cast(setting: Setting) -> Cast:
    """That of a setting."""
    paths = {id(car.path): car.path for car in setting.cars}
    number = {each: i for i, each in enumerate(paths)}
    manned = {car.name: manned_of(car, number[id(car.path)]) for car in setting.cars}
    return Cast(manned, tuple(way(each, setting.network) for each in paths.values()), setting.network.origin)


def manned_of(car: Car, way: int) -> Manned:
    """One vehicle on the way of this number."""
    span = car.model.values.validated
    dynamics = "light" if car.is_light else "full"
    return Manned(car.model.name, car.driver.model_dump(mode="json"), way, dynamics, span.model_dump() if span else None)


def way(path: Path, network: Network) -> Way:
    """A path from lane to lane."""
    legs: list[Leg] = []
    for each in path.stations:
        road = network.roads[each.road]
        lane = network.lanes_of(each.road)[each.lane_index]
        is_same = bool(legs) and legs[-1].lane.rpartition("_")[0] == each.road
        legs.append(Leg(each.s, legs[-1].begin if is_same else each.s, f"{each.road}_{lane.index}", lane.length, f":{road.to_junction}"))
    slopes = path.points[PATH_SLOPE]
    return Way(tuple(legs), tuple(slopes.round(5).tolist()) if slopes.any() else ())


def of_plain(known: Sequence[Any]) -> Cast:
    """That of plain data."""
    manned, ways, origin = known
    made = tuple(Way(tuple(Leg(*leg) for leg in legs), tuple(slopes)) for legs, slopes in ways)
    return Cast({name: Manned(*each) for name, each in manned.items()}, made, (origin[0], origin[1]))
