"""Tables and sections in Markdown."""

import inspect
from collections.abc import Iterable, Sequence
from typing import Any


def table(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """A table; what stands in a cell keeps to its cell."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(cell(each) for each in line) + " |" for line in lines) + "\n"


def cell(value: Any) -> str:
    """A value on one line, its bars escaped."""
    return " ".join(str(value).split()).replace("|", "\\|")


def code(value: Any) -> str:
    """A name or value as it is typed; nothing stays nothing."""
    return f"`{value}`" if str(value) else ""


def filled(text: str | None) -> str:
    """A docstring's text with its indentation taken away."""
    return inspect.cleandoc(text or "")
