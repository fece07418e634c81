"""Scenario files as text over REST: taken in, checked line by line, written, given out as a file."""

import json

import pytest

from tests.server.test_scenarios_files import ID, folder, held, refused, row, tag

__all__ = ["folder"]

LARGEST = 4_000_000


def checked(client, text, scenario=ID):
    answer = client.post(f"/api/scenarios/{scenario}/text/check", content=text.encode())
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_a_good_text_is_good(client, folder, sample):
    assert checked(client, sample.read_text()) == {"ok": True, "problems": []}


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ("duration: 60", "duration: -60", 13, ["clock.duration", "> 0"]),
        ("duration: 60", "durration: 60", 13, ["clock.durration", "is not a field", "did you mean 'duration'?"]),
        ("seed: 1", "seed: [1", 17, ["not YAML"]),
        ("seed: 1", "seed: 1\nseed: 2", 16, ["seed"]),
        ("seed: 1", "seed: 012", 15, ["012"]),
        ("route: east_to_west\n    position: {along: 360}", "route: nowhere\n    position: {along: 360}", 23, ["names no route"]),
        ("application: cacc", "application: cac", 59, ["applications.platoon.application"]),
        ("file: maps/berlin", "file: maps/brlin", 9, ["map.file", "does not exist", "did you mean"]),
        ("file: maps/berlin", "file: ../berlin", 9, ["map.file", "leads out"]),
    ],
)
def test_what_is_wrong_is_told_at_its_line(client, folder, sample, old, new, line, words):
    before, text = held(folder), sample.read_text()
    assert old in text
    wrong = text.replace(old, new, 1)
    told = checked(client, wrong)
    assert not told["ok"]
    lines = [each["line"] for each in told["problems"]]
    assert line in lines, told["problems"]
    refused(client.put(f"/api/scenarios/{ID}/text", content=wrong.encode()), 422, f"line {line}", *words)
    refused(client.post("/api/scenarios/import", params={"name": "taken in"}, content=wrong.encode()), 422, f"line {line}", *words)
    assert held(folder) == before


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", ["empty"]),
        (b"- a list\n", ["a YAML mapping"]),
        (b"\xff\xfe\x00", ["UTF-8"]),
        (b"\x89PNG\r\n\x1a\n\x00", ["UTF-8"]),
        (b"a: &a [*a]\n", ["holds itself"]),
        (b"{" * 100 + b"}" * 100, ["line 1"]),
        (b"version: 99\n", ["update the studio"]),
        (b"title: only\n", ["is missing"]),
    ],
)
def test_files_that_are_no_scenario(client, folder, content, words):
    before = held(folder)
    refused(client.post("/api/scenarios/import", params={"name": "x.yaml"}, content=content), 422, *words)
    refused(client.put(f"/api/scenarios/{ID}/text", content=content), 422, *words)
    assert not client.post(f"/api/scenarios/{ID}/text/check", content=content).json()["ok"]
    assert held(folder) == before


def test_files_that_are_too_large(client, folder, sample):
    """Also when nobody has said before how long the body will be."""
    before, large = held(folder), sample.read_bytes() + b"#" * LARGEST
    refused(client.post("/api/scenarios/import", params={"name": "x"}, content=large), 413, "4000000 bytes")
    refused(client.put(f"/api/scenarios/{ID}/text", content=iter([large])), 413, "4000000 bytes")
    refused(client.post(f"/api/scenarios/{ID}/text/check", content=large), 413)
    assert held(folder) == before


def test_a_file_is_taken_in_to_the_letter(client, folder, sample):
    """With its line breaks, whatever they are."""
    data = sample.read_bytes().replace(b"\n", b"\r\n")
    made = client.post("/api/scenarios/import", params={"name": "Taken in.yaml"}, content=data)
    assert made.status_code == 201 and made.json()["scenario"] == "Taken in"
    assert client.post("/api/scenarios/import", params={"name": "short.YML"}, content=data).json()["scenario"] == "short"
    assert (folder / "Taken in.yaml").read_bytes() == data and row(client, "Taken in")["problem"] is None


def test_a_text_is_written_with_its_comments(client, folder, sample):
    text = sample.read_text().replace("duration: 60", "duration: 30  # half of it")
    done = client.put(f"/api/scenarios/{ID}/text", content=text.encode(), headers={"If-Match": tag(client)})
    assert done.status_code == 200 and f'"{done.json()["digest"]}"' == tag(client)
    assert (folder / f"{ID}.yaml").read_text() == text
    assert client.get(f"/api/scenarios/{ID}").json()["document"]["clock"]["duration"] == 30


def test_a_broken_file_is_given_out_and_mended(client, folder, sample):
    (folder / "torn.yaml").write_text("title: [torn\n")
    found = client.get("/api/scenarios/torn/text")
    assert found.status_code == 200 and found.text == "title: [torn\n"
    told = checked(client, found.text, "torn")
    assert not told["ok"] and told["problems"][0]["line"] in (1, 2)
    mended = client.put("/api/scenarios/torn/text", content=sample.read_bytes(), headers={"If-Match": found.headers["ETag"]})
    assert mended.status_code == 200 and row(client, "torn")["problem"] is None


def test_what_a_file_named_before_it_may_name_still(client, folder, sample):
    """It was written by its owner, who may name files of other folders; others may not be brought in."""
    text = sample.read_text().replace("file: maps/", "file: ../scenarios/maps/")
    (folder / "own.yaml").write_text(text)
    assert client.put("/api/scenarios/own/text", content=text.replace("seed: 1", "seed: 2").encode()).status_code == 200
    refused(client.post("/api/scenarios/import", params={"name": "x"}, content=text.encode()), 422, "leads out")


def test_a_file_for_the_browser(client, folder, sample):
    (folder / "Weg über.yaml").write_bytes(sample.read_bytes())
    given = client.get("/api/scenarios/Weg über/text", params={"download": "true"})
    assert given.content == sample.read_bytes()
    assert given.headers["Content-Disposition"] == "attachment; filename*=UTF-8''Weg%20%C3%BCber.yaml"
    assert "Content-Disposition" not in client.get(f"/api/scenarios/{ID}/text").headers


def test_a_foreign_page_writes_nothing(client, folder, sample):
    before, foreign = held(folder), {"Origin": "http://evil.example"}
    for method, path in (("put", f"scenarios/{ID}/text"), ("delete", f"scenarios/{ID}"), ("post", "scenarios/import?name=x")):
        assert (
            client.request(method, f"/api/{path}", content=sample.read_bytes() if method != "delete" else None, headers=foreign).status_code
            == 403
        )
    assert held(folder) == before


def test_scenarios_that_are_not_there(client, folder, sample):
    refused(client.put("/api/scenarios/none/text", content=sample.read_bytes()), 404)
    refused(client.post("/api/scenarios/none/text/check", content=b"x"), 404)
    refused(client.put("/api/scenarios/..%2fnone/text", content=b"x"), 404)
    assert "none" not in json.dumps(client.get("/api/scenarios").json())
