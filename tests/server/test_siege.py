"""REST under attack: whatever is asked, the answer has the form that is described, is no mistake of ours, and tells where, what and how."""

import json
import random
import sqlite3
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from studio import job
from studio.server.answer import Refusal
from studio.server.app import create_app
from studio.server.desk import Desk
from studio.store.runs import open_runs

SEED, COUNT = 20261128, 300
LONG = "x" * 5000
BAD_NUMBERS = ["0", "-1", "1e3", "abc", "9" * 30, "9" * 5000, str(2**63), str(2**64), "%00", "%ff", "..", LONG, "٣"]
BAD_NAMES = [*BAD_NUMBERS, "..%2f..%2fetc%2fpasswd", "a%20b", "'%22;--", "%F0%9F%9A%97"]
BAD_BODIES = [b"", b"{", b"[" * 100_000, b"\xff\xfe", b"null", b"[]", b"1", b'{"seed": ' + b"9" * 100_000 + b"}", b'{"set": {"": 1}}']
VALUES = [None, True, -1, 10**400, 1e308, "", "\ud800", "\0", LONG, [], {}, [[]] * 50, {"a": {"b": []}}, "../../etc/passwd", "fast"]
FIELDS = ["scenario", "set", "seed", "parent", "pace", "paused", "run", "name", "place", "bbox", "element", "tags", "remove", "replace"]
PATHS = [
    "clock.duration",
    "map.file",
    "vehicles",
    "vehicles.leader.model",
    "traffic.count",
    "seed",
    "applications",
    "",
    ".",
    "a.b",
    "script",
]


@pytest.fixture(scope="module")
def here(tmp_path_factory, sample):
    """A client of the application itself, its description, and its database with a run in it."""
    folder = tmp_path_factory.mktemp("siege")
    (folder / "scenarios").mkdir()
    (folder / "scenarios" / sample.name).write_bytes(sample.read_bytes())
    (folder / "scenarios" / "maps").symlink_to(sample.parent / "maps")
    runs = open_runs(folder / "runs.db")
    job.run(job.load(sample, {"clock.duration": 0.1}), runs=runs)
    runs.close()
    app = create_app(Desk(db=folder / "runs.db", scenarios=folder / "scenarios", kinds=()))
    return TestClient(app, base_url="http://127.0.0.1", raise_server_exceptions=False), app.openapi()["paths"], folder / "runs.db"


def is_told(answer, responses):
    """Whether an answer is described, and a refusal says where and what."""
    assert answer.status_code != 500, answer.text
    if answer.status_code >= 400:
        told = Refusal.model_validate_json(answer.content, strict=True)
        assert told.message and told.problems and all(each.what for each in told.problems), answer.text
        assert len(answer.content) < 20_000
    assert str(answer.status_code) in responses, (answer.status_code, answer.text)


def drawn(chance, paths):
    """A request that is wrong in some way: route, address, question, body, headers."""
    route = chance.choice(sorted(paths))
    method = chance.choice(sorted(paths[route]))
    address = route
    for part in ("run", "job", "scenario", "map", "element"):
        usual = {"run": "1", "scenario": "grosser_stern_platoon"}.get(part, "1")
        bad = BAD_NUMBERS if part in ("run", "job") else BAD_NAMES
        address = address.replace(f"{{{part}}}", chance.choice(bad) if chance.random() < 0.6 else usual)
    names = [each["name"] for each in paths[route][method].get("parameters", []) if each["in"] == "query"]
    question = "&".join(f"{name}={chance.choice(BAD_NAMES)}" for name in names if chance.random() < 0.7)
    return method, f"{address}?{question}" if question else address, body(chance), route


def body(chance):
    """A body that is no JSON, or JSON that is not asked for."""
    if chance.random() < 0.3:
        return chance.choice(BAD_BODIES)
    made = {field: chance.choice(VALUES) for field in FIELDS if chance.random() < 0.3}
    if chance.random() < 0.5:
        made |= {"scenario": "grosser_stern_platoon", "set": {chance.choice(PATHS): chance.choice(VALUES)}}
    return json.dumps([made] if chance.random() < 0.1 else made).encode()


def test_whatever_is_asked_is_answered_as_described(here):
    """Requests drawn from a seed. What starts something is left to the tests that start a server."""
    client, paths, _ = here
    chance = random.Random(SEED)
    for _ in range(COUNT):
        method, address, content, route = drawn(chance, paths)
        if method == "get" or route.endswith("/check") or method == "patch":
            content = None if method == "get" else content
            kind = "application/json-patch+json" if method == "patch" else "application/json"
            answer = client.request(method, address, content=content, headers={"Content-Type": kind} if content is not None else {})
            is_described = answer.request.url.path.startswith("/api") and answer.status_code != 404
            is_told(answer, paths[route][method]["responses"] if is_described else {str(answer.status_code)})


@pytest.mark.parametrize("method", ["PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "HEAD", "BREW"])
def test_a_method_that_there_is_not(here, method):
    answer = here[0].request(method, "/api/runs")
    assert answer.status_code in (404, 405)
    if method != "HEAD":
        is_told(answer, {"404", "405"})


@pytest.mark.parametrize("content", BAD_BODIES, ids=lambda each: repr(each[:12]))
@pytest.mark.parametrize("address", ["runs", "live", "scene", "maps/download", "live/1/pace", "scenarios/grosser_stern_platoon/check"])
def test_a_body_that_is_none(here, address, content):
    answer = here[0].post(f"/api/{address}", content=content, headers={"Content-Type": "application/json"})
    assert answer.status_code in (400, 404, 422) or address.endswith("check"), answer.text
    is_told(
        answer, here[1][f"/api/{address}".replace("/1/", "/{run}/").replace("grosser_stern_platoon", "{scenario}")]["post"]["responses"]
    )


@pytest.mark.parametrize("channels", ["leader.speed,leader.speed", "", ","])
def test_channels_in_any_number(here, channels):
    answer = here[0].get("/api/runs/1/trace", params={"channels": channels})
    assert answer.status_code == 200 and set(answer.json()["channels"]) == {each for each in channels.split(",") if each}


@pytest.mark.parametrize("channels", ["speed", "time", "leader.sped", ".speed", "leader.", LONG])
def test_channels_that_there_are_not(here, channels):
    is_told(here[0].get("/api/runs/1/trace", params={"channels": channels}), {"404"})


@pytest.mark.parametrize("address", [f"/api/{LONG}", "/api/", "/api/runs/", "/api/runs/1/", "/api/%00", "/api/../etc"])
def test_addresses_that_there_are_not(here, address):
    is_told(here[0].get(address), {"404"})


DAMAGES = {
    "traces that are no Parquet": "update traces set parquet = x'00ff00ff'",
    "traces cut short": "update traces set parquet = substr(parquet, 1, 2000)",
    "traces that are a text": "update traces set parquet = 'PAR1'",
    "traces that are nothing": "update traces set parquet = null",
    "messages that are none": "update messages set sent = x'00'",
    "no scenario": "pragma foreign_keys = off; delete from scenarios",
    "a scenario that is no JSON": "update scenarios set document = '{'",
    "a scenario of another kind": "update scenarios set document = '[1]'",
    "parameters that are no JSON": "update runs set parameters = 'x'",
    "parameters of another kind": "update runs set parameters = '[1]', unmet = '{}'",
    "events that are none": "update events set numbers = '7', units = 'x'",
    "metrics about nobody": "update metrics set subject = 'x'",
    "no table": "drop table metrics",
    "columns of another name": "alter table runs rename column scenario_hash to hash",
    "no numbers of runs": "alter table runs rename column run to number",
}


@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
def test_a_damaged_database_is_told(here, tmp_path, damage):
    """Whatever is damaged: a list or a refusal, no mistake of ours; and what is not damaged is there."""
    _, paths, source = here
    db = tmp_path / "runs.db"
    with sqlite3.connect(source) as whole, sqlite3.connect(db) as copy:
        whole.backup(copy)
    with sqlite3.connect(db) as copy:
        copy.executescript(damage)
    client = TestClient(create_app(Desk(db=db, scenarios=Path("scenarios"), kinds=())), raise_server_exceptions=False)
    asked = {
        "/api/runs": "/api/runs",
        "/api/runs/1": "/api/runs/{run}",
        "/api/runs/1/trace?channels=leader.speed": "/api/runs/{run}/trace",
        "/api/runs/1/explanation": "/api/runs/{run}/explanation",
        "/api/runs/1/beyond": "/api/runs/{run}/beyond",
        "/api/compare?a=1&b=1": "/api/compare",
    }
    answers = {address: client.get(address) for address in asked}
    for address, answer in answers.items():
        is_told(answer, paths[asked[address]]["get"]["responses"])
    assert any(answer.status_code == 503 or "amaged" in answer.text for answer in answers.values())
