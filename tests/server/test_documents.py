"""Scenario files over REST: text, patches that are checked and written at once, undo by the inverse, edits that meet."""

import json
import os
from pathlib import Path

import pytest

ID = "grosser_stern_platoon"
LONGER = [{"op": "replace", "path": "/clock/duration", "value": 70}]


@pytest.fixture
def path(server, sample):
    """The scenario's file on the server, as the sample has it."""
    path = server[1].parent / "scenarios" / f"{ID}.yaml"
    path.write_bytes(sample.read_bytes())
    yield path
    path.chmod(0o644)
    path.write_bytes(sample.read_bytes())


def patch(client, operations, scenario=ID, **headers):
    headers = {"Content-Type": "application/json-patch+json"} | {name.replace("_", "-"): value for name, value in headers.items()}
    return client.patch(f"/api/scenarios/{scenario}", content=json.dumps(operations), headers=headers)


def test_the_text_is_the_files(client, path):
    answer = client.get(f"/api/scenarios/{ID}/text")
    assert answer.headers["Content-Type"].startswith("application/yaml")
    assert answer.content == path.read_bytes()
    assert answer.headers["ETag"] == client.get(f"/api/scenarios/{ID}/text").headers["ETag"]


def test_a_patch_and_its_inverse(client, path):
    before = path.read_bytes()
    tag = client.get(f"/api/scenarios/{ID}/text").headers["ETag"]
    done = patch(client, [*LONGER, {"op": "remove", "path": "/vehicles/follower_4"},
                          {"op": "remove", "path": "/applications/platoon/units/3"},
                          {"op": "remove", "path": "/applications/platoon/listens_to/3"}], if_match=tag)  # fmt: skip
    assert done.status_code == 200, done.text
    told = done.json()
    assert told["document"]["clock"]["duration"] == 70 and "follower_4" not in told["document"]["vehicles"]
    assert b"duration: 70" in path.read_bytes() and path.read_bytes().startswith(before[:300])
    after = client.get(f"/api/scenarios/{ID}/text").headers["ETag"]
    assert done.headers["ETag"] == after == f'"{told["digest"]}"' != tag
    undone = patch(client, told["inverse"], if_match=after)
    assert undone.status_code == 200 and path.read_bytes() == before and undone.headers["ETag"] == tag
    again = patch(client, undone.json()["inverse"], if_match=tag)
    assert again.status_code == 200 and again.headers["ETag"] == after


def test_what_has_changed_meanwhile_is_told(client, path):
    tag = client.get(f"/api/scenarios/{ID}/text").headers["ETag"]
    assert patch(client, LONGER).status_code == 200
    late = patch(client, [{"op": "replace", "path": "/seed", "value": 7}], if_match=tag)
    assert late.status_code == 412
    (problem,) = late.json()["problems"]
    assert (problem["where"], problem["value"], problem["allowed"]) == ("clock.duration", "70", "60 before")
    unknown = patch(client, LONGER, if_match='"none"')
    assert unknown.status_code == 412 and "read it again" in unknown.text
    assert b"seed: 1\n" in path.read_bytes()


def test_a_test_that_fails_is_a_conflict(client, path):
    before = path.read_bytes()
    answer = patch(client, [*LONGER, {"op": "test", "path": "/seed", "value": 2}])
    assert answer.status_code == 409 and path.read_bytes() == before
    (problem,) = answer.json()["problems"]
    assert (problem["where"], problem["value"], problem["allowed"]) == ("/seed", "1", "2")


@pytest.mark.parametrize(
    ("operations", "words"),
    [
        ([{"op": "replace", "path": "/clock/duration", "value": -1}], ["line 13, column 3: clock.duration", "> 0"]),
        ([{"op": "add", "path": "/clok", "value": {}}], ["clok", "did you mean 'clock'"]),
        ([{"op": "remove", "path": "/clock/tick"}], ["/clock/tick", "does not exist"]),
        ([{"op": "replace", "path": "/vehicles/leader/route", "value": "x"}], ["vehicles.leader.route", "names no route"]),
        ([{"op": "replace", "path": "/clock/duration"}], ["needs the member 'value'"]),
        ([{"op": "put", "path": "/clock", "value": 1}], ["'add', 'remove', 'replace'"]),
        ([{"op": "add", "path": "/title", "value": "\ud800"}], ["title"]),
        ([{"op": "replace", "path": "", "value": 3}], ["is not a scenario"]),
        ({"set": {}}, ["list"]),
    ],
)
def test_what_cannot_be_is_not_written(client, path, operations, words):
    before = path.read_bytes()
    answer = patch(client, operations)
    assert answer.status_code == 422, answer.text
    assert set(answer.json()) == {"message", "problems"}
    for word in words:
        assert word in json.dumps(answer.json(), ensure_ascii=False)
    assert path.read_bytes() == before
    assert not [each for each in os.listdir(path.parent) if each.startswith(".")]


def test_a_scenario_that_is_not_there(client):
    assert patch(client, LONGER, scenario="none").status_code == 404
    assert patch(client, LONGER, scenario="..%2f..%2fetc").status_code == 404
    assert client.get("/api/scenarios/none/text").status_code == 404


def test_files_that_may_be_read_only(client, path, sample, tmp_path):
    path.chmod(0o444)
    answer = patch(client, LONGER)
    assert answer.status_code == 403 and "copy it under another name" in answer.text
    assert path.read_bytes() == sample.read_bytes()
    outside = tmp_path / "outside.yaml"
    outside.write_bytes(sample.read_bytes())
    link = path.with_name("linked.yaml")
    link.symlink_to(outside)
    try:
        assert patch(client, LONGER, scenario="linked").status_code == 403
    finally:
        link.unlink()
    assert outside.read_bytes() == sample.read_bytes()


def test_an_old_file_is_not_changed_until_it_is_migrated(client, path):
    """Else the undo of an edit could not give its bytes back."""
    old = (Path(__file__).parents[1] / "scenario" / "version_2.yaml").read_text()
    path.write_text(old)
    assert client.get(f"/api/scenarios/{ID}/text").text == old
    answer = patch(client, [{"op": "replace", "path": "/seed", "value": 5}])
    assert answer.status_code == 422 and "studio migrate" in answer.text
    assert path.read_text() == old


def test_a_patch_that_changes_nothing_writes_nothing(client, path):
    before = path.stat().st_mtime_ns, path.read_bytes()
    assert patch(client, []).status_code == 200
    assert (path.stat().st_mtime_ns, path.read_bytes()) == before
