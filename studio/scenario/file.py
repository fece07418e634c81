"""Scenario files: reading, checking against the schema, writing; each problem with its line and column."""

import hashlib
import json
import os
import secrets
import tempfile
from collections.abc import Generator, Iterable
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from studio.errors import ConflictError, Problem, ScenarioError, StudioError, nearest
from studio.scenario.finding import problems
from studio.scenario.schema import Scenario
from studio.scenario.text import source
from studio.scenario.text.migration import migrated
from studio.scenario.text.pointer import kind
from studio.scenario.text.source import Source

SIZE_LIMIT = 4_000_000  # [B] of a scenario file
Model = TypeVar("Model", bound=BaseModel)


def read(path: Path) -> dict[str, Any]:
    """The document in a file, as the present version of the format has it; raises ScenarioError."""
    return migrated(opened(path))[0].value


def opened(path: Path) -> Source:
    """What stands in a scenario file; raises ScenarioError when it is missing, too large or not a YAML mapping."""
    return mapping(content(path, "scenario", SIZE_LIMIT), str(path), "scenario")


def content(path: Path, what: str, limit: int) -> bytes:
    """Bytes of a file, not more than `limit`; raises ScenarioError, which names the files beside a missing one."""
    if not path.is_file():
        others = [other.name for other in path.parent.glob("*.y*ml")] if path.parent.is_dir() else []
        problem = Problem(str(path), "does not exist", remedy=nearest(path.name, others))
        raise ScenarioError(f"There is no {what} file {path}.", [problem])
    try:
        with path.open("rb") as file:
            data = file.read(limit + 1)
    except OSError as error:
        raise ScenarioError(f"{path} cannot be read.", [Problem(str(path), f"cannot be opened: {error.strerror}")]) from None
    if len(data) > limit:
        raise ScenarioError(f"{path} cannot be read.", [Problem(str(path), f"is too large for a {what}", allowed=f"{limit} bytes")])
    return data


def mapping(data: bytes, where: str, what: str) -> Source:
    """The mapping in a YAML text; raises ScenarioError with the line."""
    return checked(source.read(source.decoded(data, where), where), what)


def checked(found: Source, what: str) -> Source:
    """A source that is a mapping; raises ScenarioError."""
    if not isinstance(found.root.children, dict):
        given = "empty" if found.root.scalar is None and found.root.children is None else kind(found.value)
        raise ScenarioError(f"{found.where} is not a {what}.", [Problem(found.where, f"is {given}", allowed="a YAML mapping")])
    return found


def write(path: Path, text: str) -> None:
    """Puts a text in the place of a file at once: whoever reads it meanwhile has the old one or the new one, and never a half.

    The file keeps its permissions. Raises ScenarioError when the disk does not take it.
    """
    try:
        handle, beside = tempfile.mkstemp(prefix=f".{path.name}-", dir=path.parent)
        try:
            with open(handle, "w", encoding="utf-8", newline="") as file:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
            os.chmod(beside, path.stat().st_mode)
            os.replace(beside, path)
        except BaseException:
            os.unlink(beside)
            raise
    except OSError as error:
        raise unwritten(path, error) from None


def write_new(path: Path, text: str) -> None:
    """Puts a text where there is no file yet, at once. Raises ConflictError when there is one, or ScenarioError."""
    beside = path.with_name(f".{path.name}-{secrets.token_hex(4)}")
    try:
        try:
            with beside.open("x", encoding="utf-8", newline="") as file:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
        except OSError as error:
            raise unwritten(path, error) from None
        move_new(beside, path)
    finally:
        beside.unlink(missing_ok=True)


def move_new(path: Path, target: Path) -> None:
    """Gives a file another name, which must be free: nothing is ever overwritten. Raises ConflictError or ScenarioError."""
    try:
        try:
            os.link(path, target, follow_symlinks=False)
        except FileExistsError:
            raise
        except OSError:  # a file system without hard links: the name is taken first
            target.touch(exist_ok=False)
            os.replace(path, target)
        else:
            path.unlink()
    except FileExistsError:
        problem = Problem("name", "is taken", target.name, remedy="choose another name")
        raise ConflictError(f"There is a file {target.name} already.", [problem]) from None
    except OSError as error:
        raise unwritten(target, error) from None


def unwritten(path: Path, error: OSError) -> ScenarioError:
    """A refusal of the disk."""
    return ScenarioError(f"{path} cannot be written.", [Problem(str(path), error.strerror or str(error))])


def model(found: Source, kind: type[Model], what: str) -> Model:
    """What a source says as a model of another kind of file; raises ScenarioError with all that is wrong, line by line."""
    with placed(found, found.where):
        try:
            return kind.model_validate(found.value)
        except ValidationError as error:
            raise ScenarioError(f"{found.where} is not a valid {what}.", problems(error, found.where, kind)) from None


def validate(document: dict[str, Any], where: str) -> Scenario:
    """A Scenario from a document; raises ScenarioError with every problem, named by its field's path."""
    try:
        return Scenario.model_validate(document)
    except ValidationError as error:
        raise ScenarioError(f"{where} is not a valid scenario.", problems(error, where, Scenario)) from None


@contextmanager
def placed(found: Source, name: str, *, changes: Iterable[str] = (), told: Iterable[str] = ()) -> Generator[None]:
    """Problems of fields, `name: path`, get the line and column that the field has in a file, unless a change has set it.

    What a migration has told is added: it says why a path may not stand in the file.
    """
    try:
        yield
    except StudioError as error:
        error.problems = [with_place(each, found, name, changes) for each in error.problems] + [Problem(name, each) for each in told]
        raise


def with_place(problem: Problem, found: Source, name: str, changes: Iterable[str]) -> Problem:
    """A problem with its place, if its field, or a part around it, stands in the file."""
    path = problem.where.removeprefix(f"{name}: ")
    is_set = any(f"{path}.".startswith(f"{each}.") for each in changes)
    if path == problem.where or is_set or found.find(path.split(".")[:1]) is None:
        return problem
    line, column = found.place(path.split("."))
    return replace(problem, where=f"{name}, line {line}, column {column}: {path}")


def digest(document: dict[str, Any], map_digest: str) -> str:
    """Content hash of a scenario: its document without the seed, and the map file's content.

    Which version of the format it was written in says nothing about what is run; it counts as the first.
    """
    content = {key: value for key, value in document.items() if key != "seed"} | {"version": 1}
    text = json.dumps(content, sort_keys=True, ensure_ascii=False, separators=(",", ":"))
    return hashlib.sha256(f"{map_digest}\n{text}".encode()).hexdigest()
