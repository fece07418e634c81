"""Bad maps are refused with one clear message; the cache never holds half a map."""

import gzip
import os

import pytest

from studio.errors import MapError
from studio.road import load
from studio.road.library import place

ROAD = (
    '<node id="1" version="1" lat="52.5" lon="13.4"/><node id="2" version="1" lat="52.501" lon="13.404"/>'
    '<way id="5" version="1"><nd ref="1"/><nd ref="2"/><tag k="highway" v="residential"/>{}</way>'
)
HEAD = '<?xml version="1.0"?><osm version="0.6">'


def written(tmp_path, text, name="bad.osm"):
    target = tmp_path / name
    target.write_bytes(text if isinstance(text, bytes) else text.encode())
    return target


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "empty"),
        ("   \n", "empty"),
        ("lanes: 4", "not an OpenStreetMap XML"),
        ("<html></html>", "cannot be read"),
        (HEAD + ROAD.format(""), "cannot be read"),
        ('<!DOCTYPE osm [<!ENTITY a "aaaa">]>' + HEAD + ROAD.format("") + "</osm>", "entities"),
        (HEAD + "</osm>", "no roads"),
        (HEAD + '<node id="1" version="1" lat="52.5" lon="13.4"/></osm>', "no roads"),
        (HEAD + '<node id="x" version="1" lat="52.5" lon="13.4"/></osm>', "cannot be read"),
        (HEAD + '<node id="1" version="1" lat="nan" lon="13.4"/></osm>', "cannot be read"),
        (
            HEAD + ROAD.format("").replace("52.501", "52.5").replace("13.404", "13.4") + "</osm>",
            "cannot be built",
        ),
        (HEAD + ROAD.format("").replace("residential", "footway") + "</osm>", "no roads"),
        (HEAD + ROAD.format('<tag k="access" v="private"/>') + "</osm>", "no roads"),
    ],
)
def test_bad_content_is_refused(tmp_path, own_cache, text, says):
    target = written(tmp_path, text)
    with pytest.raises(MapError, match=says) as error:
        load(target)
    assert "bad.osm" in str(error.value) and "Traceback" not in str(error.value)
    assert not own_cache.exists() or not os.listdir(own_cache)


def test_truncated_gzip_is_refused(tmp_path, map_file, own_cache):
    with pytest.raises(MapError, match="damaged"):
        load(written(tmp_path, map_file.read_bytes()[:4000], "cut.osm.gz"))


def test_a_file_that_is_no_gzip_is_refused(tmp_path):
    with pytest.raises(MapError, match="damaged"):
        load(written(tmp_path, HEAD + "</osm>", "plain.osm.gz"))


def test_a_bomb_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("studio.road.formats.osm.LARGEST", 1000)
    with pytest.raises(MapError, match="larger"):
        load(written(tmp_path, gzip.compress(b"<osm>" + b" " * 10_000), "bomb.osm.gz"))


def test_missing_file_and_unknown_kind_are_refused(tmp_path):
    with pytest.raises(MapError, match="no such map"):
        load(tmp_path / "gone.osm")
    with pytest.raises(MapError, match=r"\.osm\.gz"):
        load(written(tmp_path, "x", "map.kml"))
    (tmp_path / "folder.osm").mkdir()
    with pytest.raises(MapError, match="cannot be read"):
        load(tmp_path / "folder.osm")


@pytest.mark.parametrize("radius", [0.0, -5.0, float("nan")])
def test_a_radius_that_keeps_nothing_is_refused(map_file, radius):
    with pytest.raises(MapError, match="at least 50 m"):
        load(map_file, radius=radius)


def test_one_road_is_a_map(tmp_path, own_cache):
    lonely = load(written(tmp_path, HEAD + ROAD.format("") + "</osm>"))
    roads = [road for road in lonely.roads.values() if not road.internal]
    assert len(roads) == 2 and {round(road.speed * 3.6) for road in roads} == {30}


def test_absurd_lanes_are_ignored(tmp_path, own_cache):
    lonely = load(written(tmp_path, HEAD + ROAD.format('<tag k="lanes" v="100000"/>') + "</osm>"))
    assert len(lonely.lanes) < 10


# -- the cache -------------------------------------------------------------------------------------


@pytest.fixture
def small_map(tmp_path):
    return written(tmp_path, gzip.compress((HEAD + ROAD.format("") + "</osm>").encode()), "small.osm.gz")


def test_the_second_time_it_is_read_back(small_map, own_cache, monkeypatch):
    first = load(small_map)
    monkeypatch.setattr(place, "imported", lambda *args, **options: pytest.fail("imported again"))
    second = load(small_map)
    assert second.digest == first.digest
    assert [lane.centre.tobytes() for lane in second.lanes] == [lane.centre.tobytes() for lane in first.lanes]
    assert [entry.suffix for entry in own_cache.iterdir()] == [".pickle"]


@pytest.mark.parametrize("damage", [lambda body: body[: len(body) // 2], lambda body: b"", lambda body: b"\0" + body])
def test_a_damaged_cache_is_made_again(small_map, own_cache, damage):
    first = load(small_map)
    (kept,) = own_cache.iterdir()
    kept.write_bytes(damage(kept.read_bytes()))
    assert load(small_map).digest == first.digest
    assert place.recall(first.digest) is not None


def test_another_radius_or_content_is_another_map(small_map, own_cache, tmp_path):
    data = gzip.decompress(small_map.read_bytes())
    assert load(small_map).digest != load(small_map, radius=200.0).digest
    assert load(written(tmp_path, data, "same.osm")).digest == load(small_map).digest
    assert load(written(tmp_path, data + b"\n", "other.osm")).digest != load(small_map).digest


def test_the_name_is_the_files(small_map, own_cache, tmp_path):
    load(small_map)
    renamed = written(tmp_path, small_map.read_bytes(), "circle.osm.gz")
    assert load(renamed).name == "circle"


def test_a_cache_that_cannot_be_written_costs_only_time(small_map, tmp_path, monkeypatch):
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    monkeypatch.setenv("STUDIO_CACHE", str(blocked))
    assert len(load(small_map).lanes) == 4
