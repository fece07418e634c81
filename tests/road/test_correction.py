"""Corrections: tags that a user knows better, applied before anything is built, kept beside the map, and told."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from studio.errors import MapError
from studio.road import load
from studio.road.formats.correction import Correction, added
from studio.road.library import folder, intake, tag
from studio.road.network.report import rows

MANCHESTER = Path(__file__).parents[1] / "reference" / "maps" / "manchester_kingsway_lht.osm.gz"
STREET = "way 59876790"  # Dorset Street: neither lanes nor maxspeed are mapped


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("STUDIO_CACHE", str(tmp_path / "cache"))


def street(draft, tmp_path, *, crossing=True, **tags):
    """400 m due north as way 9, with node 2 in its middle, and way 8 across it there."""
    south, middle, north = (draft.node(latitude, 13.4) for latitude in (52.5, 52.5018, 52.5036))
    west, east = draft.node(52.5018, 13.397), draft.node(52.5018, 13.403)
    draft.way(9, [south, middle, north], **({"highway": "primary"} | tags))
    if crossing:
        draft.way(8, [west, middle, east], highway="primary", lanes="2", maxspeed="50")
    return draft.write(tmp_path / "street.osm")


def corrected(path, element, removed=(), **tags):
    """The map with one correction."""
    return load(path, corrections=(tag.correction(element, {key.replace("__", ":"): value for key, value in tags.items()}, removed),))


def lanes_of(network, way):
    """Lanes of the roads that are made of a way."""
    return [lane for road in network.roads.values() if way in road.ways for lane in network.lanes_of(road.id)]


# -- what follows from a correction ------------------------------------------------------------------


def test_lane_count_and_limit(draft, tmp_path):
    path = street(draft, tmp_path)
    before, after = load(path), corrected(path, "way 9", lanes="2", maxspeed="30")
    assert len(lanes_of(before, 9)) == 8 and {round(lane.speed * 3.6) for lane in lanes_of(before, 9)} == {50}
    assert len(lanes_of(after, 9)) == 4 and {round(lane.speed * 3.6) for lane in lanes_of(after, 9)} == {30}
    assert len(lanes_of(after, 8)) == len(lanes_of(before, 8))  # the other street stays
    assert {(each.kind, each.key, each.element) for each in before.report.guesses} == {
        ("lanes", "lanes", "way 9"),
        ("speed limit", "maxspeed", "way 9"),
    }
    assert after.report.guesses == () and after.digest != before.digest
    (told,) = after.report.corrected
    assert told.before == {"lanes": "", "maxspeed": ""} and (told.latitude, told.longitude) == pytest.approx((52.5018, 13.4))


def test_width(draft, tmp_path):
    path = street(draft, tmp_path, lanes="2", oneway="yes")
    after = corrected(path, "way 9", width="8")
    assert {lane.width for lane in lanes_of(after, 9)} == {4.0} != {lane.width for lane in lanes_of(load(path), 9)}


def test_arrows(draft, tmp_path):
    """Of two lanes towards the crossing the left one turns left only, once that is known."""
    south, middle, north = (draft.node(latitude, 13.4) for latitude in (52.5, 52.5018, 52.5036))
    draft.way(8, [draft.node(52.5018, 13.397), middle, draft.node(52.5018, 13.403)], highway="primary", lanes="2")
    draft.way(9, [south, middle], highway="primary", lanes="2", oneway="yes")
    draft.way(10, [middle, north], highway="primary", lanes="2", oneway="yes")
    path = draft.write(tmp_path / "crossing.osm")
    after = corrected(path, "way 9", turn__lanes="left|through;right")
    assert after.report.turn_lanes.tagged_lanes == after.report.turn_lanes.matching == 2
    (left,) = [lane.id for lane in lanes_of(after, 9) if lane.index == 1]
    (turn,) = [each for each in after.connections if each.from_lane == left]
    west = after.lanes[turn.to_lane].centre
    assert west[0, -1] < west[0, 0] - 100.0
    assert load(path).report.turn_lanes.tagged_lanes == 0


@pytest.mark.parametrize("sign", [{}, {"highway": "crossing"}])
def test_a_signal_appears_on_a_node_with_tags_and_without(draft, tmp_path, sign):
    south, middle, north = draft.node(52.5, 13.4), draft.node(52.5018, 13.4, **sign), draft.node(52.5036, 13.4)
    west, east = draft.node(52.5018, 13.397), draft.node(52.5018, 13.403)
    draft.way(9, [south, middle, north], highway="primary", lanes="2")
    draft.way(8, [west, middle, east], highway="primary", lanes="2")
    path = draft.write(tmp_path / "crossing.osm")
    before, after = load(path), corrected(path, "node 2", highway="traffic_signals")
    assert len(before.signals) == 0 and before.report.signals.in_map == 0
    assert len(after.signals) == 4 and after.report.signals.in_map == after.report.signals.placed == 1
    assert after.report.corrected[0].before == {"highway": sign.get("highway", "")}
    assert (after.report.corrected[0].latitude, after.report.corrected[0].longitude) == pytest.approx((52.5018, 13.4))


def test_a_signal_disappears(draft, tmp_path):
    south, middle, north = draft.node(52.5, 13.4), draft.node(52.5018, 13.4, highway="traffic_signals"), draft.node(52.5036, 13.4)
    draft.way(9, [south, middle, north], highway="primary")
    draft.way(8, [draft.node(52.5018, 13.397), middle, draft.node(52.5018, 13.403)], highway="primary")
    path = draft.write(tmp_path / "crossing.osm")
    assert len(load(path).signals) == 8  # two lanes each way on both
    after = corrected(path, "node 2", removed=["highway"])
    assert len(after.signals) == 0 and after.report.corrected[0].before == {"highway": "traffic_signals"}


def test_a_closed_way_opens_and_a_track_becomes_a_street(draft, tmp_path):
    path = street(draft, tmp_path, access="private")
    assert not lanes_of(load(path), 9)
    assert lanes_of(corrected(path, "way 9", removed=["access"]), 9)
    draft.lines.clear()
    path = street(draft, tmp_path, highway="track")
    assert not lanes_of(load(path), 9) and lanes_of(corrected(path, "way 9", highway="residential"), 9)


def test_the_height_of_a_building(draft, tmp_path):
    path = street(draft, tmp_path, crossing=False)
    ring = [draft.node(52.5010 + north, 13.4010 + east) for north, east in ((0, 0), (0, 3e-4), (2e-4, 3e-4), (2e-4, 0))]
    draft.way(7, [*ring, ring[0]], building="yes")
    path = draft.write(path)
    (guess,) = [each for each in load(path).report.guesses if each.kind == "height"]
    assert (guess.key, guess.element) == ("height", "way 7")
    after = corrected(path, guess.element, height="21")
    assert [building.height for building in after.scenery.buildings] == [21.0] and len(after.report.corrected) == 1


def test_a_way_cut_in_pieces_is_corrected_whole(draft, tmp_path):
    """Where the box cuts a way in two, both pieces are told by the mapped way's name and follow its tags."""
    corners = ((52.5, 13.400), (52.502, 13.400), (52.502, 13.420), (52.500, 13.420))
    nodes = [draft.node(*corner) for corner in corners]
    draft.way(9, nodes, highway="residential")
    path, box = draft.write(tmp_path / "bow.osm"), "13.398,52.4995,13.422,52.5012"
    before = load(path, bbox=box)
    assert {each.element for each in before.report.guesses} == {"way 9"} and len(before.report.guesses) == 4
    assert {road.ways for road in before.roads.values() if not road.internal} == {(9,)}
    after = load(path, bbox=box, corrections=(tag.correction("way 9", {"lanes": "2", "maxspeed": "20"}),))
    assert after.report.guesses == () and {round(lane.speed * 3.6) for lane in lanes_of(after, 9)} == {20}


def test_nothing_corrected_is_nothing_changed(draft, tmp_path):
    path = street(draft, tmp_path)
    assert load(path, corrections=()).digest == load(path).digest and load(path).report.corrected == ()


# -- kept beside the map -----------------------------------------------------------------------------


def test_a_correction_outlives_an_import_and_is_taken_back(tmp_path):
    out = tmp_path / "manchester"
    first = intake.take(MANCHESTER, out)
    second = intake.correct(out, tag.correction(STREET, {"lanes": "2"}))
    third = intake.correct(out, tag.correction(STREET, {"maxspeed": "20 mph"}))
    assert len({first.digest, second.digest, third.digest, load(out).digest}) == 3
    kept = [{"element": STREET, "tags": {"lanes": "2", "maxspeed": "20 mph"}, "removed": []}]
    assert json.loads((out / "corrections.json").read_text()) == kept
    again = intake.take(MANCHESTER, out)
    assert again.digest == third.digest and json.loads((out / "corrections.json").read_text()) == kept
    report = json.loads((out / "report.json").read_text())
    assert report["corrected"][0]["before"] == {"lanes": "", "maxspeed": ""}
    assert report["name"] == "manchester_kingsway_lht" and report["source"] == MANCHESTER.name
    assert intake.undo(out, STREET).digest == first.digest and not (out / "corrections.json").exists()
    assert json.loads((out / "report.json").read_text())["source"] == MANCHESTER.name


def test_the_order_of_corrections_does_not_matter(tmp_path):
    a, b = tag.correction("way 1", {"lanes": "2"}), tag.correction("node 2", {"highway": "stop"})
    assert added(added((), a), b) == added(added((), b), a)


def test_a_later_correction_of_an_element_wins():
    first = Correction("way 1", {"lanes": "2", "width": "7"}, ("maxspeed",))
    joined = first.joined(Correction("way 1", {"maxspeed": "30", "lanes": "3"}, ("width",)))
    assert joined == Correction("way 1", {"lanes": "3", "maxspeed": "30"}, ("width",))
    assert joined.applied({"lanes": "1", "width": "9", "name": "x"}) == {"lanes": "3", "maxspeed": "30", "name": "x"}


def test_an_element_that_a_newer_map_lacks_is_told(tmp_path, draft):
    out = tmp_path / "place"
    intake.take(street(draft, tmp_path), out)
    intake.correct(out, tag.correction("way 8", {"lanes": "3"}))
    draft.lines.clear()
    draft.nodes = 0
    newer = intake.take(street(draft, tmp_path, crossing=False), out)
    (gone,) = [each for each in newer.report.skipped if each.kind == "correction"]
    assert gone.element == "way 8" and gone.what == "lanes=3" and "no such element" in gone.reason
    assert newer.report.corrected == () and len(folder.corrections(out)) == 1


def test_an_element_that_is_not_there_is_refused_and_changes_nothing(tmp_path):
    out = tmp_path / "manchester"
    intake.take(MANCHESTER, out)
    before = {each.name: each.read_bytes() for each in out.iterdir()}
    with pytest.raises(MapError, match="no 'way 1'"):
        intake.correct(out, tag.correction("way 1", {"lanes": "2"}))
    with pytest.raises(MapError, match="no correction of 'way 1'"):
        intake.undo(out, "way 1")
    assert {each.name: each.read_bytes() for each in out.iterdir()} == before


def test_a_failed_exchange_puts_the_old_folder_back(tmp_path):
    out, made = tmp_path / "out", tmp_path / "made"
    out.mkdir()
    (out / "report.json").write_text("{}")
    with pytest.raises(FileNotFoundError):
        folder.exchange(made, out, tmp_path / "old")  # nothing was made
    assert (out / "report.json").read_text() == "{}"


@pytest.mark.parametrize(
    "text", ["{", "[1]", '[{"element": "way 1"}]', '[{"element": "way 1", "tags": {"lanes": "0"}, "removed": []}]', "3"]
)
def test_corrections_that_cannot_be_read_stop_the_import(tmp_path, text):
    """They may hold a day's work: nothing is overwritten, and the file is named."""
    out = tmp_path / "place"
    intake.take(MANCHESTER, out)
    (out / "corrections.json").write_text(text)
    for act in (lambda: load(out), lambda: intake.take(MANCHESTER, out)):
        with pytest.raises(MapError, match=r"corrections\.json"):
            act()
    assert (out / "corrections.json").read_text() == text


def test_the_table_tells_them(tmp_path):
    network = load(MANCHESTER, corrections=(tag.correction(STREET, {"lanes": "2"}),))
    (row,) = [row for row in rows(network.report) if row[0] == "corrected"]
    assert row[1:] == ["1", f"e.g. {STREET} (Dorset Street): lanes=2; the map says no lanes"]
    assert not [row for row in rows(load(MANCHESTER).report) if row[0] == "corrected"]


def test_the_command(tmp_path):
    def studio(*arguments):
        done = subprocess.run([sys.executable, "-m", "studio.cli", *map(str, arguments)], capture_output=True, text=True)
        return done.returncode, done.stdout, done.stderr

    out = tmp_path / "manchester"
    intake.take(MANCHESTER, out)
    code, output, _ = studio("correct", out, STREET, "lanes=2", "maxspeed=30", "--remove", "name", "--json")
    assert code == 0 and json.loads(output)["corrected"][0]["removed"] == ["name"]
    code, output, _ = studio("correct", out, STREET, "--undo")
    assert code == 0 and "corrected" not in output and "© OpenStreetMap contributors" in output
    for arguments, says in (
        (("lanes=0",), "1 to 16"), (("lanes",), "such as lanes=2"), ((), "say nothing"), (("lanes=2", "--undo"), "stands alone"),
        (("--undo",), "is not corrected"),
    ):  # fmt: skip
        code, output, errors = studio("correct", out, STREET, *arguments)
        assert code == 2 and says in errors and not output and "Traceback" not in errors


# -- what may be said ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("key", "good", "bad"),
    [
        ("lanes", ["1", "16"], ["0", "17", "-1", "2.5", "two", "１", "999999"]),
        ("maxspeed", ["30", "20 mph", "DE:urban", "none", "walk"], ["0", "-5", "fast", "251", "nan", "1e9"]),
        ("width", ["7", "7.5", "7,5 m"], ["0", "1", "101", "wide", "inf"]),
        ("turn:lanes", ["left|through;right", "none|right", "|", "slight_left"], ["up", "left,right", "left|;through|x", "|" * 16]),
        ("height", ["12", "12,5 m", "40 ft"], ["0", "901", "tall"]),
        ("oneway", ["yes", "-1", "no"], ["maybe"]),
        ("driving_side", ["left"], ["middle"]),
        ("highway", ["residential", "service", "motorway_link"], ["street", "traffic_signals"]),
        ("surface", ["asphalt", "どこか"], [" ", "x ", "x" * 256, "a\nb", "\ud800"]),
    ],
)
def test_values(key, good, bad):
    for value in good:
        assert tag.correction("way 1", {key: value}).tags == {key: value}
    for value in bad:
        with pytest.raises(MapError) as error:
            tag.correction("way 1", {key: value})
        assert error.value.problems[0].where == key


def test_all_that_is_wrong_is_told_at_once():
    with pytest.raises(MapError) as error:
        tag.correction("way 1", {"lanes": "0", "maxspeed": "fast", "width": "7"})
    assert [each.where for each in error.value.problems] == ["lanes", "maxspeed"]
    assert "1 to 16" in error.value.problems[0].allowed


@pytest.mark.parametrize(
    "element", ["", "way", "way 0", "way -0", "way --1", "way 01", "WAY 1", "way 1 ", "area 1", "way 1\n", "way " + "9" * 19]
)
def test_elements_that_are_none(element):
    with pytest.raises(MapError, match="cannot be made") as error:
        tag.correction(element, {"lanes": "2"})
    assert error.value.problems[0].where == "element"


def test_signs_stand_on_nodes():
    assert tag.correction("node 1", {"highway": "traffic_signals"})
    with pytest.raises(MapError):
        tag.correction("node 1", {"highway": "residential"})
    with pytest.raises(MapError, match="cannot be made"):
        tag.correction("node 1", {"highway": "stop"}, ["highway"])
    with pytest.raises(MapError, match="cannot be made"):
        tag.correction("node 1", {str(i): "x" for i in range(51)})


def test_positions_are_those_of_the_map(tmp_path):
    """Guesses lie on the roads that they are about."""
    network = load(MANCHESTER)
    ways = {f"way {way}": road for road in network.roads.values() for way in road.ways}
    guesses = [each for each in network.report.guesses if each.key == "lanes"]
    assert len(guesses) > 5
    for guess in guesses:
        lines = np.concatenate([lane.centre for lane in lanes_of(network, int(guess.element.split()[1]))], axis=1)
        latitude, longitude = network.origin
        x = np.radians(guess.longitude - longitude) * 6_371_000 * np.cos(np.radians(latitude))
        y = np.radians(guess.latitude - latitude) * 6_371_000
        assert guess.element in ways and np.hypot(lines[0] - x, lines[1] - y).min() < 25.0
