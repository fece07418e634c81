"""Changes of a document by dotted path, as `--set`, the page and sweeps make them: short for a JSON patch (scenario/text/patch.py)."""

from collections.abc import Iterator
from typing import Any

from studio.errors import Problem, ScenarioError, nearest
from studio.kind.preset import FIELD
from studio.scenario.text import source
from studio.scenario.text.patch import Operation, operation


def parse_assignment(text: str) -> tuple[str, Any]:
    """`PATH=VALUE` as path and value; the value is read as YAML, so 1.5, true and [a, b] mean what they look like."""
    path, equals, value = text.partition("=")
    if not equals or not path.strip():
        raise ScenarioError(
            f"--set {text} cannot be read.",
            [Problem("--set", "is not an assignment", text, "PATH=VALUE, for instance clock.duration=30")],
        )
    try:
        return path.strip(), source.read(value, f"--set {path.strip()}").value
    except ScenarioError as error:
        raise ScenarioError(f"--set {text} cannot be read.", error.problems) from None


def leaves(document: Any, prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Paths and values of all leaves of a document, of keys with dots in them too."""
    is_table = isinstance(document, list) and any(isinstance(item, dict) for item in document)
    inner = document.items() if isinstance(document, dict) else enumerate(document) if is_table else ()
    if not inner:
        yield prefix[:-1], document
    for key, value in inner:
        yield from leaves(value, f"{prefix}{key}.")


def flatten(document: Any) -> dict[str, Any]:
    """Leaves of a document by path."""
    return dict(leaves(document))


def get(document: Any, path: str) -> Any:
    """The value at a path; raises KeyError, IndexError or TypeError when there is none."""
    for part in path.split("."):
        document = document[int(part)] if isinstance(document, list) else document[part]
    return document


def has(document: Any, path: str) -> bool:
    """Whether something stands at a path."""
    try:
        get(document, path)
    except (KeyError, IndexError, TypeError, ValueError):
        return False
    return True


def assignment(document: Any, full: dict, path: str, value: Any) -> list[Operation]:
    """The patch that sets a path; it must exist in `full`, the document with defaults filled in, and is laid out from there."""
    if not has(full, path):
        raise ScenarioError(
            f"There is no parameter {path!r} to set.",
            [Problem(path, "is not a path in this scenario", remedy=nearest_path(full, path))],
        )
    parts = path.split(".")
    for depth in range(1, len(parts)):
        part = ".".join(parts[:depth])
        if is_left_out(document, full, part):
            whole = get(full, part)
            if parts[-1] == FIELD:
                whole = bare(whole, parts[depth:-1])
            return [operation("add", parts[:depth], value=whole), operation("replace", parts, value=value)]
    return [operation("replace" if has(document, path) else "add", parts, value=value)]


def bare(whole: Any, parts: list[str]) -> Any:
    """What is laid out, but at one place no more than the kind: values that are laid out there would hide those of its preset."""
    if not parts:
        return {"kind": whole["kind"], FIELD: None}
    return whole | {parts[0]: bare(whole[parts[0]], parts[1:])}


def is_left_out(document: Any, full: dict, path: str) -> bool:
    """Whether only the defaults hold something at a path."""
    found = get(document, path) if has(document, path) else None
    return found is None or (found == [] and bool(get(full, path)))


def nearest_path(full: dict, path: str) -> str:
    """The nearest path, or what stands at the deepest level that does exist."""
    parts, wrong = path.split("."), path
    while parts and not has(full, ".".join(parts)):
        wrong = parts.pop()
    level = get(full, ".".join(parts)) if parts else full
    if isinstance(level, dict):
        prefix = ".".join(parts) + "." if parts else ""
        text = nearest(wrong, [str(key) for key in level])
        return text.replace("did you mean '", f"did you mean '{prefix}")
    return nearest(path, flatten(full))
