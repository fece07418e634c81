"""The vocabulary of applications: everything that one may name, with unit and meaning, read off the contract and the kinds.

ports()     what may stand in `Sees` and `Does`, with the fields below each; a new sensor's readings are there by themselves
functions() what commands, with its arguments
names()     the other names that the contract gives
"""

import inspect
import re
from collections.abc import Iterator
from functools import cache
from typing import Annotated, Any, NamedTuple, get_args, get_origin, get_type_hints

from studio.application import contract, port
from studio.kind import registry, settings
from studio.kind.quantity import Quantity, quantities

COMMENT = re.compile(r"^    (\w+): [^#\n]*#\s*(?:\[([^\]]+)\]\s*)?(.*)$", re.MULTILINE)
KIND_OF = {"Targets": "sensor", "Inbox": "message", "Outbox": "message"}


class Word(NamedTuple):
    """A field: its name, unit, meaning, what stands below it, and whether it is a row of such."""

    name: str
    unit: str = ""
    meaning: str = ""
    words: tuple["Word", ...] = ()
    is_row: bool = False


class PortWords(NamedTuple):
    """A type of port, with the kind that it is about: its title, and its fields."""

    type: str
    kind: str
    seen: bool
    meaning: str
    words: tuple[Word, ...]


class FunctionWords(NamedTuple):
    """A function of the contract: its arguments, and what it does."""

    name: str
    arguments: tuple[str, ...]
    meaning: str


@cache
def ports() -> list[PortWords]:
    """All ports that `Sees` and `Does` may have; found anew when kinds change."""
    found = []
    for types, seen in ((port.SEEN, True), (port.DONE, False)):
        for of in types:
            found += list(port_words(of, seen))
    return found


registry.listen(ports.cache_clear)


def port_words(of: Any, seen: bool) -> Iterator[PortWords]:
    """One type of port, for each kind that it may be about."""
    sort = KIND_OF.get(of.__name__)
    if not sort:
        yield PortWords(of.__name__, "", seen, line(of.__doc__), fields(of))
        return
    for kind in registry.known(sort).values():
        below = tuple(map(word_of, quantities(kind.module.Reading if sort == "sensor" else kind.module.Payload)))
        yield PortWords(of.__name__, kind.name, seen, kind.title, fields(of, below))


def fields(of: Any, below: tuple[Word, ...] = ()) -> tuple[Word, ...]:
    """The fields of a type of the contract; `below` stands where it leaves open what is there."""
    comments = {name: (unit or "", meaning) for name, unit, meaning in COMMENT.findall(inspect.getsource(of))}
    return tuple(field(name, hint, comments.get(name, ("", "")), below) for name, hint in get_type_hints(of, include_extras=True).items())


def field(name: str, hint: Any, comment: tuple[str, str], below: tuple[Word, ...]) -> Word:
    """One field, with what its annotation or its comment says."""
    kind, *notes = get_args(hint) if get_origin(hint) is Annotated else (hint,)
    unit, meaning = (str(notes[0]), str(notes[-1])) if notes else comment
    if kind is Any:
        return Word(name, unit, meaning, below)
    if get_origin(kind) is tuple:
        inner = get_args(kind)[0]
        return Word(name, unit, meaning, fields(inner, below) if hasattr(inner, "_fields") else below, is_row=True)
    return Word(name, unit, meaning)


def word_of(quantity: Quantity) -> Word:
    """A number of a reading or a payload."""
    return Word(quantity.name, quantity.unit, quantity.meaning, is_row=quantity.size > 1)


def functions() -> list[FunctionWords]:
    """What the contract and the settings have to be called."""
    offered = {name: each for name, each in vars(contract).items() if inspect.isfunction(each) and each.__module__ == contract.__name__}
    offered |= {"number": settings.number}
    return [FunctionWords(name, tuple(inspect.signature(each).parameters), line(each.__doc__)) for name, each in offered.items()]


def names() -> list[str]:
    """The names of the contract, and what applications take from elsewhere."""
    return [name for name in vars(contract) if name[0].isalpha() and name not in ("Any", "Annotated", "NamedTuple", "register_jitable")]


def line(text: str | None) -> str:
    """The first line of a docstring."""
    return (text or "").strip().partition("\n")[0]
