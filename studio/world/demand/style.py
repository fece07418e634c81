"""Style: of which type a car of the traffic is, and what its driver is like.

kind_of(who, scenario, own)   →  Manned             that of its flow, or of the mix by chance
driver_of(who, scenario, of)  →  Driver             with what was drawn for him
type_problems(scenario, where)                      what is wrong with types and distributions

Chance tells drivers apart by their number among those that go round, or by where their flow comes in and their number there, and their
settings by name. So nothing hangs on the order of a file, and one distribution more changes no other.
"""

from collections.abc import Iterator
from math import exp, inf
from typing import NamedTuple
from zlib import crc32

import numpy as np

from studio.errors import Problem, nearest
from studio.kind.driver import Driver
from studio.model.random import TRAFFIC_MODEL, TRAFFIC_STYLE, quantile, uniform
from studio.scenario import catalogue
from studio.scenario.schema import Scenario
from studio.scenario.traffic import Distribution, Manned, Normal, Uniform

STYLE_SPREAD = 0.1  # traffic drivers want 90 % to 110 % of the usual speed, unless it is spread otherwise
LEAST_SHARE = 0.1  # of a distribution that must lie within its bounds
DRAWS = 400  # after which with this share one in 1e18 has found no value
WORD = 2**32  # chance counts in words


class Who(NamedTuple):
    """How chance tells a car of the traffic from all others."""

    entity: int
    turn: int = 0


def who_of(stream: str, turn: int) -> Who:
    """One that comes in by turns."""
    return Who(crc32(stream.encode()), turn + 1)


def kind_of(who: Who, scenario: Scenario, own: str | None) -> Manned:
    """The type of a car: that of its flow, or of the mix by chance, or the one that all have."""
    traffic = scenario.traffic
    if own or not traffic.mix:
        return traffic.manned(own or traffic.model)
    share = np.cumsum([traffic.mix[name] for name in sorted(traffic.mix)])
    at = uniform(scenario.seed_of("traffic"), who.entity, TRAFFIC_MODEL, who.turn) * share[-1]
    return traffic.manned(sorted(traffic.mix)[int(np.searchsorted(share, at, side="right"))])


def driver_of(who: Who, scenario: Scenario, of: Manned) -> Driver:
    """The driver of a car of a type."""
    return of.driver.model_copy(update=drawn(who, scenario.seed_of("traffic"), of))


def drawn(who: Who, seed: int, of: Manned) -> dict[str, float]:
    """What is his own of a driver, by setting."""
    by = 1.0 + STYLE_SPREAD * (2.0 * uniform(seed, who.entity, TRAFFIC_STYLE, who.turn) - 1.0)
    return {"speed_factor": of.driver.speed_factor * by} | {name: draw(name, who, seed, of) for name in of.spread}


def draw(name: str, who: Who, seed: int, of: Manned) -> float:
    """His value of a setting that is spread."""
    each, about = of.spread[name], crc32(name.encode())
    least, most = bounds(each, type(of.driver), name)
    value = least
    for attempt in range(DRAWS):
        value = value_at(each, uniform(seed, who.entity, TRAFFIC_STYLE, who.turn, (about + attempt) % WORD))
        if least <= value <= most:
            return value
    return min(max(value, least), most)


def value_at(each: Distribution, p: float) -> float:
    """The number that a share p of the distribution is below, before its bounds cut."""
    if isinstance(each, Uniform):
        return each.least + p * (each.most - each.least)
    return each.mean + each.deviation * quantile(p) if isinstance(each, Normal) else each.median * exp(each.sigma * quantile(p))


def bounds(each: Distribution, driver: type[Driver], name: str) -> tuple[float, float]:
    """Between what a setting is drawn: its own range where the distribution says nothing."""
    low, high = range_of(driver, name)
    return low if each.least is None else each.least, high if each.most is None else each.most


def range_of(driver: type[Driver], name: str) -> tuple[float, float]:
    """What a setting allows."""
    marks = driver.model_fields[name].metadata
    low = [getattr(mark, sign) for mark in marks for sign in ("ge", "gt") if hasattr(mark, sign)]
    high = [getattr(mark, sign) for mark in marks for sign in ("le", "lt") if hasattr(mark, sign)]
    return max(low, default=-inf), min(high, default=inf)


# -- what may be wrong -----------------------------------------------------------------------------


def type_problems(scenario: Scenario, where: str) -> Iterator[Problem]:
    """Types with the name of a model, settings that there are not, and distributions beyond what they allow."""
    traffic = scenario.traffic
    for name in traffic.types.keys() & set(catalogue.vehicle_names()):
        yield Problem(f"{where}: traffic.types.{name}", "is the name of a vehicle of the catalogue", repr(name), remedy="choose another")
    for name, each in traffic.spread.items():
        yield from spread_problem(each, type(traffic.driver), name, f"{where}: traffic.spread.{name}")
    for of in traffic.types:
        driver = traffic.manned(of).driver
        for name, each in traffic.types[of].spread.items():
            yield from spread_problem(each, type(driver), name, f"{where}: traffic.types.{of}.spread.{name}")


def spread_problem(each: Distribution, driver: type[Driver], name: str, at: str) -> Iterator[Problem]:
    """What is wrong with the distribution of one setting."""
    settings = [key for key, field in driver.model_fields.items() if field.annotation is float]
    if name not in settings:
        yield Problem(at, "names no setting of these drivers that is a number", repr(name), ", ".join(settings), nearest(name, settings))
        return
    low, high = range_of(driver, name)
    for part in ("least", "most", "mean"):
        value = getattr(each, part, None)
        if value is not None and not low <= value <= high:
            yield Problem(f"{at}.{part}", f"is beyond what {name} may be", f"{value:g}", f"{low:g} to {high:g}")
            return
    least, most = bounds(each, driver, name)
    share = 1.0 if isinstance(each, Uniform) else each.below(most) - each.below(least)
    if share < LEAST_SHARE:
        told = f"{least:g} to {most:g} have {100 * share:.2g} % of it"
        yield Problem(at, "lies beyond its bounds", told, f"≥ {100 * LEAST_SHARE:g} %", "widen the bounds, or move the mean")
