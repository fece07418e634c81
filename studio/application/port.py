"""Ports: what the annotations of `Sees` and `Does` say, read once for whoever connects them.

seen(module)   →  Port, Port, ...       what an application sees
done(module)   →  Port, Port, ...       what it does
problems(module)                        everything about them that does not fit
"""

from collections.abc import Iterator
from types import ModuleType
from typing import Annotated, Any, NamedTuple, get_args, get_origin, get_type_hints

from studio.application import contract
from studio.application.contract import Clock, Command, Inbox, Notice, Outbox, Own, Targets
from studio.errors import Problem

MOST = 64  # targets or messages of one port
SEEN = {Clock: "clock", Own: "own", Targets: "targets", Inbox: "inbox"}
DONE = {Command: "command", Outbox: "outbox", Notice: "notice"}
WITH_KIND = {"targets": "sensor", "inbox": "message", "outbox": "message"}
TARGETS, INBOX, OUTBOX, COMMAND, NOTICE, LOG = "targets", "inbox", "outbox", "command", "notice", "log"


class Port(NamedTuple):
    """One port: its name, what it is, the kind that it is about and how many of it at most; the type of a log."""

    name: str
    what: str
    kind: str = ""
    most: int = 1
    type: Any = None


class Told(NamedTuple):
    """A field of the contract: its name, unit, range and meaning."""

    name: str
    unit: str
    low: float
    high: float
    meaning: str


def told(of: type, name: str) -> Told:
    """What the contract says about a field."""
    notes = get_args(get_type_hints(of, include_extras=True)[name])[1:]
    span = next((each for each in notes if isinstance(each, tuple)), (float("-inf"), float("inf")))
    return Told(name, notes[0], *span, meaning=notes[-1])


OWN = tuple(told(Own, name) for name in Own._fields)
ACTUATORS = tuple(told(Command, name) for name in Command._fields[1:])
BITS = {each.name: getattr(contract, each.name.upper()) for each in ACTUATORS}


def seen(module: ModuleType) -> list[Port]:
    """What an application sees; raises TypeError."""
    return [port(name, hint, SEEN) for name, hint in hints(module.Sees)]


def done(module: ModuleType) -> list[Port]:
    """What it does; raises TypeError."""
    return [port(name, hint, DONE) for name, hint in hints(module.Does)]


def commanded(module: ModuleType) -> int:
    """The actuators that it may command, as a sum of their bits."""
    return int(getattr(module, "COMMANDS", contract.NOTHING))


def hints(bundle: Any) -> list[tuple[str, Any]]:
    """The fields of a NamedTuple with their annotations, in order."""
    found = get_type_hints(bundle, include_extras=True)
    return [(name, found[name]) for name in bundle._fields]


def port(name: str, hint: Any, types: dict[Any, str]) -> Port:
    """One port."""
    kind, *notes = get_args(hint) if get_origin(hint) is Annotated else (hint,)
    if kind not in types:
        if types is DONE and isinstance(kind, type) and hasattr(kind, "_fields"):
            return Port(name, LOG, type=kind)
        allowed = ", ".join(each.__name__ for each in types) + (", or a NamedTuple of values to be recorded" if types is DONE else "")
        raise TypeError(f"{name} is {getattr(kind, '__name__', kind)}; allowed: {allowed}")
    what = types[kind]
    if what not in WITH_KIND:
        return Port(name, what)
    if len(notes) != 2 or not isinstance(notes[0], str) or not isinstance(notes[1], int) or not 1 <= notes[1] <= MOST:
        example = f'{name}: Annotated[{kind.__name__}, "name of the {WITH_KIND[what]}", 4]'
        raise TypeError(f"{name} does not say which {WITH_KIND[what]} and how many (1 to {MOST}): write {example}")
    return Port(name, what, notes[0], notes[1])


def problems(module: ModuleType, where: str) -> Iterator[Problem]:
    """Everything about the ports of a module that does not fit."""
    for bundle, read in (("Sees", seen), ("Does", done)):
        try:
            ports = read(module)
        except (TypeError, NameError) as error:
            yield Problem(f"{where}: {bundle}", str(error))
            continue
        single = [each.what for each in ports if each.what in (COMMAND, NOTICE, LOG)]
        for what in sorted({what for what in single if single.count(what) > 1}):
            yield Problem(f"{where}: {bundle}", f"has more than one port for a {what}", allowed="one")
        if bundle == "Does" and (COMMAND in single) != bool(commanded(module)):
            yield Problem(
                f"{where}: COMMANDS",
                "does not fit the ports",
                remedy="give COMMANDS = ACCELERATION, say, and a port for a Command, or neither",
            )
        if bundle == "Does" and NOTICE in single and not getattr(module, "NOTICES", ()):
            yield Problem(f"{where}: NOTICES", "is missing", remedy='say what may be shown: NOTICES = ("Brake!",)')
