"""A truck whose way has a turn that only cars can take: wherever a route is planned or judged, its own lock counts."""

import numpy as np
import pytest

from studio.errors import ScenarioError
from studio.scenario.setup import complete
from studio.world.setting import setting
from tests.road.plot import plot

BACK = np.radians(152.0)  # [rad] from street 11 into street 13
HOUSE = {1: (-150, 0), 2: (0, 0), 3: (150, 0), 4: (150 * np.cos(BACK), 150 * np.sin(BACK)), 5: (150, 700), 6: (-132, 700), 7: (-350, 70)}
ONE_WAY = {"highway": "residential", "oneway": "yes", "lanes": "1"}
STREETS = {11: ([1, 2], ONE_WAY), 12: ([2, 3], ONE_WAY), 13: ([2, 4], ONE_WAY), 15: ([3, 5, 6, 4], ONE_WAY), 14: ([4, 7], ONE_WAY)}


@pytest.fixture
def prepared(tmp_path):
    """Makes the streets with a scenario: to street 14 there is the sharp turn, and a way round the block."""
    plot(tmp_path / "map.osm", HOUSE, STREETS)

    def made(**document):
        return setting(complete({"title": "trucks", "map": {"file": "map.osm"}, **document}, "trucks"), tmp_path, "trucks")

    return made


CAR = {"route": "r", "position": {"along": 10.0}, "speed": 5.0}


def driven(model, **more):
    """A vehicle from street 11 to street 14."""
    return {"routes": {"r": {"roads": ["11", "14"]}}, "vehicles": {"own": CAR | {"model": model}}, **more}


def test_the_way_of_a_truck_leads_round_the_block(prepared):
    roads = {model: [each.road for each in prepared(**driven(model)).cars[0].path.stations] for model in ("bmw_320i", "truck")}
    assert roads == {"bmw_320i": ["11", "13", "14"], "truck": ["11", "12", "14"]}


def test_a_station_of_a_script_lies_on_the_way_that_is_driven(prepared):
    """1500 m: a truck comes there, a car has arrived long before."""
    script = {"it": {"when": {"kind": "passed", "vehicle": "own", "along": 1500.0}, "do": {"kind": "end"}}}
    assert prepared(**driven("truck", script=script)).cars[0].path.length > 1500.0
    with pytest.raises(ScenarioError, match="lies beyond the end of the route of 'own'"):
        prepared(**driven("bmw_320i", script=script))


def test_a_row_of_cones_lies_on_the_way_that_is_driven(prepared):
    script = {"it": {"do": {"kind": "objects", "route": "r", "start": 1490.0, "end": 1500.0}}}
    assert prepared(**driven("truck", script=script)).sites[0].laid[0].line.length > 1500.0
    with pytest.raises(ScenarioError, match="lies beyond the end of its route"):
        prepared(**driven("bmw_320i", script=script))


def test_of_a_route_file_trucks_that_do_not_get_round_are_left_out_and_told(prepared, tmp_path):
    types = '<vType id="car" vClass="passenger"/><vType id="lorry" vClass="truck"/>'
    ways = (("car", "11 13"), ("lorry", "11 13"), ("lorry", "11 12"), ("car", "13 11"))
    cars = [f'<vehicle id="v{i}" type="{kind}" depart="{i}"><route edges="{way}"/></vehicle>' for i, (kind, way) in enumerate(ways)]
    (tmp_path / "town.rou.xml").write_text(f"<routes>{types}{''.join(cars)}</routes>")
    made = prepared(**driven("bmw_320i", traffic={"routes": "town.rou.xml"}))
    assert {(each.model, each.path.stations[-1].road) for each in made.sources} == {("car", "13"), ("lorry", "12")}
    assert "cars whose route has turns that are too narrow for them: 1" in made.imported
    assert "cars whose route does not lead over this map: 1" in made.imported
