"""Starts: texts to begin an application of one's own with."""

from inspect import cleandoc
from string import Template
from typing import NamedTuple

from studio.kind import registry
from studio.workshop.draft import TEMPLATES

NEW = "new"  # the name of what `studio new application` writes


class Start(NamedTuple):
    """One of them: its name, what it is, and the text."""

    name: str
    title: str
    explanation: str
    text: str


def starts() -> list[Start]:
    """What `studio new application` writes first, then the applications that come with the studio."""
    template = (TEMPLATES / "application.py.txt").read_text(encoding="utf-8")
    text = Template(template).substitute(name="mine", title="Mine")
    first = Start(
        NEW, "The shortest", "Keeps a time gap to the car ahead, as its radar sees it: what `studio new application` writes.", text
    )
    return [first, *(built_in(kind) for kind in registry.known("application").values() if kind.is_built_in)]


def built_in(kind: registry.Kind) -> Start:
    """An application that comes with the studio, as a start."""
    return Start(kind.name, kind.title, cleandoc(kind.module.__doc__ or ""), next(iter(kind.texts.values())))
