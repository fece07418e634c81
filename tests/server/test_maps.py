"""Maps over REST: imports in processes of their own, reports, corrections, a first drive. Whatever is sent, the server lives."""

import gzip
import json
import re
import shutil
import threading
import time
from pathlib import Path

import psutil
import pytest
import yaml

from studio import job
from studio.errors import MapError, ServerError
from studio.road import load
from studio.server import maps as server_maps
from studio.server.maps import job as map_job
from tests.patience import PATIENCE, until
from tests.road.test_download import RECORDED
from tests.road.test_download import server as answering
from tests.server.server import served

REFERENCE = Path(__file__).parents[1] / "reference" / "maps"
PERTH = REFERENCE / "perth_peanut_roundabout_lht.osm.gz"
MANCHESTER = REFERENCE / "manchester_kingsway_lht.osm.gz"
STREET = "way 59876790"  # Dorset Street, Manchester: neither lanes nor maxspeed are mapped


@pytest.fixture(scope="module")
def overpass():
    """An Overpass server that keeps silent until it is told to answer."""
    speak = threading.Event()

    def body(out):
        speak.wait(PATIENCE)
        out.write(RECORDED)

    with answering((200, {"Content-Type": "application/json", "Connection": "close"}, body)) as (address, asked):
        yield address, asked, speak
        speak.set()


@pytest.fixture(scope="module")
def running(tmp_path_factory, sample, overpass):
    """Client, folder and process of a server with the sample and its map."""
    place = tmp_path_factory.mktemp("maps")
    (place / "scenarios" / "maps").mkdir(parents=True)
    shutil.copy(sample, place / "scenarios")
    shutil.copy(sample.parent / "maps" / "berlin_siegessaeule_grosser_stern.osm.gz", place / "scenarios" / "maps")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("NO_PROXY", "*")
        patch.setenv("STUDIO_OVERPASS", overpass[0])
        with served(place) as (client, _, process):
            yield client, place / "scenarios", process


@pytest.fixture(scope="module")
def client(running):
    return running[0]


@pytest.fixture(scope="module")
def folder(running):
    return running[1] / "maps"


def over(client, answer):
    """The import of an answer, when it is over."""
    assert answer.status_code == 202, answer.text
    return ended(client, answer.json()["id"])


def ended(client, number):
    """An import, when it is over."""
    return once(client, number, lambda row: row["status"] != "running")


def once(client, number, is_so):
    """An import, as soon as something is so."""

    def look():
        row = client.get(f"/api/map-jobs/{number}").json()
        return row if is_so(row) else None

    return until(look, f"import {number}")


def uploaded(client, name, content, **options):
    """The import of a file that is sent, when it is over."""
    return over(client, client.post("/api/maps", params={"name": name, **options}, content=content))


def done(client, name, content, **options):
    """The map of a file that is sent."""
    row = uploaded(client, name, content, **options)
    assert row["status"] == "done", row
    return row["map"]


def leftovers(folder):
    """What imports have not cleared away."""
    return [each.name for each in folder.iterdir() if each.name.startswith(".")]


@pytest.fixture(scope="module")
def perth(client):
    """Perth, imported."""
    return done(client, "Perth.osm.gz", PERTH.read_bytes())


@pytest.fixture(scope="module")
def manchester(client):
    """Manchester, imported."""
    return done(client, "Manchester.osm.gz", MANCHESTER.read_bytes())


# -- what there is -----------------------------------------------------------------------------------


def test_imports_and_files_are_listed(client, perth):
    rows = {each["id"]: each for each in client.get("/api/maps").json()}
    file, made = rows["berlin_siegessaeule_grosser_stern.osm.gz"], rows[perth]
    assert (file["kind"], file["drive_side"], file["problem"]) == ("file", None, None)
    assert (made["kind"], made["source"], made["drive_side"], made["problem"]) == ("import", "Perth.osm.gz", "left", None)
    assert made["attribution"] == "© OpenStreetMap contributors" and "ODbL" in made["licence"] and made["bytes"] > 30_000
    assert made["lane_km"] == load(PERTH).report.lane_km


def test_the_report_points_at_places_on_the_plan(client, manchester):
    found, plan = client.get(f"/api/maps/{manchester}").json(), client.get(f"/api/maps/{manchester}/plan").json()
    report = found["report"]
    things = [*report["guesses"], *report["skipped"], *report["corrected"]]
    assert [each["number"] for each in things] == list(range(1, len(things) + 1))
    guess = next(each for each in report["guesses"] if each["element"] == STREET and each["kind"] == "lanes")
    assert guess["key"] == "lanes" and guess["where"] == f"{STREET} (Dorset Street)"
    marks = {each["number"]: each for each in [*plan["guesses"], *plan["skipped"]]}
    assert marks[guess["number"]] == {key: guess[key] for key in ("number", "kind", "x", "y")}
    road = next(each for each in plan["roads"] if int(STREET.split()[1]) in each["ways"])
    lines = [point for lane in plan["lanes"] if lane["id"] in road["lanes"] for point in lane["centre"]]
    assert min((x - guess["x"]) ** 2 + (y - guess["y"]) ** 2 for x, y in lines) < 15.0**2


def test_the_plan_is_the_network(client, manchester):
    plan, network = client.get(f"/api/maps/{manchester}/plan").json(), load(MANCHESTER)
    assert plan["drive_side"] == "left" and plan["bounds_m"] == pytest.approx(network.bounds)
    assert [each["id"] for each in plan["lanes"]] == [each.id for each in network.lanes]
    assert len(plan["signals"]) == len(network.signals) and len(plan["buildings"]) == len(network.scenery.buildings)
    mapped = set(map(int, re.findall(rb'<way [^>]*?\bid="(\d+)"', gzip.decompress(MANCHESTER.read_bytes()))))
    ways = {way for road in plan["roads"] for way in road["ways"]}
    assert len(ways) > 30 and ways <= mapped


def test_a_plain_file_has_a_report_and_a_plan(client, folder):
    found = client.get("/api/maps/berlin_siegessaeule_grosser_stern.osm.gz").json()
    assert found["kind"] == "file" and found["corrections"] == []
    assert found["report"]["lane_km"] == load(folder / "berlin_siegessaeule_grosser_stern.osm.gz").report.lane_km
    assert client.get("/api/maps/berlin_siegessaeule_grosser_stern.osm.gz/plan").json()["drive_side"] == "right"


# -- names -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "becomes"),
    [
        ("東京 駅.osm.gz", "東京_駅"),
        ("../../../evil.osm.gz", "evil"),
        ("C:\\maps\\city.OSM.GZ", "city"),
        (".hidden.osm.gz", "hidden"),
        ("नमस्ते.osm.gz", "नमस्ते"),
        ("x" * 290 + ".osm.gz", "x" * 80),
    ],
)
def test_names_of_any_script_stay_in_the_folder(client, folder, name, becomes):
    made = done(client, name, PERTH.read_bytes())
    assert made == becomes and (folder / becomes / "report.json").is_file()
    assert client.get(f"/api/maps/{made}").json()["id"] == made
    assert client.delete(f"/api/maps/{made}").status_code == 204 and not (folder / becomes).exists()


def test_a_name_that_is_taken_gets_a_number(client, perth):
    again = done(client, "Perth.osm.gz", PERTH.read_bytes())
    assert again == f"{perth}_2" and client.delete(f"/api/maps/{again}").status_code == 204


@pytest.mark.parametrize(
    ("path", "says"),
    [
        ("/api/maps?name=map.kml", ".osm.pbf"),
        ("/api/maps?name=...osm", "no letter or digit"),
        ("/api/maps?name=a.osm&bbox=5.8,47.2,15.1,55.1", "limit of 25 km"),
        ("/api/maps?name=a.osm&bbox=1,2", "west,south,east,north"),
        ("/api/maps", "query.name"),
    ],
)
def test_what_is_wrong_with_the_question_is_told_at_once(client, path, says):
    refused = client.post(path, content=b"x")
    assert refused.status_code == 422 and says in refused.text


@pytest.mark.parametrize("path", ["none", "..%2f..%2fscenarios", "%2e%2e%2fmaps", ".hidden", "none/plan"])
def test_there_is_no_way_out_of_the_folder(client, path):
    assert client.get(f"/api/maps/{path}").status_code == 404


def test_pages_from_elsewhere_are_refused(client):
    refused = client.post("/api/maps?name=a.osm", content=b"x", headers={"Origin": "http://evil.example"})
    assert refused.status_code == 403


# -- bad files ---------------------------------------------------------------------------------------

LAUGHS = b"<!DOCTYPE osm [" + b"".join(b'<!ENTITY a%d "%s">' % (i, b"&a%d;" % (i - 1) * 10) for i in range(1, 10)) + b"]><osm>&a9;</osm>"


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("empty.osm", b"", "empty"),
        ("cut.osm.gz", PERTH.read_bytes()[:4000], "damaged"),
        ("cut.osm", gzip.decompress(PERTH.read_bytes())[:4000], "cannot be read"),
        ("entities.osm", LAUGHS, "entities"),
        ("no.osm.pbf", b"\x00\x00\x00\x0d" + b"garbage" * 99, "cannot be read"),
        ("page.osm", b"<html><body>busy</body></html>", "cannot be read"),
        ("page.json", b"<html><body>busy</body></html>", "not JSON"),
        ("roads.osm", b'<osm version="0.6"><node id="1" version="1" lat="1" lon="1"/></osm>', "no roads"),
        ("bomb.osm.gz", gzip.compress(bytes(513 * 2**20), 1), "larger than 512 MiB"),
    ],
)
def test_a_bad_file_ends_with_one_message_and_nothing_stays(client, folder, name, content, says):
    row = uploaded(client, name, content)
    assert row["status"] == "failed" and says in row["problem"]["message"] and name in row["problem"]["message"]
    assert str(folder) not in json.dumps(row) and "Traceback" not in json.dumps(row)
    assert not (folder / row["map"]).exists() and not leftovers(folder)
    assert client.get("/api/info").status_code == 200


def test_a_file_of_a_hundred_megabytes_is_taken(client, folder):
    """As large as may be: a street, and blanks."""
    nodes = '<node id="1" version="1" lat="52.5" lon="13.4"/><node id="2" version="1" lat="52.501" lon="13.404"/>'
    way = '<way id="5" version="1"><nd ref="1"/><nd ref="2"/><tag k="highway" v="residential"/></way>'
    head, tail = f'<osm version="0.6">{nodes}'.encode(), f"{way}</osm>".encode()
    made = done(client, "vast.osm", head + b" " * (100 * 2**20 - len(head) - len(tail)) + tail)
    assert client.get(f"/api/maps/{made}").json()["report"]["lane_km"] == pytest.approx(2 * 0.293, rel=0.02)
    assert client.delete(f"/api/maps/{made}").status_code == 204 and not leftovers(folder)


def test_more_than_a_hundred_megabytes_are_refused(client, folder):
    chunk = b" " * 2**20
    for content in (chunk * 101, (chunk for _ in range(101))):  # with its length, and without
        refused = client.post("/api/maps?name=vast.osm", content=content)
        assert refused.status_code == 413 and "at most 100 MiB" in refused.text
    assert not leftovers(folder)


def test_an_upload_without_room_is_refused_before_it_comes(tmp_path):
    """One that would fill the disk by itself: there is no room for what is made of it."""
    map_job.check_disk(tmp_path, 1000)
    with pytest.raises(ServerError, match=r"no room(.|\n)*MB free"):
        map_job.check_disk(tmp_path, shutil.disk_usage(tmp_path).free)


def test_an_upload_that_breaks_off_leaves_nothing(client, folder):
    """In the folder, nor in what the server says."""

    def broken():
        yield b"<osm"
        raise OSError("the cable")

    with pytest.raises(OSError, match="the cable"):
        client.post("/api/maps?name=half.osm", content=broken())
    until(lambda: not leftovers(folder), "a tidy folder")
    assert not (folder / "half").exists()
    assert "Traceback" not in (folder.parent.parent / "server.log").read_text()


# -- downloads, cancelling, crashes ------------------------------------------------------------------

BOX = [-122.34, 47.6155, -122.3365, 47.6185]
ASKING = ("asking 127.0.0.1", "downloading")


def processes(running):
    """The processes of the server, and theirs."""
    return {each.pid for each in psutil.Process(running[2].pid).children(recursive=True)}


def asking(client, **wanted):
    """A download that waits for the silent server."""
    number = client.post("/api/maps/download", json={"bbox": BOX, **wanted}).json()["id"]
    once(client, number, lambda row: row["stage"] in ASKING)
    return number


def test_two_at_a_time_and_none_is_left_when_cancelled(client, folder, running, overpass):
    before = processes(running)
    first, second = asking(client), asking(client, name="second")
    third = client.post("/api/maps/download", json={"bbox": BOX}).json()
    assert third["map"] == "place_47_6170_-122_3383_2" and third["stage"] == "waiting for other imports"
    assert [each["id"] for each in client.get("/api/map-jobs").json()[:3]] == [third["id"], second, first]
    assert client.delete(f"/api/map-jobs/{first}").json()["status"] == "cancelled"
    once(client, third["id"], lambda row: row["stage"] in ASKING)
    for number in (second, third["id"]):
        assert client.delete(f"/api/map-jobs/{number}").json()["status"] == "cancelled"
        assert client.delete(f"/api/map-jobs/{number}").json()["status"] == "cancelled"  # once more changes nothing
    until(lambda: not leftovers(folder) and not processes(running) - before, "a tidy folder without processes")
    assert not [each for each in client.get("/api/maps").json() if "place" in each["id"] or each["id"] == "second"]


def quiet(running):
    """The processes of a server that starts and ends none just now."""
    found = processes(running)
    time.sleep(1.0)
    return found if found == processes(running) else set()


def test_a_process_that_is_killed_fails_its_import_only(client, folder, running):
    before = until(lambda: quiet(running), "a quiet server")
    number = asking(client, name="killed")
    (pid,) = (each for each in processes(running) - before if not psutil.Process(each).children())  # the other one is its guard
    psutil.Process(pid).kill()
    row = ended(client, number)
    assert row["status"] == "failed" and "ended by the system" in row["problem"]["problems"][0]["what"]
    assert not (folder / "killed").exists() and client.get("/api/info").status_code == 200


def test_a_download_becomes_a_map(client, overpass):
    number = asking(client, name="Dreieck")
    overpass[2].set()
    row = ended(client, number)
    assert row["status"] == "done" and row["share"] == 1.0, row
    found = client.get(f"/api/maps/{row['map']}").json()
    assert found["source"] == "Dreieck.json" and found["bbox"].startswith("-122.34") and found["report"]["lane_km"] > 0.5


@pytest.mark.parametrize(
    ("wanted", "says"),
    [
        ({}, "give one of them"),
        ({"place": "Berlin", "bbox": BOX}, "give one of them"),
        ({"bbox": [5.8, 47.2, 15.1, 55.1]}, "limit of 25 km"),
        ({"bbox": [13.3, 52.45, 13.45, 52.55]}, "at most 40 km²"),
        ({"bbox": [1, 1, 1, 1]}, "no area"),
        ({"bbox": [1, 2]}, "body.bbox"),
        ({"place": ""}, "body.place"),
        ({"place": "Berlin", "name": "///"}, "no letter or digit"),
    ],
)
def test_a_download_that_nobody_should_be_asked_for(client, overpass, wanted, says):
    before = len(overpass[1])
    refused = client.post("/api/maps/download", json=wanted)
    assert refused.status_code == 422 and says in json.dumps(refused.json(), ensure_ascii=False) and len(overpass[1]) == before


def test_imports_end_with_the_server(tmp_path, monkeypatch):
    (tmp_path / "scenarios").mkdir()
    silence = threading.Event()
    monkeypatch.setenv("NO_PROXY", "*")
    with answering((200, {}, lambda out: silence.wait(PATIENCE))) as (address, _):
        monkeypatch.setenv("STUDIO_OVERPASS", address)
        with served(tmp_path) as (client, _, process):
            asking(client)
            begun = [psutil.Process(pid) for pid in processes((None, None, process))]
        silence.set()
    psutil.wait_procs(begun, timeout=PATIENCE)
    assert not [each for each in begun if each.is_running() and each.status() != psutil.STATUS_ZOMBIE]
    assert not leftovers(tmp_path / "scenarios" / "maps")


# -- corrections -------------------------------------------------------------------------------------


def corrected(client, name, **correction):
    return over(client, client.put(f"/api/maps/{name}/corrections", json=correction))


def test_a_correction_settles_a_guess_and_is_taken_back(client, manchester):
    before = client.get(f"/api/maps/{manchester}").json()
    row = corrected(client, manchester, element=STREET, tags={"lanes": "3", "maxspeed": "20 mph"})
    assert row["status"] == "done" and row["map"] == manchester, row
    after = client.get(f"/api/maps/{manchester}").json()
    assert after["corrections"] == [{"element": STREET, "tags": {"lanes": "3", "maxspeed": "20 mph"}, "removed": []}]
    assert not [each for each in after["report"]["guesses"] if each["element"] == STREET]
    (noted,) = after["report"]["corrected"]
    assert noted["before"] == {"lanes": "", "maxspeed": ""} and noted["where"] == f"{STREET} (Dorset Street)"
    assert after["digest"] != before["digest"] and after["source"] == before["source"]
    plan = client.get(f"/api/maps/{manchester}/plan").json()
    own = [lane for road in plan["roads"] if 59876790 in road["ways"] for lane in plan["lanes"] if lane["id"] in road["lanes"]]
    assert {round(lane["speed"] * 3.6) for lane in own} == {32}
    again = done(client, "Manchester.osm.gz", MANCHESTER.read_bytes(), replace=True)  # a newer file
    assert again == manchester and client.get(f"/api/maps/{manchester}").json()["corrections"] == after["corrections"]
    assert over(client, client.delete(f"/api/maps/{manchester}/corrections/{STREET}"))["status"] == "done"
    back = client.get(f"/api/maps/{manchester}").json()
    assert back["digest"] == before["digest"] and back["corrections"] == []


def test_corrections_one_after_the_other_are_all_kept(client, perth):
    asked = [
        client.put(f"/api/maps/{perth}/corrections", json={"element": "way 35468318", "tags": tags})
        for tags in ({"lanes": "2"}, {"width": "7"})
    ]
    assert [over(client, each)["status"] for each in asked] == ["done", "done"]
    (kept,) = client.get(f"/api/maps/{perth}").json()["corrections"]
    assert kept["tags"] == {"lanes": "2", "width": "7"}
    assert over(client, client.delete(f"/api/maps/{perth}/corrections/way 35468318"))["status"] == "done"


@pytest.mark.parametrize(
    ("correction", "says"),
    [
        ({"element": "way 1; rm -rf /", "tags": {"lanes": "2"}}, "element"),
        ({"element": STREET, "tags": {"lanes": "0"}}, "1 to 16"),
        ({"element": STREET, "tags": {"lanes": "17"}}, "1 to 16"),
        ({"element": STREET, "tags": {"maxspeed": "fast"}}, "maxspeed"),
        ({"element": STREET, "tags": {"turn:lanes": "up|down"}}, "turn:lanes"),
        ({"element": STREET, "tags": {"name": "a\u0000b"}}, "cannot be printed"),
        ({"element": STREET, "tags": {"name": "\ud800"}}, "no Unicode"),
        ({"element": STREET}, "say nothing"),
        ({"element": STREET, "tags": {"lanes": 2}}, "body.tags.lanes"),
        ({"element": STREET, "tag": {}}, "body.tag"),
    ],
)
def test_a_correction_that_means_nothing_is_refused_at_once(client, manchester, correction, says):
    refused = client.put(
        f"/api/maps/{manchester}/corrections", content=json.dumps(correction), headers={"Content-Type": "application/json"}
    )
    assert refused.status_code == 422 and says in refused.text


def test_a_correction_that_fails_changes_nothing(client, folder, manchester):
    before = (folder / manchester / "report.json").read_bytes()
    row = corrected(client, manchester, element="way 1", tags={"lanes": "2"})
    assert row["status"] == "failed" and "no 'way 1'" in row["problem"]["message"]
    assert (folder / manchester / "report.json").read_bytes() == before and not (folder / manchester / "corrections.json").exists()
    refused = client.delete(f"/api/maps/{manchester}/corrections/way 1")
    assert refused.status_code == 422 and "no correction" in refused.text


def test_a_plain_file_cannot_be_corrected_or_removed(client, folder):
    name = "berlin_siegessaeule_grosser_stern.osm.gz"
    assert "import it first" in client.put(f"/api/maps/{name}/corrections", json={"element": "way 1", "tags": {"lanes": "2"}}).text
    assert client.delete(f"/api/maps/{name}").status_code == 422 and (folder / name).is_file()


# -- a first drive -----------------------------------------------------------------------------------


def test_a_map_is_driven_at_once(client, running, perth):
    """Scenario, scene and a run from start to arrival, all on the folder of an import."""
    answer = client.post(f"/api/maps/{perth}/drive")
    assert answer.status_code == 201, answer.text
    name = answer.json()["scenario"]
    row = next(each for each in client.get("/api/scenarios").json() if each["id"] == name)
    assert row["problem"] is None and row["vehicles"] == 1
    assert client.post(f"/api/scenarios/{name}/check", json={}).json()["ok"]
    assert client.post("/api/scene", json={"scenario": name}).json()["vehicles"][0]["name"] == "ego"
    loaded = job.load(running[1] / f"{name}.yaml")
    prepared = job.prepare(loaded)
    assert prepared.network.digest == load(running[1] / "maps" / perth).digest == client.get(f"/api/maps/{perth}").json()["digest"]
    assert prepared.cars[0].path.length > 500.0
    result = job.run(loaded)
    assert result.status == "done" and result.metrics["collisions"].value == 0
    assert "arrived at the end of its route" in [each.text for each in result.record.happenings]


def test_a_radius_still_cuts_an_import(running, perth):
    found = job.load(next(running[1].glob(f"{perth}_drive.yaml")))
    whole, cut = load(running[1] / "maps" / perth), job.prepare(job.load(found.path, {"map.radius": 400})).network
    assert max(map(abs, cut.bounds)) == pytest.approx(400.0, rel=0.01)
    assert max(map(abs, whole.bounds)) > 600.0


def test_a_second_drive_has_another_name_and_the_same_way(client, running, perth):
    names = [client.post(f"/api/maps/{perth}/drive").json()["scenario"] for _ in range(2)]
    a, b = (yaml.safe_load((running[1] / f"{name}.yaml").read_text()) for name in names)
    assert names[0] != names[1] and a == b


def test_a_map_in_use_is_not_removed(client, running, folder, perth):
    refused = client.delete(f"/api/maps/{perth}")
    assert refused.status_code == 422 and f"scenario {perth}_drive" in refused.text and (folder / perth).is_dir()
    for each in running[1].glob(f"{perth}_drive*.yaml"):
        each.unlink()
    (folder / perth / "thesis.txt").write_text("years")
    assert "thesis.txt" in client.delete(f"/api/maps/{perth}").text
    (folder / perth / "thesis.txt").unlink()
    assert client.delete(f"/api/maps/{perth}").status_code == 204
    assert not (folder / perth).exists() and not leftovers(folder)
    assert client.get(f"/api/maps/{perth}").status_code == 404


def test_a_plain_file_is_driven_too(client, running):
    name = client.post("/api/maps/berlin_siegessaeule_grosser_stern.osm.gz/drive").json()["scenario"]
    prepared = job.prepare(job.load(running[1] / f"{name}.yaml"))
    assert prepared.cars[0].path.length > 500.0
    (running[1] / f"{name}.yaml").unlink()


def test_a_report_that_is_broken_is_told_in_the_list(tmp_path):
    (tmp_path / "maps" / "odd").mkdir(parents=True)
    for text in ("{", "[]", '{"origin": {"latitude": 1, "longitude": 2}, "guesses": [{}]}'):
        (tmp_path / "maps" / "odd" / "report.json").write_text(text)
        (row,) = server_maps.Maps(tmp_path).rows()
        assert "import the map again" in row.problem


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("bounds_m", 10**20),
        ("bounds_m", [[], 0, 0, 0]),
        ("bbox", -1),
        ("source", 10**30),
        ("licence", None),
        ("digest", 5),
        ("origin", {"latitude": 2**63, "longitude": 0}),
        ("origin", {"latitude": 1, "longitude": 10**400}),
        ("guesses", [{"latitude": "x", "longitude": 0}]),
        ("lane_km", "x"),
    ],
)
def test_a_report_with_one_field_that_is_broken_is_told(tmp_path, folder, manchester, field, value):
    """Whatever is told of an import is looked at before: the list tells of it, and the map itself is refused."""
    shutil.copytree(folder / manchester, tmp_path / "maps" / manchester)
    report = tmp_path / "maps" / manchester / "report.json"
    report.write_text(json.dumps(json.loads(report.read_text()) | {field: value}))
    maps = server_maps.Maps(tmp_path)
    (row,) = maps.rows()
    assert "import the map again" in row.problem
    with pytest.raises(MapError, match="import the map again"):
        maps.detail(manchester)


def test_names_for_the_disk():
    assert server_maps.plain_name("../../Straße des 17. Juni (東京)") == "Straße_des_17_Juni_東京"
    assert server_maps.plain_name("\ud800\0\n..") == "" and len(server_maps.plain_name("東" * 200).encode()) <= 180
    assert server_maps.free_name("berlin", ["berlin", "berlin_2"]) == "berlin_3"
