"""Streets with one lane for both directions: drawn on one ground, with room to meet at the ends, and told."""

import pytest

from studio.road import load
from studio.road.assembly.shared import LEAST_END, MOST_END, TAPER
from studio.road.network import curve
from studio.road.ways.conflict import AGAINST, SHARED, SHARED_FIRST, SHARED_LAST
from studio.road.ways.meeting import meetings_of
from studio.road.ways.strand import WIDTH, strands_of
from tests.road.plot import LONDON, guessed, plot, skipped

OUTSIDE = 250.0  # [m] of wider road on either side
NARROW = {"highway": "residential", "lanes": "1", "maxspeed": "30"}


def street(target, length, tags=None, *, centre=None, bend=0.0):
    """East along way 11, which is wide, then 12 with one lane, then 13: `length` metres of it, its middle so far [m] to the north."""
    h = length / 2.0
    nodes = {1: (-h - OUTSIDE, 0), 2: (-h, 0), 3: (0, bend), 4: (h, 0), 5: (h + OUTSIDE, 0)}
    ways = {11: ([1, 2], {}), 12: ([2, 3, 4], NARROW | (tags or {})), 13: ([4, 5], {})}
    return plot(target, nodes, ways, **({"centre": centre} if centre else {}))


def both(network):
    """The lanes of way 12."""
    return network.lanes_of("12")[0], network.lanes_of("-12")[0]


def apart(network):
    """How far the points of the lane to the east are from the other one [m], and where [m]."""
    east, west = both(network)
    return curve.stations(east.centre), curve.distances(east.centre, west.centre)


@pytest.mark.parametrize(("length", "bend"), [(60.0, 0.0), (100.0, 0.0), (200.0, 0.0), (200.0, 25.0)])
@pytest.mark.parametrize("centre", [None, LONDON])
def test_two_directions_lie_on_one_ground_but_for_the_ends(tmp_path, own_cache, length, bend, centre):
    network = load(street(tmp_path / "map.osm", length, centre=centre, bend=bend))
    s, distance = apart(network)
    end = min(max(0.15 * s[-1], LEAST_END), MOST_END)
    middle = (s > end + TAPER + 2.0) & (s < s[-1] - end - TAPER - 2.0)
    assert middle.any() and distance[middle].max() < 0.1
    assert distance[[0, 1, -2, -1]].min() > WIDTH  # there is room to meet
    assert curve.curvature(curve.resampled(both(network)[0].centre, 1.0)).max() < curve.LOCK


@pytest.mark.parametrize("length", [60.0, 200.0])
def test_their_meeting_spans_the_whole_ground(tmp_path, own_cache, length):
    network = load(street(tmp_path / "map.osm", length))
    east, west = both(network)
    met, strands = meetings_of(network), strands_of(network)
    (m,) = [m for m in range(met.first[east.id], met.first[east.id + 1]) if met.partner[m] == west.id]
    enter, leave, its_enter, its_leave = met.span[:, m]
    assert (met.shape[m], met.turn[m]) == (AGAINST, SHARED)
    assert [enter + its_leave, leave + its_enter] == pytest.approx([strands.length[east.id]] * 2, abs=1.5)  # the same from either end
    assert LEAST_END < enter < MOST_END + TAPER and leave - enter > strands.length[east.id] - 2 * (MOST_END + TAPER)


@pytest.mark.parametrize(("priority", "first"), [("forward", "12"), ("backward", "-12")])
def test_a_sign_says_who_goes_first(tmp_path, own_cache, priority, first):
    network = load(street(tmp_path / "map.osm", 100.0, {"priority": priority}))
    met, (east, west) = meetings_of(network), both(network)
    turns = {lane.road: met.turn[met.first[lane.id]] for lane in (east, west)}
    assert turns.pop(first) == SHARED_FIRST and set(turns.values()) == {SHARED_LAST}
    assert not any("priority" in line for line in skipped(network))


@pytest.mark.parametrize(
    ("length", "tags", "told"),
    [
        (150.0, {}, "passed one after the other on 9"), (150.0, {"width": "3"}, "passed one after the other on 9"),
        (40.0, {}, "two lanes of 2.5 m at way 12 (lanes=1 for both directions, on less than 48 m: cars pass each other)"),
        (150.0, {"width": "5.5"}, "two lanes at way 12 (lanes=1 for both directions, and wide enough for two: cars pass each other)"),
    ],
)  # fmt: skip
def test_the_report_says_how_one_meets(tmp_path, own_cache, length, tags, told):
    network = load(street(tmp_path / "map.osm", length, tags))
    (line,) = [line for line in guessed(network) if line.startswith("one lane: ")]
    assert told in line and (both(network)[0].facing >= 0) == ("one after the other" in told)


@pytest.mark.parametrize("tags", [{"lanes": "2"}, {"lanes": "1", "oneway": "yes"}, {"lanes": "", "maxspeed": "50"}])
def test_other_streets_are_as_they_were(tmp_path, own_cache, tags):
    network = load(street(tmp_path / "map.osm", 150.0, tags))
    assert all(lane.facing < 0 for lane in network.lanes) and (meetings_of(network).turn < SHARED).all()
    assert not any(line.startswith("one lane") for line in guessed(network))


def test_both_lanes_know_each_other(tmp_path, own_cache):
    east, west = both(load(street(tmp_path / "map.osm", 150.0)))
    assert (east.facing, west.facing) == (west.id, east.id)
    assert WIDTH < curve.distances(east.centre[:, -1:], west.centre)[0] < 3.0
