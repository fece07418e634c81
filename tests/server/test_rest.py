"""REST: the same functions as the command line, the same runs, refusals that say what is wrong."""

import json
import os

import psutil
import pytest

from studio import job
from studio.kind.sort import SORTS
from studio.server import answer
from studio.store.runs import open_runs
from tests.broken import EVERY
from tests.patience import until

SCENARIO = "grosser_stern_platoon"
SHORT = {"clock.duration": 3}


def finished(client, run):
    """The run when it is over."""

    def over():
        row = client.get(f"/api/runs/{run}").json()
        return row if row["status"] != "running" else None

    return until(over, f"the end of run {run}")


@pytest.fixture(scope="module")
def pair(client):
    """A run of 3 s, and its child with another headway."""
    first = client.post("/api/runs", json={"scenario": SCENARIO, "set": SHORT})
    assert first.status_code == 202, first.text
    a = finished(client, first.json()["run"])
    changes = SHORT | {"applications.platoon.parameters.headway": 0.9}
    second = client.post("/api/runs", json={"scenario": SCENARIO, "set": changes, "parent": a["run"]})
    return a, finished(client, second.json()["run"])


def test_scenarios(client):
    rows = {each["id"]: each for each in client.get("/api/scenarios").json()}
    assert rows[SCENARIO]["vehicles"] == 25 and rows[SCENARIO]["problem"] is None
    assert rows[SCENARIO]["attribution"] == "© OpenStreetMap contributors"
    assert rows["motorway_platoon"]["attribution"] == "Motorway, Cooperative ADAS Studio"
    assert "clok" in rows["bad"]["problem"]


def test_a_scenario_with_its_form(client):
    found = client.get(f"/api/scenarios/{SCENARIO}").json()
    assert found["document"]["applications"]["platoon"]["parameters"]["k_p"] == 0.2
    assert found["schema"]["$defs"]["ad_hoc_radio"]["properties"]["loss"]["maximum"] == 1
    assert found["attribution"] == "© OpenStreetMap contributors"
    assert client.get("/api/scenarios/motorway_platoon").json()["attribution"] == "Motorway, Cooperative ADAS Studio"


def test_check(client):
    good = client.post(f"/api/scenarios/{SCENARIO}/check", json={"set": {"radio.loss": 0.2}}).json()
    assert good["ok"] and good["document"]["radio"]["loss"] == 0.2
    bad = client.post(f"/api/scenarios/{SCENARIO}/check", json={"set": {"radio.loss": 2}}).json()
    assert not bad["ok"] and "radio.loss" in bad["problems"][0]["where"] and "1" in bad["problems"][0]["allowed"]


def test_kinds(client):
    """All of them, with what may be set and what they give; a broken file is told with its traceback."""
    found = client.get("/api/kinds").json()
    kinds = {(each["sort"], each["name"]): each for each in found["kinds"]}
    assert {sort for sort, _ in kinds} == set(SORTS)
    cacc, own = kinds["application", "cacc"], kinds["sensor", "flawless"]
    assert cacc["source"] == "built in" and cacc["settings"]["properties"]["headway"]["unit"] == "s"
    assert own["source"].endswith("flawless.py") and "A radar without noise" in own["description"]
    clearance = {"name": "clearance", "unit": "m", "size": 1, "meaning": "to the rear of the car ahead"}
    assert own["gives"][0] == clearance and [each["name"] for each in own["gives"]] == ["clearance", "closing"]
    series = {each["name"]: each for each in kinds["sensor", "front_radar"]["presets"]}["series_acc_radar"]
    assert series["source"] and series["values"] and own["presets"] == []
    assert {"begin", "end", "vehicles"} == set(kinds["metric", "min_ttc"]["settings"]["properties"])
    assert kinds["metric", "time_exposed_ttc"]["settings"]["properties"]["limit"]["unit"] == "s"
    (broken,) = found["broken"]
    assert broken["name"] == "torn" and broken["file"].endswith("torn.py")
    assert "ModuleNotFoundError" in broken["what"] and "torn.py" in broken["traceback"] and "line 3" in broken["traceback"]


def test_a_broken_file_is_told_where_the_server_was_started(server):
    told = (server[1].parent / "server.log").read_text()
    assert "torn.py" in told and "studio.nowhere" in told


def test_a_slot_is_exchanged(client):
    """The check shows what will run; the run has what the new sensor gives, with its unit."""
    front = "vehicles.follower_1.sensors.front"
    given = client.get(f"/api/scenarios/{SCENARIO}").json()["given"]
    assert "sensors" not in given["vehicles"]["follower_1"]
    changes = {f"{front}.kind": "flawless", f"{front}.patience": 3.0, "clock.duration": 1, "applications": {}}
    checked = client.post(f"/api/scenarios/{SCENARIO}/check", json={"set": changes}).json()
    sensor = EVERY | {"kind": "flawless", "range": 80.0, "opening_angle": 0.5, "patience": 3.0}
    assert checked["problems"] == [] and checked["document"]["vehicles"]["follower_1"]["sensors"]["front"] == sensor
    run = client.post("/api/runs", json={"scenario": SCENARIO, "set": changes}).json()["run"]
    detail = finished(client, run)
    channels = {each["name"]: each for each in client.get(f"/api/runs/{run}").json()["channels"]}
    assert detail["status"] == "done" and channels["follower_1.front.clearance"]["unit"] == "m"
    assert channels["follower_1.front.clearance"]["label"] == "Clearance of front"
    trace = client.get(f"/api/runs/{run}/trace", params={"channels": "follower_1.front.clearance,follower_1.gap"}).json()["channels"]
    assert trace["follower_1.front.clearance"]["values"][-1] == pytest.approx(trace["follower_1.gap"]["values"][-1], abs=0.5)


def test_the_command_lines_bits(pair, sample):
    """REST's run ends with the same state and metrics as Python's."""
    run = job.run(job.load(sample, SHORT))
    assert pair[0]["state_hash"] == run.state_hash
    assert pair[0]["metrics"]["min_gap"]["value"] == run.metrics["min_gap"].value


def test_the_same_runs_in_the_database(pair, server):
    row = open_runs(server[1]).find(pair[1]["run"])
    assert row.parent == pair[0]["run"] and row.parameters == pair[1]["parameters"]


def test_list_and_detail(client, pair):
    listed = client.get("/api/runs", params={"scenario": SCENARIO}).json()
    assert [each["run"] for each in listed[:2]] == [pair[1]["run"], pair[0]["run"]] or len(listed) > 2
    had = {each["run"]: each["settings"].get("applications.platoon.parameters.headway") for each in listed}
    assert [had[each["run"]] for each in pair] == [0.6, 0.9]  # of the first, which has not set it, as its scenario has it
    detail = client.get(f"/api/runs/{pair[0]['run']}").json()
    assert detail["document"]["clock"]["duration"] == 3
    assert {"name": "follower_1.gap", "unit": "m", "label": "Gap to the car ahead"} in detail["channels"]


def test_trace_is_decimated_on_request(client, pair):
    path = f"/api/runs/{pair[0]['run']}/trace"
    full = client.get(path, params={"channels": "follower_1.speed,leader.gap"}).json()
    assert len(full["time"]) == 151 and full["channels"]["follower_1.speed"]["unit"] == "m/s"
    assert len(full["channels"]["leader.gap"]["values"]) == 151
    thin = client.get(path, params={"channels": "follower_1.speed", "points": 20}).json()
    assert len(thin["time"]) <= 22


def test_a_part_of_a_trace_comes_finer(client, pair):
    """As many rows for a shorter time, which begin and end a sample beyond it; a time that is none is refused."""
    path, some = f"/api/runs/{pair[0]['run']}/trace", {"channels": "follower_1.speed", "points": 20}
    part = client.get(path, params=some | {"begin": 1.0, "end": 1.2}).json()
    assert part["time"] == pytest.approx([0.98 + 0.02 * i for i in range(13)])
    assert len(part["channels"]["follower_1.speed"]["values"]) == 13
    assert client.get(path, params=some | {"begin": 2.9}).json()["time"][-1] == pytest.approx(3.0)
    assert client.get(path, params=some | {"begin": 2, "end": 1}).json()["time"] == []
    assert client.get(path, params=some | {"begin": "nan"}).status_code == 422
    query = {each["name"]: each for each in client.get("/openapi.json").json()["paths"]["/api/runs/{run}/trace"]["get"]["parameters"]}
    assert "[s]" in query["begin"]["description"] and "[s]" in query["end"]["description"]


def test_whom_a_measure_is_about(pair):
    """Subject and time beside the value; none of what is about the whole run."""
    gap, speed = (pair[0]["metrics"][name] for name in ("min_gap", "mean_speed"))
    assert len(gap["subject"]) == 2 and 0 <= gap["time"] <= 3 and gap["about"] and gap["kind"] == "min_gap"
    assert (speed["subject"], speed["time"], speed["about"]) == ([], None, "")


def test_why_it_happened(client):
    """A hard brake, told with what was known; a run without one has nothing to tell, a wrong question is refused."""
    brake = {"script.hard_brake.do.deceleration": 8, "script.hard_brake.when.at": 0.2, "clock.duration": 2}
    run = finished(client, client.post("/api/runs", json={"scenario": SCENARIO, "set": brake}).json()["run"])["run"]
    found = client.get(f"/api/runs/{run}/explanation").json()
    assert {each["event"] for each in found} <= {"hard_brake", "near_miss", "collision"} and found[0]["lines"]
    assert client.get(f"/api/runs/{run}/explanation", params={"event": "1"}).json() == found[:1]
    refused = client.get(f"/api/runs/{run}/explanation", params={"event": "colision"})
    assert refused.status_code == 404 and "did you mean 'collision'" in refused.text


def test_compare(client, pair):
    found = client.get("/api/compare", params={"a": pair[0]["run"], "b": pair[1]["run"]}).json()
    assert [each["path"] for each in found["parameters"]] == ["applications.platoon.parameters.headway"]
    assert {each["better"] for each in found["metrics"]} <= {"a", "b", "same", None}
    assert found["alike"] == 0.01 and found["unranked"] == ""


@pytest.mark.parametrize(
    ("method", "path", "body", "status", "words"),
    [
        ("get", "/api/runs/999", None, 404, ["no run 999"]),
        ("get", "/api/runs/1/trace?channels=leader.sped", None, 404, ["did you mean 'leader.speed'"]),
        ("get", "/api/scenarios/none", None, 404, ["scenario", "none"]),
        ("get", "/api/scenarios/..%2f..%2fetc", None, 404, []),
        ("get", "/api/compare?a=1&b=999", None, 404, ["999"]),
        ("get", "/api/compare?a=1", None, 422, ["query.b"]),
        ("get", "/api/nonsense", None, 404, ["/api/nonsense"]),
        ("post", "/api/runs", {"scenario": SCENARIO, "set": {"radio.los": 1}}, 422, ["radio.los", "radio.loss"]),
        ("post", "/api/runs", {"scenario": SCENARIO, "set": {"radio.loss": 2}}, 422, ["radio.loss"]),
        (
            "post",
            "/api/runs",
            {"scenario": SCENARIO, "set": {"routes.east_to_west.roads": ["206170873#1", "340498991"]}},
            422,
            ["206170873#1"],
        ),
        ("post", "/api/runs", {"scenario": SCENARIO, "seed": -1}, 422, ["seed"]),
        ("post", "/api/runs", {"scenario": SCENARIO, "parent": 999}, 404, ["999"]),
        ("post", "/api/runs", {"scenario": "bad"}, 422, ["clok"]),
        ("post", "/api/runs", {"scene": SCENARIO}, 422, ["body"]),
        ("post", "/api/live", {"scenario": SCENARIO, "pace": 100}, 422, ["pace", "0.05"]),
        ("post", "/api/live/999/pause", None, 404, ["999"]),
        ("get", "/api/runs/99999999999999999999", None, 404, ["no run"]),
        ("get", f"/api/compare?a=1&b={10**30}", None, 404, ["no run"]),
        ("post", "/api/live", {"scenario": SCENARIO, "parent": 10**30}, 404, ["no run"]),
        ("post", "/api/runs", {"scenario": SCENARIO, "set": {"map.file": "x" * 5000}}, 422, ["map.file", "300"]),
        ("post", "/api/scene", {}, 422, ["a scenario or a run"]),
    ],
)
def test_refusals(client, pair, method, path, body, status, words):
    answer = client.request(method, path, json=body)
    assert answer.status_code == status, answer.text
    told = answer.json()
    assert set(told) == {"message", "problems"}
    for word in words:
        assert word in json.dumps(told, ensure_ascii=False)


def test_half_characters_and_zero_bytes(client):
    broken = b'{"scenario": "%s", "set": {"title": "\\ud800"}}' % SCENARIO.encode()
    answer = client.post("/api/runs", content=broken, headers={"Content-Type": "application/json"})
    assert answer.status_code == 422 and "Unicode" in answer.text
    assert client.post("/api/runs", content=b'{"scenario": "\\ud800"}', headers={"Content-Type": "application/json"}).status_code in (
        404,
        422,
    )
    assert client.get("/%00").status_code == client.get("/assets/%00").status_code == 404


OUTSIDE = ["/etc/passwd", "../../nowhere.osm", "maps/../../x.osm", "C:\\x.osm", "..\\x.osm", "//server/x.osm", "/etc", "/dev/stdin"]


@pytest.mark.parametrize("path", OUTSIDE)
@pytest.mark.parametrize("field", ["map.file", "vehicles.leader.model", "traffic.model", "traffic.routes"])
def test_rest_looks_at_no_other_folders(client, path, field):
    """Nor does it tell what is there: the same answer whether it exists or not."""
    name = path if field == "map.file" else f"{path}.yaml"
    for ask, key in (("runs", "problems"), ("live", "problems"), ("scene", "problems"), (f"scenarios/{SCENARIO}/check", "problems")):
        body = {"set": {field: name}} | ({} if "check" in ask else {"scenario": SCENARIO})
        (problem,) = client.post(f"/api/{ask}", json=body).json()[key]
        assert field in problem["where"] and "leads out" in problem["what"] and not problem["remedy"]
    assert client.patch(f"/api/scenarios/{SCENARIO}", json=[{"op": "add", "path": "/map/file", "value": path}]).status_code == 422


def test_what_is_no_file_blocks_nobody(client, server):
    """A pipe into which nobody writes, as a map, a scenario or a vehicle."""
    folder = server[1].parent / "scenarios"
    for name in ("pipe.osm", "pipe.yaml"):
        os.mkfifo(folder / name)
    changes = {"map.file": "pipe.osm"}, {"vehicles.leader.model": "./pipe.yaml"}
    answers = [client.post("/api/scene", json={"scenario": SCENARIO, "set": each}) for each in changes]
    answers.append(client.get("/api/scenarios/pipe"))
    for name in ("pipe.osm", "pipe.yaml"):
        (folder / name).unlink()
    assert [each.status_code for each in answers] == [422, 422, 422]


def test_a_check_knows_the_names(client):
    found = client.post(f"/api/scenarios/{SCENARIO}/check", json={"set": {"vehicles.leader.route": "nope"}}).json()
    assert not found["ok"] and "vehicles.leader.route" in found["problems"][0]["where"]


def test_nothing_was_written_by_refusals(client, pair):
    assert len(client.get("/api/runs").json()) == 4  # the pair, one with a goal, and one that brakes hard


def test_a_foreign_origin_is_forbidden_everywhere(client):
    for path in ("/", "/api/scenarios", "/scene/", "/openapi.json"):
        assert client.get(path, headers={"Origin": "http://evil.example"}).status_code == 403
    assert client.post("/api/runs", json={"scenario": SCENARIO}, headers={"Origin": "http://evil.example"}).status_code == 403
    assert client.get("/api/scenarios", headers={"Host": "evil.example"}).status_code == 403


def test_the_description_names_every_route(client):
    paths = client.get("/openapi.json").json()["paths"]
    assert {"/api/scenarios", "/api/runs", "/api/runs/{run}/trace", "/api/compare", "/api/live/{run}/pace"} <= set(paths)


def test_trajectories_come_for_other_programs(client, pair):
    path = f"/api/runs/{pair[0]['run']}/trajectories"
    fcd, table = client.get(path), client.get(path, params={"format": "csv", "degrees": True})
    assert fcd.headers["content-type"].startswith("application/xml") and fcd.text.endswith("</fcd-export>\n")
    assert table.headers["content-type"].startswith("text/csv")
    assert table.text.startswith("time,vehicle,type,x,y,angle,speed,acceleration,lane,pos,slope\n0.000,leader,bmw_320i,13.3")
    assert client.get(path, params={"format": "gpx"}).status_code == 422
    assert client.get("/api/runs/999/trajectories").status_code == 404


def test_the_description_names_what_the_socket_tells(client):
    api = client.get("/openapi.json").json()
    switching = api["paths"]["/api/live/{run}/socket"]["get"]["responses"]["1XX"]
    assert switching["content"]["application/json"]["schema"] == {"$ref": "#/components/schemas/News"}
    objects = api["components"]["schemas"]
    kinds = objects["News"]["discriminator"]["mapping"]
    assert set(kinds) == {"state", "channels", "samples", "layers", "event", "end", "refused"}
    for kind, reference in kinds.items():
        described = objects[reference.removeprefix("#/components/schemas/")]
        assert described["properties"]["type"]["const"] == kind and "type" in described["required"]


def test_the_socket_asked_for_as_a_page_says_what_it_is(client):
    answer = client.get("/api/live/1/socket")
    assert answer.status_code == 426 and answer.headers["Upgrade"] == "websocket"
    assert "WebSocket" in answer.json()["message"]


def test_the_glossary_explains_every_channel_and_metric(client, pair):
    found = client.get("/api/glossary").json()
    channels, metrics = ({each["name"]: each for each in found[kind]} for kind in ("channels", "metrics"))
    run = client.get(f"/api/runs/{pair[0]['run']}").json()
    of_vehicles = [each for each in run["channels"] if each["name"].count(".") == 1]  # what sensors give is told by their kinds
    assert len(of_vehicles) > 100
    for each in of_vehicles:
        known = channels[each["name"].partition(".")[2]]
        assert (known["unit"], known["label"]) == (each["unit"], each["label"])
    assert metrics.keys() == run["metrics"].keys()
    for name, measured in run["metrics"].items():
        assert (metrics[name]["unit"], metrics[name]["goal"]) == (measured["unit"], measured["goal"])
    assert all(each["meaning"] for each in found["channels"])
    assert all(each["title"] and each["explanation"] for each in found["metrics"])
    assert metrics["min_ttc"]["title"] == "Least time to collision" and metrics["min_ttc"]["goal"] == "higher"


def test_a_database_is_closed_when_its_request_is_over(client, pair, server):
    """Whatever has been asked, and whether it was refused: no descriptor waits for somebody to clear up."""
    for address in (
        "runs",
        "runs/1",
        "runs/999",
        "runs/1/trace?channels=leader.speed",
        "runs/1/explanation",
        "runs/1/beyond",
        "runs/1/trajectories",
        "compare?a=1&b=2",
    ):
        client.get(f"/api/{address}")
    process = psutil.Process(server[2].pid)
    until(lambda: not [each for each in process.open_files() if "runs.db" in each.path], "the database to be closed")


def test_the_list_of_runs_is_what_each_run_says_of_itself(client, pair):
    """SQLite writes its metrics as text: to the last bit what is kept, and what is described."""
    _, later = pair
    listed = next(each for each in client.get("/api/runs").json() if each["run"] == later["run"])
    answer.ListedRun.model_validate(listed)
    assert len(listed["metrics"]) > 20 and all(listed[name] == later[name] for name in listed if name != "settings")


def test_runs_come_in_pages(client, pair):
    every = [each["run"] for each in client.get("/api/runs").json()]
    assert every == sorted(every, reverse=True) and len(every) >= 2
    (first,) = client.get("/api/runs?limit=1").json()
    assert [first["run"], *(each["run"] for each in client.get(f"/api/runs?before={first['run']}").json())] == every
    assert client.get("/api/runs?before=0").status_code == 422
