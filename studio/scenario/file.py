"""Reading and writing scenario files (YAML), and telling what is wrong in them."""

import hashlib
import json
from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError

from studio.errors import Problem, ScenarioError, nearest
from studio.scenario.schema import Scenario, located

MOVED = {"road": "its friction is `weather.friction` now, its patches are `changes` of the kind friction"}
SIZE_LIMIT = 4_000_000  # [B] of a scenario file


# What PyYAML raises for text that is no YAML, or for tags whose value is none of theirs.
YAML_TROUBLE = (yaml.YAMLError, ValueError, TypeError, KeyError, AttributeError, OverflowError, RecursionError)


def read(path: Path) -> dict[str, Any]:
    """The document in a file; raises ScenarioError when it is missing, too large or not a YAML mapping."""
    if not path.is_file():
        others = [other.name for other in path.parent.glob("*.y*ml")] if path.parent.is_dir() else []
        raise ScenarioError(
            f"There is no scenario file {path}.", [Problem(str(path), "does not exist", remedy=nearest(path.name, others))]
        )
    if path.stat().st_size > SIZE_LIMIT:
        raise ScenarioError(
            f"{path} cannot be read.", [Problem(str(path), "is too large for a scenario", allowed=f"{SIZE_LIMIT} bytes")]
        )
    return parse(path.read_bytes(), str(path))


def parse(content: bytes, where: str) -> dict[str, Any]:
    """The mapping in a YAML text; raises ScenarioError with the line."""
    try:
        document = yaml.load(content.decode("utf-8"), Loader=UniqueKeys)
    except UnicodeDecodeError as error:
        raise ScenarioError(f"{where} is not a text file.", [Problem(where, str(error), allowed="UTF-8")]) from None
    except YAML_TROUBLE as error:
        mark = getattr(error, "problem_mark", None)
        line = f"{where}, line {mark.line + 1}" if mark else where
        what = getattr(error, "problem", None) or str(error) or "is nested too deep"
        raise ScenarioError(f"{where} is not YAML.", [Problem(line, what, remedy="mend the syntax there")]) from None
    if not isinstance(document, dict):
        kind = "empty" if document is None else f"a {type(document).__name__}"
        raise ScenarioError(f"{where} is not a scenario.", [Problem(where, f"is {kind}", allowed="a YAML mapping")])
    return document


class UniqueKeys(yaml.SafeLoader):
    """YAML that refuses a key that stands twice: the second would silently win."""

    def construct_mapping(self, node, deep=False):
        """As its parent, after a look at the keys."""
        seen = set()
        for key_node, _ in node.value:
            key = self.construct_object(key_node, deep=True)
            if isinstance(key, (str, int, float)) and key in seen:
                raise yaml.constructor.ConstructorError(
                    problem=f"the key {key!r} stands twice", problem_mark=key_node.start_mark
                )
            seen.add(str(key))
        return super().construct_mapping(node, deep)


def validate(document: dict[str, Any], where: str) -> Scenario:
    """A Scenario from a document; raises ScenarioError with every problem, named by its field's path."""
    try:
        return Scenario.model_validate(document)
    except ValidationError as error:
        raise ScenarioError(f"{where} is not a valid scenario.", problems(error, where, Scenario)) from None


def problems(error: ValidationError, where: str, model: type, *, under: str = "") -> list[Problem]:
    """Pydantic's findings as ours; `under` is the path of the model within its document, with a dot."""
    return [problem(finding, where, model, under) for finding in error.errors(include_url=False)]


def problem(finding: dict, where: str, model: type, under: str) -> Problem:
    """One finding: the path of the field, what is wrong, what is allowed, the nearest right name."""
    path = under + located(model.model_json_schema(), finding["loc"])[0] or "the scenario"
    what = finding["msg"].removeprefix("Value error, ")
    value, remedy = short(finding["input"]), ""
    if finding["type"] == "extra_forbidden":
        what, value = "is not a field that exists here", ""
        remedy = MOVED.get(path) or nearest(str(finding["loc"][-1]), fields_at(model, finding["loc"][:-1]))
    elif finding["type"] == "missing":
        what, value, remedy = "is missing", "", "add it"
    return Problem(f"{where}: {path}", lower(what), value, allowed(finding), remedy)


def lower(text: str) -> str:
    """Pydantic's sentence as a clause."""
    return text[:1].lower() + text[1:]


def short(value: Any, limit: int = 60) -> str:
    """A value that fits into a message."""
    text = repr(value)
    return text if len(text) <= limit else text[: limit - 1] + "…"


def allowed(finding: dict) -> str:
    """Bounds that a finding names."""
    signs = {"ge": "≥", "gt": ">", "le": "≤", "lt": "<", "pattern": "pattern", "expected": ""}
    context = finding.get("ctx", {})
    return " ".join(f"{sign} {context[key]}".strip() for key, sign in signs.items() if key in context)


def fields_at(model: type, path: tuple) -> list[str]:
    """Names of the fields that the schema has at a path."""
    return sorted(located(model.model_json_schema(), path)[1].get("properties", {}))


def digest(document: dict[str, Any], map_digest: str) -> str:
    """Content hash of a scenario: its document without the seed, and the map file's content."""
    content = {key: value for key, value in document.items() if key != "seed"}
    text = json.dumps(content, sort_keys=True, ensure_ascii=False, separators=(",", ":"))
    return hashlib.sha256(f"{map_digest}\n{text}".encode()).hexdigest()
