"""The life of scenario files over REST: made, copied, taken in, renamed, deleted, brought back; what is refused loses nothing."""

import json
import os
import resource
import signal
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from studio.errors import MapError
from studio.server.scenarios import template
from tests.patience import until
from tests.server.server import served

ID = "grosser_stern_platoon"
LONGER = {"clock.duration": 70}


@pytest.fixture
def folder(server, sample):
    """The folder of scenarios as it was at the beginning."""
    folder = server[1].parent / "scenarios"
    before = {path.name for path in folder.iterdir()}
    yield folder
    for path in folder.iterdir():
        if path.name == "trash":
            for each in path.iterdir():
                each.unlink()
            path.rmdir()
        elif path.name not in before:
            path.unlink()
    (folder / f"{ID}.yaml").unlink(missing_ok=True)
    (folder / f"{ID}.yaml").write_bytes(sample.read_bytes())


def held(folder) -> dict[str, bytes]:
    """All files of the folder, and of its trash."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*.yaml")}


def tag(client, scenario=ID) -> str:
    return client.get(f"/api/scenarios/{scenario}/text").headers["ETag"]


def row(client, scenario=ID) -> dict:
    return next(each for each in client.get("/api/scenarios").json() if each["id"] == scenario)


def refused(answer, status, *words):
    """A refusal in the one form that there is."""
    assert answer.status_code == status, answer.text
    told = answer.json()
    assert set(told) == {"message", "problems"} and told["problems"]
    for word in words:
        assert word in json.dumps(told, ensure_ascii=False), told


# -- the list ----------------------------------------------------------------------------------------


def test_the_list_tells_of_every_file(client, folder):
    found = row(client)
    assert (found["file"], found["map"]) == (f"{ID}.yaml", "maps/berlin_siegessaeule_grosser_stern.osm.gz")
    assert f'"{found["digest"]}"' == tag(client) and found["changed"].endswith("+00:00")
    assert found["sealed"] is False and found["runs"] == 0 and found["problem"] is None
    assert "clok" in row(client, "bad")["problem"] and row(client, "bad")["digest"]


def test_what_cannot_be_read_is_told_too(client, folder):
    (folder / "away.yaml").symlink_to(folder / "nowhere.yaml")
    (folder / "locked.yaml").write_text("title: x\n")
    (folder / "locked.yaml").chmod(0o444)
    assert row(client, "away")["sealed"] and row(client, "away")["problem"] and row(client, "away")["digest"] == ""
    assert row(client, "locked")["sealed"]


# -- new ---------------------------------------------------------------------------------------------


def test_every_template_gives_a_scenario_that_can_be_run(client, folder):
    known = client.get("/api/templates").json()
    assert len(known) >= 5 and all(each["title"] and each["description"] for each in known)
    for place in ("urban_grid.osm", "motorway.xodr"):
        for each in known:
            asked = {"name": f"{each['name']} on {place}", "template": each["name"], "map": place}
            made = client.post("/api/scenarios", json=asked)
            assert made.status_code == 201, made.text
            detail = client.get(f"/api/scenarios/{made.json()['scenario']}")
            assert detail.status_code == 200, detail.text
            assert row(client, made.json()["scenario"])["problem"] is None


def test_a_new_one_has_the_title_that_it_is_given(client, folder):
    made = client.post("/api/scenarios", json={"name": "Mein Weg", "title": "Über die Brücke", "map": "motorway.xodr"})
    assert made.json()["scenario"] == "Mein Weg" and row(client, "Mein Weg")["title"] == "Über die Brücke"
    assert made.json()["digest"] == row(client, "Mein Weg")["digest"]


NAMES = [
    ("", "is empty"),
    (" .yaml", "is empty"),
    ("..", "leads to another folder"),
    ("../away", "leads to another folder"),
    ("/etc/passwd", "leads to another folder"),
    ("C:\\away", "leads to another folder"),
    ("maps/x", "leads to another folder"),
    (".hidden", "dot"),
    ("ends.", "dot"),
    ("a:b", "':'"),
    ("a\nb", "\\\\n"),
    ("a\0b", "\\\\x00"),
    ("a\u202eb", "202e"),
    ("what?", "'?'"),
    ("CON", "Windows"),
    ("lpt1.yaml", "Windows"),
    ("x" * 81, "too long"),
    ("東" * 70, "too long"),
    (ID, "is taken"),
    (ID.upper(), "is taken"),
    (f"{ID}.yaml", "is taken"),
]


@pytest.mark.parametrize(("name", "words"), NAMES)
def test_names_that_no_file_may_have(client, folder, name, words):
    """By whichever way a name comes; nothing is written."""
    before, status = held(folder), 409 if words == "is taken" else 422
    text = (folder / f"{ID}.yaml").read_bytes()
    refused(client.post("/api/scenarios", json={"name": name, "map": "motorway.xodr"}), status, words)
    refused(client.post(f"/api/scenarios/{ID}/copy", json={"name": name}), status, words)
    refused(client.post("/api/scenarios/import", params={"name": name}, content=text), status, words)
    if ID not in name.lower():
        refused(client.post(f"/api/scenarios/{ID}/rename", json={"name": name}), status, words)
    assert held(folder) == before


def test_what_is_there_already_is_suggested_otherwise(client, folder):
    refused(client.post(f"/api/scenarios/{ID}/copy", json={"name": ID}), 409, f"such as {ID}_2")


def test_a_name_of_half_characters(client, folder):
    broken = client.post(f"/api/scenarios/{ID}/copy", content=b'{"name": "\\ud800"}', headers={"Content-Type": "application/json"})
    assert broken.status_code == 422


def test_templates_and_maps_that_are_not_there(client, folder):
    before = held(folder)
    refused(client.post("/api/scenarios", json={"name": "x", "map": "nowhere.osm"}), 404, "map")
    refused(client.post("/api/scenarios", json={"name": "x", "map": "../maps/motorway.xodr"}), 404, "map")
    refused(client.post("/api/scenarios", json={"name": "x", "map": "motorway.xodr", "template": "plato"}), 404, "did you mean 'platoon'")
    assert held(folder) == before


def test_a_template_needs_a_way():
    """Five cars one behind the other do not stand on a road of 100 m."""
    way: Any = SimpleNamespace(length=100.0, start=5.0, speed=13.9)
    for laid in (template.platoon, template.stepping_out):
        with pytest.raises(MapError, match="does not fit on this map") as told:
            laid({"vehicles": {}}, way)
        assert told.value.problems[0].what == "has no way that is long enough"


# -- copies ------------------------------------------------------------------------------------------


def test_a_copy_is_the_same_to_the_letter(client, folder, sample):
    made = client.post(f"/api/scenarios/{ID}/copy", json={"name": "another"})
    assert made.status_code == 201 and (folder / "another.yaml").read_bytes() == sample.read_bytes()


def test_a_form_is_saved_as_another_file(client, folder, sample):
    """With its comments; the old one stays as it was."""
    asked = {"name": "longer", "title": "Longer", "set": LONGER | {"radio.loss": 0.2, "applications.platoon.application": "acc"}}
    made = client.post(f"/api/scenarios/{ID}/copy", json=asked)
    assert made.status_code == 201, made.text
    text = (folder / "longer.yaml").read_text()
    assert "title: Longer" in text and "duration: 70" in text and "# CACC sees neither lights" in text and "application: acc" in text
    assert (folder / f"{ID}.yaml").read_bytes() == sample.read_bytes()
    document = client.get("/api/scenarios/longer").json()["document"]
    assert document["radio"]["loss"] == 0.2 and document["clock"]["duration"] == 70


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"clock.duration": -1}, ["clock.duration", "> 0"]),
        ({"clok": 1}, ["clok"]),
        ({"map.file": "../../etc/passwd"}, ["map.file", "leads out"]),
        ({"vehicles.leader.route": "nope"}, ["names no route"]),
    ],
)
def test_a_form_that_is_no_scenario_is_not_saved(client, folder, changes, words):
    before = held(folder)
    refused(client.post(f"/api/scenarios/{ID}/copy", json={"name": "wrong", "set": changes}), 422, *words)
    refused(client.post(f"/api/scenarios/{ID}/save", json={"set": changes}), 422, *words)
    assert held(folder) == before


def test_a_broken_file_can_be_copied(client, folder):
    assert client.post("/api/scenarios/bad/copy", json={"name": "bad too"}).status_code == 201
    assert (folder / "bad too.yaml").read_bytes() == (folder / "bad.yaml").read_bytes()


def test_an_old_file_is_copied_as_one_of_today(client, folder):
    old = Path(__file__).parents[1] / "scenario" / "version_2.yaml"
    (folder / "old.yaml").write_bytes(old.read_bytes())
    assert client.post("/api/scenarios/old/copy", json={"name": "new", "title": "New"}).status_code == 201
    assert "version: 3" in (folder / "new.yaml").read_text()
    refused(client.post("/api/scenarios/old/save", json={"set": LONGER}), 422, "studio migrate")
    refused(client.post("/api/scenarios/old/rename", json={"name": "older", "title": "Older"}), 422, "studio migrate")
    assert (folder / "old.yaml").read_bytes() == old.read_bytes() and not (folder / "older.yaml").exists()


# -- the form over its own file ----------------------------------------------------------------------


def test_a_form_is_saved_over_its_file_and_taken_back(client, folder, sample):
    before = tag(client)
    done = client.post(f"/api/scenarios/{ID}/save", json={"set": LONGER}, headers={"If-Match": before})
    assert done.status_code == 200, done.text
    assert done.headers["ETag"] == tag(client) != before and b"duration: 70" in (folder / f"{ID}.yaml").read_bytes()
    undone = client.patch(f"/api/scenarios/{ID}", json=done.json()["inverse"], headers={"If-Match": done.headers["ETag"]})
    assert undone.status_code == 200 and (folder / f"{ID}.yaml").read_bytes() == sample.read_bytes()


def test_whoever_has_seen_an_older_file_changes_nothing(client, folder, sample):
    """By save, text, rename and delete alike; what has changed is told."""
    seen = {"If-Match": tag(client)}
    assert client.post(f"/api/scenarios/{ID}/save", json={"set": LONGER}).status_code == 200
    before = held(folder)
    told = ["clock.duration", "60 before"]
    refused(client.post(f"/api/scenarios/{ID}/save", json={"set": {"seed": 5}}, headers=seen), 412, *told)
    refused(client.put(f"/api/scenarios/{ID}/text", content=sample.read_bytes(), headers=seen), 412, *told)
    refused(client.post(f"/api/scenarios/{ID}/rename", json={"name": "other"}, headers=seen), 412, *told)
    refused(client.delete(f"/api/scenarios/{ID}", headers=seen), 412, *told)
    assert held(folder) == before
    (folder / f"{ID}.yaml").write_text("no: [yaml")
    refused(client.delete(f"/api/scenarios/{ID}", headers=seen), 412, "read it again")


def test_what_somebody_else_has_deleted_is_told(client, folder, sample):
    seen = {"If-Match": tag(client)}
    assert client.delete(f"/api/scenarios/{ID}").status_code == 200
    for answer in (
        client.post(f"/api/scenarios/{ID}/save", json={"set": LONGER}, headers=seen),
        client.put(f"/api/scenarios/{ID}/text", content=sample.read_bytes(), headers=seen),
        client.post(f"/api/scenarios/{ID}/rename", json={"name": "other"}, headers=seen),
        client.post(f"/api/scenarios/{ID}/copy", json={"name": "other"}),
        client.delete(f"/api/scenarios/{ID}", headers=seen),
        client.get(f"/api/scenarios/{ID}"),
    ):
        refused(answer, 404, "was deleted", "bring it back from the trash")


# -- other names -------------------------------------------------------------------------------------


def test_a_file_gets_another_name_and_title(client, folder, sample):
    done = client.post(f"/api/scenarios/{ID}/rename", json={"name": "Großer Stern"}, headers={"If-Match": tag(client)})
    assert done.json()["scenario"] == "Großer Stern"
    assert (folder / "Großer Stern.yaml").read_bytes() == sample.read_bytes() and not (folder / f"{ID}.yaml").exists()
    titled = client.post("/api/scenarios/Großer Stern/rename", json={"name": "stern", "title": "The star"})
    assert titled.status_code == 200 and row(client, "stern")["title"] == "The star"
    assert (folder / "stern.yaml").read_text() == sample.read_text().replace("title: Großer Stern platoon", "title: The star")
    only = client.post("/api/scenarios/stern/rename", json={"name": "stern", "title": "A star"})
    assert only.status_code == 200 and row(client, "stern")["title"] == "A star"
    small = client.post("/api/scenarios/stern/rename", json={"name": "Stern"})
    assert small.status_code == 200 and {path.stem for path in folder.glob("[sS]tern.yaml")} == {"Stern"}


@pytest.mark.parametrize("title", ["", "x" * 121])
def test_a_title_that_is_none(client, folder, title):
    before = held(folder)
    refused(client.post(f"/api/scenarios/{ID}/rename", json={"name": "other", "title": title}), 422, "title")
    assert held(folder) == before


def test_runs_go_with_their_scenario(client, folder):
    made = client.post(f"/api/scenarios/{ID}/copy", json={"name": "short", "set": {"clock.duration": 1}})
    assert made.status_code == 201
    live = client.post("/api/live", json={"scenario": "short", "paused": True}).json()
    refused(client.post("/api/scenarios/short/rename", json={"name": "shorter"}), 409, f"run {live['run']}", "is not over")
    assert client.post(f"/api/live/{live['run']}/stop").status_code == 200
    until(lambda: client.get(f"/api/runs/{live['run']}").json()["status"] not in ("running", "waiting"), "the end of the run")
    assert row(client, "short")["runs"] == 1
    assert client.post("/api/scenarios/short/rename", json={"name": "shorter"}).status_code == 200
    assert client.get(f"/api/runs/{live['run']}").json()["scenario"] == "shorter" and row(client, "shorter")["runs"] == 1


# -- deleted, and back -------------------------------------------------------------------------------


def test_what_is_deleted_comes_back(client, folder, sample):
    gone = client.delete(f"/api/scenarios/{ID}", headers={"If-Match": tag(client)})
    assert gone.status_code == 200, gone.text
    assert not (folder / f"{ID}.yaml").exists() and ID not in [each["id"] for each in client.get("/api/scenarios").json()]
    (entry,) = client.get("/api/trash").json()
    assert entry == gone.json() and entry["scenario"] == ID and entry["bytes"] == len(sample.read_bytes())
    back = client.post(f"/api/trash/{entry['id']}/restore", json={})
    assert back.status_code == 200 and back.json()["scenario"] == ID
    assert (folder / f"{ID}.yaml").read_bytes() == sample.read_bytes() and client.get("/api/trash").json() == []


def test_deleted_twice_is_kept_twice_and_comes_back_beside_another(client, folder, sample):
    (folder / "twin.yaml").write_text("title: one\n")
    assert client.delete("/api/scenarios/twin").status_code == 200
    (folder / "twin.yaml").write_text("title: two\n")
    assert client.delete("/api/scenarios/twin").status_code == 200
    second, first = client.get("/api/trash").json()
    assert client.post(f"/api/trash/{first['id']}/restore", json={}).status_code == 200
    before = held(folder)
    refused(client.post(f"/api/trash/{second['id']}/restore", json={}), 409, "is taken", "twin_2")
    refused(client.post(f"/api/trash/{second['id']}/restore", json={"name": "../x"}), 422, "leads to another folder")
    assert held(folder) == before
    assert client.post(f"/api/trash/{second['id']}/restore", json={"name": "twin_2"}).json()["scenario"] == "twin_2"
    assert (folder / "twin.yaml").read_text() == "title: one\n" and (folder / "twin_2.yaml").read_text() == "title: two\n"


def test_what_is_not_in_the_trash(client, folder):
    (folder / "trash").mkdir()
    (folder / "trash" / "by hand.yaml").write_text("title: x\n")
    (folder / "trash" / "x.99999999T999999999999Z.yaml").write_text("title: x\n")
    (folder / "trash" / "x.20260101T000000000000Z.yaml").symlink_to(folder / f"{ID}.yaml")
    assert client.get("/api/trash").json() == []
    for name in ("by hand", "none", "..%2fx", "x.20260101T000000000000Z"):
        refused(client.post(f"/api/trash/{name}/restore", json={}), 404)


def test_a_restart_forgets_nothing(tmp_path, sample):
    """Also a file that is written by hand meanwhile is there."""
    scenarios = tmp_path / "scenarios"
    scenarios.mkdir()
    (scenarios / "maps").symlink_to(sample.parent / "maps")
    (scenarios / "mine.yaml").write_bytes(sample.read_bytes())
    with served(tmp_path) as (client, _, _):
        assert client.delete("/api/scenarios/mine").status_code == 200
        assert client.get("/api/scenarios").json() == []
    with served(tmp_path) as (client, _, _):
        (entry,) = client.get("/api/trash").json()
        assert client.post(f"/api/trash/{entry['id']}/restore", json={}).status_code == 200
    assert (scenarios / "mine.yaml").read_bytes() == sample.read_bytes()


# -- links, and what may be read only ----------------------------------------------------------------


def test_links_are_left_alone(client, folder, sample, tmp_path):
    outside = tmp_path / "outside.yaml"
    outside.write_bytes(sample.read_bytes())
    (folder / "linked.yaml").symlink_to(outside)
    (folder / "inner.yaml").symlink_to(folder / f"{ID}.yaml")
    (folder / "nowhere.yaml").symlink_to(tmp_path / "nowhere.yaml")
    for name in ("linked", "inner", "nowhere"):
        refused(client.delete(f"/api/scenarios/{name}"), 403, "is a link")
        refused(client.post(f"/api/scenarios/{name}/rename", json={"name": "other"}), 403, "is a link")
        refused(client.post(f"/api/scenarios/{ID}/copy", json={"name": name}), 409, "is taken")
    refused(client.put("/api/scenarios/linked/text", content=sample.read_bytes() + b"\n"), 403, "read only")
    assert client.put("/api/scenarios/nowhere/text", content=sample.read_bytes()).status_code in (403, 422)
    assert outside.read_bytes() == sample.read_bytes() and not (tmp_path / "nowhere.yaml").exists()
    assert (folder / "linked.yaml").is_symlink()


def test_a_trash_that_leads_elsewhere_is_not_used(client, folder, tmp_path):
    (folder / "trash").symlink_to(tmp_path)
    refused(client.delete(f"/api/scenarios/{ID}"), 403, "is a link")
    assert (folder / f"{ID}.yaml").exists() and client.get("/api/trash").json() == []
    (folder / "trash").unlink()
    (folder / "trash").write_text("no folder\n")
    refused(client.delete(f"/api/scenarios/{ID}"), 422, "File exists")
    assert (folder / f"{ID}.yaml").exists()
    (folder / "trash").unlink()


def test_what_is_write_protected_stays(client, folder, sample):
    path = folder / f"{ID}.yaml"
    path.chmod(0o444)
    refused(client.delete(f"/api/scenarios/{ID}"), 403, "copy it under another name")
    refused(client.post(f"/api/scenarios/{ID}/rename", json={"name": "other"}), 403)
    refused(client.put(f"/api/scenarios/{ID}/text", content=sample.read_bytes() + b"\n"), 403)
    refused(client.post(f"/api/scenarios/{ID}/save", json={"set": LONGER}), 403)
    assert client.post(f"/api/scenarios/{ID}/copy", json={"name": "mine"}).status_code == 201
    assert path.read_bytes() == sample.read_bytes() and os.access(folder / "mine.yaml", os.W_OK)
    assert (folder / "mine.yaml").stat().st_mode & 0o200


# -- a full disk -------------------------------------------------------------------------------------


def full(server):
    """No file of that process grows any more."""
    process = server[2]
    resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (100, resource.RLIM_INFINITY))


@pytest.mark.skipif(not hasattr(resource, "prlimit"), reason="the limit of another process can be set on Linux only")
def test_a_full_disk_loses_nothing(client, server, folder, sample):
    """Played by a limit on the size of files: the system says that a file is too large instead of that the disk is full."""
    assert signal.getsignal(signal.SIGXFSZ) == signal.SIG_IGN  # Python ignores it, and the write fails
    before = held(folder)
    full(server)
    try:
        text = sample.read_bytes()
        answers = [
            client.post("/api/scenarios", json={"name": "x", "map": "motorway.xodr"}),
            client.post(f"/api/scenarios/{ID}/copy", json={"name": "x"}),
            client.post("/api/scenarios/import", params={"name": "x"}, content=text),
            client.put(f"/api/scenarios/{ID}/text", content=text + b"\n# more\n"),
            client.post(f"/api/scenarios/{ID}/save", json={"set": LONGER}),
            client.post(f"/api/scenarios/{ID}/rename", json={"name": "x", "title": "X"}),
        ]
    finally:
        resource.prlimit(server[2].pid, resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    for answer in answers:
        refused(answer, 422, "cannot be written", "File too large")
    assert held(folder) == before
    assert not [path for path in folder.iterdir() if path.name.startswith(".")]
