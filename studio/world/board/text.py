"""The text of a host's loop: what an application sees is put together, what it does is looked at and passed on, all from its ports.

source(application)    →  the text
loop(application)      →  the loop
checked(module)        →  the names of what is looked at, as faults count them
"""

from collections.abc import Callable, Iterator
from functools import cache
from math import isfinite
from types import ModuleType
from typing import Any

import numpy as np

from studio.application import port
from studio.application.contract import Command, Notice, Outbox
from studio.application.port import ACTUATORS, COMMAND, INBOX, LOG, NOTICE, OUTBOX, OWN, TARGETS, Port
from studio.compiled import compiled
from studio.kind import registry
from studio.kind.loop import written
from studio.kind.number import shapes, spelled, tuple_of
from studio.kind.quantity import Quantity, quantities
from studio.kind.registry import Kind
from studio.world.board.host import NOT_FINITE, NOT_ITS_OWN, OUT_OF_RANGE, is_compiled
from studio.world.board.post import spelled_size
from studio.world.table.unit import H_CAME, H_MISSED, H_NUMBER, H_SENDER, H_STAMP, H_TIME, HEARD, MEASURED, OWN_FIRST

HEAD = '''"""Calls {name} for all its units."""

from studio.application.contract import Clock, Heard, Inbox, Own, Targets
from studio.compiled import inlined, lean
from studio.world.board.text import bad, bad_actuator, bad_count, bad_mask, shaped
from studio.world.board.post import send
from studio.world.table.unit import DRIFT, OFFSET, PRESENT
from {module} import Does, Memory, ParametersTuple, Sees, decide
{imports}
{parts}


{above}def run(fixed, now, commands, unit, column, rank, stopped, parameters, memory, said, shown, fault, wrong{arguments}, tick, time):
    faults = 0
    for j in range(unit.size):
        u = unit[j]
        fault[j] = -1
        if now[PRESENT, u] == 0.0 or stopped[j] != 0:
            fault[j] = shown[j] = 0
            continue
        offset, rate = fixed[OFFSET, u], 1.0 + fixed[DRIFT, u]
        sees = Sees({sees})
        remembered, does = {call}
        f, w = 0, 0.0
{checks}
        fault[j], wrong[j] = f, w
        if f != 0:
            faults += 1
            continue
{store}
    return faults
'''


# -- what the text calls ---------------------------------------------------------------------------------


@compiled
def bad(f, w, number, value, is_loose):
    """The first fault so far: `value` must be finite; a loose one may be infinite."""
    if f == 0 and (value != value or (not is_loose and not isfinite(value))):
        return 4 * number + NOT_FINITE, float(value)
    return f, w


@compiled
def bad_count(f, w, number, value, most):
    """A count must be within 0 and its most."""
    if f == 0 and not 0 <= value <= most:
        return 4 * number + OUT_OF_RANGE, float(value)
    return f, w


@compiled
def bad_mask(f, w, number, mask):
    """A mask is a sum of the actuators' bits."""
    if f == 0 and not 0 <= mask < 256:
        return 4 * number + OUT_OF_RANGE, float(mask)
    return f, w


@compiled
def bad_actuator(f, w, number, value, is_named, is_its_own, low, high):
    """What the mask names must be the application's to command, finite and in range."""
    if f != 0 or not is_named:
        return f, w
    if not is_its_own:
        return 4 * number + NOT_ITS_OWN, float(value)
    if not isfinite(value):
        return 4 * number + NOT_FINITE, float(value)
    return (f, w) if low <= value <= high else (4 * number + OUT_OF_RANGE, float(value))


def shaped(answer: Any, module: ModuleType) -> tuple[Any, Any]:
    """What `decide` returned, if it is what its file declares; raises TypeError. Compiled code cannot return anything else."""
    if not (isinstance(answer, tuple) and len(answer) == 2):
        raise TypeError(f"decide() returned {short(answer)}, not (memory, does)")
    remembered, does = answer
    for name, given, of in (("memory", remembered, module.Memory), ("does", does, module.Does)):
        if not isinstance(given, of):
            raise TypeError(f"decide() returned {short(given)} as its {name}, not a {of.__name__}")
    for each in outlets(module):
        check_port(getattr(does, each.name), each)
    check_values(remembered, "memory", module.Memory)
    return remembered, does


# An application in plain Python is looked at in every tick; what its file declares stays the same until a kind comes in.
@cache
def outlets(module: ModuleType) -> list[Port]:
    """What an application does."""
    return port.done(module)


@cache
def payload_of(message: str) -> type:
    """The payload of a kind of message."""
    return registry.find("message", message).module.Payload


@cache
def declared(of: type) -> list[Any]:
    """The quantities of a NamedTuple."""
    return quantities(of)


for kept in (outlets, payload_of, declared):
    registry.listen(kept.cache_clear)


def check_port(given: Any, each: Port) -> None:
    """What stands at a port is of its type."""
    of: Any = each.type if each.what == LOG else TYPES[each.what]
    if not isinstance(given, of):
        raise TypeError(f"decide() returned {short(given)} at {each.name}, not a {of.__name__}")
    if isinstance(given, Outbox):
        payload = payload_of(each.kind)
        if not isinstance(given.message, tuple) or len(given.message) < each.most:
            raise TypeError(f"{each.name}.message holds {short(given.message)}; a tuple of {each.most} payloads is meant")
        for one in given.message[: each.most]:
            if not isinstance(one, payload):
                raise TypeError(f"{each.name}.message holds {short(one)}, not the Payload of {each.kind!r}")
            check_values(one, f"{each.name}.message", payload)
    elif each.what == LOG:
        check_values(given, each.name, each.type)


def check_values(given: Any, where: str, of: type) -> None:
    """Plain numbers, and tuples of as many as are declared."""
    for each in declared(of):
        value = getattr(given, each.name)
        some = value if each.size > 1 else (value,)
        if not isinstance(some, tuple) or len(some) != each.size or not all(isinstance(one, NUMBER) for one in some):
            raise TypeError(
                f"{where}.{each.name} is {short(value)}; {'a number' if each.size == 1 else f'a tuple of {each.size} numbers'} is meant"
            )


NUMBER = (int, float, np.number, np.bool_)
TYPES = {COMMAND: Command, OUTBOX: Outbox, NOTICE: Notice}


def short(value: Any) -> str:
    """A value that fits into a message."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:59]}…"


# out, health, column; inbox, links, how many, for how long; ring, last, fresh, sender
WIRES = {TARGETS: "abc", INBOX: "abcd", OUTBOX: "abcd"}


# -- the text --------------------------------------------------------------------------------------------


def source(application: Kind) -> str:
    """The text of the loop."""
    module = application.module
    remembered = quantities(module.Memory)
    seen = list(wired(port.seen(module), (TARGETS, INBOX)))
    sent = list(wired(port.done(module), (OUTBOX,), len(seen)))
    decide = f"decide(ParametersTuple({spelled([each.size for each in shapes(module.Parameters)], 'parameters')}), "
    decide += f"Memory({values(remembered, 'memory', 'j', 0)}), sees)"
    return HEAD.format(
        name=application.name,
        module=module.__name__,
        imports="\n".join(
            [*(imported(each, part_of(each), i) for i, each in seen), *(imported(each, "size", i) for i, each in sized(sent))]
        ),
        parts="\n".join(part(i, each) for i, each in seen),
        above="@lean\n" if is_compiled(application) else "",
        arguments="".join(f", {letter}{i}" for i, each in [*seen, *sent] for letter in WIRES[each.what]),
        sees=", ".join(seeing(each, seen) for each in port.seen(module)),
        call=decide if is_compiled(application) else f"shaped({decide}, module)",
        checks="\n".join(f"        {line}" for line in checks(module)),
        store="\n".join(f"        {line}" for line in [*stores(module), *sends(sent)]),
    ) + ("" if is_compiled(application) else f"\n\nimport {module.__name__} as module  # noqa: E402\n")


def wired(ports: list[Port], which: tuple[str, ...], first: int = 0) -> Iterator[tuple[int, Port]]:
    """The ports that are connected to arrays, numbered."""
    return enumerate((each for each in ports if each.what in which), first)


def kind_of(each: Port) -> Kind:
    """The kind that a port is about."""
    return registry.find(port.WITH_KIND[each.what], each.kind)


def imported(each: Port, part: str, i: int) -> str:
    """The line that takes a part of a kind's file, numbered like its port."""
    return f"from {kind_of(each).module.__name__} import {part} as {part}{i}"


def sized(sent: list[tuple[int, Port]]) -> Iterator[tuple[int, Port]]:
    """Those of some ports whose messages are as large as what they carry."""
    return ((i, each) for i, each in sent if hasattr(kind_of(each).module, "size"))


def part_of(each: Port) -> str:
    """The type of what comes in at a port."""
    return "Reading" if each.what == TARGETS else "Payload"


def part(i: int, each: Port) -> str:
    """The function that reads one target or message."""
    if each.what == TARGETS:
        of = quantities(kind_of(each).module.Reading)
        targets = ", ".join(f"Reading{i}({values(of, 'out.T', 's', 1 + k * total(of))})" for k in range(each.most))
        none = ", ".join(f"Reading{i}({blanks(of)})" for _ in range(each.most))
        return TARGET.format(i=i, targets=targets, none=none, measured=MEASURED)
    of = quantities(kind_of(each).module.Payload)
    return MESSAGE.format(i=i, blank=blanks(of), payload=values(of, "inbox", "link", len(HEARD)), **ROWS)


TARGET = """

@inlined
def read{i}(out, health, s, most, time, offset, rate):
    if s < 0 or health[{measured}, s] < 0.0:
        return Targets(0, ({none},), time * rate + offset)
    return Targets(min(int(out[s, 0]), most), ({targets},), (time - health[{measured}, s]) * rate)
"""
MESSAGE = """

@inlined
def read{i}(inbox, link, kept, time, offset, rate):
    now = time * rate + offset
    if link < 0 or inbox[{number}, link] < 0.0:
        return Heard(False, 0.0, now, 0.0, 0.0, Payload{i}({blank}))
    stamp, came = inbox[{stamp}, link], inbox[{came}, link] * rate + offset
    if time - inbox[{time}, link] > kept:
        return Heard(False, 0.0, now - stamp, 0.0, 0.0, Payload{i}({blank}))
    return Heard(True, inbox[{sender}, link], now - stamp, came - stamp, inbox[{missed}, link], Payload{i}({payload}))
"""
ROWS = {"number": H_NUMBER, "time": H_TIME, "stamp": H_STAMP, "came": H_CAME, "sender": H_SENDER, "missed": H_MISSED}


def total(of: list[Quantity]) -> int:
    """How many numbers some quantities hold."""
    return sum(each.size for each in of)


def values(of: list[Quantity], array: str, column: str, first: int) -> str:
    """Arguments from the rows of an array; yes or no from numbers."""
    parts, row = [], first
    for each in of:
        one = spelled([each.size], array, column, row)
        parts.append(f"{one} > 0.0" if each.is_flag else one)
        row += each.size
    return ", ".join(parts)


def blanks(of: list[Quantity]) -> str:
    """Arguments where there is nothing."""
    zeros = ["False" if each.is_flag else "0.0" if each.size == 1 else f"({', '.join(['0.0'] * each.size)})" for each in of]
    return ", ".join(zeros)


def seeing(each: Port, seen: list[tuple[int, Port]]) -> str:
    """The argument for one port of `Sees`."""
    if each.what == "clock":
        return f"{each.name}=Clock(time * rate + offset, tick * rate)"
    if each.what == "own":
        return f"{each.name}=Own({', '.join(f'now[{OWN_FIRST + i}, u]' for i in range(len(OWN)))})"
    i = next(i for i, other in seen if other == each)
    if each.what == TARGETS:
        return f"{each.name}=read{i}(a{i}, b{i}, c{i}[0, j], {each.most}, time, offset, rate)"
    messages = ", ".join(f"read{i}(a{i}, b{i}[{k}, j], d{i}[j], time, offset, rate)" for k in range(each.most))
    return f"{each.name}=Inbox(c{i}[j], ({messages},))"


def checked(module: ModuleType) -> list[str]:
    """The names of what is looked at, in order."""
    return [f"memory.{each.name}" for each in quantities(module.Memory)] + [name for each in port.done(module) for name in names(each)]


def names(each: Port) -> list[str]:
    """Those of one port."""
    if each.what == COMMAND:
        return [f"{each.name}.{name}" for name in Command._fields]
    if each.what == OUTBOX:
        return [f"{each.name}.count", *(f"{each.name}.message.{one.name}" for one in quantities(kind_of(each).module.Payload))]
    return [f"{each.name}.{one.name}" for one in quantities(each.type)] if each.what == LOG else [f"{each.name}.number"]


def checks(module: ModuleType) -> Iterator[str]:
    """Lines that look for the first fault, in the order of `checked`."""
    n = 0
    for each in quantities(module.Memory):
        for one in ones(each):
            yield f"f, w = bad(f, w, {n}, remembered.{each.name}{one}, True)"
        n += 1
    for each in port.done(module):
        yield from checks_of(each, n, port.commanded(module), len(getattr(module, "NOTICES", ())))
        n += len(names(each))


def ones(each: Quantity) -> list[str]:
    """How the numbers of a quantity are reached; yes and no become 1 and 0."""
    if each.is_flag:
        return [" * 1.0"]
    return [""] if each.size == 1 else [f"[{i}]" for i in range(each.size)]


def checks_of(each: Port, n: int, commanded: int, notices: int) -> Iterator[str]:
    """Those of one port."""
    name = f"does.{each.name}"
    if each.what == COMMAND:
        yield f"f, w = bad_mask(f, w, {n}, {name}.mask)"
        for i, one in enumerate(ACTUATORS):
            named = f"int({name}.mask) >> {i} & 1"
            own = bool(commanded >> i & 1)
            yield f"f, w = bad_actuator(f, w, {n + 1 + i}, {name}.{one.name}, {named}, {own}, {one.low}, {one.high})"
    elif each.what == NOTICE:
        yield f"f, w = bad_count(f, w, {n}, {name}.number, {notices})"
    elif each.what == OUTBOX:
        yield f"f, w = bad_count(f, w, {n}, {name}.count, {each.most})"
        for k in range(each.most):
            yield f"if {name}.count > {k}:"
            for m, one in enumerate(quantities(kind_of(each).module.Payload)):
                for at in ones(one):
                    yield f"    f, w = bad(f, w, {n + 1 + m}, {name}.message[{k}].{one.name}{at}, False)"
    else:
        for m, one in enumerate(quantities(each.type)):
            for at in ones(one):
                yield f"f, w = bad(f, w, {n + m}, {name}.{one.name}{at}, False)"


def stores(module: ModuleType) -> Iterator[str]:
    """Lines that keep what was remembered, commanded, logged and shown."""
    row = 0
    for each in quantities(module.Memory):
        for one in ones(each):
            yield f"memory[{row}, j] = remembered.{each.name}{one}"
            row += 1
    for each in port.done(module):
        if each.what == COMMAND:
            for i, one in enumerate(ACTUATORS):
                if port.commanded(module) >> i & 1:
                    yield f"if int(does.{each.name}.mask) >> {i} & 1:"
                    yield f"    commands[{i}, column[j]] = does.{each.name}.{one.name}"
                    yield f"    commands[{len(ACTUATORS) + i}, column[j]] = rank[j]"
        elif each.what == NOTICE:
            yield f"shown[j] = does.{each.name}.number"
        elif each.what == LOG:
            places = ((one, at) for one in quantities(each.type) for at in ones(one))
            yield from (f"said[{i}, j] = does.{each.name}.{one.name}{at}" for i, (one, at) in enumerate(places))


def sends(sent: list[tuple[int, Port]]) -> Iterator[str]:
    """Lines that give messages to the radio; wired are ring, numbers of the last, how many are fresh, and the sender's index."""
    for i, each in sent:
        of = quantities(kind_of(each).module.Payload)
        for k in range(each.most):
            given = f"does.{each.name}.message[{k}]"
            payload = ", ".join(f"{given}.{one.name}{at}" for one in of for at in ones(one))
            size = spelled_size(kind_of(each).module, f"size{i}", given)
            yield f"if does.{each.name}.count > {k}:"
            yield f"    send(d{i}[j], u, time, fixed, {size}, ({payload},), now, a{i}, b{i}, c{i})"


def loop(application: Kind) -> Callable:
    """The loop over all units of an application."""
    module = application.module
    tuple_of(module, module.Parameters)
    ports = [each for each in (*port.seen(module), *port.done(module)) if each.what in port.WITH_KIND]
    return written(f"host_{application.name}", source(application), application, *(kind_of(each) for each in ports)).run
