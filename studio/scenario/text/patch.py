"""JSON patches (RFC 6902): the one way in which a document changes.

    operations(json)            →  operations, read and checked
    steps(document, operation)  →  what it comes to: add, remove and replace, each of one value
    stepped(document, step)     →  the document after it; the given one stays as it is
    patched(document, patch)    →  the same for a whole patch: all of it, or ScenarioError and nothing

The standard says nothing about the order of keys, comments and the way a value is written. An inverse of scenario/text/splice.py
says it in one more member of its operations, `layout`, which other programs ignore, as the standard demands (section 4).
"""

import json
from collections.abc import Callable, Iterable, Sequence
from functools import reduce
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError, model_validator

from studio.errors import ConflictError, Problem, ScenarioError, short
from studio.scenario.finding import problems
from studio.scenario.text import pointer
from studio.scenario.text.source import same

MOST_OPERATIONS = 1000  # of a patch
NEEDS = {"add": "value", "replace": "value", "test": "value", "move": "from_", "copy": "from_"}


def is_text(value: Any) -> Any:
    """Refuses what is no JSON, and half characters (lone surrogates): JSON can carry them, a file cannot."""
    try:
        json.dumps(value, ensure_ascii=False).encode()
    except UnicodeEncodeError as error:
        raise ValueError(f"holds text that is no Unicode: {error.reason}") from None
    except TypeError as error:
        raise ValueError(f"holds what JSON cannot say: {error}") from None
    return value


class Layout(BaseModel):
    """How a value was written, so that an inverse is exact to the letter."""

    model_config = ConfigDict(extra="forbid")

    source: str = Field(description="the text of the value or of the entry")
    after: str | None = Field(None, description="the key that it stands behind in its mapping; null: it is the first")
    lines: int = Field(0, ge=0, description="lines between that key's entry and this one")


class Operation(BaseModel):
    """One operation of a JSON patch; members that the standard does not know are ignored, `layout` is that of an inverse."""

    op: Literal["add", "remove", "replace", "move", "copy", "test"]
    path: str = Field(description="JSON pointer (RFC 6901)", examples=["/clock/duration"])
    from_: str | None = Field(None, alias="from", description="JSON pointer, of move and copy")
    value: Any = Field(None, description="of add, replace and test")
    layout: Layout | None = None

    @model_validator(mode="after")
    def has_what_it_needs(self):
        needed = NEEDS.get(self.op)
        if needed and (needed not in self.model_fields_set or (needed == "from_" and self.from_ is None)):
            raise ValueError(f"the operation {self.op} needs the member {needed.rstrip('_')!r}")
        return self

    @model_validator(mode="after")
    def can_be_sent(self):
        is_text(self.as_json())
        return self

    @property
    def parts(self) -> tuple[str, ...]:
        """Keys and indices of its path."""
        return pointer.parts(self.path)

    @property
    def origin(self) -> tuple[str, ...]:
        """Keys and indices of the place that a move or a copy takes from."""
        assert self.from_ is not None  # neither comes to be without
        return pointer.parts(self.from_)

    def as_json(self) -> dict[str, Any]:
        """The operation as it is sent."""
        return self.model_dump(by_alias=True, exclude_unset=True)


def operation(op: str, path: Iterable[str | int], *, layout: Layout | None = None, **members: Any) -> Operation:
    """An operation at a place."""
    given = {"op": op, "path": pointer.joined(path), **members} | ({"layout": layout} if layout else {})
    return Operation.model_validate(given)


def operations(raw: Any) -> list[Operation]:
    """A patch from plain JSON; raises ScenarioError with all that is wrong."""
    try:
        found = TypeAdapter(list[Operation]).validate_python(raw)
    except ValidationError as error:
        raise ScenarioError("This is no JSON patch.", problems(error, "patch", Operation)) from None
    if len(found) > MOST_OPERATIONS:
        problem = Problem("patch", "has too many operations", str(len(found)), f"{MOST_OPERATIONS}", "send several")
        raise ScenarioError("The patch is too large.", [problem])
    return found


def patched(document: Any, patch: Iterable[Operation]) -> Any:
    """The document with a whole patch; raises ScenarioError, or ConflictError for a test that fails."""
    return reduce(lambda found, each: reduce(stepped, steps(found, each), found), patch, document)


def steps(document: Any, operation: Operation) -> list[Operation]:
    """What an operation comes to in this document: add (of what is new), remove and replace; a test that passes is nothing."""
    return STEPS[operation.op](document, operation)


def adding(document: Any, given: Operation) -> list[Operation]:
    """An add of what is there already replaces it; `-` is behind the last entry of a list."""
    if not given.path:
        return [given.model_copy(update={"op": "replace"})]
    *place, last = given.parts
    parent = pointer.get(document, place)
    if isinstance(parent, list):
        index = str(len(parent)) if last == "-" else last
        if not pointer.INDEX.fullmatch(index) or int(index) > len(parent):
            raise pointer.misfit(given.path, "is no place in this list", allowed=f"0 to {len(parent)}, or - for its end")
        return [given.model_copy(update={"path": pointer.joined([*place, index])})]
    if not isinstance(parent, dict):
        pointer.step(parent, place, last)
    return [given.model_copy(update={"op": "replace"} if last in parent else {})]


def replacing(document: Any, given: Operation) -> list[Operation]:
    """What is replaced must be there."""
    pointer.get(document, given.parts)
    return [given]


def removing(document: Any, given: Operation) -> list[Operation]:
    """What is removed must be there; the whole document cannot go."""
    if not given.path:
        raise pointer.misfit("", "cannot be removed", remedy="replace it")
    return replacing(document, given)


def moving(document: Any, given: Operation) -> list[Operation]:
    """A move takes away and adds; nothing can be moved into itself."""
    source = given.origin
    value = pointer.get(document, source)
    if given.parts == source:
        return []
    if given.parts[: len(source)] == source:
        raise pointer.misfit(given.path, f"lies within {given.from_ or 'the document'}, which is to be moved there")
    away = removing(document, operation("remove", source))
    return away + adding(stepped(document, away[0]), operation("add", given.parts, value=value))


def copying(document: Any, given: Operation) -> list[Operation]:
    """A copy adds what stands elsewhere."""
    value = pointer.get(document, given.origin)
    return adding(document, operation("add", given.parts, value=value))


def testing(document: Any, given: Operation) -> list[Operation]:
    """A test compares values; numbers are equal when their values are (section 4.6). Raises ConflictError."""
    found = pointer.get(document, given.parts)
    if not equal(found, given.value):
        problem = Problem(given.path or "the document", "has another value", short(found), short(given.value), "read it again")
        raise ConflictError("The document is not as the patch expects it.", [problem])
    return []


STEPS: dict[str, Callable[[Any, Operation], list[Operation]]] = {
    "add": adding, "remove": removing, "replace": replacing, "move": moving, "copy": copying, "test": testing,
}  # fmt: skip


def equal(a: Any, b: Any) -> bool:
    """Whether two values are the same to JSON: neither order of keys nor 1 and 1.0 make a difference, true and 1 do."""
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(equal(a[key], b[key]) for key in a)
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(map(equal, a, b))
    if isinstance(a, bool) or isinstance(b, bool):
        return a is b
    return a == b or same(a, b)


def stepped(document: Any, step: Operation) -> Any:
    """The document after an add, remove or replace that fits; what it does not touch is shared with the given one."""
    return within(document, step.parts, step)


def within(node: Any, path: Sequence[str], step: Operation) -> Any:
    """A node with a step done at a path below it."""
    if not path:
        return step.value
    if isinstance(node, list):
        index, inner = int(path[0]), node[int(path[0]) : int(path[0]) + 1]
    else:
        index, inner = path[0], [node[path[0]]] if path[0] in node else []
    if len(path) > 1:
        return exchanged(node, index, [within(inner[0], path[1:], step)])
    if step.op == "add":
        return inserted(node, index, step)
    return exchanged(node, index, [] if step.op == "remove" else [step.value])


def exchanged(node: Any, index: Any, new: list[Any]) -> Any:
    """A mapping or list with another value at a key, or none."""
    if isinstance(node, list):
        return [*node[:index], *new, *node[index + 1 :]]
    return {key: (new[0] if key == index else value) for key, value in node.items() if new or key != index}


def inserted(node: Any, index: Any, step: Operation) -> Any:
    """A mapping or list with one value more: at an index, behind the key that its layout names, else at the end."""
    if isinstance(node, list):
        return [*node[:index], step.value, *node[index:]]
    keys = list(node)
    cut = keys.index(after) + 1 if (after := anchor(node, step)) is not None else 0
    return {key: step.value if key == index else node[key] for key in [*keys[:cut], index, *keys[cut:]]}


def anchor(node: dict[str, Any], step: Operation) -> str | None:
    """The key that a new one stands behind: as its layout says; without one, or when that key is gone, the last."""
    last = next(reversed(node), None)
    if step.layout is None or (step.layout.after is not None and step.layout.after not in node):
        return last
    return step.layout.after
