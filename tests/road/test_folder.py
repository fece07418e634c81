"""`studio import`: a folder or one clear message, never half a folder."""

import gzip
import json
import subprocess
import sys
from pathlib import Path

import pytest

from studio.errors import MapError
from studio.road import load
from studio.road.formats import overpass
from studio.road.library import folder
from tests.patience import PATIENCE

MAPS = Path(__file__).parents[1] / "reference" / "maps"
PERTH = MAPS / "perth_peanut_roundabout_lht.osm.gz"
MANCHESTER = MAPS / "manchester_kingsway_lht.osm.gz"


@pytest.fixture(scope="module", autouse=True)
def cache(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("STUDIO_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


def studio(*arguments):
    """Runs the command; returns exit code, output, errors."""
    done = subprocess.run([sys.executable, "-m", "studio.cli", *map(str, arguments)], capture_output=True, text=True, timeout=PATIENCE)
    return done.returncode, done.stdout, done.stderr


def test_the_folder_holds_map_network_and_report(tmp_path):
    code, output, _ = studio("import", PERTH, "--out", tmp_path / "perth", "--json")
    assert code == 0
    text = json.loads((tmp_path / "perth" / "report.json").read_text())
    assert text == json.loads(output)
    assert text["attribution"] == "© OpenStreetMap contributors" and "ODbL" in text["licence"]
    assert text["drive_side"] == "left" and text["drive_side_why"] == "Australia"
    assert set(text["signals"]) == {"in_map", "placed", "groups"} and set(text["turn_lanes"]) == {"tagged_lanes", "matching"}
    wanted = {"lane_km", "junctions", "speed_limits", "buildings", "parking", "guesses", "skipped", "seconds"}
    assert wanted <= set(text)
    network = json.loads(gzip.decompress((tmp_path / "perth" / "network.json.gz").read_bytes()))
    built = load(tmp_path / "perth")
    assert len(network["lanes"]) == len(built.lanes) and built.digest == load(PERTH).digest == text["digest"]
    assert sorted(each.name for each in tmp_path.iterdir()) == ["perth"]


def test_a_box_is_kept_and_remembered(tmp_path):
    box = "-2.3105,53.4440,-2.3035,53.4480"
    code, output, errors = studio("import", MANCHESTER, "--out", tmp_path / "cross", "--bbox", box)
    assert code == 0, errors
    assert "© OpenStreetMap contributors" in output and "drive side" in output
    opened = load(tmp_path / "cross")
    assert opened.digest == load(MANCHESTER, bbox=box).digest != load(MANCHESTER).digest
    x0, y0, x1, y1 = opened.bounds
    assert x1 - x0 == pytest.approx(465.0, rel=0.01) and y1 - y0 == pytest.approx(445.0, rel=0.01)
    for lane in opened.lanes:
        assert (lane.centre[0] > x0 - 15).all() and (lane.centre[0] < x1 + 15).all()


def test_an_import_is_replaced_and_other_folders_are_not(tmp_path):
    assert studio("import", PERTH, "--out", tmp_path / "place")[0] == 0
    assert studio("import", MANCHESTER, "--out", tmp_path / "place")[0] == 0
    assert json.loads((tmp_path / "place" / "report.json").read_text())["name"] == "manchester_kingsway_lht"
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").write_text("years")
    code, _, errors = studio("import", PERTH, "--out", tmp_path / "mine")
    assert code == 2 and "other things" in errors
    assert [each.name for each in (tmp_path / "mine").iterdir()] == ["thesis.txt"]


@pytest.mark.parametrize(
    ("box", "says"),
    [
        ("13,52,13,53", "no area"),
        ("13,53,14,52", "no area"),
        ("5.8,47.2,15.1,55.1", "limit of 25 km"),
        ("-200,1,2,3", "outside the world"),
        ("nan,1,2,3", "outside the world"),
        ("1,2,3", "west,south,east,north"),
        ("a,b,c,d", "west,south,east,north"),
        ("1.0,1.0,1.01,1.01", "no roads for cars within"),
    ],
)
def test_bad_boxes(box, says):
    with pytest.raises(MapError, match=says):
        load(PERTH, bbox=box)


BOMB = b'<!DOCTYPE osm [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><osm version="0.6"></osm>'


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("empty.osm", b"", "empty"),
        ("empty.osm.pbf", b"", "empty"),
        ("empty.json", b"", "empty"),
        ("cut.osm.gz", PERTH.read_bytes()[:5000], "damaged"),
        ("bomb.osm", BOMB, "entities"),
        ("wide.osm", BOMB.decode().encode("utf-16-le"), "cannot be read"),
        ("no.osm.pbf", b"this is no PBF at all", "cannot be read"),
        ("roads.osm", b'<osm version="0.6"><node id="1" version="1" lat="1" lon="1"/></osm>', "no roads"),
        ("cut.json", b'{"elements": [{"type": "node", "id": 1', "cut off"),
        ("other.json", b"[1, 2]", "no Overpass answer"),
        ("busy.json", b'{"elements": [], "remark": "runtime error: Query timed out"}', "did not finish"),
        ("odd.json", b'{"elements": [{"type": "way"}]}', "not as it should be"),
        ("vast.json", b'{"elements": [{"type": "node", "id": 1e999, "lat": 1, "lon": 1}]}', "not as it should be"),
        ("deep.json", b"[" * 100_000, "not JSON"),
        ("map.kml", b"<kml/>", "not a kind of map"),
    ],
)
def test_bad_files_end_with_code_2_and_leave_nothing(tmp_path, name, content, says):
    bad = tmp_path / name
    bad.write_bytes(content)
    code, output, errors = studio("import", bad, "--out", tmp_path / "out" / "place")
    assert code == 2 and says in errors and name in errors and "Traceback" not in errors and not output
    assert not (tmp_path / "out").exists()


def test_a_file_over_the_limit_is_refused(tmp_path):
    large = tmp_path / "large.osm"
    with large.open("wb") as file:
        file.truncate(100 * 2**20 + 1)  # a hole, not on disk
    with pytest.raises(MapError, match="larger than 100 MiB"):
        load(large)


def test_a_disk_that_does_not_take_it(tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(MapError, match=r"cannot be written|in the way"):
        folder.write(load(PERTH), PERTH, tmp_path / "file" / "place", bbox=None)


# -- Overpass JSON ---------------------------------------------------------------------------------

STREET = {"type": "way", "id": 5, "nodes": [1, 2], "tags": {"highway": "residential", "name": "Straße 東京 <&>"}}
NODES = [{"type": "node", "id": 1, "lat": 52.5, "lon": 13.4}, {"type": "node", "id": 2, "lat": 52.501, "lon": 13.404}]
GEOMETRY = [{"lat": node["lat"], "lon": node["lon"]} for node in NODES]


@pytest.mark.parametrize("elements", [[STREET, *NODES], [*NODES, STREET], [{**STREET, "geometry": GEOMETRY}]])
def test_overpass_answers_are_read_in_every_order(tmp_path, elements):
    target = tmp_path / "street.json"
    target.write_text(json.dumps({"version": 0.6, "elements": elements}))
    street = load(target)
    assert street.name == "street" and {road.name for road in street.roads.values() if not road.internal} == {"Straße 東京 <&>"}
    assert street.report.lane_km == pytest.approx(2 * 0.293, rel=0.02)


def test_no_elements_means_no_roads(tmp_path):
    target = tmp_path / "none.json"
    target.write_text('{"elements": []}')
    with pytest.raises(MapError, match="no roads"):
        load(target)
    assert b"<osm" in overpass.as_xml(target, target.read_bytes())


def test_xml_with_ways_before_nodes_is_sorted(tmp_path):
    target = tmp_path / "turned.osm"
    target.write_text(
        '<osm version="0.6"><way id="5" version="1"><nd ref="1"/><nd ref="2"/><tag k="highway" v="residential"/></way>'
        '<node id="1" version="1" lat="52.5" lon="13.4"/><node id="2" version="1" lat="52.501" lon="13.404"/></osm>'
    )
    assert load(target).report.lane_km == pytest.approx(2 * 0.293, rel=0.02)


def test_a_way_is_interrupted_where_nodes_are_missing(tmp_path):
    """Four nodes in a row 100 m apart are known, the fifth is not, the last two are: 3 + 1 pieces of 100 m, no bridge."""
    nodes = "".join(f'<node id="{i}" version="1" lat="{52.5 + 0.0009 * i:.4f}" lon="13.4"/>' for i in (1, 2, 3, 4, 6, 7))
    refs = "".join(f'<nd ref="{i}"/>' for i in range(1, 8))
    target = tmp_path / "gap.osm"
    target.write_text(
        f'<osm version="0.6">{nodes}<way id="9" version="1">{refs}<tag k="highway" v="residential"/><tag k="oneway" v="yes"/></way></osm>'
    )
    gap = load(target)
    assert gap.report.lane_km == pytest.approx(0.4, rel=0.02)
    (skipped,) = [each for each in gap.report.skipped if each.kind == "missing nodes"]
    assert skipped.what == "1 of 7 nodes" and skipped.where == "way 9"


def test_nodes_outside_the_world_are_left_out(tmp_path):
    target = tmp_path / "mars.osm"
    target.write_text(
        '<osm version="0.6"><node id="1" version="1" lat="95" lon="13.4"><tag k="highway" v="traffic_signals"/></node>'
        '<node id="2" version="1" lat="52.5" lon="190"/>'
        '<way id="5" version="1"><nd ref="1"/><nd ref="2"/><tag k="highway" v="residential"/></way></osm>'
    )
    with pytest.raises(MapError, match="no roads for cars"):
        load(target)


def test_a_map_of_half_a_country_is_refused_and_a_box_of_it_is_not(draft, tmp_path):
    for i in range(40):
        a, b = draft.node(52.5 + 0.02 * i, 13.4), draft.node(52.501 + 0.02 * i, 13.404)
        draft.way(i + 1, [a, b], highway="residential")
    country = draft.write(tmp_path / "country.osm")
    with pytest.raises(MapError, match="limit of 25 km a side") as error:
        load(country)
    assert "country.osm" in str(error.value)
    part = load(country, bbox="13.39,52.49,13.41,52.53")
    assert part.report.lane_km == pytest.approx(2 * 2 * 0.293, rel=0.02)
