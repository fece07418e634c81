"""The editor in a real browser: things placed, dragged, copied, deleted and brought back; routes, triggers, two browsers at once."""

import re
import shutil

import numpy as np
import pytest
import yaml
from playwright.sync_api import expect

from tests.browser.browser import browser, drawn, pixels, watched
from tests.patience import until
from tests.server.server import served

SIZE = {"width": 1280, "height": 800}
ID = "stepping_out"
NEXT_ROAD = 120.0  # [m] to the east of the lane of the cars lies a lane of the next road, both to the north


@pytest.fixture(scope="module")
def place(tmp_path_factory, sample):
    """A folder with the sample that has people, objects and events, and its map."""
    folder = tmp_path_factory.mktemp("editor")
    maps = folder / "scenarios" / "maps"
    maps.mkdir(parents=True)
    shutil.copy(sample.parent / "maps" / "urban_grid.osm", maps)
    shutil.copy(sample.with_name(f"{ID}.yaml"), folder / "scenarios")
    return folder


@pytest.fixture(scope="module")
def opened(place):
    """A browser and the client of a server."""
    with browser() as found, served(place) as (client, _, _):
        yield found, client
        found.close()


@pytest.fixture
def path(place, sample):
    """The scenario's file, as the sample has it at the beginning of every test."""
    found = place / "scenarios" / f"{ID}.yaml"
    shutil.copy(sample.with_name(f"{ID}.yaml"), found)
    return found


@pytest.fixture
def page(opened, path):
    """The editor with the scenario; its console has complained about nothing at the end."""
    found, complaints = watched(opened[0], viewport=SIZE, color_scheme="light")
    begin(found, opened[1])
    yield found
    assert complaints == []
    found.close()


def begin(page, client):
    """Opens the editor, until everything is to be seen."""
    page.goto(f"{client.base_url}/edit/{ID}")
    expect(on_plan(page, "vehicles.first")).to_be_visible()
    drawn(page)


def on_plan(page, path):
    """The name of a thing on the plan."""
    return page.get_by_test_id(f"on-plan-{path}")


def spot(page, path):
    """Where a thing is on the screen: under its name."""
    box = on_plan(page, path).bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] + 8


def beside(page, path, east, south):
    """A place on the screen beside a thing [px]."""
    x, y = spot(page, path)
    return x + east, y + south


def metre(page):
    """How large a metre is [px]: the two cars stand 20 m behind each other."""
    (x, y), (u, v) = spot(page, "vehicles.first"), spot(page, "vehicles.second")
    return ((x - u) ** 2 + (y - v) ** 2) ** 0.5 / 20.0


def drag(page, start, end):
    """A press, a way, and letting go."""
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)
    page.mouse.move(*end)
    page.mouse.up()


def row(page, name, **state):
    """A thing in the list."""
    return page.get_by_role("navigation", name="Everything in the scenario").get_by_role("button", name=name, exact=True, **state)


def add(page, what):
    """Chooses what the next click puts there."""
    page.get_by_role("button", name="Add", exact=True).click()
    page.get_by_role("menuitem", name=what, exact=True).click()


def done(page, name, chosen=None):
    """Until a step is the last, and what it made is chosen: only then are its handles there."""
    expect(page.get_by_role("button", name=f"Undo: {name}")).to_be_enabled()
    if chosen:
        expect(row(page, chosen, pressed=True)).to_be_visible()
        drawn(page)  # the list of what happens may have become longer, and the plan lower


def document(path):
    return yaml.safe_load(path.read_text())


def test_a_tree_is_placed_undone_and_done_again(page, path):
    before = path.read_bytes()
    add(page, "Tree")
    page.mouse.click(*beside(page, "vehicles.first", 60, 0))
    done(page, "Add tree", "tree")
    assert document(path)["script"]["tree"]["do"]["shape"] == "tree"
    page.get_by_role("button", name="Select").click()
    page.keyboard.press("Control+z")
    expect(row(page, "tree")).to_have_count(0)
    assert path.read_bytes() == before
    page.keyboard.press("Control+Shift+Z")
    expect(row(page, "tree")).to_be_visible()
    row(page, "tree").click()
    page.keyboard.press("Delete")
    expect(row(page, "tree")).to_have_count(0)
    assert path.read_bytes() == before


FRAMES = """() => new Promise((resolve) => {
  const ask = window.requestAnimationFrame;
  let count = 0;
  window.requestAnimationFrame = (call) => (count++, ask(call));
  setTimeout(() => ((window.requestAnimationFrame = ask), resolve(count)), 1000);
})"""


def test_the_plan_rests_and_still_shows_what_changes(page):
    """For a second nobody asks for a frame; a tree that is placed then is drawn all the same."""
    until(lambda: page.evaluate(FRAMES) == 0, "the plan to rest")
    x, y = beside(page, "vehicles.first", 60, 0)
    bare = pixels(page.screenshot(clip=square(x, y)))
    add(page, "Tree")
    page.mouse.click(x, y)
    done(page, "Add tree", "tree")
    page.mouse.move(5, 5)
    # the plan is lower now, and the tree elsewhere on the screen
    until(lambda: np.abs(pixels(page.screenshot(clip=square(*spot(page, "script.tree")))) - bare).mean() > 10.0, "the tree in the picture")


def square(x, y):
    """Eight pixels around a place on the screen."""
    return {"x": round(x) - 4, "y": round(y) - 4, "width": 8, "height": 8}


def test_a_car_is_dragged_along_its_way(page, path):
    before = document(path)["vehicles"]["first"]["position"]
    drag(page, spot(page, "vehicles.first"), beside(page, "vehicles.first", 2, -80))
    done(page, "Move first")
    after = document(path)["vehicles"]["first"]["position"]
    assert after["along"] > before["along"] + 5  # it drives north, which is up


def test_a_car_is_dragged_onto_another_road(page, path):
    """It gets a route of its own there, because its own does not come by."""
    drag(page, spot(page, "vehicles.second"), beside(page, "vehicles.second", NEXT_ROAD * metre(page), -25 * metre(page)))
    done(page, "Move second to another road", "second")
    vehicle = document(path)["vehicles"]["second"]
    assert vehicle["route"] != "straight_on" and vehicle["position"]["road"] in document(path)["routes"][vehicle["route"]]["roads"]
    expect(row(page, "second")).to_have_attribute("aria-pressed", "true")
    page.reload()
    expect(row(page, "second")).to_have_attribute("aria-pressed", "true")  # what is chosen stands in the address


def test_a_car_beside_the_road_stays_where_it_is(page, path):
    before = path.read_bytes()
    drag(page, spot(page, "vehicles.second"), beside(page, "vehicles.second", 130, 0))
    expect(page.get_by_role("alert").filter(has_text="Vehicles stand on lanes")).to_be_visible()
    assert path.read_bytes() == before


def test_a_rectangle_chooses_several_which_are_copied(page, path):
    x, y = spot(page, "vehicles.first")
    u, v = spot(page, "vehicles.second")
    drag(page, (min(x, u) - 40, min(y, v) - 20), (max(x, u) + 40, max(y, v) + 20))
    for name in ("first", "second"):
        expect(row(page, name)).to_have_attribute("aria-pressed", "true")
    expect(page.get_by_text("2 things are chosen")).to_be_visible()
    row(page, "child").click(modifiers=["Shift"])
    expect(page.get_by_text("3 things are chosen")).to_be_visible()
    page.keyboard.press("Escape")
    row(page, "van").click()
    page.get_by_role("application").focus()
    page.keyboard.press("Control+c")
    page.keyboard.press("Control+v")
    done(page, "Copy van", "van_2")
    page.keyboard.press("Control+d")
    expect(row(page, "van_3")).to_be_visible()
    assert document(path)["script"]["van_3"]["do"]["length"] == document(path)["script"]["van"]["do"]["length"]


def test_what_is_hidden_is_not_seen_and_what_is_locked_does_not_move(page, path):
    page.get_by_role("button", name="Hide cyclist").click(force=True)
    expect(on_plan(page, "script.cyclist")).to_have_count(0)
    page.get_by_role("button", name="Show cyclist").click()
    expect(on_plan(page, "script.cyclist")).to_be_visible()
    before = path.read_bytes()
    page.get_by_role("button", name="Lock first").click(force=True)
    drag(page, spot(page, "vehicles.first"), beside(page, "vehicles.first", 0, -60))
    row(page, "first").click()
    page.get_by_role("application").focus()
    page.keyboard.press("Delete")
    expect(page.get_by_role("alert").filter(has_text="It is locked")).to_be_visible()
    assert path.read_bytes() == before


def test_the_arrow_keys_move_what_is_chosen_in_one_step(page, path):
    row(page, "first").click()
    page.get_by_role("application").focus()
    before = document(path)["vehicles"]["first"]["position"]["along"]
    for _ in range(4):
        page.keyboard.press("ArrowUp")
    done(page, "Move first")
    until(lambda: abs(document(path)["vehicles"]["first"]["position"]["along"] - before - 4 * 0.5) < 0.05, "all four strokes in the file")
    page.keyboard.press("f")
    drawn(page)
    page.keyboard.press("m")
    x, y = spot(page, "vehicles.first")
    page.mouse.click(x - 100, y + 80)
    page.mouse.move(x + 100, y + 80)
    expect(page.get_by_test_id("tape")).to_have_text(re.compile(r"^\d+\.\d\d m$"))


def test_a_number_out_of_its_range_is_refused_in_its_field(page, path):
    before = path.read_bytes()
    row(page, "first").click()
    field = page.get_by_role("region", name="Properties").get_by_role("textbox", name="Initial speed")
    field.fill("700")
    refusal = page.get_by_role("alert").filter(has_text="at most 70 m/s")
    expect(refusal).to_be_visible()
    assert path.read_bytes() == before
    field.fill("9.5")
    done(page, "Change initial speed of first")
    expect(refusal).to_have_count(0)
    assert document(path)["vehicles"]["first"]["speed"] == 9.5


def test_a_route_goes_on_where_one_clicks(page, path):
    """A car gets a route of its own, which is led on over the crossing, and back again by a click on its last point."""
    row(page, "second").click()
    page.get_by_role("application").focus()
    page.keyboard.press("r")
    expect(page.get_by_test_id("tool-hint")).to_contain_text("2 vehicles follow it")
    page.get_by_role("button", name="A route of its own from here").click()
    done(page, "New route of second")
    expect(page.get_by_test_id("tool-hint")).to_contain_text("second_way goes on there")
    assert len(document(path)["routes"]["second_way"]["roads"]) == 1
    page.mouse.click(*spot(page, "script.cyclist"))
    done(page, "Change route second_way")
    roads = document(path)["routes"]["second_way"]["roads"]
    assert len(roads) == 2 and document(path)["vehicles"]["second"]["route"] == "second_way"
    box = page.get_by_role("application").bounding_box()
    page.mouse.click(box["x"] + 300, box["y"] + 400)  # beside all roads
    expect(page.get_by_role("alert").filter(has_text="No road is there")).to_be_visible()
    assert document(path)["routes"]["second_way"]["roads"] == roads
    page.keyboard.press("Control+z")
    expect(page.get_by_role("button", name="Redo: Change route second_way")).to_be_enabled()
    assert len(document(path)["routes"]["second_way"]["roads"]) == 1


def test_an_area_that_nobody_drives_through_is_told(page, path):
    add(page, "Area with a trigger")
    x, y = spot(page, "vehicles.first")
    for east, south in ((90, -40), (190, -40), (190, 40)):
        page.mouse.click(x + east, y + south)
    page.keyboard.press("Enter")
    done(page, "Add area", "area")
    when = page.get_by_role("list", name="What happens when")
    expect(when.get_by_role("note").filter(has_text="the way of first does not cross the area")).to_be_visible()
    assert len(document(path)["script"]["area"]["when"]["area"]["corners"]) == 3


def test_two_browsers_see_what_each_other_does(page, path, opened):
    other, complaints = watched(opened[0], viewport=SIZE, color_scheme="dark")
    begin(other, opened[1])
    row(page, "close").click()
    page.get_by_role("application").focus()
    page.keyboard.press("Delete")
    expect(row(other, "close")).to_have_count(0)
    expect(other.get_by_role("status").filter(has_text="“Delete close” by browser")).to_be_visible()
    other.get_by_role("button", name="Undo: Delete close").click()
    expect(row(page, "close")).to_be_visible()
    assert complaints == []
    other.close()


def test_what_somebody_else_deletes_is_brought_back_with_its_steps(page, path, opened):
    row(page, "close").click()
    page.get_by_role("application").focus()
    page.keyboard.press("Delete")
    done(page, "Delete close")
    opened[1].delete(f"/api/scenarios/{ID}").raise_for_status()
    told = page.get_by_role("status").filter(has_text="There is no scenario")
    expect(told).to_contain_text("was deleted; bring it back from the trash")
    page.get_by_role("button", name="Bring it back").click()
    expect(told).to_have_count(0)
    assert path.exists()
    page.get_by_role("button", name="Undo: Delete close").click()
    expect(row(page, "close")).to_be_visible()


def test_the_menu_behind_the_right_button_and_the_way_to_the_studio(page, path):
    page.mouse.click(*spot(page, "script.cyclist"), button="right")
    page.get_by_role("menu", name="What to do with cyclist").get_by_role("menuitem", name="Delete").click()
    done(page, "Delete cyclist")
    page.get_by_role("button", name="Steps").click()
    expect(page.get_by_role("menu", name="Steps").get_by_role("menuitem").first).to_contain_text("Delete cyclist")
    page.keyboard.press("Escape")
    page.get_by_role("link", name="Text").click()
    expect(page).to_have_url(re.compile(rf"/scenarios/{ID}/text$"))
    page.go_back()
    expect(on_plan(page, "vehicles.first")).to_be_visible()


def test_a_wall_is_turned_by_its_handle_and_an_area_by_its_corners(page, path):
    add(page, "Wall")
    page.mouse.click(*beside(page, "vehicles.first", 80, 0))
    done(page, "Add wall", "wall")
    page.get_by_role("button", name="Select").click()
    x, y = spot(page, "script.wall")
    assert document(path)["script"]["wall"]["do"]["heading"] == 0  # to the east, where its handle lies
    drag(page, (x + 34, y), (x, y - 60))
    done(page, "Turn wall")
    assert document(path)["script"]["wall"]["do"]["heading"] == pytest.approx(1.571, abs=0.03)
    add(page, "Area with a trigger")
    corners = [(x - 30, y + 30), (x + 60, y + 30), (x + 60, y + 90)]
    for corner in corners:
        page.mouse.click(*corner)
    page.keyboard.press("Enter")
    done(page, "Add area", "area")
    reshaped = document(path)["script"]["area"]["when"]["area"]["corners"]
    start = middle_of(knob(page, "Corner 2 of area"))
    drag(page, start, (start[0] + 60, start[1]))
    done(page, "Reshape area")
    after = document(path)["script"]["area"]["when"]["area"]["corners"]
    assert after[1][0] > reshaped[1][0] + 5 and after[0] == reshaped[0] and after[2] == reshaped[2]


def knob(page, name):
    """A point of a shape, for the keyboard; its middle is where the plan draws it."""
    return page.get_by_role("button", name=name, exact=True)


def middle_of(found):
    """Where something is on the screen, once it stays there."""
    box = None
    while box != (box := found.bounding_box()):
        drawn(found.page)
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def shaped(path):
    """The corners of the area that a test has made."""
    return document(path)["script"]["area"]["when"]["area"]["corners"]


def test_corners_are_put_on_an_edge_and_taken_out(page, path):
    add(page, "Area with a trigger")
    x, y = spot(page, "vehicles.first")
    for east, south in ((60, -60), (200, -60), (200, 40)):
        page.mouse.click(x + east, y + south)
    page.keyboard.press("Enter")
    done(page, "Add area", "area")
    before = shaped(path)
    new = knob(page, "New corner of area behind corner 1")
    start = middle_of(new)
    drag(page, start, (start[0], start[1] - 60))
    expect(knob(page, "Corner 4 of area")).to_be_attached()
    after = shaped(path)
    assert [after[0], *after[2:]] == before and after[1][1] > before[0][1] + 2  # to the north
    # The keyboard: half a metre to the east, and out of it.
    knob(page, "Corner 2 of area").focus()
    page.keyboard.press("ArrowRight")
    expect(page.get_by_role("button", name="Undo: Reshape area")).to_be_enabled()
    until(lambda: shaped(path)[1] != after[1], "the corner to be moved")
    assert shaped(path)[1] == [pytest.approx(after[1][0] + 0.5), after[1][1]]
    page.keyboard.press("Delete")
    expect(knob(page, "Corner 4 of area")).to_have_count(0)
    assert shaped(path) == before
    page.mouse.dblclick(*middle_of(knob(page, "Corner 1 of area")))  # three are the fewest
    expect(page.get_by_role("alert").filter(has_text="The corner stays")).to_be_visible()
    knob(page, "New corner of area behind corner 3").focus()
    page.keyboard.press("Enter")
    expect(knob(page, "Corner 4 of area")).to_be_attached()
    last = shaped(path)[3]
    assert last == [pytest.approx((before[2][axis] + before[0][axis]) / 2, abs=0.01) for axis in (0, 1)]
    page.mouse.dblclick(*middle_of(knob(page, "Corner 4 of area")))
    expect(knob(page, "Corner 4 of area")).to_have_count(0)
    assert shaped(path) == before


def test_walls_go_from_corner_to_corner_and_each_by_its_ends(page, path):
    add(page, "Wall from corner to corner")
    x, y = spot(page, "vehicles.first")
    for east, south in ((60, -60), (140, -60), (140, 20)):
        page.mouse.click(x + east, y + south)
    page.keyboard.press("Enter")
    done(page, "Add 2 things", "wall_2")
    first, second = (document(path)["script"][name]["do"] for name in ("wall", "wall_2"))
    assert first["heading"] == 0 and second["heading"] == pytest.approx(-1.571, abs=0.01)
    # Where the one ends, the other begins.
    assert first["x"] + first["length"] / 2 == pytest.approx(second["x"], abs=0.02)
    assert second["y"] + second["length"] / 2 == pytest.approx(first["y"], abs=0.02)
    row(page, "wall").click()
    expect(row(page, "wall_2", pressed=False)).to_be_visible()
    end = middle_of(knob(page, "End 1 of wall"))
    drag(page, end, (end[0] - 40, end[1]))
    done(page, "Reshape wall")
    longer = document(path)["script"]["wall"]["do"]
    assert longer["length"] > first["length"] + 2
    assert longer["x"] + longer["length"] / 2 == pytest.approx(first["x"] + first["length"] / 2, abs=0.02)  # the other end stays


def test_a_trigger_is_made_of_what_the_kinds_offer(page, path):
    """Another condition is chosen; what it needs is filled in from what there is, and its time is told."""
    add(page, "Event")
    done(page, "Add event", "event")
    form = page.get_by_role("region", name="Properties")
    form.get_by_role("combobox", name="Condition").select_option(label="A vehicle has passed a place")
    done(page, "Exchange condition of event")
    assert document(path)["script"]["event"]["when"]["vehicle"] in document(path)["vehicles"]
    form.get_by_role("textbox", name="Along its route").fill("140")
    done(page, "Change along its route of event")
    when = page.get_by_role("list", name="What happens when").get_by_role("listitem").filter(has=page.get_by_role("button", name="event"))
    expect(when).to_contain_text("s at the earliest")
    form.get_by_role("textbox", name="Along its route").fill("850")
    expect(when).to_contain_text("never: first at the earliest comes at")


def test_applications_goals_and_sensors_are_added_and_taken_out(page, path):
    """What has no place on the plan: with the units, the bound and the sensors by default that a file would have."""
    part = page.get_by_role("region", name="Applications: add and take out")
    part.get_by_placeholder("choose").fill("radar only")
    page.get_by_role("option", name="Adaptive cruise control (radar only)").click()
    part.get_by_role("button", name="Add it").click()
    expect(part.get_by_role("button", name="Take acc out")).to_be_visible()
    assert document(path)["applications"]["acc"]["application"] == "acc"
    goals = page.get_by_role("region", name="Goals: add and take out")
    goals.get_by_placeholder("a measure").fill("min_ttc")  # a title is as good as a name
    page.get_by_role("option", name="Least time to collision", exact=True).click()
    goals.get_by_label("Value of the goal").fill("1.5")
    expect(goals).to_contain_text("s")
    goals.get_by_role("button", name="Add the goal").click()
    done(page, "Add a goal for min_ttc")
    assert document(path)["goals"]["min_ttc"] == {"least": 1.5}
    before = document(path)["vehicles"]["first"]["sensors"]
    row(page, "first").click()
    sensors = page.get_by_role("region", name="Sensors: add and take out")
    expect(sensors.get_by_role("button", name="Take front out")).to_be_visible()
    sensors.get_by_placeholder("choose").fill("odo")
    page.get_by_role("option", name="Odometry").click()
    sensors.get_by_role("button", name="Add it").click()
    done(page, "Add odometry to first")
    assert document(path)["vehicles"]["first"]["sensors"] == {**before, "odometry": {"kind": "odometry"}}
    sensors.get_by_role("button", name="Take odometry out").click()
    done(page, "Take odometry out")
    assert document(path)["vehicles"]["first"]["sensors"] == before
