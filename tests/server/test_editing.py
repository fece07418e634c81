"""Editing: named steps that can be undone, also after a restart; edits that meet; what goes along; ways; what can never happen."""

import json
import shutil
from dataclasses import replace
from math import sin

import pytest
import yaml
from websockets.sync.client import connect

from studio import job
from studio.errors import ConflictError, RouteError, SealedError, StudioError
from studio.road import load
from studio.road.assembly.storey import STOREY
from studio.road.network.curve import LOCK
from studio.scenario import catalogue, figures
from studio.scenario.text.patch import operation
from studio.scene import pose
from studio.scene.obstacle import SHAPES
from studio.server.desk import Desk
from studio.server.editing.answer import NewEdit, NewTurn
from studio.server.editing.figure import lock_of
from studio.server.editing.history import Change, steps
from studio.server.editing.merge import changed_places, conflicts
from studio.server.editing.way import driven, way
from studio.server.frame import first_frame
from studio.store.runs import open_runs
from tests.conftest import ROOT
from tests.patience import PATIENCE
from tests.road.plot import plot
from tests.server.test_replay import FLYOVER


@pytest.fixture
def folder(tmp_path, sample):
    """A folder with two samples and their maps."""
    (tmp_path / "maps").symlink_to(sample.parent / "maps")
    for name in ("grosser_stern_platoon", "stepping_out"):
        shutil.copy(sample.with_name(f"{name}.yaml"), tmp_path)
    return tmp_path


@pytest.fixture
def desk(folder):
    return desk_of(folder)


def desk_of(folder):
    """A desk as a server has it; a second one is that of the server after a restart."""
    return Desk(db=folder / "runs.db", scenarios=folder, kinds=())


@pytest.fixture
def path(folder):
    return folder / "grosser_stern_platoon.yaml"


def edit(desk, path, name, base, **what):
    return desk.editing.edit(path, NewEdit(name=name, base=base, **what))


def lead(path, along):
    """Where the leader is put."""
    return {"vehicles.leader.position.along": along}


def names(piles):
    return [each.name for each in piles]


def test_steps_are_undone_and_done_again_to_the_letter(desk, path):
    texts = [path.read_bytes()]
    for number, along in enumerate((362, 364)):
        edit(desk, path, f"Move leader {number}", number, set=lead(path, along))
        texts.append(path.read_bytes())
    assert b"# CACC sees neither lights" in texts[2]  # comments stay
    state = desk.editing.undo(path, NewTurn(base=2))
    assert path.read_bytes() == texts[1] and (names(state.done), names(state.undone)) == (["Move leader 0"], ["Move leader 1"])
    state = desk.editing.undo(path, NewTurn(base=3))
    assert path.read_bytes() == texts[0] and state.done == []
    for base in (4, 5):
        state = desk.editing.redo(path, NewTurn(base=base))
    assert path.read_bytes() == texts[2] and state.undone == [] and state.revision == 6
    assert desk.editing.redo(path, NewTurn(base=6)) == state  # a key that was pressed once too often
    assert path.read_bytes() == texts[2]


def test_a_new_step_ends_what_could_be_done_again(desk, path):
    edit(desk, path, "One", 0, set=lead(path, 362))
    desk.editing.undo(path, NewTurn(base=1))
    state = edit(desk, path, "Other", 2, set={"clock.duration": 50})
    assert (names(state.done), state.undone) == (["Other"], [])


def test_the_history_outlives_the_server(desk, folder, path):
    before = path.read_bytes()
    edit(desk, path, "Delete follower_4", 0, remove=["vehicles.follower_4"])
    again = desk_of(folder)
    assert names(again.editing.state(path).done) == ["Delete follower_4"]
    again.editing.undo(path, NewTurn(base=1))
    assert path.read_bytes() == before


def test_an_edit_to_an_older_revision_is_done_to_the_present_one(desk, path):
    edit(desk, path, "Move leader", 0, set=lead(path, 363), who="one")
    state = edit(desk, path, "Longer", 0, set={"clock.duration": 80}, who="two")
    assert state.document["clock"]["duration"] == 80 and state.document["vehicles"]["leader"]["position"]["along"] == 363


def test_an_edit_of_what_somebody_else_has_changed_is_refused_and_nothing_is_lost(desk, path):
    edit(desk, path, "Move leader", 0, set=lead(path, 363), who="one")
    text = path.read_bytes()
    with pytest.raises(ConflictError, match="“Move leader”") as refusal:
        edit(desk, path, "Move it elsewhere", 0, set=lead(path, 370), who="two")
    (problem,) = refusal.value.problems
    assert (problem.where, problem.value, problem.allowed) == ("vehicles.leader.position.along", "363", "360 before")
    assert path.read_bytes() == text and names(desk.editing.state(path).done) == ["Move leader"]
    edit(desk, path, "Delete leader", 1, remove=["vehicles.leader"])
    with pytest.raises(ConflictError, match="“Delete leader”"):
        edit(desk, path, "Move leader", 1, set=lead(path, 364))
    with pytest.raises(ConflictError, match="not as the edit expects"):
        edit(desk, path, "From nowhere", 99, set=lead(path, 364))


def test_undo_refuses_when_somebody_has_gone_on(desk, path):
    edit(desk, path, "Move leader", 0, set=lead(path, 363))
    edit(desk, path, "Longer", 1, set={"clock.duration": 80})
    with pytest.raises(ConflictError, match="meanwhile"):
        desk.editing.undo(path, NewTurn(base=1))


def test_what_is_changed_as_text_is_a_step_too(desk, path):
    edit(desk, path, "Move leader", 0, set=lead(path, 363))
    between = path.read_text()
    path.write_text(between.replace("duration: 60", "duration: 55"))
    state = desk.editing.state(path)
    assert state.revision == 2 and "text" in state.done[-1].name and state.document["clock"]["duration"] == 55
    desk.editing.undo(path, NewTurn(base=2))
    assert path.read_text() == between


def test_a_text_changed_before_the_first_step_is_a_step_too(desk, path):
    first = path.read_text()
    assert desk.editing.state(path).revision == 0
    path.write_text(first.replace("duration: 60", "duration: 55"))
    state = desk.editing.state(path)
    assert state.revision == 1 and "text" in state.done[-1].name
    with pytest.raises(ConflictError):
        edit(desk, path, "Longer", 0, set={"clock.duration": 70})
    desk.editing.undo(path, NewTurn(base=1))
    assert path.read_text() == first


def test_a_new_file_of_the_name_is_not_a_change_of_the_old_one(desk, path):
    desk.editing.state(path)
    path.write_text(path.read_text().replace("duration: 60", "duration: 55"))
    desk.editing.forget(path.stem)
    assert desk.editing.state(path).done == []


def test_a_text_that_was_broken_for_a_moment_does_not_block_undo(desk, path):
    edit(desk, path, "Move leader", 0, set=lead(path, 363))
    good = path.read_text()
    for broken in (good.replace("duration: 60", "duration: -5"), "clock: ["):
        path.write_text(broken)
        with pytest.raises(StudioError):
            desk.editing.state(path)
        assert desk.editing.latest(path).name == "Move leader"
    path.write_text(good.replace("duration: 60", "duration: 55"))
    assert desk.editing.state(path).revision == 2
    path.write_text(good.replace("duration: 60", "duration: -5"))
    edit(desk, path, "Longer", 2, patch=[operation("replace", ["clock", "duration"], value=70)])
    for base, duration in ((3, 55), (4, 60)):
        assert desk.editing.undo(path, NewTurn(base=base)).document["clock"]["duration"] == duration
    assert path.read_text() == good
    desk.editing.undo(path, NewTurn(base=5))


def test_what_cannot_be_run_is_refused_and_not_written(desk, path):
    before = path.read_bytes()
    for what in (
        {"set": {"vehicles.leader.speed": 700}},
        {"set": lead(path, 345.2)},  # in another car
        {"patch": [operation("replace", ["routes", "east_to_west", "roads"], value=["206170873#1", "340498991"])]},  # no way leads there
        {"remove": ["routes.east_to_west"]},
        {"patch": [operation("replace", ["map", "file"], value="../elsewhere.osm")]},
        {},
    ):
        with pytest.raises(StudioError):
            edit(desk, path, "Wrong", 0, **what)
    assert path.read_bytes() == before and desk.editing.state(path).done == []


def test_a_file_that_may_be_read_only_stays(desk, path):
    path.chmod(0o444)
    assert "cannot be changed" in desk.editing.state(path).sealed
    with pytest.raises(SealedError):
        edit(desk, path, "Move leader", 0, set=lead(path, 363))


def test_what_names_a_thing_goes_with_it_or_is_named_anew(desk, path):
    state = edit(desk, path, "Delete follower_2", 0, remove=["vehicles.follower_2"])
    platoon = state.given["applications"]["platoon"]
    assert platoon["units"] == ["follower_1", "follower_3", "follower_4"]
    assert platoon["listens_to"] == ["leader", "follower_1", "follower_3"]  # the third listens to whom the second listened to
    state = edit(desk, path, "Rename", 1, rename={"vehicles.leader": "boss", "routes.east_to_west": "main"})
    assert "boss" in state.given["vehicles"] and state.given["script"]["hard_brake"]["do"]["vehicle"] == "boss"
    assert {each["route"] for each in state.given["vehicles"].values()} == {"main"}
    state = edit(desk, path, "Delete boss", 2, remove=["vehicles.boss"])
    assert state.given["script"] == {}  # the entry was about nobody else
    assert state.given["applications"]["platoon"]["units"] == ["follower_3", "follower_4"]  # the first has nobody to listen to


def test_every_thing_has_its_place(desk, folder):
    items = {each.path: each for each in desk.editing.state(folder / "stepping_out.yaml").items}
    groups = {path: each.group for path, each in items.items()}
    assert groups["vehicles.first"] == "vehicle" and groups["routes.straight_on"] == "route"
    assert (groups["script.child"], groups["script.van"], groups["script.close"]) == ("person", "object", "event")
    first = items["vehicles.first"]
    (body,) = first.figures
    x, y = body.line[int(first.station / 2.0)]  # a point every two metres
    assert body.anchor == pytest.approx((x, y), abs=0.05) and body.length > body.width > 1.5


@pytest.fixture
def grid(desk, folder):
    """The network of the town, two of whose roads follow each other on the sample's route."""
    return job.prepare(job.load(folder / "stepping_out.yaml")).network


def test_a_way_leads_through_points(desk, folder, grid):
    (body,) = next(each for each in desk.editing.state(folder / "stepping_out.yaml").items if each.group == "vehicle").figures
    start, end = body.line[20], body.line[-20]
    found = way(grid, [start, end], onwards=False, before=[])
    assert len(found.roads) == 2 and found.length > 300 and found.line[0] == pytest.approx(body.line[0], abs=3)
    assert [each.road for each in found.handles] == found.roads
    farther = way(grid, [start], onwards=True, before=[])
    assert farther.roads[0] == found.roads[0] and farther.length > way(grid, [start], onwards=False, before=[]).length


def test_a_way_is_that_of_its_vehicle():
    """From a street by 154° onto the one beside it, Berlin Mitte: a car swings round, a truck does not, and is told why."""
    mitte, roads = load(ROOT / "tests" / "reference" / "maps" / "berlin_mitte.osm.gz"), ["24243052#1", "465376243#0"]
    assert driven(mitte, roads, LOCK).length > 10.0
    with pytest.raises(RouteError, match="turns no sharper"):
        driven(mitte, roads, figures.lock(catalogue.find_vehicle("truck").values))


def test_the_least_lock_of_the_vehicles_counts(folder):
    """A truck among cars; without any, or for names that are not there, that of a car."""
    (folder / "mixed.yaml").write_text((folder / "stepping_out.yaml").read_text(encoding="utf-8"), encoding="utf-8")
    setting = job.prepare(job.load(folder / "mixed.yaml"))
    first = replace(setting.cars[0], model=catalogue.find_vehicle("truck"))
    mixed = replace(setting, cars=(first, *setting.cars[1:]))
    names = [car.name for car in mixed.cars]
    assert lock_of(mixed, names) == lock_of(mixed, names[:1]) == pytest.approx(0.92 * sin(0.75) / 5.1)
    assert lock_of(mixed, []) == lock_of(mixed, ["nobody"]) == LOCK


def test_where_no_way_leads_the_reason_is_told(grid):
    with pytest.raises(RouteError, match="No road is there") as refusal:
        way(grid, [(grid.bounds[0] - 500.0, 0.0)], onwards=False, before=[])
    assert "point 1" in str(refusal.value)
    exits = [road.id for road in grid.roads.values() if not road.internal and not leading(grid, road.id)]
    somewhere = next(road for road in grid.roads.values() if not road.internal and leading(grid, road.id))
    middle = tuple(grid.lanes_of(somewhere.id)[0].centre[:2].mean(axis=1))
    with pytest.raises(RouteError, match="No way leads there") as refusal:
        way(grid, [middle], onwards=False, before=exits[:1])
    assert "leads out of the map" in str(refusal.value)


def leading(network, road):
    """Whether a road leads to another."""
    lanes = set(network.roads[road].lanes)
    return any(each.from_lane in lanes and each.direction != "turn" for each in network.connections)


SQUARE = ((-10, -10), (10, -10), (10, 10), (-10, 10))


@pytest.mark.parametrize(
    ("when", "never", "begins"),
    [
        ({"kind": "time", "at": 12}, "", 12.0),
        ({"kind": "time", "at": 300}, "the run ends at 30", None),
        ({"kind": "in_area", "vehicle": "first", "area": {"x": 5000, "y": 5000, "radius": 10}}, "off the map", None),
        ({"kind": "in_area", "vehicle": "first", "area": {"x": 0, "y": 0, "radius": 15}}, "does not cross", None),
        ({"kind": "passed", "vehicle": "first", "along": 30}, "", 0.0),
        ({"kind": "passed", "vehicle": "first", "along": 850}, "the run ends at 30", None),
        ({"kind": "speed", "vehicle": "first", "speed": 5, "side": "below"}, "", None),
        ({"kind": "all_of", "of": [{"kind": "time", "at": 3}, {"kind": "passed", "vehicle": "first", "along": 20}]}, "", 3.0),
        ({"kind": "later", "of": {"kind": "time", "at": 3}, "delay": 4}, "", 7.0),
        ({"kind": "any_of", "of": [{"kind": "time", "at": 300}, {"kind": "time", "at": 400}]}, "the run ends", None),
    ],
)  # fmt: skip
def test_what_happens_when_and_what_never(desk, folder, when, never, begins):
    path = folder / "stepping_out.yaml"
    patch = [operation("add", ["script", "mine"], value={"when": when, "do": {"kind": "mark"}})]
    state = edit(desk, path, "Add mine", 0, patch=patch)
    turn = next(each for each in state.turns if each.entry == "mine")
    assert never in turn.never and bool(turn.never) == bool(never)
    assert turn.begins == begins or (begins is not None and turn.begins == pytest.approx(begins))


@pytest.mark.parametrize(
    ("more", "ends"),
    [({"duration": 4}, 16.0), ({"duration": 4, "to_speed": 2}, 16.0), ({"duration": 40}, 15.0)],
)  # fmt: skip
def test_an_action_ends_when_it_has_taken_as_long_as_it_takes(desk, folder, more, ends):
    """At the latest: what stands behind `until` may come before."""
    do = {"kind": "brake", "vehicle": "first", "deceleration": 3, **more}
    entry = {"when": {"kind": "time", "at": 12}, "do": do} | ({"until": {"kind": "time", "at": 15}} if ends == 15.0 else {})
    state = edit(desk, folder / "stepping_out.yaml", "Add mine", 0, patch=[operation("add", ["script", "mine"], value=entry)])
    (turn,) = [each for each in state.turns if each.entry == "mine"]
    assert (turn.begins, turn.ends) == (12.0, ends)


def test_what_comes_after_what_never_comes_never_comes(desk, folder):
    patch = [
        operation("add", ["script", "one"], value={"when": {"kind": "time", "at": 100}, "do": {"kind": "mark"}}),
        operation("add", ["script", "two"], value={"when": {"kind": "after", "entry": "one", "delay": 1}, "do": {"kind": "mark"}}),
    ]
    turns = {each.entry: each for each in edit(desk, folder / "stepping_out.yaml", "Two", 0, patch=patch).turns}
    assert turns["two"].never.startswith("one never begins")


def test_a_place_is_reckoned_with_the_speeds_of_the_road(desk, folder):
    """At a constant limit v the way s takes s / v; the driver's factor counts."""
    path = folder / "stepping_out.yaml"
    state = edit(desk, path, "Add", 0, patch=[
        operation("add", ["script", "mine"], value={"when": {"kind": "passed", "vehicle": "first", "along": 140}, "do": {"kind": "mark"}})
    ])  # fmt: skip
    turn = next(each for each in state.turns if each.entry == "mine")
    assert not turn.is_exact and 100 / 20 < turn.begins < 100 / 5


@pytest.mark.parametrize(
    "deed",
    [
        {"kind": "set_speed", "vehicle": "first", "speed": 60, "acceleration": 10},
        {"kind": "change_lane", "vehicle": "first", "offset": 1.0},
        {"kind": "steer", "vehicle": "first", "angle": 0.05},
    ],
)
def test_of_a_vehicle_that_the_script_drives_nobody_knows(desk, folder, deed):
    """It may be faster than the limit, and off its way: what is told of others must not be told of it."""
    path = folder / "stepping_out.yaml"
    far = {"kind": "passed", "vehicle": "first", "along": 850}
    beside = {"kind": "in_area", "vehicle": "first", "area": {"x": 0, "y": 0, "radius": 15}}
    state = edit(desk, path, "Add", 0, patch=[
        operation("add", ["script", "far"], value={"when": far, "do": {"kind": "mark"}}),
        operation("add", ["script", "beside"], value={"when": beside, "do": {"kind": "mark"}}),
    ])  # fmt: skip
    assert all(each.never for each in state.turns if each.entry in ("far", "beside"))
    driven = {"when": {"kind": "time", "at": 2}, "do": deed}
    state = edit(desk, path, "Drive", 1, patch=[operation("add", ["script", "driven"], value=driven)])
    assert [(each.begins, each.never) for each in state.turns if each.entry in ("far", "beside")] == [(None, ""), (None, "")]


@pytest.mark.parametrize("shape", ["cuboid", "cylinder", "cone", "barrier", "wall", "tree"])
def test_an_object_stands_where_it_is_put_and_looks_where_it_is_turned(desk, folder, shape):
    value = {"do": {"kind": "object", "shape": shape, "x": -150.0, "y": -300.0, "heading": 1.25}}
    state = edit(desk, folder / "stepping_out.yaml", "Add", 0, patch=[operation("add", ["script", "mine"], value=value)])
    item = next(each for each in state.items if each.path == "script.mine")
    (body,) = item.figures
    assert item.group == "object" and (body.x, body.y) == (-150.0, -300.0)
    assert body.heading == pytest.approx(1.25) and body.line == []
    # as high as it is drawn in the scene, on the ground
    drawn = SHAPES["box" if shape == "cuboid" else shape]()
    assert body.height == pytest.approx(float(drawn.vertices[:, 2].max()), abs=0.01) and body.height > 0.5 and body.lift == 0.0


def test_who_starts_on_a_bridge_is_told_as_high_as_its_road_is_drawn(desk, folder):
    nodes = {1: (-400, 0), 2: (-50, 0), 3: (50, 0), 4: (400, 0), 5: (0, -300), 6: (0, 300)}
    plot(folder / "map.osm", nodes, {11: ([1, 2], {}), 12: ([2, 3], {"bridge": "yes"}), 13: ([3, 4], {}), 14: ([5, 6], {})})
    path = folder / "flyover.yaml"
    path.write_text(FLYOVER, encoding="utf-8")
    bodies = {each.name: each.figures[0] for each in desk.editing.state(path).items if each.group == "vehicle"}
    drawn = dict(zip(("up", "down", "above"), first_frame(job.prepare(job.load(path))).poses[pose.Z], strict=True))
    assert bodies["above"].lift == pytest.approx(STOREY, abs=0.15) and bodies["down"].lift == 0.0
    for name, body in bodies.items():
        assert body.lift == pytest.approx(float(drawn[name]), abs=0.15) and 1.2 < body.height < 1.9


def test_what_differs_between_documents():
    before, now = {"a": {"b": 1, "c": [1, 2]}, "d": 3}, {"a": {"b": 2, "c": [1, 2, 3]}, "e": 3}
    assert changed_places(before, now) == {("a", "b"), ("a", "c"), ("d",), ("e",)}
    assert changed_places({"a": True}, {"a": 1}) == {("a",)}
    assert conflicts([operation("replace", ["a", "c", 0], value=5)], before, now)  # within a list that has grown
    assert conflicts([operation("remove", ["a"])], before, now)  # around what has changed
    assert not conflicts([operation("add", ["f"], value=5)], before, now)


def test_steps_follow_from_the_changes():
    sorts = ("edit", "edit", "undo", "edit", "undo", "undo", "redo")
    changes = [Change(i + 1, sort, f"{i + 1}", "", "", "", "") for i, sort in enumerate(sorts)]
    assert [names(pile) for pile in steps(changes)] == [["1"], ["4"]]


def test_the_history_goes_with_a_new_name(desk, folder, path):
    open_runs(desk.db).close()
    edit(desk, path, "Move leader", 0, set=lead(path, 363))
    found = desk.rename("grosser_stern_platoon", "elsewhere", None, None)
    assert names(desk.editing.state(found).done) == ["Move leader"]
    assert yaml.safe_load(found.read_text())["vehicles"]["leader"]["position"]["along"] == 363


def test_two_clients_hear_of_each_other(server, client):
    """Over REST: one edits, the other hears of it at once, and takes the step back."""
    place = "/api/scenarios/motorway_platoon/editing"
    first = client.get(place).json()
    with connect(f"{str(client.base_url).replace('http', 'ws', 1)}{place}/socket", proxy=None) as socket:
        assert json.loads(socket.recv(PATIENCE))["revision"] == first["revision"]
        new = {"name": "Longer", "base": first["revision"], "who": "one", "set": {"clock.duration": 77}}
        done = client.post(place, json=new)
        assert done.status_code == 200, done.text
        news = json.loads(socket.recv(PATIENCE))
        assert (news["type"], news["name"], news["who"], news["revision"]) == ("revised", "Longer", "one", first["revision"] + 1)
        late = client.post(place, json=new | {"name": "Shorter", "set": {"clock.duration": 55}})
        assert late.status_code == 409 and "“Longer”" in late.json()["message"]
        undone = client.post(f"{place}/undo", json={"base": news["revision"], "who": "two"})
        assert undone.status_code == 200 and undone.json()["document"]["clock"] == first["document"]["clock"]
        assert json.loads(socket.recv(PATIENCE))["who"] == "two"
    assert client.get(f"{place}/socket").status_code == 426


def test_a_plan_and_a_way_over_rest(client):
    plan = client.get("/api/scenarios/motorway_platoon/plan").json()
    lane = next(each for each in plan["lanes"] if not each["internal"])
    way = client.post("/api/scenarios/motorway_platoon/way", json={"points": [lane["centre"][0]]})
    assert way.status_code == 200 and way.json()["roads"] == [lane["road"]]
    nowhere = client.post("/api/scenarios/motorway_platoon/way", json={"points": [[90000, 90000]]})
    assert nowhere.status_code == 200 and nowhere.json()["problem"]["problems"][0]["where"] == "point 1" and nowhere.json()["roads"] == []


def test_the_history_of_a_deleted_file_comes_back_with_it_and_is_nobody_elses(desk, path):
    edit(desk, path, "Move leader", 0, set=lead(path, 362))
    text, scenario = path.read_text(), path.stem
    gone = desk.scenario_files.delete(path, None)
    desk.editing.follow(scenario, gone.id)
    path.write_text(text)  # somebody makes a file of that name
    assert desk.editing.history.changes(scenario) == []
    path.unlink()
    back = desk.scenario_files.restore(gone.id, "again")
    desk.editing.follow(gone.id, back.stem)
    assert [each.name for each in desk.editing.history.changes("again")] == ["Move leader"]
    desk.editing.undo(back, NewTurn(base=1))
    assert back.read_text() != text
