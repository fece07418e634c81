"""Verdicts and remarks over REST: given, told with the run and in the list, and refused in the usual form."""

import pytest

from tests.patience import until
from tests.server.server import served


@pytest.fixture(scope="module")
def studio(tmp_path_factory, sample):
    """A client, and the number of a run that is over."""
    with served(tmp_path_factory.mktemp("verdicts"), "--scenarios", sample.parent) as (client, _, _):
        run = client.post("/api/runs", json={"scenario": sample.stem, "set": {"clock.duration": 0.2}}).json()["run"]
        until(lambda: client.get(f"/api/runs/{run}").json()["status"] == "done", "the end of the run")
        yield client, run


def test_a_verdict_is_told_with_its_run(studio):
    client, run = studio
    assert client.get(f"/api/runs/{run}").json()["verdicts"] == []
    answers = [
        client.post(f"/api/runs/{run}/verdicts", json={"verdict": verdict, "reason": reason, "who": "Ada"})
        for verdict, reason in (("discarded", "too near"), ("candidate", "near enough"))
    ]
    assert [each.status_code for each in answers] == [201, 201]
    told = client.get(f"/api/runs/{run}").json()
    assert told["verdicts"] == [each.json() for each in answers]
    assert (told["verdict"], told["reason"]) == ("candidate", "near enough")
    (row,) = client.get("/api/runs").json()
    assert (row["verdict"], row["reason"]) == ("candidate", "near enough") and row["note"] == ""


def test_a_remark_is_told_with_its_run(studio):
    client, run = studio
    said = {"name": "short gap", "tags": ["wet"], "note": "At 12.3 s.\nThen not."}
    assert client.put(f"/api/runs/{run}/remark", json=said).json() == said
    told, (row,) = client.get(f"/api/runs/{run}").json(), client.get("/api/runs").json()
    assert {key: told[key] for key in said} == said and (row["name"], row["tags"]) == ("short gap", ["wet"])


def test_many_are_decided_about_and_tagged_at_once(studio):
    client, run = studio
    given = {"verdicts": [{"run": run, "verdict": "open", "reason": "anew"}], "who": "Ada"}
    client.put(f"/api/runs/{run}/remark", json={"tags": ["wet"]})
    (verdict,) = client.post("/api/verdicts", json=given).json()
    assert client.get(f"/api/runs/{run}").json()["verdicts"][-1] == verdict
    made = client.post("/api/tags", json={"tags": [{"run": run, "add": ["far"], "remove": ["wet"]}]}).json()
    had = client.get(f"/api/runs/{run}").json()
    assert made == {"tags": [{"run": run, "add": ["far"], "remove": ["wet"]}]} and had["tags"] == ["far"]
    both = [{"run": run, "verdict": "open", "reason": "x"}, {"run": 999, "verdict": "open", "reason": "x"}]
    assert client.post("/api/verdicts", json={"verdicts": both}).status_code == 404
    assert client.get(f"/api/runs/{run}").json()["verdicts"][-1] == verdict


@pytest.mark.parametrize(
    ("body", "where"),
    [
        ({"verdict": "candidate", "reason": " "}, "reason"),
        ({"verdict": "splendid", "reason": "x"}, "verdict"),
        ({"verdict": "open", "reason": "x", "why": "y"}, "why"),
        ({"verdict": "open", "reason": "a\nb"}, "reason"),
        ({"reason": "x"}, "verdict"),
    ],
)
def test_what_is_no_verdict_is_refused(studio, body, where):
    client, run = studio
    before = client.get(f"/api/runs/{run}").json()["verdicts"]
    refused = client.post(f"/api/runs/{run}/verdicts", json=body)
    assert refused.status_code == 422 and any(where in each["where"] for each in refused.json()["problems"]), refused.text
    assert client.get(f"/api/runs/{run}").json()["verdicts"] == before
    assert client.post("/api/runs/999/verdicts", json={"verdict": "open", "reason": "x"}).status_code == 404


def test_the_page_about_a_run_is_kept_as_a_file(studio):
    client, run = studio
    answer = client.get(f"/api/runs/{run}/report")
    assert answer.headers["content-disposition"] == f'attachment; filename="run_{run}.html"' and answer.text.startswith("<!doctype html>")
    assert client.get(f"/api/runs/{run}").json()["state_hash"] in answer.text
    paper = client.get(f"/api/runs/{run}/report.pdf")
    assert paper.headers["content-type"] == "application/pdf" and paper.content.startswith(b"%PDF-")
    assert paper.headers["content-disposition"] == f'attachment; filename="run_{run}.pdf"'
    assert [client.get(f"/api/runs/999/report{each}").status_code for each in ("", ".pdf")] == [404, 404]
