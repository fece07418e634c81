"""Version 2 to 3: triggers and changes of the road are one script of kinds."""

from collections.abc import Iterator
from typing import Any

from studio.errors import Problem, ScenarioError, short
from studio.scenario.schema import VERSION
from studio.scenario.text.patch import Operation, operation
from studio.scenario.text.section import free, section
from studio.scenario.text.source import Source

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
