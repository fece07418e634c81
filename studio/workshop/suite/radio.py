"""Radio models: every message is lost for a cause that there is, or comes within the longest delay; compiled and as Python the same."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from studio.kind.registry import Kind
from studio.workshop import draw, twice
from studio.workshop.check import Check, tried
from studio.world.table.cause import CAUSES, RECEIVED
from studio.world.view import Draw, Sent, Spot, Way

DRAWS = 300
ROUNDING = 1e-9  # [s]
LONGEST_RUN = 3600.0  # [s]
SEEDS = 2**31


def checks(kind: Kind) -> Iterator[Check]:
    """All of them, on drawn ways, chances and memories."""
    module, seed = kind.module, np.random.default_rng(1)
    chosen = [draw.settings(module.Settings, seed) for _ in range(DRAWS)]
    yield tried("longest(), reach() and largest() are finite, and not negative", lambda: bounds(kind, chosen))
    draws = [drawn(seed, kind, each) for each in chosen]
    yield from twice_over("transmit", module.transmit, draws)
    yield tried("no message comes before it was sent, or after longest()", lambda: delays(kind, chosen, draws))
    if hasattr(module, "airtime"):
        sizes = [(given[0], given[1].size) for given in draws]
        yield from twice_over("airtime", module.airtime, sizes)
        yield tried("airtime() is not negative", lambda: negative(module.airtime, sizes))
    if hasattr(module, "control"):
        asked = [(given[0], float(seed.uniform()), *memory(kind, "Control", seed)) for given in draws]
        yield from twice_over("control", module.control, asked)
        yield tried("control() gives no time below zero", lambda: negative(lambda *given: module.control(*given)[0], asked))
    if hasattr(module, "admit"):
        entered = [(given[0], sent(given[1]), *memory(kind, "Cell", seed)) for given in draws]
        yield from twice_over("admit", module.admit, entered)
        yield tried("admit() lets nobody wait less than no time", lambda: negative(lambda *given: module.admit(*given)[0], entered))
    if hasattr(module, "wait"):
        waited = [(given[0], sent(given[1]), given[2]) for given in draws]
        yield from twice_over("wait", module.wait, waited)
        yield tried("wait() lets nobody wait less than no time", lambda: negative(module.wait, waited))
    if hasattr(module, "place"):
        spots = [(given[0], spot(given[1], given[2]), module.Around()) for given in draws]
        yield from twice_over("place", module.place, spots)


def drawn(seed: np.random.Generator, kind: Kind, settings: Any) -> tuple:
    """What `transmit` is given, with all that other parts of the radio say of a drawn way."""
    module, plain = kind.module, draw.settings_tuple(kind.module, settings)
    given, chance = way(seed, kind, settings), chances(seed)
    if hasattr(module, "wait"):
        given = given._replace(wait=float(module.wait(plain, sent(given), chance)))
    if hasattr(module, "place"):
        near, far = (module.place(plain, spot(each, chance), module.Around())[0] for each in (given, turned(given)))
        given = given._replace(from_place=near, to_place=far)
    if hasattr(module, "table"):
        given = given._replace(table=np.asarray(module.table(settings), dtype=float))
    return plain, given, chance, *memory(kind, "Memory", seed)


def twice_over(name: str, function: Any, draws: list[tuple]) -> Iterator[Check]:
    """What every compiled function of a radio keeps."""
    yield tried(f"{name}() gives the same compiled and as Python", lambda: twice.agree(function, draws))
    yield tried(f"{name}() gives finite numbers", lambda: twice.finite(function, draws))
    yield tried(f"{name}() gives the same to the same", lambda: twice.steady(function, draws))


def way(seed: np.random.Generator, kind: Kind, settings: Any) -> Way:
    """A way within reach, long or short, through houses now and then, of a message that the radio takes."""
    walls, distance = float(seed.integers(0, 4)), float(seed.uniform(0.0, max(kind.module.reach(settings), 1.0)))
    x, y, angle = (float(each) for each in seed.uniform(-500.0, 500.0, 3))
    return Way(
        distance=distance,
        walls=walls,
        inside=10.0 * walls,
        size=float(seed.uniform(1.0, kind.module.largest(settings))),
        speed=float(seed.uniform(0.0, 60.0)),
        approach=float(seed.uniform(-100.0, 100.0)),
        time=float(seed.uniform(0.0, LONGEST_RUN)),
        from_x=x,
        from_y=y,
        from_height=float(seed.uniform(0.5, 10.0)),
        to_x=x + distance * math.cos(angle),
        to_y=y + distance * math.sin(angle),
        to_height=float(seed.uniform(0.5, 10.0)),
        from_load=float(seed.uniform()),
        load=float(seed.uniform()),
        wait=float(seed.uniform(0.0, kind.module.longest(settings))) if hasattr(kind.module, "admit") else 0.0,
    )


def chances(seed: np.random.Generator) -> Draw:
    """What chance tells a message apart by."""
    return Draw(*(int(each) for each in seed.integers(0, SEEDS, 2)), *(int(each) for each in seed.integers(0, 60_000, 4)))


def sent(given: Way) -> Sent:
    """A message before it goes out."""
    return Sent(given.time, given.from_x, given.from_y, given.size, given.from_load)


def spot(given: Way, chance: Draw) -> Spot:
    """Where its sender is."""
    return Spot(given.from_x, given.from_y, chance.seed, chance.common)


def turned(given: Way) -> Way:
    """The same way from its receiver."""
    return given._replace(from_x=given.to_x, from_y=given.to_y)


def memory(kind: Kind, name: str, seed: np.random.Generator) -> tuple:
    """What a radio may remember: at first, or later; nothing of a radio that remembers nothing."""
    of = getattr(kind.module, name, None)
    if of is None:
        return ()
    return (of(),) if seed.uniform() < 0.5 else (draw.quantity_tuple(of, seed),)


def bounds(kind: Kind, chosen: list[Any]) -> str | None:
    """What the rings of messages are made for."""
    for each in chosen:
        found = {name: float(getattr(kind.module, name)(each)) for name in ("longest", "reach", "largest")}
        if hasattr(kind.module, "heard_within"):
            found["heard_within"] = float(kind.module.heard_within(each))
        for name, value in found.items():
            if not (math.isfinite(value) and value >= 0.0):
                return f"{name}() gave {value!r} for {each}: give a bound that the settings imply"
    return None


def negative(function: Any, draws: list[tuple]) -> str | None:
    """A time below zero."""
    return next((f"it gives {found} of {given}" for given in draws if (found := function(*given)) < 0.0), None)


def delays(kind: Kind, chosen: list[Any], draws: list[tuple]) -> str | None:
    """A delay that is longer than was said would be taken for one of another message; a cause that is none could not be told."""
    for settings, given in zip(chosen, draws, strict=True):
        answer = kind.module.transmit(*given)
        found = answer[0] if hasattr(kind.module, "Memory") else answer
        if not 0 <= int(found.lost) < len(CAUSES):
            return f"transmit() gave {found.lost}, which is no cause; world/table/cause.py has them"
        if found.lost == RECEIVED and not 0.0 <= found.delay <= kind.module.longest(settings) + ROUNDING:
            return f"transmit() gave a delay of {found.delay} s, longest() {kind.module.longest(settings)} s, for {settings}"
    return None
