"""Old files: read as the present version, told what is another way now, and nothing is lost."""

import pytest

from studio import job
from studio.errors import ScenarioError
from studio.scenario import file
from studio.scenario.schema import VERSION
from studio.scenario.text import migration, source

OLD = """\
# How it was written at first
title: Old

road:  # wet
  friction: 0.70
  patches:
    leaves: {route: a, start: 10, end: 20, friction: 0.4}

seed: 1  # keep
"""
NEW = """\
# How it was written at first
version: 2
title: Old

seed: 1  # keep
weather: {friction: 0.7}
changes:
  leaves:
    do: {change: friction, route: a, start: 10, end: 20, friction: 0.4}
"""


def migrated(text: str) -> tuple[str, list[str]]:
    found, told = migration.migrated(source.read(text, "my.yaml"))
    return found.text, told


def refusal(text: str) -> str:
    with pytest.raises(ScenarioError) as caught:
        migrated(text)
    return str(caught.value)


def test_every_version_has_a_way_to_the_next():
    assert list(migration.MIGRATIONS) == list(range(1, VERSION))


def test_a_file_of_the_first_version():
    text, told = migrated(OLD)
    assert text == NEW
    assert [each.partition(":")[0] for each in told] == ["version 1 to 2"] * 3
    assert "`road.friction` is `weather.friction`" in told[0] and "`road.patches.leaves` is `changes.leaves`" in told[1]


def test_what_is_new_already_stays_as_it_is():
    text, told = migrated("version: 2 # x\nroad: {}\n")
    assert text == "version: 2 # x\nroad: {}\n" and told == []


def test_only_the_number_changes_where_nothing_was_moved():
    assert migrated("# a\nversion: 1  # first\nseed: 2\n") == ("# a\nversion: 2  # first\nseed: 2\n", [])


def test_names_that_are_taken_get_a_number():
    text, _ = migrated("road: {patches: {ice: {friction: 0.1}}}\nchanges: {ice: {}, ice_2: {}}\nweather: {visibility: 100}\n")
    found = source.read(text, "my.yaml").value
    assert found["changes"] == {"ice": {}, "ice_2": {}, "ice_3": {"do": {"change": "friction", "friction": 0.1}}}
    assert found["weather"] == {"visibility": 100}


@pytest.mark.parametrize(
    ("version", "words"),
    [
        ("3", ["line 1, column 1: version", "newer than this studio", "got 3", "1 to 2", "update the studio"]),
        ("0", ["no version of the format", "got 0", "write version: 2"]),
        ("true", ["no version", "True"]),
        ("1.0", ["no version", "1.0"]),
        ("new", ["no version", "'new'"]),
        ("null", ["no version", "None"]),
    ],
)
def test_versions_that_cannot_be_read(version, words):
    told = refusal(f"version: {version}\n")
    for word in words:
        assert word in told


def test_an_old_scenario_runs_as_its_new_form(sample, tmp_path):
    """Read, migrated and rewritten it is the same scenario with the same hash."""
    (tmp_path / "maps").symlink_to(sample.parent / "maps")
    path = tmp_path / "old.yaml"
    old = sample.read_text().replace("version: 2\n", "")
    path.write_text(old + "\nroad: {friction: 0.5, patches: {ice: {route: east_to_west, start: 10, end: 20, friction: 0.1}}}\n")
    loaded = job.load(path)
    assert loaded.scenario.version == VERSION and len(loaded.migrated) == 3
    assert loaded.scenario.weather.friction == 0.5 and loaded.scenario.changes["ice"].do.friction == 0.1
    file.write(path, migration.migrated(loaded.source)[0].text)
    again = job.load(path)
    assert again.migrated == () and again.document == loaded.document
    assert job.scenario_hash(again, job.prepare(again)) == job.scenario_hash(loaded, job.prepare(loaded))


def test_problems_have_the_line_of_the_old_file(tmp_path):
    path = tmp_path / "old.yaml"
    path.write_text(OLD.replace("seed: 1", "sed: 1"))
    with pytest.raises(ScenarioError) as caught:
        job.load(path)
    assert "old.yaml, line 9, column 1: sed: is not a field that exists here; did you mean 'seed'?" in str(caught.value)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("road: {friction: 0.7, slope: 2}\n", "my.yaml, line 1, column 23: road.slope: is no field of version 1"),
        ("road: 3\n", "road: is no section (got 3)"),
        ("road: []\n", "road: is no section"),
        ("road: {fricton: 1}\n", "road.fricton: is no field of version 1; allowed: friction, patches"),
        ("road: {friction: high}\n", "road.friction: is no number"),
        ("road: {patches: {ice: 3}}\n", "road.patches.ice: is no stretch (got 3)"),
        ("road: {patches: 3}\n", "road.patches: is no section"),
        ("road: {friction: 0.7}\nweather: {friction: 0.5}\n", "weather.friction: stands beside road.friction (got 0.5)"),
    ],
)
def test_what_the_first_version_did_not_know_is_refused(text, says):
    assert says in refusal(text)


def test_an_empty_section_holds_nothing_up():
    assert migrated("title: a\nroad:\n")[0] == "version: 2\ntitle: a\n"
    text, _ = migrated("road: {friction: 0.7}\nweather:\nchanges:\n")
    assert source.read(text, "my.yaml").value == {"version": 2, "weather": {"friction": 0.7}, "changes": None}
