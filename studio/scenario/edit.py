"""Changes of a document by path, as `--set`, the page and sweeps make them."""

import copy
from typing import Any

import yaml

from studio.errors import Problem, ScenarioError, nearest
from studio.scenario.file import YAML_TROUBLE


def parse_assignment(text: str) -> tuple[str, Any]:
    """`PATH=VALUE` as path and value; the value is read as YAML, so 1.5, true and [a, b] mean what they look like."""
    path, equals, value = text.partition("=")
    if not equals or not path.strip():
        raise ScenarioError(
            f"--set {text} cannot be read.",
            [Problem("--set", "is not an assignment", text, "PATH=VALUE, for instance clock.duration=30")],
        )
    try:
        return path.strip(), yaml.safe_load(value)
    except YAML_TROUBLE:
        raise ScenarioError(
            f"--set {text} cannot be read.", [Problem(f"--set {path}", "has a value that is not YAML", value)]
        ) from None


def known_paths(document: Any, prefix: str = "") -> list[str]:
    """Paths of all leaves of a document."""
    if isinstance(document, dict) and document:
        return [path for key, value in document.items() for path in known_paths(value, f"{prefix}{key}.")]
    if isinstance(document, list) and any(isinstance(item, dict) for item in document):
        return [path for i, value in enumerate(document) for path in known_paths(value, f"{prefix}{i}.")]
    return [prefix[:-1]]


def flatten(document: Any) -> dict[str, Any]:
    """Leaves of a document by path."""
    return {path: get(document, path) for path in known_paths(document)}


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


def put(document: dict, full: dict, path: str, value: Any) -> dict:
    """A copy of `document` with `value` at `path`, which must exist in `full`, the document with defaults filled in."""
    if not has(full, path):
        raise ScenarioError(
            f"There is no parameter {path!r} to set.",
            [Problem(path, "is not a path in this scenario", remedy=nearest_path(full, path))],
        )
    changed = copy.deepcopy(document)
    parts = path.split(".")
    node, shadow = changed, full
    for part in parts[:-1]:
        node, shadow = step(node, shadow, part)
    node[int(parts[-1]) if isinstance(node, list) else parts[-1]] = value
    return changed


def step(node: Any, shadow: Any, part: str) -> tuple[Any, Any]:
    """One level down in both; what only has defaults so far is laid out."""
    if isinstance(node, list):
        return node[int(part)], shadow[int(part)]
    if node.get(part) is None or (isinstance(shadow[part], list) and not node[part]):
        node[part] = copy.deepcopy(shadow[part])
    return node[part], shadow[part]


def nearest_path(full: dict, path: str) -> str:
    """The nearest path, or what stands at the deepest level that does exist."""
    parts = path.split(".")
    while parts and not has(full, ".".join(parts)):
        wrong = parts.pop()
    level = get(full, ".".join(parts)) if parts else full
    if isinstance(level, dict):
        prefix = ".".join(parts) + "." if parts else ""
        text = nearest(wrong, [str(key) for key in level])
        return text.replace("did you mean '", f"did you mean '{prefix}")
    return nearest(path, known_paths(full))
