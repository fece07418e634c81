"""Reading scenario files: everything wrong is told at once, with field, value, what is allowed, the nearest name."""

import copy

import numpy as np
import pytest
import yaml

from studio import job
from studio.errors import MapError, RouteError, ScenarioError
from studio.scenario import file, setup
from studio.world.car import position


@pytest.fixture
def document(sample):
    return file.read(sample)


def refusal(document) -> str:
    with pytest.raises(ScenarioError) as caught:
        setup.complete(document, "my.yaml")
    return str(caught.value)


def test_the_sample_is_valid_and_complete(document):
    scenario = setup.complete(document, "sample")
    assert scenario.applications["platoon"].parameters["k_p"] == 0.2  # a default, filled in
    again = setup.complete(scenario.model_dump(mode="json"), "sample")
    assert again == scenario


def test_a_preset_gives_what_is_not_given(document):
    group = document["applications"]["platoon"] | {"application": "acc", "preset": "series", "parameters": {"headway": 2.0}}
    group.pop("listens_to", None)
    found = setup.complete(document | {"applications": {"platoon": group}}, "sample").applications["platoon"].parameters
    assert (found["headway"], found["response_time"], found["cruise_gain"]) == (2.0, 0.51, 0.5)
    group["preset"] = "serial"
    assert "series" in refusal(document | {"applications": {"platoon": group}})


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        ("clock.duraton", 3, ["clock.duraton", "did you mean 'duration'"]),
        ("clock.duration", -3, ["clock.duration", "-3", "> 0"]),
        ("clock.duration", "long", ["clock.duration", "'long'"]),
        ("clock.tick", 0.013, ["clock", "whole number of steps"]),
        ("traffic.count", 3001, ["traffic.count", "3001", "≤ 3000"]),
        ("vehicles.leader.speed", float("nan"), ["vehicles.leader.speed", "nan"]),
        ("vehicles.leader.colour", "red", ["vehicles.leader.colour", "'red'"]),
        ("applications.platoon.application", "cac", ["applications.platoon.application", "did you mean 'cacc'"]),
        ("applications.platoon.parameters", {"headway": 9}, ["applications.platoon.parameters.headway", "9", "≤ 5"]),
        ("applications.platoon.parameters", {"hedway": 1}, ["parameters.hedway", "did you mean 'headway'"]),
        ("applications.platoon.listens_to", ["leader"], ["4 units but 1"]),
        ("applications.platoon.preset", "series", ["applications.platoon.preset", "'series'", "'cacc' has no presets"]),
        ("vehicles.leader.position", {"along": 1, "road": "x"}, ["vehicles.leader.position", "either"]),
        ("version", 1, ["version", "1"]),
        ("vehicles.leader.sped", 2, ["vehicles.leader.sped", "did you mean 'speed'"]),
    ],
)
def test_a_wrong_field_is_named(document, path, value, words):
    *parents, last = path.split(".")
    node = document
    for part in parents:
        node = node.setdefault(part, {})
    node[last] = value
    text = refusal(document)
    for word in ["my.yaml", *words]:
        assert word in text


def test_all_problems_at_once(document):
    document["clock"]["duration"] = 0
    document["radio"] = {"loss": 2}
    document["nonsense"] = 1
    text = refusal(document)
    assert all(word in text for word in ("clock.duration", "radio.loss", "nonsense"))


def change_vehicle(document, **fields):
    changed = copy.deepcopy(document)
    changed["vehicles"]["leader"].update(fields)
    return changed


def prepared(document, folder):
    path = folder / "my.yaml"
    path.write_text(yaml.safe_dump(document), encoding="utf-8")
    return job.prepare(job.load(path))


@pytest.fixture
def folder(tmp_path, sample):
    (tmp_path / "maps").symlink_to(sample.parent / "maps")
    return tmp_path


def test_names_that_do_not_exist(document, folder):
    wrong = change_vehicle(document, model="bmw_320", route="east")
    wrong["script"]["hard_brake"]["do"]["vehicle"] = "leeder"
    with pytest.raises(ScenarioError) as caught:
        prepared(wrong, folder)
    text = str(caught.value)
    assert "did you mean 'bmw_320i'" in text and "vehicles.leader.route" in text and "did you mean 'leader'" in text


def test_a_route_over_roads_that_do_not_connect(document, folder):
    wrong = copy.deepcopy(document)
    wrong["routes"]["east_to_west"]["roads"] = ["206170873#1", "340498991"]
    with pytest.raises(RouteError) as caught:
        prepared(wrong, folder)
    text = str(caught.value)
    assert "routes.east_to_west.roads" in text and "206170873#1" in text and "340498991" in text


def test_a_road_that_is_not_on_the_map(document, folder):
    wrong = copy.deepcopy(document)
    wrong["routes"]["east_to_west"]["roads"] = ["34049899", "206170873#1"]
    with pytest.raises(RouteError, match="340498991"):
        prepared(wrong, folder)


def test_a_start_beyond_the_route(document, folder):
    with pytest.raises(ScenarioError, match="beyond the end"):
        prepared(change_vehicle(document, position={"along": 99_999}), folder)


def test_a_start_by_road_and_lane(document, folder):
    setting = prepared(change_vehicle(document, position={"road": "340498991", "lane": 2, "offset": 50}), folder)
    leader = setting.cars[setting.names.index("leader")]
    assert leader.station == 50 and leader.path.stations[0].lane_index == 2


def test_two_applications_on_one_car(document, folder):
    """Of two that command the same actuator one must come first."""
    document["applications"]["second"] = {"application": "acc", "units": ["follower_1"]}
    with pytest.raises(ScenarioError, match="commands acceleration of 'follower_1', as 'platoon' does, with the same priority"):
        prepared(document, folder)


def test_a_period_that_is_no_whole_number_of_ticks(document, folder):
    document["radio"] = {"period": 0.03}
    with pytest.raises(ScenarioError, match=r"radio\.period"):
        prepared(document, folder)


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        ("clock", {"duration": 0.05}, ["clock.duration", "whole number of ticks"]),
        ("goals", {"min_tcc": {"least": 1}}, ["goals.min_tcc", "did you mean 'min_ttc'"]),
        ("applications", {"a": {"application": "acc", "units": ["leader"], "listens_to": ["leader"]}}, ["itself"]),
    ],
)
def test_what_only_makes_sense_as_a_whole(document, folder, path, value, words):
    document[path] = value
    with pytest.raises(ScenarioError) as caught:
        prepared(document, folder)
    assert all(word in str(caught.value) for word in words)


def test_names_of_the_traffic_are_taken(document, folder):
    document["vehicles"]["traffic_01"] = document["vehicles"]["leader"] | {"position": {"along": 10}}
    with pytest.raises(ScenarioError, match="name of the traffic"):
        prepared(document, folder)


def test_two_cars_in_one_place(document, folder):
    """Their outlines decide: of the ways out the shortest is to the side, by the 1.61 m that a car is wide."""
    document["vehicles"]["other"] = document["vehicles"]["leader"] | {"position": {"along": 361}}
    with pytest.raises(ScenarioError) as caught:
        prepared(document, folder)
    (problem,) = caught.value.problems
    assert problem.where.endswith("vehicles.other.position") and "starts where 'leader' starts" in str(problem)
    assert "a gap of -1.6" in str(problem)


def test_cars_side_by_side_are_not_in_one_place(document, folder):
    """On neighbouring lanes, 3.2 m from middle to middle, which is less than a car is long."""
    start = {"road": "340498991", "offset": 360}
    document["vehicles"] = {f"lane_{i}": document["vehicles"]["leader"] | {"position": start | {"lane": i}} for i in (1, 2)}
    document |= {"applications": {}, "script": {}, "traffic": {"count": 0}}
    one, other = prepared(document, folder).cars
    (x, y), (a, b) = position(one.path, one.station), position(other.path, other.station)
    assert 3.0 < np.hypot(x - a, y - b) < 3.5


def test_a_car_in_a_barrier(document, folder):
    """What stands on the road from the beginning is there when cars start; what comes later is not."""
    put = {"kind": "objects", "route": "east_to_west", "what": "barriers", "start": 361, "end": 362}
    document["script"] = {"later": {"when": {"kind": "time", "at": 1}, "do": put}}
    prepared(document, folder)
    document["script"] = {"works": {"do": put}}
    with pytest.raises(ScenarioError, match="starts where barrier_1 of works starts"):
        prepared(document, folder)


def test_a_missing_map(document, folder):
    document["map"]["file"] = "maps/berlin_siegessaeule_grosser_sten.osm.gz"
    with pytest.raises(MapError) as caught:
        prepared(document, folder)
    assert "map.file" in str(caught.value) and "did you mean 'berlin_siegessaeule_grosser_stern.osm.gz'" in str(caught.value)


def test_a_map_that_is_none(document, tmp_path):
    (tmp_path / "place.osm").write_text("hello")
    document["map"]["file"] = "place.osm"
    with pytest.raises(MapError, match=r"place\.osm"):
        prepared(document, tmp_path)


def test_traffic_for_which_there_is_no_room_waits_outside(document, folder):
    document["traffic"] = {"count": 500, "spacing": 150}
    cars = [each for each in prepared(document, folder).cars if each.returns]
    assert len(cars) == 500
    assert 0 < sum(each.is_outside for each in cars) < 500


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "empty"),
        (b"- a\n- b\n", "list"),
        (b"a: [1, 2\n", "line"),
        (b"\xff\xfe\x00", "UTF-8"),
        (b"title: a\ntitle: b\n", "twice"),
        (b"a: !!python/object/apply:os.system ['true']\n", "line 1"),
        (b"[" * 5000, "line 1, column 66: is nested too deep"),
    ],
)
def test_files_that_are_no_scenario(tmp_path, content, words):
    path = tmp_path / "bad.yaml"
    path.write_bytes(content)
    with pytest.raises(ScenarioError, match=words):
        file.read(path)


def test_a_missing_file_names_its_neighbour(sample):
    with pytest.raises(ScenarioError, match=r"did you mean 'grosser_stern_platoon\.yaml'"):
        file.read(sample.with_name("grosser_stern_platon.yaml"))


def test_of_very_many_problems_the_first_are_told(document):
    """And their number; nobody waits for what nobody reads."""
    wrong = {f"car_{i}": {"x": i} for i in range(5000)}
    told = refusal(document | {"vehicles": wrong})
    assert "vehicles.car_0.x" in told and "more problems" in told and len(told) < 100_000
