"""What lies beside a fast road: a shoulder that no lane lies on, and rails that stand clear of all asphalt."""

import numpy as np
import pytest
import shapely

from studio import job
from studio.road.network.outline import road_form
from studio.scene.city import verge
from studio.scene.city.building import DARKEST, LUMINANCE, lifted
from studio.scene.colour import linear


def test_a_town_has_neither(town):
    form = road_form(town)
    assert verge.shoulder(town, form).is_empty and verge.rails(town, form) == []


def test_a_motorway_has_both_and_they_keep_off_the_lanes(sample):
    network = job.prepare(job.load(sample.with_stem("motorway_platoon"))).network
    form = road_form(network)
    beside, lines = verge.shoulder(network, form), verge.rail_lines(network, form)
    assert beside.intersection(form).area < 1e-3 * beside.area
    length = sum(line.length for line in lines)
    road = sum(each.length for each in network.roads.values())
    assert length > 0.9 * road  # one at the outer side of each direction at least
    assert min(shapely.distance(line, form) for line in lines) >= verge.CLEAR - 0.1  # by which lines are simplified
    tops = [solid.vertices[:, 2].max() for solid in verge.rails(network, form)]
    assert max(tops) == pytest.approx(verge.RAIL_HEIGHT)


def test_black_glass_is_lifted_and_other_walls_stay():
    assert lifted(linear("#1c1d1f")) @ LUMINANCE == pytest.approx(DARKEST)
    np.testing.assert_array_equal(lifted(linear("#e2dacb")), linear("#e2dacb"))
