"""JSON pointers (RFC 6901): `/vehicles/leader/speed` names a place in a document; `~1` is a slash in a key, `~0` a tilde."""

import re
from collections.abc import Iterable, Sequence
from typing import Any

from studio.errors import Problem, ScenarioError, nearest

INDEX = re.compile(r"0|[1-9][0-9]{0,8}")


def parts(pointer: str) -> tuple[str, ...]:
    """Keys and indices of a pointer; raises ScenarioError for what is none."""
    if pointer and not pointer.startswith("/"):
        raise misfit(pointer, "is no JSON pointer", remedy=f"write /{pointer.replace('.', '/')}")
    if re.search(r"~(?![01])", pointer):
        raise misfit(pointer, "has a ~ that stands for nothing", remedy="write ~0 for ~ and ~1 for /")
    return tuple(part.replace("~1", "/").replace("~0", "~") for part in pointer.split("/")[1:])


def joined(path: Iterable[str | int]) -> str:
    """The pointer of keys and indices."""
    return "".join("/" + str(part).replace("~", "~0").replace("/", "~1") for part in path)


def get(document: Any, path: Sequence[str]) -> Any:
    """What stands at a place; raises ScenarioError that names the nearest."""
    for depth, part in enumerate(path):
        document = document[step(document, path[:depth], part)]
    return document


def step(node: Any, place: Sequence[str], part: str) -> str | int:
    """Key or index of what `part` names within `node`, which stands at `place`; raises ScenarioError."""
    where = joined([*place, part])
    if isinstance(node, dict):
        if part not in node:
            raise misfit(where, "does not exist", remedy=nearest(part, node))
        return part
    if not isinstance(node, list):
        raise misfit(where, f"leads into {kind(node)}", remedy=f"{joined(place) or 'the document'} holds nothing further")
    if not INDEX.fullmatch(part) or int(part) >= len(node):
        raise misfit(where, "is no entry of this list", allowed=entries(len(node)))
    return int(part)


def entries(count: int) -> str:
    """Indices of a list as text."""
    return f"0 to {count - 1}" if count else "none, the list is empty"


def kind(value: Any) -> str:
    """What a value is, as JSON says it."""
    if value is None:
        return "null"
    names = {bool: "a boolean", int: "a number", float: "a number", str: "a text", list: "a list", dict: "a mapping"}
    return names[type(value)]


def misfit(where: str, what: str, value: str = "", allowed: str = "", remedy: str = "") -> ScenarioError:
    """A refusal of a patch that does not fit."""
    return ScenarioError("The patch does not fit.", [Problem(where or "the document", what, value, allowed, remedy)])
