"""Chatter: an application that hears every kind of message, and may send every one that applications send; it sends each now.

It is written for the kinds that there are, and stands in a file of its own while a stage is built. Whatever talks can be tried with it.
"""

from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from studio.kind import registry
from studio.kind.quantity import quantities
from studio.kind.registry import Kind

NAME = "chatter"
TEXT = '''"""Hears everything, and sends what applications send at every tick. It is for trials; no figure stands in it."""

from typing import Annotated, NamedTuple

from studio.application.contract import Inbox, Outbox
from studio.kind.settings import Part
{imports}

KIND = "application"
TITLE = "Chatter"


class Parameters(Part):
    """Nothing."""


class Memory(NamedTuple):
    """Nothing."""


class Sees(NamedTuple):
    """Everything that is said."""

{sees}


class Does(NamedTuple):
    """What it says."""

{does}


def decide(parameters, memory, sees):
    """Says something of every kind."""
    return Memory(), Does({words})
'''


@contextmanager
def chatter() -> Generator[str]:
    """Its name while it can be had."""
    kept = list(registry.every())
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"{NAME}.py"
        path.write_text(text(), encoding="utf-8")
        registry.load_file(path)
        try:
            yield NAME
        finally:
            registry.restore(kept)


def text() -> str:
    """Its file, for the messages that come with the studio."""
    known = [kind for kind in registry.known("message").values() if kind.is_built_in]
    sent = [kind for kind in known if not hasattr(kind.module, "beacon")]
    return TEXT.format(
        imports="\n".join(f"from {kind.module.__name__} import Payload as {kind.name}" for kind in sent),
        sees="\n".join(f'    {kind.name}: Annotated[Inbox, "{kind.name}", 1]' for kind in known),
        does="\n".join(f'    {kind.name}: Annotated[Outbox, "{kind.name}", 1]' for kind in sent),
        words=", ".join(f"Outbox(1, ({blank(kind)},))" for kind in sent),
    )


def blank(kind: Kind) -> str:
    """A payload of first values."""
    return f"{kind.name}({', '.join(repr(each.default) for each in quantities(kind.module.Payload))})"
