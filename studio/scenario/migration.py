"""Old scenario files: each version becomes the next by a patch, so that comments and order stay, and says what has changed.

    source, told = migrated(source)

A version n to n + 1 is one function in MIGRATIONS: it gets the document, and returns its patch and a sentence for each change.
"""

from collections.abc import Callable
from typing import Any

from studio.errors import Problem, ScenarioError
from studio.scenario.document import applied
from studio.scenario.finding import short
from studio.scenario.patch import Layout, Operation, operation
from studio.scenario.schema import VERSION
from studio.scenario.source import Source

Migration = Callable[[dict[str, Any]], tuple[list[Operation], list[str]]]


def migrated(given: Source) -> tuple[Source, list[str]]:
    """A scenario as the present version has it, and what was changed for that; raises ScenarioError for a version to come."""
    version, now, told = version_of(given), given, []
    for number in range(version, VERSION):
        patch, sentences = MIGRATIONS[number](now.value)
        now, _ = applied(now, [*patch, numbered(now.value, number + 1)])
        told += [f"version {number} to {number + 1}: {each}" for each in sentences]
    return now, told


def version_of(given: Source) -> int:
    """The version that a file names; those that name none are of the first."""
    version = given.value.get("version", 1)
    where, allowed = given.told("version"), f"1 to {VERSION}"
    if isinstance(version, int) and not isinstance(version, bool) and 1 <= version <= VERSION:
        return version
    newer = isinstance(version, int) and version > VERSION
    what = "is newer than this studio" if newer else "is no version of the format"
    remedy = "update the studio, or write the scenario with this one" if newer else f"write version: {VERSION}"
    raise ScenarioError(f"{given.where} cannot be read.", [Problem(where, what, short(version), allowed, remedy)])


def numbered(document: dict[str, Any], version: int) -> Operation:
    """The operation that names a version; where none stood it comes first."""
    if "version" in document:
        return operation("replace", ["version"], value=version)
    return operation("add", ["version"], value=version, layout=Layout(source=f"version: {version}\n", after=None))


def weather(document: dict[str, Any]) -> tuple[list[Operation], list[str]]:
    """1 to 2: what `road` held stands with the weather and with the changes, where it can begin and end."""
    road = document.get("road")
    if not isinstance(road, dict) or not road.keys() <= {"friction", "patches"}:
        return [], []
    patch, told = friction(document, road)
    more, said = patches(document, road)
    return [*patch, *more, operation("remove", ["road"])], [*told, *said, "`road`, which is empty now, is left out"]


def friction(document: dict[str, Any], road: dict[str, Any]) -> tuple[list[Operation], list[str]]:
    """The friction of all roads is the weather's."""
    if "friction" not in road:
        return [], []
    value = road["friction"]
    if "weather" in document:
        return [operation("add", ["weather", "friction"], value=value)], ["`road.friction` is `weather.friction`"]
    return [operation("add", ["weather"], value={"friction": value})], ["`road.friction` is `weather.friction`"]


def patches(document: dict[str, Any], road: dict[str, Any]) -> tuple[list[Operation], list[str]]:
    """A slippery stretch is a change of the kind friction, from the beginning to the end."""
    found, taken = road.get("patches"), document.get("changes") or {}
    if not isinstance(found, dict) or not found:
        return [], []
    names = {name: free(name, {*taken} | ({*found} if name in taken else set())) for name in found}
    made = {names[name]: {"do": {"change": "friction"} | stretch} for name, stretch in found.items() if isinstance(stretch, dict)}
    told = [f"`road.patches.{name}` is `changes.{names[name]}`, a change of the kind friction" for name in found]
    if "changes" not in document:
        return [operation("add", ["changes"], value=made)], told
    return [operation("add", ["changes", name], value=each) for name, each in made.items()], told


def free(name: str, taken: set[str]) -> str:
    """The name, with a number behind it when it is taken."""
    tried, number = name, 1
    while tried in taken:
        number += 1
        tried = f"{name}_{number}"
    return tried


MIGRATIONS: dict[int, Migration] = {1: weather}
