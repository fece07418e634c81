"""Old files: read as the present version, told what is another way now, and nothing is lost."""

from pathlib import Path

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
version: 3
title: Old

seed: 1  # keep
weather: {friction: 0.7}
script:
  leaves:
    do: {kind: friction, route: a, start: 10, end: 20, friction: 0.4}
"""
SECOND = """\
version: 2  # of the format
title: Second

triggers:
  # the leader brakes
  stop: {time: 20, vehicle: leader, do: {maneuver: brake, deceleration: 6, to_speed: 3}}
  works: {time: 5, vehicle: b}
seed: 1  # keep
changes:
  works:
    start: {vehicle: leader, along: 600}
    end: {time: 90}
    do: {change: close_lane, road: "7", lane: 1, start: 10, end: 20}
  row:
    end: {vehicle: b, along: 30}
    do: {change: objects, kind: barriers, route: a, start: 1, end: 2}
"""
SCRIPT = {
    "stop": {"when": {"kind": "time", "at": 20}, "do": {"kind": "brake", "vehicle": "leader", "deceleration": 6, "to_speed": 3}},
    "works": {"when": {"kind": "time", "at": 5}, "do": {"kind": "brake", "vehicle": "b"}},
    "works_2": {
        "when": {"kind": "passed", "vehicle": "leader", "along": 600},
        "until": {"kind": "time", "at": 90},
        "do": {"kind": "close_lane", "road": "7", "lane": 1, "start": 10, "end": 20},
    },
    "row": {
        "until": {"kind": "passed", "vehicle": "b", "along": 30},
        "do": {"kind": "objects", "what": "barriers", "route": "a", "start": 1, "end": 2},
    },
}


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
    assert [each.partition(":")[0] for each in told] == ["version 1 to 2"] * 3 + ["version 2 to 3"]
    assert "`road.friction` is `weather.friction`" in told[0] and "`road.patches.leaves` is `changes.leaves`" in told[1]


def test_a_file_of_the_second_version():
    """Triggers and changes are one script; names that were taken twice have a number, everything else stays as it is."""
    text, told = migrated(SECOND)
    found = source.read(text, "my.yaml").value
    assert found["script"] == SCRIPT and found.keys() == {"version", "title", "seed", "script"}
    assert text.startswith("version: 3  # of the format\ntitle: Second\n") and "seed: 1  # keep\n" in text
    assert [each.partition(": ")[2] for each in told] == [
        "`triggers.stop` is `script.stop`, an action of the kind brake",
        "`triggers.works` is `script.works`, an action of the kind brake",
        "`changes.works` is `script.works_2`, an action of the kind close_lane",
        "`changes.row` is `script.row`, an action of the kind objects",
    ]


def test_what_is_new_already_stays_as_it_is():
    text, told = migrated(f"version: {VERSION} # x\nroad: {{}}\n")
    assert text == f"version: {VERSION} # x\nroad: {{}}\n" and told == []


@pytest.mark.parametrize("version", [1, 2])
def test_only_the_number_changes_where_nothing_was_moved(version):
    assert migrated(f"# a\nversion: {version}  # old\nseed: 2\n") == (f"# a\nversion: {VERSION}  # old\nseed: 2\n", [])


def test_names_that_are_taken_get_a_number():
    changes = "changes: {ice: {do: {change: limit}}, ice_2: {do: {change: limit}}}"
    text, _ = migrated(f"road: {{patches: {{ice: {{friction: 0.1}}}}}}\n{changes}\nweather: {{visibility: 100}}\n")
    found = source.read(text, "my.yaml").value
    limit = {"do": {"kind": "limit"}}
    assert found["script"] == {"ice": limit, "ice_2": limit, "ice_3": {"do": {"kind": "friction", "friction": 0.1}}}
    assert found["weather"] == {"visibility": 100}


@pytest.mark.parametrize(
    ("version", "words"),
    [
        ("99", ["line 1, column 1: version", "newer than this studio", "got 99", f"1 to {VERSION}", "update the studio"]),
        ("0", ["no version of the format", "got 0", f"write version: {VERSION}"]),
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
    old = (Path(__file__).parent / "version_2.yaml").read_text().replace("version: 2\n", "")
    path.write_text(old + "\nroad: {friction: 0.5, patches: {ice: {route: east_to_west, start: 10, end: 20, friction: 0.1}}}\n")
    loaded = job.load(path)
    assert loaded.scenario.version == VERSION and len(loaded.migrated) >= 5
    assert loaded.scenario.weather.friction == 0.5 and loaded.scenario.script["ice"].do.friction == 0.1
    assert loaded.scenario.script["hard_brake"].do.deceleration == 6
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


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("triggers: 3\n", "my.yaml, line 2, column 1: triggers: is no section (got 3)"),
        ("triggers: {a: 3}\n", "triggers.a: is no entry (got 3); allowed: time, vehicle, do"),
        ("triggers: {a: {time: 3, vehicel: b}}\n", "my.yaml, line 2, column 25: triggers.a.vehicel: is no field of version 2"),
        (
            "triggers: {a: {time: 3, do: {maneuver: swerve}}}\n",
            "triggers.a.do.maneuver: is none of version 2 (got 'swerve'); allowed: brake",
        ),
        ("triggers: {a: {time: 3, do: {kind: brake}}}\n", "triggers.a.do.kind: is no field of version 2"),
        ("changes: {a: {when: {time: 3}}}\n", "changes.a.when: is no field of version 2; allowed: start, end, do"),
        ("changes: {a: {start: {time: 3}}}\n", "changes.a: has no `do`"),
        ("changes: {a: {do: {change: ice}}}\n", "changes.a.do.change: is none of version 2 (got 'ice'); allowed: limit"),
        ("changes: {a: {start: {vehicle: b}, do: {change: limit}}}\n", "changes.a.start: is no moment of version 2"),
        ("changes: {a: {end: {time: 3, vehicle: b}, do: {change: limit}}}\n", "changes.a.end: is no moment of version 2"),
        ("script: {}\ntriggers: {}\n", "script: is no field of version 2; write version: 3"),
    ],
)
def test_what_the_second_version_did_not_know_is_refused(text, says):
    assert says in refusal(f"version: 2\n{text}")


def test_an_empty_section_holds_nothing_up():
    assert migrated("title: a\nroad:\n")[0] == f"version: {VERSION}\ntitle: a\n"
    assert migrated("version: 2\ntriggers:\ntitle: a\nchanges: {}\n")[0] == f"version: {VERSION}\ntitle: a\n"
    text, _ = migrated("road: {friction: 0.7}\nweather:\nchanges:\n")
    assert source.read(text, "my.yaml").value == {"version": VERSION, "weather": {"friction": 0.7}}
