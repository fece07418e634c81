"""Downloads, from servers of our own on this machine: a recorded answer, and everything that goes wrong on the way."""

import gzip
import json
import subprocess
import sys
import threading
import time
from contextlib import contextmanager
from dataclasses import replace
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import parse_qs, urlsplit
from xml.etree import ElementTree

import pytest

from studio.errors import MapError
from studio.road import load
from studio.road.formats import osm
from studio.road.formats.kind import GREEN
from studio.road.library import download, folder, intake
from studio.road.library.download import Patience
from tests.patience import PATIENCE

SEATTLE = Path(__file__).parents[1] / "reference" / "maps" / "seattle_triangle_small.osm.gz"
BOX = osm.bounding_box("-122.3400,47.6155,-122.3365,47.6185")
HASTE = Patience(connect=PATIENCE, silence=PATIENCE, first_wait=0.0)


def overpass_json(path):
    """An OSM XML file as an Overpass server answers it."""
    elements = []
    for each in ElementTree.fromstring(gzip.decompress(path.read_bytes())):
        if each.tag not in ("node", "way", "relation"):
            continue
        element = {"type": each.tag, "id": int(each.get("id")), "tags": {tag.get("k"): tag.get("v") for tag in each.iter("tag")}}
        if each.tag == "node":
            element |= {"lat": float(each.get("lat")), "lon": float(each.get("lon"))}
        if each.tag == "way":
            element["nodes"] = [int(node.get("ref")) for node in each.iter("nd")]
        if each.tag == "relation":
            element["members"] = [{"type": m.get("type"), "ref": int(m.get("ref")), "role": m.get("role")} for m in each.iter("member")]
        elements.append(element)
    copyright = "The data included in this document is from www.openstreetmap.org. The data is made available under ODbL."
    return json.dumps({"version": 0.6, "osm3s": {"copyright": copyright}, "elements": elements}).encode()


RECORDED = overpass_json(SEATTLE)


@contextmanager
def server(*answers):
    """A server that gives these answers one after the other, the last one for ever; yields its address and what it was asked.

    An answer is (status, headers, body); a body that is callable writes by itself.
    """
    asked = []

    class Handler(BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def do_GET(self):
            self.answer("")

        def do_POST(self):
            self.answer(self.rfile.read(int(self.headers["Content-Length"])).decode())

        def answer(self, body):
            asked.append((self.command, self.path, dict(self.headers), body))
            status, headers, content = answers[min(len(asked), len(answers)) - 1]
            self.send_response(status)
            for key, value in headers.items():
                self.send_header(key, value)
            if not callable(content):
                self.send_header("Content-Length", str(len(content)))
            self.end_headers()
            try:
                content(self.wfile) if callable(content) else self.wfile.write(content)
            except OSError:
                return  # the client has heard enough

        def log_message(self, *arguments):
            pass

    running = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=running.serve_forever, daemon=True)
    thread.start()
    try:
        yield f"http://127.0.0.1:{running.server_port}/api", asked
    finally:
        running.shutdown()
        running.server_close()
        thread.join()


DATA = (200, {"Content-Type": "application/json"}, RECORDED)
BUSY = (429, {"Retry-After": "0"}, b"rate limited")


@pytest.fixture(autouse=True)
def here(monkeypatch, tmp_path):
    """No proxy between a test and its server, and a cache of its own."""
    monkeypatch.setenv("NO_PROXY", "*")
    monkeypatch.setenv("STUDIO_CACHE", str(tmp_path / "cache"))


def fetched(address, tmp_path, patience=HASTE, box=BOX):
    """The file that a download of the box writes."""
    target = tmp_path / "map.json"
    download.download(box, target, by=download.servers(address), patience=patience)
    return target


# -- the map ---------------------------------------------------------------------------------------


def test_a_place_is_downloaded_and_imported_in_one_go(tmp_path):
    with server(DATA) as (address, asked):
        told = []
        network = intake.fetch(BOX, tmp_path / "seattle", overpass=address, progress=told.append)
    ((method, _, headers, body),) = asked
    assert method == "POST" and headers["User-Agent"].startswith("cooperative-adas-studio/")
    (text,) = parse_qs(body)["data"]
    assert "[bbox:47.6155000,-122.3400000,47.6185000,-122.3365000]" in text and 'way["highway"]' in text
    assert told[0] == "asking 127.0.0.1" and "building lanes and junctions" in told
    made = folder.opened(tmp_path / "seattle")
    assert made.map.name == "map.json" and made.map.read_bytes() == RECORDED and made.source == "seattle.json"
    assert load(tmp_path / "seattle").digest == network.digest
    bounds = "-122.3400000,47.6155000,-122.3365000,47.6185000"
    assert network.report.lane_km == load(SEATTLE, bbox=bounds).report.lane_km


def test_the_command_reads_its_server_from_the_environment(tmp_path, monkeypatch):
    with server(BUSY, DATA) as (address, asked):
        monkeypatch.setenv("STUDIO_OVERPASS", address)
        command = ["download", "--bbox", "-122.3400,47.6155,-122.3365,47.6185", "--out", str(tmp_path / "here"), "--json"]
        done = subprocess.run([sys.executable, "-m", "studio.cli", *command], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["attribution"] == "© OpenStreetMap contributors" and len(asked) == 2
    assert "the server is busy; waiting 0 s" in done.stderr


def test_the_command_wants_a_place_or_a_box(tmp_path):
    done = subprocess.run([sys.executable, "-m", "studio.cli", "download", "--out", str(tmp_path / "x")], capture_output=True, text=True)
    assert done.returncode == 2 and "give one of them" in done.stderr and not (tmp_path / "x").exists()


def test_the_query_asks_for_what_the_importer_reads():
    """Every kind of ground, and all else that a survey notes."""
    text = download.query(BOX)
    assert all(f'way["{key}"]' in text for key in (*GREEN, "highway", "building", "building:part"))
    assert 'relation["type"="restriction"]' in text and "out body;" in text and "meta" not in text


# -- busy, slow, large -----------------------------------------------------------------------------


@pytest.mark.parametrize("status", download.BUSY)
def test_a_busy_server_is_asked_again(tmp_path, status):
    with server((status, {"Retry-After": "0"}, b""), (status, {}, b""), DATA) as (address, asked):
        assert fetched(address, tmp_path).read_bytes() == RECORDED
    assert len(asked) == 3


def test_a_server_that_stays_busy_is_asked_four_times(tmp_path):
    with server(BUSY) as (address, asked), pytest.raises(MapError, match=r"busy \(429\), asked 4 times"):
        fetched(address, tmp_path)
    assert len(asked) == 4


def test_who_shall_wait_for_an_hour_is_told_so_at_once(tmp_path):
    with server((504, {"Retry-After": "3600"}, b"")) as (address, asked), pytest.raises(MapError, match="again in 3600 s"):
        fetched(address, tmp_path)
    assert len(asked) == 1


def test_a_silent_server_is_given_up(tmp_path):
    gone = threading.Event()
    with server((200, {}, lambda out: gone.wait(PATIENCE))) as (address, _):
        try:
            with pytest.raises(MapError, match="did not answer in time"):
                fetched(address, tmp_path, replace(HASTE, silence=0.2))
        finally:
            gone.set()


def test_a_server_that_drips_is_given_up(tmp_path):
    """Never silent, never done."""
    gone = threading.Event()

    def drip(out):
        out.write(b"{")
        while not gone.wait(0.01):
            out.write(b" ")
            out.flush()

    with server((200, {}, drip)) as (address, _):
        try:
            with pytest.raises(MapError, match=r"took longer than 0\.3 s"):
                fetched(address, tmp_path, replace(HASTE, whole=0.3))
        finally:
            gone.set()


def test_an_answer_that_breaks_off_is_refused(tmp_path):
    headers = {"Content-Length": str(len(RECORDED))}
    cut_off = (200, {**headers, "Connection": "close"}, lambda out: out.write(RECORDED[:9000]))
    with server(cut_off) as (address, _), pytest.raises(MapError, match="download failed"):
        fetched(address, tmp_path)


def test_an_answer_without_end_is_cut_at_the_limit(tmp_path, monkeypatch):
    monkeypatch.setattr(osm, "LARGEST_FILE", 2**20)

    def flood(out):
        out.write(b"{")
        for _ in range(10_000):
            out.write(b" " * 2**16)

    with server((200, {"Connection": "close"}, flood)) as (address, _), pytest.raises(MapError, match="larger than 1 MiB"):
        fetched(address, tmp_path)
    assert (tmp_path / "map.json").stat().st_size <= 2**20


def test_a_packed_bomb_is_cut_at_the_limit(tmp_path, monkeypatch):
    monkeypatch.setattr(osm, "LARGEST_FILE", 2**20)
    packed = gzip.compress(b"{" + b" " * 2**24)
    with server((200, {"Content-Encoding": "gzip"}, packed)) as (address, _), pytest.raises(MapError, match="larger than 1 MiB"):
        fetched(address, tmp_path)


# -- what is no data -------------------------------------------------------------------------------

PAGE = b"<html><head><title>OSM3S Response</title></head><body><p><strong>Error</strong>: line 1: parse error</p></body></html>"


@pytest.mark.parametrize(
    ("answer", "says"),
    [
        ((200, {"Content-Type": "text/html"}, PAGE), "something else than data: Error: line 1: parse error"),
        ((400, {"Content-Type": "text/html"}, PAGE), r"refused \(400\): Error: line 1: parse error"),
        ((404, {}, b""), r"refused \(404\)"),
        ((301, {"Location": "http://127.0.0.1:9/"}, b""), r"refused \(301\)"),
        ((200, {}, b""), "something else than data: nothing"),
        ((200, {}, b"\x00\xff garbage"), "something else than data"),
        ((200, {"Content-Encoding": "gzip"}, b"no gzip"), "download failed"),
        ((200, {}, b'{"elements": ['), "seattle.json: this is not JSON, or it is cut off"),
        ((200, {}, b'{"elements": []}'), "seattle.json: there are no roads"),
        ((200, {}, b'{"elements": [], "remark": "runtime error: Query timed out"}'), "seattle.json: the Overpass server did not finish"),
    ],
)
def test_no_data_makes_no_folder(tmp_path, answer, says):
    with server(answer) as (address, _), pytest.raises(MapError, match=says) as error:
        intake.fetch(BOX, tmp_path / "seattle", overpass=address)
    assert "Traceback" not in str(error.value) and str(tmp_path) not in str(error.value)
    assert not (tmp_path / "seattle").exists()


def test_nobody_there(tmp_path):
    with server(DATA) as (address, _):
        pass
    with pytest.raises(MapError, match="download failed"):
        fetched(address, tmp_path)


@pytest.mark.parametrize("address", ["ftp://127.0.0.1/api", "file:///etc/passwd", "overpass", "http://"])
def test_an_address_that_is_none(address):
    with pytest.raises(MapError, match="http://"):
        download.servers(address)


def test_a_large_box_is_refused_before_anybody_is_asked(tmp_path):
    with server(DATA) as (address, asked), pytest.raises(MapError) as error:
        fetched(address, tmp_path, box=osm.bounding_box("13.3,52.45,13.45,52.55"))
    assert "at most 40 km²" in str(error.value) and not asked
    remedy = error.value.problems[0].remedy.split()[-1]
    assert download.area(osm.bounding_box(remedy)) == pytest.approx(4.0, rel=0.01)


# -- names -----------------------------------------------------------------------------------------


def named(name, south, north, west, east):
    return {"display_name": name, "boundingbox": [str(each) for each in (south, north, west, east)]}


TRIANGLE = named("Denny Triangle, Seattle", 47.610, 47.620, -122.345, -122.330)
CORNER = named("Denny Way, Denny Triangle, Seattle", 47.6178, 47.6182, -122.340, -122.338)
NAMESAKE = named("Denny Triangle, Elsewhere", 40.0, 40.01, -100.01, -100.0)


def sought(address, tmp_path, place="Denny Triangle"):
    return download.find(place, by=download.servers(search=address), target=tmp_path / "places.json", patience=HASTE)


def places(*found):
    return 200, {"Content-Type": "application/json"}, json.dumps(found).encode()


def test_a_name_becomes_a_box_and_a_map(tmp_path):
    with server(places(TRIANGLE, CORNER)) as (search, asked), server(DATA) as (overpass, queries):
        intake.fetch("Denny Triangle, 西雅图", tmp_path / "triangle", overpass=overpass, search=search)
    assert parse_qs(urlsplit(asked[0][1]).query)["q"] == ["Denny Triangle, 西雅图"]
    assert "[bbox:47.6100000,-122.3450000,47.6200000,-122.3300000]" in parse_qs(queries[0][3])["data"][0]
    assert folder.opened(tmp_path / "triangle").bbox == "-122.3450000,47.6100000,-122.3300000,47.6200000"


def test_a_small_place_gets_its_surroundings(tmp_path):
    with server(places(CORNER)) as (address, _):
        box = sought(address, tmp_path).box
    assert download.area(box) == pytest.approx(1.0, rel=0.01) and box.centre == pytest.approx((47.618, -122.339))


def test_several_places_are_listed(tmp_path):
    with server(places(TRIANGLE, NAMESAKE, CORNER)) as (address, _), pytest.raises(MapError) as error:
        sought(address, tmp_path)
    assert [each.where for each in error.value.problems] == ["Denny Triangle, Seattle", "Denny Triangle, Elsewhere"]
    assert osm.bounding_box(error.value.problems[0].value).centre == pytest.approx((47.615, -122.3375))


def test_no_place_is_told(tmp_path):
    with server(places()) as (address, _), pytest.raises(MapError, match="No place is called 'Denny Triangle'"):
        sought(address, tmp_path)


@pytest.mark.parametrize("answer", [{"error": "x"}, [1], [{}], [named("x", "nan", 1, 0, 1)], [named("x", 1, 2, 200, 201)]])
def test_a_list_of_places_that_is_none(tmp_path, answer):
    with server((200, {}, json.dumps(answer).encode())) as (address, _), pytest.raises(MapError, match="no list of places"):
        sought(address, tmp_path)


def test_a_country_is_refused_with_the_limit(tmp_path):
    germany = named("Deutschland", 47.2, 55.1, 5.8, 15.1)
    with server(places(germany)) as (search, _), server(DATA) as (overpass, asked), pytest.raises(MapError, match="too large"):
        intake.fetch("Deutschland", tmp_path / "d", search=search, overpass=overpass)
    assert not asked and not (tmp_path / "d").exists()


def test_a_wait_until_a_date():
    assert download.retry_after("Sun, 06 Nov 1994 08:49:37 GMT", 5.0) == 0.0
    later = time.strftime("%a, %d %b %Y %H:%M:%S GMT", time.gmtime(time.time() + 3600))
    assert 3500 < download.retry_after(later, 5.0) <= 3600
    assert download.retry_after("soon", 5.0) == 5.0
