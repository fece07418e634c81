"""Validation over REST: a project with its logs, what is done with it in processes of their own, and what came out."""

import time

import pytest
import yaml

from tests.patience import PATIENCE
from tests.server.server import served

PATCH = {"Content-Type": "application/json-patch+json"}


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    folder = tmp_path_factory.mktemp("validations")
    (folder / "scenarios").mkdir()
    with served(folder) as (client, _, process):
        yield client, folder / "scenarios" / "validation", process


@pytest.fixture(scope="module")
def client(running):
    return running[0]


def ended(client, job):
    """A job when it is over."""
    until = time.monotonic() + PATIENCE
    while (now := client.get(f"/api/validation-jobs/{job['id']}").json())["status"] == "running":
        assert time.monotonic() < until, now
        time.sleep(0.1)
    return now


def begun(client, project, **job):
    made = client.post(f"/api/validations/{project}/jobs", json=job)
    assert made.status_code == 202, made.text
    return ended(client, made.json())


@pytest.fixture(scope="module")
def project(client):
    """The sample: four runs calibrate, six validate."""
    made = client.post("/api/validations/sample", json={"name": "worn"})
    assert made.status_code == 202 and ended(client, made.json())["status"] == "done"
    return "worn"


def detail(client, project):
    return client.get(f"/api/validations/{project}").json()


def test_from_drives_to_a_validated_car(client, project):
    before = detail(client, project)
    assert [each["kind"] for each in before["files"]].count("log") == 10 and before["problems"] == [] and before["iterations"] == []
    looked = begun(client, project, task="look", log="turn_0.csv")["looked"]
    assert {each["name"] for each in looked["ours"]} == {"road_wheel_angle", "speed", "yaw_rate", "lateral_acceleration"}
    assert looked["ours"][0]["rate"] == pytest.approx(100.0) and [each["kind"] for each in looked["cuts"]] == ["j_turn"]
    assert all(len(each["time"]) == len(each["values"]) <= 3000 for each in looked["drawn"]) and looked["hints"] == []

    refused = begun(client, project, task="validate")
    (number,) = refused["kept"]["iterations"]
    assert client.get(f"/api/iterations/{number}").json()["result"]["valid"] is False

    (found,) = begun(client, project, task="calibrate")["kept"]["iterations"]
    estimate = client.get(f"/api/iterations/{found}").json()["result"]["estimates"][0]
    assert abs(estimate["value"] - 0.85) < 3 * estimate["spread"] + 0.002

    (judged,) = begun(client, project, task="validate")["kept"]["iterations"]
    after = client.get(f"/api/iterations/{judged}").json()
    assert after["result"]["valid"] and after["parent"] == found and after["changes"] == {estimate["path"]: estimate["value"]}
    courses = client.get(f"/api/validations/{project}/iterations/{judged}/courses").json()
    assert [each["signal"] for each in courses["courses"]] == ["yaw_rate", "lateral_acceleration"] and "two-sided" in courses["interval"]
    inside = [
        low <= ours <= high
        for course in courses["courses"]
        for low, ours, high in zip(course["low"], course["ours"], course["high"], strict=True)
        if None not in (low, ours, high)
    ]
    assert sum(inside) > 0.9 * len(inside)
    report = client.get(f"/api/validations/{project}/iterations/{judged}/report")
    assert report.status_code == 200 and report.text.count("<svg") == 2
    paper = client.get(f"/api/validations/{project}/iterations/{judged}/report.pdf")
    assert paper.headers["content-type"] == "application/pdf" and paper.content.startswith(b"%PDF-")
    assert [(each["unit"], each["error_unit"]) for each in after["result"]["verdicts"][:2]] == [("rad/s", "rad/s"), ("rad/s", "1")]
    car = yaml.safe_load(client.get(f"/api/validations/{project}/iterations/{judged}/vehicle").text)
    assert car["validated"] == after["result"]["span"]["whole"]
    assert car["tyres"]["front_cornering"]["value"] == estimate["value"] and "calibrated" in car["tyres"]["front_cornering"]["source"]
    rows = detail(client, project)["iterations"]
    assert [each["iteration"] for each in rows] == [judged, found, number] and [each["valid"] for each in rows] == [True, None, False]
    assert client.get("/api/validations").json()[0]["valid"] is True


def test_a_project_is_changed_by_patches_that_keep_its_comments(client, project, running):
    before = detail(client, project)
    patch = [{"op": "add", "path": "/confidence", "value": "one-sided"}]
    done = client.patch(f"/api/validations/{project}", json=patch, headers=PATCH | {"If-Match": before["digest"]})
    now = detail(client, project)
    assert done.status_code == 200 and now["digest"] == done.json()["digest"] and now["document"]["confidence"] == "one-sided"
    assert now["text"].startswith("# Ten drives whose truth is known")
    late = client.patch(f"/api/validations/{project}", json=patch, headers=PATCH | {"If-Match": before["digest"]})
    assert late.status_code == 412 and detail(client, project)["text"] == now["text"]
    back = client.patch(f"/api/validations/{project}", json=done.json()["inverse"], headers=PATCH)
    assert back.status_code == 200 and detail(client, project)["text"] == before["text"]


def test_a_cut_beyond_its_log_is_refused_when_it_is_saved(client, project):
    """The logs of the sample begin at 0 s; what the last one of a kind has stands in what it is looked at for."""
    before = detail(client, project)
    log = before["document"]["maneuvers"]["turn"]["validation"][0]["log"]
    until = max(each["until"] for each in begun(client, project, task="look", log=log)["looked"]["ours"])
    cut = lambda **times: [{"op": "replace", "path": "/maneuvers/turn/validation/0", "value": {"log": log, **times}}]  # noqa: E731
    for times, field in (({"begin": 61.5, "end": 68}, "begin"), ({"end": until + 1}, "end"), ({"begin": until}, "begin")):
        refused = client.patch(f"/api/validations/{project}", json=cut(**times), headers=PATCH)
        assert refused.status_code == 422, times
        (told,) = refused.json()["problems"]
        assert told["where"] == f"maneuvers.turn.validation.0.{field}" and told["allowed"] == f"0 to {until:.2f} s", told
    assert client.patch(f"/api/validations/{project}", json=cut(begin=2, end=1), headers=PATCH).status_code == 422
    text = before["text"].replace(f"{{log: {log}}}", f"{{log: {log}, begin: 61.5}}")
    assert text != before["text"] and client.put(f"/api/validations/{project}/text", content=text.encode()).status_code == 422
    assert detail(client, project)["text"] == before["text"]
    kept = client.patch(f"/api/validations/{project}", json=cut(begin=0.2, end=round(until, 2)), headers=PATCH)
    assert kept.status_code == 200
    client.patch(f"/api/validations/{project}", json=kept.json()["inverse"], headers=PATCH)
    assert detail(client, project)["text"] == before["text"]


def test_what_is_no_number_of_the_vehicle_is_not_looked_for(client, project):
    """Told when it is saved, with the nearest that there is; what stands there already hinders nobody who saves something else."""
    before = detail(client, project)
    offered = {each["path"]: each for each in before["parameters"]}
    assert offered["wheels.rolling_resistance"] == {
        "path": "wheels.rolling_resistance",
        "title": "Rolling resistance over load",
        "unit": "1",
        "value": 0.012,
        "low": 0.01,
        "high": 0.015,
    }
    assert offered["body.mass"]["unit"] == "kg" and offered["body.mass"]["low"] is None
    assert "gearbox.ratios" not in offered and "title" not in offered

    def looked_for(path):
        patch = [{"op": "add", "path": f"/calibration/lateral/parameters/{path}", "value": {"low": 0.5, "high": 2.0}}]
        return client.patch(f"/api/validations/{project}", json=patch, headers=PATCH)

    refused = looked_for("tyres.front_corner")
    assert refused.status_code == 422 and detail(client, project)["text"] == before["text"]
    (told,) = refused.json()["problems"]
    assert told["where"] == "calibration.lateral.parameters.tyres.front_corner" and "tyres.front_cornering" in told["remedy"]
    kept = looked_for("body.mass")
    assert kept.status_code == 200
    client.patch(f"/api/validations/{project}", json=kept.json()["inverse"], headers=PATCH)


def test_a_new_project_gets_its_files_and_loses_none(client, running):
    made = client.post("/api/validations", json={"name": "mine", "title": "My car", "vehicle": "bmw_320i"})
    assert made.status_code == 201 and made.json()["document"]["title"] == "My car"
    assert client.post("/api/validations", json={"name": "Mine"}).status_code == 409
    rows = "t [s];Geschwindigkeit [km/h]\n" + "".join(f"{i / 10:.1f};{36 + i / 10:.1f}\n".replace(".", ",") for i in range(50))
    sent = client.put("/api/validations/mine/files/drive.csv", content=rows.encode())
    assert sent.status_code == 201 and sent.json() == {"name": "drive.csv", "bytes": len(rows), "kind": "log"}
    assert client.put("/api/validations/mine/files/drive.csv", content=b"x").status_code == 409
    unknown = begun(client, "mine", task="look", log="drive.csv")["looked"]
    assert [each["unit"] for each in unknown["recorded"]] == ["km/h"] and unknown["ours"] == []
    mapping = b"signals:\n  speed: {from: Geschwindigkeit, unit: km/h}\n"
    assert client.put("/api/validations/mine/files/mapping.yaml", content=mapping).json()["kind"] == "mapping"
    known = begun(client, "mine", task="look", log="drive.csv", mapping="mapping.yaml")["looked"]
    assert known["ours"][0]["low"] == pytest.approx(10.0) and known["ours"][0]["unit"] == "m/s"
    assert known["mapping"]["signals"]["speed"]["from"] == "Geschwindigkeit" and known["mapping"]["dbc"] is None
    assert unknown["mapping"] is None
    nothing = begun(client, "mine", task="validate")
    assert nothing["status"] == "failed" and "nothing to validate with" in nothing["problem"]["message"]
    assert client.delete("/api/validations/mine/files/drive.csv").status_code == 204
    assert client.delete("/api/validations/mine/files/project.yaml").status_code == 409


def test_a_title_is_of_one_project(client, project):
    title = detail(client, project)["document"]["title"]
    made = client.post("/api/validations", json={"name": "same", "title": title, "vehicle": "bmw_320i"}).json()
    assert made["document"]["title"] == f"{title}, 2" and made["iterations"] == []
    refused = client.patch("/api/validations/same", json=[{"op": "replace", "path": "/title", "value": title}], headers=PATCH)
    assert refused.status_code == 409 and "iterations are kept by title" in refused.text
    put = client.put("/api/validations/same/text", content=made["text"].replace(f"{title}, 2", title).encode())
    assert put.status_code == 409 and detail(client, "same")["text"] == made["text"]
    kept = client.patch("/api/validations/same", json=[{"op": "add", "path": "/confidence", "value": "one-sided"}], headers=PATCH)
    assert kept.status_code == 200


def test_a_sample_that_comes_to_nothing_leaves_its_name_free(client, project, running):
    long = client.post(f"/api/validations/{project}/jobs", json={"task": "calibrate", "afresh": True}).json()
    waiting = client.post("/api/validations/sample", json={"name": "second"}).json()
    assert client.delete(f"/api/validation-jobs/{waiting['id']}").json()["status"] == "cancelled"
    assert not (running[1] / "second").exists()
    more = [client.post(f"/api/validations/{project}/jobs", json={"task": "validate"}).json() for _ in range(15)]
    assert client.post("/api/validations/sample", json={"name": "second"}).status_code >= 400 and not (running[1] / "second").exists()
    for each in [*more, long]:
        client.delete(f"/api/validation-jobs/{each['id']}")
    again = client.post("/api/validations/sample", json={"name": "second"})
    assert again.status_code == 202 and ended(client, again.json())["status"] == "done"
    assert detail(client, "second")["document"]["title"] != detail(client, project)["document"]["title"]


@pytest.mark.parametrize(
    "name", ["../out.csv", "..%2Fout.csv", "project.yaml", "drive.exe", ".hidden.csv", "con.csv"],
)  # fmt: skip
def test_names_of_files_lead_nowhere_else(client, project, running, name):
    before = sorted(running[1].rglob("*"))
    assert client.put(f"/api/validations/{project}/files/{name}", content=b"t,v\n0,1\n").status_code >= 400
    assert sorted(running[1].rglob("*")) == before


@pytest.mark.parametrize("path", ["../../secret.csv", "/etc/passwd", "C:\\secret.csv", "a/../../b.csv"])
def test_what_is_sent_names_no_file_elsewhere(client, project, path):
    before = detail(client, project)
    text = before["text"].replace("turn_0.csv", path)
    put = client.put(f"/api/validations/{project}/text", content=text.encode())
    assert put.status_code == 422 and "leads out of the project's folder" in put.text
    mapping = f"dbc: {path!r}\nsignals:\n  speed: {{from: v, unit: m/s}}\n"
    sent = client.put(f"/api/validations/{project}/files/other.yaml", content=mapping.encode())
    assert sent.status_code == 422 and "leads out" in sent.text
    assert client.put(f"/api/validations/{project}/files/other.YAML", content=mapping.encode()).status_code == 422
    tyres = f"tyres:\n  front: {path!r}\n"
    sent = client.put(f"/api/validations/{project}/files/car.yaml", content=tyres.encode())
    assert sent.status_code == 422 and "tyres.front" in sent.text
    patch = [{"op": "add", "path": "/changes", "value": {"tyres.front": path}}]
    changed = client.patch(f"/api/validations/{project}", json=patch, headers=PATCH)
    assert changed.status_code == 422 and "leads out" in changed.text
    assert detail(client, project)["text"] == before["text"]


def test_a_mapping_is_not_hidden_in_a_log(client, project):
    hidden = b"dbc: /etc/passwd\nsignals:\n  speed: {from: v, unit: m/s}\n"
    assert client.put(f"/api/validations/{project}/files/hidden.csv", content=hidden).status_code == 201
    looked = client.post(f"/api/validations/{project}/jobs", json={"task": "look", "log": "turn_0.csv", "mapping": "hidden.csv"})
    assert looked.status_code == 422 and "is no YAML file" in looked.text
    for place, value in (("mapping", "hidden.csv"), ("vehicle", "./hidden.csv")):
        patch = [{"op": "add", "path": f"/{place}", "value": value}]
        assert client.patch(f"/api/validations/{project}", json=patch, headers=PATCH).status_code == 422
    assert client.delete(f"/api/validations/{project}/files/hidden.csv").status_code == 204


def test_what_is_wrong_is_told_at_its_line(client, project):
    text = detail(client, project)["text"].replace("kind: j_turn", "kind: j_tur")
    told = client.put(f"/api/validations/{project}/text", content=text.encode()).json()["problems"][0]
    assert told["where"].startswith("project.yaml, line 6, column") and "j_turn" in told["remedy"]


def test_what_is_cancelled_keeps_the_steps_that_were_over_and_nothing_else(client, project):
    text, before = (detail(client, project)[each] for each in ("text", "iterations"))
    step = {"parameters": {"tyres.front_cornering": {"low": 0.5, "high": 1.5}}}
    patch = [{"op": "add", "path": "/calibration/again", "value": step}]
    assert client.patch(f"/api/validations/{project}", json=patch, headers=PATCH).status_code == 200
    job = client.post(f"/api/validations/{project}/jobs", json={"task": "calibrate", "afresh": True}).json()
    until = time.monotonic() + PATIENCE
    while (now := client.get(f"/api/validation-jobs/{job['id']}").json())["stage"] != "calibrating: again":
        assert now["status"] == "running" and time.monotonic() < until, now
        time.sleep(0.02)
    assert client.delete(f"/api/validation-jobs/{job['id']}").json()["status"] == "cancelled"
    assert begun(client, project, task="look", log="turn_1.csv")["status"] == "done"  # after the process of the other has ended
    first, *others = detail(client, project)["iterations"]
    assert first["step"] == "lateral" and others == before and ended(client, job)["status"] == "cancelled"
    assert client.put(f"/api/validations/{project}/text", content=text.encode()).status_code == 200


def test_a_damaged_log_ends_its_own_errand_only(client, project):
    sent = client.put(f"/api/validations/{project}/files/bad.mf4", content=b"MDF     4.10" + bytes(50))
    assert sent.status_code == 201
    told = begun(client, project, task="look", log="bad.mf4")
    assert told["status"] == "failed" and "bad.mf4" in told["problem"]["message"]
    assert client.get("/api/validations").status_code == 200


def test_unknown_things_are_told(client, project):
    assert client.get("/api/validations/wor").json()["problems"][0]["remedy"] == "did you mean 'worn'?"
    for address in ("/api/iterations/999", "/api/validation-jobs/999", f"/api/validations/{project}/iterations/999/report.pdf"):
        assert client.get(address).status_code == 404
    assert client.post(f"/api/validations/{project}/jobs", json={"task": "look", "log": "turn_99.csv"}).status_code == 404
    assert client.post(f"/api/validations/{project}/jobs", json={"task": "sample"}).status_code == 422
