"""Applications: whatever they see, they do what their file declares; compiled and as Python the same."""

from collections.abc import Iterator
from types import ModuleType
from typing import Any

import numpy as np

from studio.application import port
from studio.application.contract import Clock, Heard, Inbox, Targets
from studio.application.port import ACTUATORS, COMMAND, INBOX, NOTICE, OUTBOX, TARGETS, Port
from studio.kind import registry
from studio.kind.registry import Kind
from studio.workshop import draw, twice
from studio.workshop.check import Check, tried
from studio.workshop.suite.message import own
from studio.world.board.text import shaped

DRAWS = 300
TICK = 0.02  # [s]


def checks(kind: Kind) -> Iterator[Check]:
    """All of them, tick after tick: what is remembered at one is given to the next."""
    module, seed = kind.module, np.random.default_rng(1)
    plain = getattr(module.decide, "py_func", module.decide)
    draws: list[tuple] = []
    yield tried("decide() takes what its ports see, and returns (memory, does) as declared", lambda: ticks(module, plain, seed, draws))
    if hasattr(module.decide, "py_func"):
        yield tried("decide() gives the same compiled and as Python", lambda: twice.agree(module.decide, draws))
    yield tried("decide() gives finite numbers", lambda: twice.finite(plain, draws))
    yield tried("decide() gives the same to the same", lambda: twice.steady(plain, draws))
    yield tried("what it does is declared, and in range", lambda: excess(module, plain, draws))


def ticks(module: ModuleType, plain: Any, seed: np.random.Generator, draws: list[tuple]) -> None:
    """Many ticks; raises TypeError for an answer of another shape."""
    memory = module.Memory()
    for k in range(DRAWS):
        parameters = draw.settings_tuple(module, draw.settings(module.Parameters, seed))
        draws.append((parameters, memory, sees(module, k * TICK, seed)))
        memory, _ = shaped(plain(*draws[-1]), module)
        memory = remembered(module, memory)


def remembered(module: ModuleType, memory: Any) -> Any:
    """A memory as a run keeps it: plain numbers."""
    return module.Memory(*[tuple(map(float, each)) if isinstance(each, tuple) else float(each) for each in memory])


def sees(module: ModuleType, time: float, seed: np.random.Generator) -> Any:
    """What might be seen at a tick."""
    return module.Sees(*[at_port(each, time, seed) for each in port.seen(module)])


def at_port(each: Port, time: float, seed: np.random.Generator) -> Any:
    """What might come in at one port."""
    if each.what == TARGETS:
        reading = registry.find("sensor", each.kind).module.Reading
        targets = tuple(draw.quantity_tuple(reading, seed) for _ in range(each.most))
        return Targets(int(seed.integers(0, each.most + 1)), targets, float(seed.uniform(0.0, 0.2)))
    if each.what == INBOX:
        return Inbox(int(seed.integers(0, each.most + 1)), tuple(heard(each, time, seed) for _ in range(each.most)))
    return Clock(time, TICK) if each.what == "clock" else own(seed)


def heard(each: Port, time: float, seed: np.random.Generator) -> Heard:
    """A message that may have come."""
    payload = draw.quantity_tuple(registry.find("message", each.kind).module.Payload, seed)
    delay, missed = float(seed.uniform(0.0, 0.3)), float(seed.integers(0, 3))
    return Heard(
        bool(seed.integers(2)), float(seed.integers(0, 9)), min(time, delay + float(seed.exponential(0.3))), delay, missed, payload
    )


def excess(module: ModuleType, plain: Any, draws: list[tuple]) -> str | None:
    """The first thing that was done and must not be."""
    for given in draws:
        does = plain(*given)[1]
        for each in port.done(module):
            if wrong := too_much(getattr(does, each.name), each, module):
                return f"{wrong}, of {twice.short(given)}"
    return None


def too_much(does: Any, each: Port, module: ModuleType) -> str:
    """What is wrong at one port; "" when nothing is."""
    if each.what == COMMAND:
        return next((text for bit, one in enumerate(ACTUATORS) if does.mask >> bit & 1 if (text := forbidden(does, bit, one, module))), "")
    most = {NOTICE: len(getattr(module, "NOTICES", ())), OUTBOX: each.most}.get(each.what)
    count = getattr(does, "number", getattr(does, "count", 0))
    return f"{each.name} is {count}: 0 to {most} is meant" if most is not None and not 0 <= count <= most else ""


def forbidden(does: Any, bit: int, one: port.Told, module: ModuleType) -> str:
    """An actuator that is not its to command, or a value that it cannot have."""
    value = getattr(does, one.name)
    if not port.commanded(module) >> bit & 1:
        return f"{one.name} is commanded, and is not among its COMMANDS"
    return (
        ""
        if one.low <= value <= one.high
        else f"{one.name} = {value:g} is out of range: bound it to {one.low:g} to {one.high:g} {one.unit}"
    )
