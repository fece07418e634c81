"""Old scenario files: each version becomes the next by a patch, which leaves alone what it does not mean, and says what has changed.

    source, told = migrated(source)

A version n to n + 1 is one function in MIGRATIONS: it gets the source, and returns its patch and a sentence for each change. What
moves is written anew, without its comments; what version n did not know is refused, so that nothing is lost.
"""

from collections.abc import Callable, Iterator
from typing import Any

from studio.errors import Problem, ScenarioError
from studio.scenario.finding import short
from studio.scenario.schema import VERSION
from studio.scenario.text.document import applied
from studio.scenario.text.patch import Layout, Operation, operation
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


def section(value: Any) -> Any:
    """A section of a file; one that was left empty holds nothing."""
    return {} if value is None else value


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


def free(name: str, taken: set[str]) -> str:
    """The name, with a number behind it when it is taken."""
    tried, number = name, 1
    while tried in taken:
        number += 1
        tried = f"{name}_{number}"
    return tried


# -- 2 to 3: kinds -------------------------------------------------------------------------------------

ENTRY_FIELDS = {"triggers": ("time", "vehicle", "do"), "changes": ("start", "end", "do")}
CHANGES = ("limit", "friction", "close_lane", "shift_lane", "objects")


def script(now: Source) -> tuple[list[Operation], list[str]]:
    """`triggers` and `changes` were the same thing said twice: when something begins, and what it is."""
    present = [name for name in ENTRY_FIELDS if name in now.value]
    if not present:
        return [], []
    problems = [each for name in present for each in strange(now, name)]
    if "script" in now.value:
        problems.append(Problem(now.told("script"), "is no field of version 2", remedy=f"write version: {VERSION}"))
    if problems:
        raise ScenarioError(f"{now.where} cannot be read as version 2.", problems)
    made, told = {}, []
    for part in present:
        for name, entry in section(now.value[part]).items():
            new = free(name, {*made})
            made[new] = maneuvering(entry) if part == "triggers" else changing(entry)
            told.append(f"`{part}.{name}` is `script.{new}`, an action of the kind {made[new]['do']['kind']}")
    added = [operation("add", ["script"], value=made)] if made else []
    return [*added, *(operation("remove", [part]) for part in present)], told


def strange(now: Source, part: str) -> Iterator[Problem]:
    """What version 2 did not have in `triggers` or `changes`."""
    entries = section(now.value[part])
    if not isinstance(entries, dict):
        yield Problem(now.told(part), "is no section", short(entries), "a name for each entry")
        return
    for name, entry in entries.items():
        yield from strange_entry(now, part, name, entry)


def strange_entry(now: Source, part: str, name: str, entry: Any) -> Iterator[Problem]:
    """What version 2 did not have in one of them."""
    at, allowed = f"{part}.{name}", ", ".join(ENTRY_FIELDS[part])
    if not isinstance(entry, dict):
        yield Problem(now.told(at), "is no entry", short(entry), allowed)
        return
    for field in entry.keys() - set(ENTRY_FIELDS[part]):
        yield Problem(now.told(f"{at}.{field}"), "is no field of version 2", allowed=allowed)
    for field in {"start", "end"} & entry.keys():
        yield from strange_moment(now, f"{at}.{field}", entry[field])
    yield from strange_action(now, f"{at}.do", part, entry.get("do", {} if part == "triggers" else None))


def strange_moment(now: Source, at: str, moment: Any) -> Iterator[Problem]:
    """A moment was a time, or a vehicle with a station."""
    given = {key for key, value in moment.items() if value is not None} if isinstance(moment, dict) else set()
    if given not in ({"time"}, {"vehicle", "along"}):
        yield Problem(now.told(at), "is no moment of version 2", short(moment), "time, or vehicle with along")


def strange_action(now: Source, at: str, part: str, do: Any) -> Iterator[Problem]:
    """What was done had a name."""
    tag, kinds = ("maneuver", ("brake",)) if part == "triggers" else ("change", CHANGES)
    if do is None:
        yield Problem(now.told(at.removesuffix(".do")), "has no `do`", allowed=f"{tag} and its fields")
    elif not isinstance(do, dict):
        yield Problem(now.told(at), "is no action", short(do), f"{tag} and its fields")
    elif do.get(tag, "brake") not in kinds:
        yield Problem(now.told(f"{at}.{tag}"), "is none of version 2", short(do.get(tag)), ", ".join(kinds))
    elif "kind" in do and do.get(tag) != "objects":
        yield Problem(now.told(f"{at}.kind"), "is no field of version 2", short(do["kind"]))


def maneuvering(trigger: dict[str, Any]) -> dict[str, Any]:
    """A trigger as an entry of the script; what it lacks is told when the entry is checked."""
    when = {"kind": "time"} | ({"at": trigger["time"]} if "time" in trigger else {})
    do = {key: value for key, value in (trigger.get("do") or {}).items() if key != "maneuver"}
    vehicle = {"vehicle": trigger["vehicle"]} if "vehicle" in trigger else {}
    return {"when": when, "do": {"kind": "brake"} | vehicle | do}


def changing(change: dict[str, Any]) -> dict[str, Any]:
    """A change of the road as an entry of the script."""
    turns = {"when": change.get("start"), "until": change.get("end")}
    do = {"what" if key == "kind" else key: value for key, value in change["do"].items() if key != "change"}
    return {key: waiting(moment) for key, moment in turns.items() if moment} | {"do": {"kind": change["do"]["change"]} | do}


def waiting(moment: dict[str, Any]) -> dict[str, Any]:
    """A moment as a condition."""
    if moment.get("time") is not None:
        return {"kind": "time", "at": moment["time"]}
    return {"kind": "passed", "vehicle": moment["vehicle"], "along": moment["along"]}


# Each part of the change is a function of its own; their patches are about different sections.
DOORS: tuple[Migration, ...] = (script,)


def doors(now: Source) -> tuple[list[Operation], list[str]]:
    """2 to 3: what can be replaced names its kind."""
    found = [part(now) for part in DOORS]
    return [each for patch, _ in found for each in patch], [each for _, told in found for each in told]


MIGRATIONS: dict[int, Migration] = {1: weather, 2: doors}
