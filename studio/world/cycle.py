"""Cycles: entries of the script that wait for each other, so that none of them ever begins.

circles(scenario, where)   →  one Problem for each
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

from studio.errors import Problem
from studio.kind.settings import inner, named
from studio.scenario.schema import Scenario


class Turn(NamedTuple):
    """The beginning or the end of an entry."""

    entry: str
    ends: bool


def circles(scenario: Scenario, where: str) -> list[Problem]:
    """Every cycle once, told at its first entry in the order of the file."""
    waits = {Turn(name, ends): sorted(awaited(name, ends, scenario)) for name in scenario.script for ends in (False, True)}
    found, told = [], set()
    for turn in waits:
        way = round_trip(turn, waits)
        if way and not told & set(way):
            told |= set(way)
            names = " → ".join(f"{each.entry} {'ends' if each.ends else 'begins'}" for each in [*way, turn])
            field = "until" if turn.ends else "when"
            what = "waits for itself, so that it never comes"
            found.append(Problem(f"{where}: script.{turn.entry}.{field}", what, names, remedy="let one of them wait for something else"))
    return found


def awaited(name: str, ends: bool, scenario: Scenario) -> Iterator[Turn]:
    """What a turn of an entry waits for: those that its condition names; and an end waits for the beginning."""
    entry = scenario.script[name]
    if ends:
        yield Turn(name, False)
    part = entry.until if ends else entry.when
    if part is not None:
        yield from (each for each in turns_named(part) if each.entry in scenario.script)


def turns_named(part: Any) -> Iterator[Turn]:
    """The turns that a condition and those in it name; of one that does not say which, the beginning."""
    for name, field in type(part).model_fields.items():
        if named(field) == "entry" and getattr(part, name) is not None:
            yield Turn(getattr(part, name), getattr(part, "turn", "begins") == "ends")
    for _, each in inner(part):
        yield from turns_named(each)


def round_trip(start: Turn, waits: dict[Turn, list[Turn]]) -> list[Turn]:
    """The shortest way from a turn back to it; empty when there is none."""
    ways, seen = [[start]], {start}
    for way in ways:
        for each in waits[way[-1]]:
            if each == start:
                return way
            if each not in seen:
                seen.add(each)
                ways.append([*way, each])
    return []
