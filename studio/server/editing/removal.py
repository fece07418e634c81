"""What goes along when something is taken out of a scenario, so that nothing names it any more.

A unit of a group goes out of its list; who has listened to it listens to whom it listened to: a platoon closes its gap. An entry of the
script that is about what is gone goes too, and what is about that entry. The last unit takes its group along. Vehicles do not go with
their route: that is refused when the result is checked.
"""

from collections.abc import Iterator
from typing import Any

from studio.kind.settings import references
from studio.scenario.schema import Application, Scenario
from studio.scenario.text import pointer
from studio.scenario.text.patch import Operation, operation

NAMED = {
    "routes": {"route"},
    "vehicles": {"vehicle", "unit", "body"},
    "stations": {"unit"},
    "script": {"entry", "body"},
    "applications": {"application"},
}
Path = tuple[str, ...]


def removal(scenario: Scenario, given: dict[str, Any], wanted: list[Path]) -> list[Operation]:
    """The patch that takes things out of a document, and all that is about them."""
    gone = closure(scenario, wanted)
    tops = {path for path in gone if not any(path[:depth] in gone for depth in range(1, len(path)))}
    kept = [path for path in sorted(tops, key=backwards, reverse=True) if is_given(given, path)]
    return [*rewired(scenario, gone), *(operation("remove", path) for path in kept)]


def renaming(scenario: Scenario, given: dict[str, Any], names: dict[Path, str]) -> list[Operation]:
    """The patch that gives things other names, also wherever they are named."""
    moves = [operation("move", [path[0], name], **{"from": pointer.joined(path)}) for path, name in names.items() if path[-1] != name]
    return [each for path, name in names.items() for each in mentioned(scenario, given, path, name)] + moves


def mentioned(scenario: Scenario, given: dict[str, Any], path: Path, name: str) -> list[Operation]:
    """Whoever names a thing names it anew."""
    sorts = NAMED.get(path[0], set())
    places = [tuple(each.path.split(".")) for each in references(scenario) if each.what in sorts and each.name == path[-1]]
    return [operation("replace", place, value=name) for place in places if is_given(given, place)]


def closure(scenario: Scenario, wanted: list[Path]) -> set[Path]:
    """All places that go when these do."""
    gone, fresh = set(wanted), set(wanted)
    while fresh:
        fresh = (set().union(*(about(scenario, path, gone) for path in gone)) | emptied(scenario, gone)) - gone
        gone |= fresh
    return gone


def about(scenario: Scenario, path: Path, gone: set[Path]) -> set[Path]:
    """The places that name what stands at a path, as far as they go when it does."""
    sorts = NAMED.get(path[0], set()) if len(path) == 2 else set()
    named = [each.path.split(".") for each in references(scenario) if each.what in sorts and each.name == path[1]]
    return {place for each in named for place in goes(scenario, each, gone)}


def goes(scenario: Scenario, place: list[str], gone: set[Path]) -> list[Path]:
    """What goes when the name at a place does: an entry of the script, or a unit of a group with whom it listens to.

    A unit stays that has others to listen to, or can listen to whom the one that is gone has listened to.
    """
    match place:
        case ["script", entry, *_]:
            return [("script", entry)]
        case ["applications", group, "listens_to", number, *_] if hears_on(scenario.applications[group], int(number), gone):
            return []
        case ["applications", group, "units" | "listens_to", number, *_]:
            listens = [("applications", group, "listens_to", number)] if scenario.applications[group].listens_to else []
            return [("applications", group, "units", number), *listens]
    return []


def names_gone(gone: set[Path]) -> set[str]:
    """The units that go."""
    return {path[1] for path in gone if len(path) == 2 and path[0] in ("vehicles", "stations")}


def hears_on(group: Application, number: int, gone: set[Path]) -> list[str]:
    """Whom a unit of a group listens to when others are gone: in the place of one that is gone those that this one has listened to."""
    found: list[str] = []
    waiting, seen, lost = list(group.senders(number)), {group.units[number]}, names_gone(gone)
    while waiting:
        name = waiting.pop(0)
        if name in lost and name in group.units and name not in seen:
            waiting += group.senders(group.units.index(name))
        elif name not in lost and name not in seen:
            found.append(name)
        seen.add(name)
    return found


def rewired(scenario: Scenario, gone: set[Path]) -> Iterator[Operation]:
    """What is changed of whom the units listen to that stay."""
    for name, group in scenario.applications.items():
        for i, before in enumerate(group.listens_to):
            at = ("applications", name, "listens_to", str(i))
            if at in gone or at[:2] in gone or not names_gone(gone) & set(group.senders(i)):
                continue
            after = hears_on(group, i, gone)
            yield operation("replace", at, value=after[0] if isinstance(before, str) else after)


def emptied(scenario: Scenario, gone: set[Path]) -> set[Path]:
    """Groups of which every unit goes."""
    return {
        ("applications", name)
        for name, group in scenario.applications.items()
        if all(("applications", name, "units", str(i)) in gone for i in range(len(group.units)))
    }


def backwards(path: Path) -> tuple:
    """The last entries of a list first: the numbers of the others stay."""
    return tuple((1, int(part), "") if part.isdecimal() else (0, 0, part) for part in path)


def is_given(given: Any, path: Path) -> bool:
    """Whether a place stands in the file."""
    for part in path:
        if isinstance(given, dict) and part in given:
            given = given[part]
        elif isinstance(given, list) and pointer.INDEX.fullmatch(part) and int(part) < len(given):
            given = given[int(part)]
        else:
            return False
    return True
