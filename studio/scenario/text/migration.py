"""Old scenario files: each version becomes the next by a patch, which leaves alone what it does not mean, and says what has changed.

    source, told = migrated(source)

A version n to n + 1 is one function in MIGRATIONS: it gets the source, and returns its patch and a sentence for each change. What
moves is written anew, without its comments; what version n did not know is refused, so that nothing is lost.
"""

from collections.abc import Callable, Iterator
from typing import Any

from studio.errors import Problem, ScenarioError, short
from studio.scenario.schema import VERSION
from studio.scenario.text import doors as part
from studio.scenario.text import script
from studio.scenario.text.document import applied
from studio.scenario.text.patch import Layout, Operation, operation
from studio.scenario.text.section import free, section
from studio.scenario.text.source import Source

Migration = Callable[[Source], tuple[list[Operation], list[str]]]


def migrated(given: Source) -> tuple[Source, list[str]]:
    """A scenario as the present version has it, and what was changed for that.

    Raises:
        ScenarioError: a version to come, or what the file's own version did not know.
    """
    version, now, told = version_of(given), given, []
    for number in range(version, VERSION):
        patch, sentences = MIGRATIONS[number](now)
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


def weather(now: Source) -> tuple[list[Operation], list[str]]:
    """1 to 2: what `road` held stands with the weather and with the changes, where it can begin and end."""
    if "road" not in now.value:
        return [], []
    problems = [*unknown(now), *doubled(now)]
    if problems:
        raise ScenarioError(f"{now.where} cannot be read as version 1.", problems)
    road = section(now.value["road"])
    patch, told = friction(now.value, road)
    more, said = patches(now.value, road)
    return [*patch, *more, operation("remove", ["road"])], [*told, *said, "`road`, which is empty now, is left out"]


def unknown(now: Source) -> Iterator[Problem]:
    """What version 1 did not have in `road`."""
    road = section(now.value["road"])
    if not isinstance(road, dict):
        yield Problem(now.told("road"), "is no section", short(road), "friction, patches")
        return
    for name in road.keys() - {"friction", "patches"}:
        yield Problem(now.told(f"road.{name}"), "is no field of version 1", allowed="friction, patches")
    value, stretches = road.get("friction", 1.0), section(road.get("patches"))
    if isinstance(value, bool) or not isinstance(value, int | float):
        yield Problem(now.told("road.friction"), "is no number", short(value))
    if not isinstance(stretches, dict):
        yield Problem(now.told("road.patches"), "is no section", short(stretches), "a name for each stretch")
        return
    for name, stretch in stretches.items():
        if not isinstance(stretch, dict):
            yield Problem(now.told(f"road.patches.{name}"), "is no stretch", short(stretch), "route, start, end, friction")


def doubled(now: Source) -> Iterator[Problem]:
    """A friction that stands in both places: one of the two would be lost."""
    road, beside = now.value["road"], now.value.get("weather")
    if isinstance(road, dict) and "friction" in road and isinstance(beside, dict) and "friction" in beside:
        yield Problem(now.told("weather.friction"), "stands beside road.friction", short(beside["friction"]), remedy="keep one of them")


def friction(document: dict[str, Any], road: dict[str, Any]) -> tuple[list[Operation], list[str]]:
    """The friction of all roads is the weather's."""
    if "friction" not in road:
        return [], []
    value = road["friction"]
    if isinstance(document.get("weather"), dict):
        return [operation("add", ["weather", "friction"], value=value)], ["`road.friction` is `weather.friction`"]
    return [operation("add", ["weather"], value={"friction": value})], ["`road.friction` is `weather.friction`"]


def patches(document: dict[str, Any], road: dict[str, Any]) -> tuple[list[Operation], list[str]]:
    """A slippery stretch is a change of the kind friction, from the beginning to the end."""
    found, taken = section(road.get("patches")), document.get("changes") or {}
    if not found:
        return [], []
    names = {name: free(name, {*taken} | ({*found} if name in taken else set())) for name in found}
    made = {names[name]: {"do": {"change": "friction"} | stretch} for name, stretch in found.items()}
    told = [f"`road.patches.{name}` is `changes.{names[name]}`, a change of the kind friction" for name in found]
    if not isinstance(document.get("changes"), dict):
        return [operation("add", ["changes"], value=made)], told
    return [operation("add", ["changes", name], value=each) for name, each in made.items()], told


# Version 3 names kinds. Each part of the change is a function of its own; their patches are about different sections.
DOORS: tuple[Migration, ...] = (part.sensors, part.units, part.messages, part.channels, script.script)


def doors(now: Source) -> tuple[list[Operation], list[str]]:
    """2 to 3: what can be replaced names its kind."""
    found = [each(now) for each in DOORS]
    return [each for patch, _ in found for each in patch], [each for _, told in found for each in told]


MIGRATIONS: dict[int, Migration] = {1: weather, 2: doors}
