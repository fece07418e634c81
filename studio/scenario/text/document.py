"""A scenario as a document: its text, changed by patches, each of which can be undone to the letter.

document = Document.read(text, "my.yaml")
inverse = document.apply(patch, name="Longer run")      all of it, or ScenarioError and nothing
document.undo(), document.redo()                        by name, as far as there is something to undo
"""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from studio.scenario.text import patch as patches
from studio.scenario.text import source
from studio.scenario.text.patch import Operation
from studio.scenario.text.source import Source
from studio.scenario.text.splice import renamed, spliced


@dataclass(frozen=True)
class Step:
    """A patch that was applied, by name, and what undoes it."""

    name: str
    inverse: list[Operation]


@dataclass
class Document:
    """A YAML text with the steps that were done to it and those that were undone."""

    source: Source
    done: list[Step] = field(default_factory=list)
    undone: list[Step] = field(default_factory=list)

    @classmethod
    def read(cls, text: str, where: str) -> "Document":
        """A document from a text; raises ScenarioError."""
        return cls(source.read(text, where))

    @property
    def text(self) -> str:
        """What stands in the file."""
        return self.source.text

    @property
    def value(self) -> Any:
        """Its plain data."""
        return self.source.value

    def apply(self, patch: Sequence[Operation], *, name: str = "") -> list[Operation]:
        """Changes the document and returns what takes the change back. Raises ScenarioError or ConflictError, then all is as before."""
        self.source, inverse = applied(self.source, patch)
        self.done.append(Step(name, inverse))
        self.undone.clear()
        return inverse

    def undo(self) -> str | None:
        """Takes the last step back; returns its name, or None when there is none."""
        return self.turn(self.done, self.undone)

    def redo(self) -> str | None:
        """Does again what was undone last; returns its name, or None when there is none."""
        return self.turn(self.undone, self.done)

    def turn(self, taken: list[Step], given: list[Step]) -> str | None:
        """Moves a step from one pile to the other."""
        if not taken:
            return None
        step = taken[-1]
        self.source, inverse = applied(self.source, step.inverse)
        given.append(Step(taken.pop().name, inverse))
        return step.name


def applied(before: Source, patch: Sequence[Operation]) -> tuple[Source, list[Operation]]:
    """A source with a patch, and its inverse. Raises ScenarioError or ConflictError."""
    now, inverse = before, []
    for each in patch:
        steps = patches.steps(now.value, each)
        if each.op == "move" and steps:
            steps[1] = renamed(now, *steps)
        for step in steps:
            now, back = spliced(now, step)
            inverse = back + inverse
    return now, inverse


def digest(text: str) -> str:
    """What tells two texts apart, to the letter."""
    return hashlib.sha256(text.encode()).hexdigest()
