"""Countries, sides and limits without asking the network."""

import pytest

from studio.road import load
from studio.road.assembly.side import drive_side
from studio.road.formats import limit, osm
from studio.road.formats.country import Country, country_at
from studio.road.network.report import Notes


# capitals and towns on both sides of the world; sides as their traffic codes have them
@pytest.mark.parametrize(
    ("latitude", "longitude", "country", "side"),
    [
        (52.52, 13.40, "Germany", "right"),
        (51.51, -0.13, "United Kingdom", "left"),
        (53.35, -6.26, "Ireland", "left"),
        (35.90, 14.51, "Malta", "left"),
        (34.68, 33.04, "Cyprus", "left"),
        (35.68, 139.69, "Japan", "left"),
        (28.61, 77.21, "India", "left"),
        (13.75, 100.50, "Thailand", "left"),
        (1.286, 103.859, "Singapore", "left"),
        (-6.2, 106.8, "Indonesia", "left"),
        (-33.87, 151.21, "Australia", "left"),
        (-36.85, 174.76, "New Zealand", "left"),
        (-26.2, 28.04, "South Africa", "left"),
        (-1.29, 36.82, "Kenya", "left"),
        (18.01, -76.79, "Jamaica", "left"),
        (18.34, -64.93, "U.S. Virgin Is.", "left"),
        (18.46, -66.10, "Puerto Rico", "right"),
        (47.61, -122.33, "United States of America", "right"),
        (21.31, -157.86, "United States of America", "right"),
        (48.86, 2.35, "France", "right"),
        (39.90, 116.40, "China", "right"),
        (-23.55, -46.63, "Brazil", "right"),
        (66.0, -172.5, "Russia", "right"),
    ],
)
def test_sides_of_the_world(latitude, longitude, country, side):
    found = country_at(latitude, longitude)
    assert (found.name, found.drives) == (country, side)


def test_near_a_border_to_the_other_side_nothing_is_certain():
    assert not country_at(17.88, 102.74).certain  # Nong Khai: Laos begins across the river
    assert not country_at(22.32, 114.17).certain  # Hong Kong
    assert country_at(54.99, -7.31).certain  # Derry: Ireland drives left as well
    assert country_at(51.13, 1.31).certain  # Dover: France is 33 km away


def test_the_open_sea_belongs_to_nobody():
    assert country_at(0.0, -30.0) == Country("no country", "right", certain=False)


RING = [(0.0, 0.001), (-0.001, 0.0), (0.0, -0.001), (0.001, 0.0), (0.0, 0.001)]  # counter-clockwise


def way(points, **tags):
    return osm.Way(7, list(range(len(points))), points, {"highway": "primary", **tags})


def test_a_tag_beats_the_country():
    tagged = way(RING, driving_side="left")
    assert drive_side([tagged], Country("Germany", "right", certain=True)).side == "left"


@pytest.mark.parametrize(("ring", "side"), [(RING, "right"), (RING[::-1], "left")])
def test_near_a_border_roundabouts_decide(ring, side):
    ways = [way(ring, junction="roundabout"), way(RING[:2])]
    for country in (Country("A", "right", certain=False), Country("B", "left", certain=False)):
        decided = drive_side(ways, country)
        assert decided.side == side and "roundabout" in decided.why
    assert drive_side(ways, Country("A", "right", certain=True)).side == "right"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("50", 50.0),
        ("30 mph", 48.28),
        ("30mph", 48.28),
        ("10 knots", 18.52),
        ("walk", 7.0),
        ("none", 130.0),
        ("DE:urban", 50.0),
        ("DE:zone:30", 30.0),
        ("DE:zone30", 30.0),
        ("FR:30", 30.0),
        ("GB:nsl_single", 96.56),
        ("GB:20", 32.19),
        ("XX:urban", 50.0),
        ("signals", None),
        ("variable", None),
        ("fast", None),
        ("0", None),
        ("5000", None),
        ("", None),
    ],
)
def test_limits_are_read_with_their_units(text, expected):
    limit_read = limit.kilometres_per_hour(text)
    assert limit_read == expected if expected is None else limit_read == pytest.approx(expected, abs=0.01)


def test_what_is_mapped_is_no_guess_and_what_is_guessed_is_told():
    notes = Notes()
    assert limit.limited(way(RING, maxspeed="30 mph"), "Germany", notes).tags["maxspeed"] == "48.280"
    assert limit.limited(way(RING, **{"zone:traffic": "DE:rural"}), "Germany", notes).tags["maxspeed"] == "100.000"
    assert not notes.guesses
    assert limit.limited(way(RING), "United Kingdom", notes).tags["maxspeed"] == "48.280"
    (guess,) = notes.guesses
    assert (guess.what, guess.source) == ("48 km/h", "highway=primary in United Kingdom")


def test_a_limit_that_names_no_speed_is_told_and_guessed():
    notes = Notes()
    assert limit.limited(way(RING, maxspeed="signals"), "Germany", notes).tags["maxspeed"] == "50.000"
    assert notes.skipped[0].what == "maxspeed=signals" and len(notes.guesses) == 1


def test_each_direction_has_its_limit_and_its_side(draft, tmp_path, own_cache):
    """A street in Dover: 30 mph one way, 20 mph back; who drives east has the oncoming lane on the right, that is south."""
    a, b = draft.node(51.13, 1.310), draft.node(51.13, 1.314)
    draft.way(1, [a, b], highway="tertiary", maxspeed__forward="30 mph", maxspeed__backward="20 mph")
    street = load(draft.write(tmp_path / "dover.osm"))
    east, west = street.lanes_of("1")[0], street.lanes_of("-1")[0]
    assert (east.speed * 3.6, west.speed * 3.6) == pytest.approx((48.28, 32.19), abs=0.1)
    assert east.centre[0, -1] > east.centre[0, 0] and east.centre[1].mean() > west.centre[1].mean() + 2.0
    assert street.drive_side == "left" and not [each for each in street.report.guesses if each.kind == "speed limit"]


def test_a_way_against_its_nodes(draft, tmp_path, own_cache):
    a, b = draft.node(52.5, 13.400), draft.node(52.5, 13.404)
    draft.way(1, [a, b], highway="tertiary", oneway="-1", maxspeed="DE:urban")
    street = load(draft.write(tmp_path / "against.osm"))
    (only,) = [lane for lane in street.lanes if not lane.internal]
    assert only.centre[0, -1] < only.centre[0, 0] and only.speed * 3.6 == pytest.approx(50.0, abs=0.1)


@pytest.mark.parametrize(
    ("tags", "is_built"),
    [
        ({"access": "no"}, False),
        ({"access": "no", "motor_vehicle": "yes"}, True),
        ({"access": "yes", "motorcar": "no"}, False),
        ({"vehicle": "private"}, False),
        ({"access": "destination"}, True),
    ],
)
def test_the_more_exact_access_counts(draft, tmp_path, own_cache, tags, is_built):
    nodes = [draft.node(52.5, 13.40 + 0.004 * i) for i in range(3)]
    draft.way(1, nodes[:2], highway="residential", maxspeed="30")
    draft.way(2, nodes[1:], highway="residential", maxspeed="50", **tags)
    built = load(draft.write(tmp_path / "access.osm"))
    assert ("50" in built.report.speed_limits.lane_km) == is_built
    assert any(each.kind == "closed way" and each.where == "way 2" for each in built.report.skipped) != is_built
