"""Slips that people make in scenario files by hand: each is told with its line, the value, what is allowed and what to write."""

import pytest

from studio import job
from studio.errors import ScenarioError
from studio.road.drawn.motorway import motorway

BASE = """\
version: 3
title: two cars
map: {file: motorway.xodr}
clock: {duration: 2}
routes:
  way: {roads: [motorway]}
vehicles:
  a: {route: way, position: {along: 100}, speed: 15}
  b: {route: way, position: {along: 200}, speed: 15}
"""


@pytest.fixture(scope="module")
def loaded(tmp_path_factory):
    """Loads a text as the scenario of a folder with a map."""
    folder = tmp_path_factory.mktemp("slips")
    (folder / "motorway.xodr").write_text(motorway(length=600.0, lanes=2), encoding="utf-8")

    def load(text):
        (folder / "two.yaml").write_bytes(text if isinstance(text, bytes) else text.encode())
        return job.load(folder / "two.yaml")

    return load


def with_(old, new):
    assert old in BASE
    return BASE.replace(old, new, 1)


SLIPS = {
    "a unit behind the number": (with_("speed: 15", "speed: 15 m/s"), "line 8", "vehicles.a.speed", "number alone; its unit is m/s"),
    "another unit": (
        with_("speed: 15", "speed: 54 km/h"),
        "line 8",
        "vehicles.a.speed",
        "is text (got '54 km/h'); allowed: a number",
    ),
    "a unit without a gap": (with_("duration: 2", "duration: 2s"), "line 4", "clock.duration", "write the number alone; its unit is s"),
    "a comma": (with_("speed: 15", "speed: '15,5'"), "line 8", "vehicles.a.speed", "write 15.5, with a point"),
    "a list as a comma": (with_("duration: 2", "duration: '2'"), "line 4", "clock.duration", "write it without quotes"),
    "lane beside along": (with_("along: 100", "along: 100, lane: 1"), "line 8", "vehicles.a.position", "`lane` would count for nothing"),
    "a name twice": (with_("  b: {", "  a: {"), "line 9", "", "the key 'a' stands twice; it stands in line 8 already"),
    "a name with a dot": (with_("  a: {", "  a.b: {"), "line 7", "vehicles.a.b", "is no name (got 'a.b'); allowed: a letter, then letters"),
    "a number as a name": (with_("  a: {", "  1: {"), "line 8", "vehicles.1", "is no name"),
    "a number as a title": (with_("two cars", "3"), "line 2", "title", "write it in quotes"),
    "a section left empty": (
        f"{BASE}applications:\n",
        "line 10",
        "applications",
        "is empty; allowed: a mapping; fill it, write {}",
    ),
    "a list of vehicles": (f"{BASE.split('vehicles:')[0]}vehicles:\n  - {{route: way}}\n", "line 7", "vehicles", "is no mapping"),
    "an alias before its anchor": (with_("a: {route", "a: *b\n  c: {route"), "line 8", "", "stands before its anchor, or has none"),
    "a merge of itself": (with_("b: {route: way", "b: &q {<<: *q, route: way"), "line 9", "", "the alias *q holds itself"),
    "a tab": (with_("  way", "\tway"), "line 6", "", "a line begins with a tab; indent with spaces"),
    "a million cars": (f"{BASE}traffic: {{count: 1000000}}\n", "line 10", "traffic.count", "allowed: ≤ 3000"),
    "a date": (with_("two cars", "2026-11-30"), "line 2", "", "'2026-11-30' in quotes"),
    "a time": (with_("duration: 2", "duration: 1:30"), "line 4", "", "means different things in YAML 1.1 and 1.2"),
    "on": (f"{BASE}recording: {{traffic: on}}\n", "line 10", "", "write true, or 'on' in quotes"),
    "yes": (f"{BASE}recording: {{traffic: yes}}\n", "line 10", "", "write true, or 'yes' in quotes"),
    "two documents": (f"{BASE}---\n{BASE}", "line 10", "", "a second document begins"),
    "latin-1": (BASE.replace("two cars", "zwei große").encode("latin-1"), "line 2", "", "save the file as UTF-8"),
}


@pytest.mark.parametrize("case", SLIPS)
def test_a_slip_is_told_with_what_to_write(case, loaded):
    text, line, field, words = SLIPS[case]
    with pytest.raises(ScenarioError) as told:
        loaded(text)
    assert line in str(told.value) and field in str(told.value) and words in str(told.value)


@pytest.mark.parametrize("text", ["", "# nothing\n", "null\n", "- a\n", "3\n"])
def test_a_file_without_a_scenario_is_told(text, loaded):
    with pytest.raises(ScenarioError, match="allowed: a YAML mapping"):
        loaded(text)


@pytest.mark.parametrize(
    "text",
    [
        with_("  b: {route: way, position: {along: 200}, speed: 15}", "  b: {<<: *x, position: {along: 200}}").replace("a: {", "a: &x {"),
        with_("speed: 15", "speed: !!int '15'"),
        with_("along: 100", "along: 0x64"),
        with_("title: two", "title:\ttwo"),
        BASE.replace("\n", "\r\n"),
        f"\ufeff{BASE}",
    ],
    ids=["anchor and merge", "tag", "hexadecimal", "tab before a value", "line ends of Windows", "byte order mark"],
)
def test_what_is_unusual_and_clear_is_taken(text, loaded):
    vehicles = loaded(text).scenario.vehicles
    assert {name: (each.position.along, each.speed) for name, each in vehicles.items()} == {"a": (100.0, 15.0), "b": (200.0, 15.0)}
