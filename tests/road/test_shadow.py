"""What buildings hide, against shapely and closed forms."""

from math import atan, pi, sqrt

import numpy as np
import pytest
import shapely

from studio.model.radio import propagation
from studio.road import load
from studio.road.network import Building
from studio.road.network.curve import resampled
from studio.road.network.shadow import (
    EYE,
    OPEN,
    SKY_CELL,
    SKY_REACH,
    is_clear,
    joined,
    open_sky,
    shadow,
    shadow_of,
    sky_above,
    walk,
    walls_between,
)
from tests.road.test_places import FILES


def box(x0, y0, x1, y1, *, height=20.0, base=0.0, holes=()):
    """A house with its sides along the axes."""
    return Building(np.array([[x0, x1, x1, x0], [y0, y0, y1, y1]], dtype=float), tuple(holes), height, base, "")


def ring(x0, y0, x1, y1):
    return np.array([[x0, x0, x1, x1], [y0, y1, y1, y0]], dtype=float)


HOUSE = box(40, -10, 60, 10)


def crossed(buildings, a, b):
    """Walls and metres between two places [m], both 1.5 m above the ground unless a height is given."""
    a, b = ((*each, EYE)[:3] for each in (a, b))
    return walls_between(shadow(buildings), 0, *map(float, a), *map(float, b))


def test_a_house_of_twenty_metres_costs_26_decibels():
    """Two walls and 20 m: 18 dB + 8 dB (check value for the model of Sommer et al.)."""
    walls, inside = crossed([HOUSE], (0, 0), (100, 0))
    assert (walls, inside) == (2, pytest.approx(20.0))
    assert propagation.attenuation(walls, inside) == pytest.approx(26.0)


@pytest.mark.parametrize("exponent", [2.0, 2.75, 4.0])
def test_a_weaker_signal_is_a_longer_way(exponent):
    """10 n log10 of the felt over the true distance is the attenuation again; without buildings nothing changes."""
    felt = propagation.felt_distance(80.0, 26.0, exponent)
    assert 10.0 * exponent * np.log10(felt / 80.0) == pytest.approx(26.0)
    assert propagation.felt_distance(80.0, 0.0, exponent) == 80.0


@pytest.mark.parametrize(
    ("a", "b", "walls", "inside"),
    [
        ((0, 0), (100, 30), 0, 0.0),  # passes its corner by
        ((0, 0), (100, 20), 2, sqrt(1.04) * 10.0),  # cuts its corner off
        ((0, 11), (100, 11), 0, 0.0),
        ((50, -100), (50, 100), 2, 20.0),
        ((50, 0), (100, 0), 1, 10.0),  # from inside
        ((0, 0), (50, 0), 1, 10.0),
        ((45, 0), (55, 5), 0, sqrt(125.0)),  # both inside
        ((0, 0), (30, 0), 0, 0.0),  # ends before it
        ((0, 0, 30), (100, 0, 30), 0, 0.0),  # over it
        ((0, 0, 0), (100, 0, 40), 1, sqrt(1.16) * 10.0),  # leaves it through the roof in its middle
        ((0, 0, 40), (100, 0, 0), 1, sqrt(1.16) * 10.0),
    ],
)
def test_lines_past_and_through_a_house(a, b, walls, inside):
    assert crossed([HOUSE], a, b) == (walls, pytest.approx(inside))


def test_a_courtyard_is_no_inside():
    """A house of 40 m with a court of 20 m: four walls, 20 m."""
    assert crossed([box(0, 0, 40, 40, holes=[ring(10, 10, 30, 30)])], (-10, 20), (50, 20)) == (4, pytest.approx(20.0))
    assert crossed([box(0, 0, 40, 40, holes=[ring(10, 10, 30, 30)])], (20, 20), (50, 20)) == (2, pytest.approx(10.0))


def test_what_hangs_above_the_antennas_does_not_block():
    assert crossed([box(40, -10, 60, 10, base=4.0)], (0, 0), (100, 0)) == (0, 0.0)
    assert crossed([box(40, -10, 60, 10, height=1.0)], (0, 0), (100, 0)) == (0, 0.0)


def test_the_way_round_an_outline_is_drawn_does_not_matter():
    turned = Building(HOUSE.outline[:, ::-1], (), 20.0, 0.0, "")
    assert crossed([turned], (0, 3), (100, -4)) == crossed([HOUSE], (0, 3), (100, -4))


def test_without_buildings_nothing_is_hidden():
    empty = shadow([])
    assert walls_between(empty, 0, 0.0, 0.0, 1.5, 1e4, 5e3, 1.5) == (0, 0.0)
    assert open_sky(empty, 0, 3.0, 4.0) == 1.0


@pytest.fixture(scope="module", params=FILES)
def here(request):
    return load(FILES[request.param])


def lines(here, count, seed):
    """Straight lines of any length and direction about the buildings of a map."""
    rng = np.random.default_rng(seed)
    outlines = np.concatenate([each.outline for each in here.scenery.buildings], axis=1)
    low, high = outlines.min(axis=1), outlines.max(axis=1)
    a = rng.uniform(low - 50.0, high + 50.0, (count, 2))
    return a, a + rng.normal(0.0, 1.0, (count, 2)) * rng.choice([5.0, 60.0, 600.0], (count, 1))


def test_walls_and_metres_are_those_of_shapely(here):
    """Every building by itself, cut with every line; antennas at their usual height."""
    found = shadow_of(here)
    blocking = [each for each in here.scenery.buildings if each.base <= EYE < each.height]
    forms = [shapely.Polygon(each.outline.T, [hole.T for hole in each.holes]) for each in blocking]
    tree = shapely.STRtree(forms)
    hits = 0
    for a, b in zip(*lines(here, 300, 1), strict=True):
        line = shapely.LineString([a, b])
        met = [forms[i] for i in tree.query(line)]
        inside = sum(form.intersection(line).length for form in met if form.is_valid)
        walls = sum(points_of(form.boundary.intersection(line)) for form in met)
        counted, metres = walls_between(found, 0, *a, EYE, *b, EYE)
        assert counted == walls
        assert metres == pytest.approx(inside, abs=1e-6)
        hits += walls > 0
    assert hits > 20


def points_of(cut):
    """Number of points in an intersection."""
    return sum(part.geom_type == "Point" for part in shapely.get_parts(cut))


def test_both_ways_are_the_same_bit_by_bit(here):
    found = shadow_of(here)
    for a, b in zip(*lines(here, 200, 2), strict=True):
        assert walls_between(found, 0, *a, 1.0, *b, 6.0) == walls_between(found, 0, *b, 6.0, *a, 1.0)


def test_maps_side_by_side_hide_what_each_hides_alone():
    maps = [load(FILES[name]) for name in ("seattle_triangle_small", "singapore_bayfront_lht")]
    alone = [shadow_of(each) for each in maps]
    both = joined([alone[0], shadow([]), alone[1]])
    for each, own, m in ((maps[0], alone[0], 0), (maps[1], alone[1], 2)):
        for a, b in zip(*lines(each, 60, 3), strict=True):
            assert walls_between(both, m, *a, EYE, *b, EYE) == walls_between(own, 0, *a, EYE, *b, EYE)
            assert walls_between(both, 1, *a, EYE, *b, EYE) == (0, 0.0)
            assert open_sky(both, m, *a) == open_sky(own, 0, *a)


# -- the sky ---------------------------------------------------------------------------------------


def horizon(here, x, y, azimuths):
    """Sine of the elevation of the highest top at each azimuth, every building cut with every line by shapely."""
    forms = [(shapely.Polygon(each.outline.T, [hole.T for hole in each.holes]), each.height - EYE) for each in here.scenery.buildings]
    spot = shapely.Point(x, y)
    if any(form.contains(spot) for form, height in forms if height > 0.0):
        return np.ones(len(azimuths))
    near = [(form, height) for form, height in forms if height > 0.0 and form.distance(spot) < SKY_REACH]
    found = []
    for angle in azimuths:
        line = shapely.LineString([(x, y), (x + SKY_REACH * np.cos(angle), y + SKY_REACH * np.sin(angle))])
        rises = [height / spot.distance(form.intersection(line)) for form, height in near if form.intersects(line)]
        found.append(np.sin(np.arctan(max(rises, default=0.0))))
    return np.array(found)


def test_the_sky_of_a_real_place_is_that_of_shapely(here):
    azimuths = 2.0 * pi * (np.arange(24) + 0.5) / 24
    rng = np.random.default_rng(8)
    for lane in rng.choice([each.id for each in here.lanes], 6):
        x, y = here.lanes[lane].centre[:, 0]
        assert sky_above(shadow_of(here), 0, x, y) == pytest.approx(1.0 - horizon(here, x, y, azimuths).mean(), abs=1e-9)


def test_the_sky_over_lanes_is_there_before_anybody_asks(here):
    """It is the same as when somebody asks; and where no lane is nearby it is left until then."""
    found, asked = shadow_of(here), shadow(here.scenery.buildings)
    known = int(np.count_nonzero(found.sky))
    for lane in here.lanes[::7]:
        for place in resampled(lane.centre, 3.0).T:
            assert open_sky(found, 0, *place) == open_sky(asked, 0, *place)
    assert np.count_nonzero(found.sky) == known < found.sky.size


def test_the_sky_in_a_round_court():
    """A court of 30 m radius, walls that rise 20 m above the eye: 1 - sin(atan(2/3)) of the sky is open."""
    angle = 2.0 * pi * np.arange(720) / 720
    round_ = np.array([np.cos(angle), np.sin(angle)])
    court = Building(60.0 * round_, (30.0 * round_[:, ::-1],), EYE + 20.0, 0.0, "")
    assert sky_above(shadow([court]), 0, 0.0, 0.0) == pytest.approx(1.0 - np.sin(atan(2.0 / 3.0)), abs=2e-4)


def test_the_sky_beside_a_long_wall():
    """Horizon atan(h cos(a)/D) on one side: open is 1 - mean of sin over its half, by fine summation of the same integral."""
    h, distance = 18.0, 12.0
    wall = shadow([box(-5000, distance, 5000, distance + 10, height=EYE + h)])
    azimuths = (np.arange(100_000) + 0.5) / 100_000 * pi - pi / 2
    rise = h * np.cos(azimuths) / distance
    rise[distance / np.cos(azimuths) > SKY_REACH] = 0.0
    exact = 1.0 - 0.5 * np.mean(rise / np.sqrt(1.0 + rise**2))
    assert sky_above(wall, 0, 0.0, 0.0) == pytest.approx(exact, abs=0.01)
    assert exact == pytest.approx(0.70, abs=0.02)


def test_a_street_between_houses_has_less_sky_than_one_side_of_it():
    near, far = box(-500, 10, 500, 20), box(-500, -20, 500, -10)
    one, two = (sky_above(shadow(each), 0, 0.0, 0.0) for each in ([near], [near, far]))
    assert 1.0 - two == pytest.approx(2.0 * (1.0 - one), abs=1e-12)
    assert sky_above(shadow([near, far, near]), 0, 0.0, 0.0) == two


def test_no_sky_in_a_house_and_a_whole_one_far_away():
    found = shadow([HOUSE])
    assert sky_above(found, 0, 50.0, 0.0) == 0.0
    assert open_sky(found, 0, 50.0 + SKY_REACH + 60.0, 0.0) == 1.0
    assert open_sky(found, 0, float("nan"), 0.0) == 1.0


def test_what_is_remembered_of_the_sky_is_what_was_worked_out():
    """The second answer is the first one, and close to that of the place itself."""
    found = shadow([HOUSE])
    for x in np.linspace(-150.0, 150.0, 41):
        first = open_sky(found, 0, x, 14.0)
        assert open_sky(found, 0, x, 14.0) == first
        assert first == pytest.approx(sky_above(found, 0, x, 14.0), abs=0.15)
    assert np.count_nonzero(found.sky) == 41


def cells_in(found, m, x0, y0, x1, y1):
    """What stands in every cell that an upright box reaches into, each asked for by itself."""
    xs, ys = (np.append(np.arange(low, high, 0.5 * SKY_CELL), high) for low, high in ((x0, x1), (y0, y1)))
    return {walk(found.grid.frame, found.mass, m, x, y, x, y, False) for x in xs for y in ys}


@pytest.mark.parametrize("m", [0, 1])
def test_a_box_is_clear_when_every_cell_in_it_is_open(m):
    """On either of two maps side by side, also beyond the edges of the map; both answers come."""
    houses = [HOUSE, box(-90, 30, -70, 75), box(10, -80, 13, -60, base=3.0), box(-40, -45, -20, -25, height=1.0)]
    found = joined([shadow(houses), shadow([box(-300, -20, -260, 0), box(5, 5, 30, 90)])])
    rng, answers = np.random.default_rng(7), []
    for _ in range(400):
        x, y = rng.uniform(-400.0, 400.0, 2) if rng.random() < 0.3 else rng.uniform(-110.0, 90.0, 2)
        east, north = rng.uniform(0.0, 60.0, 2)
        answers.append(is_clear(found.grid.frame, found.filled, m, x, y, x + east, y + north))
        assert answers[-1] == (cells_in(found, m, x, y, x + east, y + north) == {OPEN})
    assert 20 < sum(answers) < 380


def test_around_a_place_far_away_it_is_clear():
    """On a map without buildings, and a kilometre beyond the edges of one with a house."""
    none, one = shadow([]), shadow([HOUSE])
    assert is_clear(none.grid.frame, none.filled, 0, -10.0, -10.0, 10.0, 10.0)
    for x, y in ((-2000.0, 0.0), (2000.0, 0.0), (0.0, -2000.0), (0.0, 2000.0)):
        assert is_clear(one.grid.frame, one.filled, 0, x, y, x + 50.0, y + 50.0)
    assert not is_clear(one.grid.frame, one.filled, 0, -2000.0, -2000.0, 2000.0, 2000.0)
