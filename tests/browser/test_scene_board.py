"""The scene beside the plan in a real browser: things chosen, dragged, placed and deleted with the mouse in three dimensions."""

import re
import shutil
from math import cos, hypot, sin

import pytest
import yaml
from playwright.sync_api import expect

from tests.browser.browser import browser, drawn, watched
from tests.browser.test_layers_menu import REST
from tests.patience import until
from tests.server.server import served

ID = "stepping_out"
SPOT = "place => window.__studioOverlay?.spot(place)"


@pytest.fixture(scope="module")
def place(tmp_path_factory, sample):
    """A folder with the sample that has cars, people and objects, and its map."""
    folder = tmp_path_factory.mktemp("board")
    maps = folder / "scenarios" / "maps"
    maps.mkdir(parents=True)
    shutil.copy(sample.parent / "maps" / "urban_grid.osm", maps)
    shutil.copy(sample.with_name(f"{ID}.yaml"), folder / "scenarios")
    return folder


class Board:
    """The editor with its scene, which looks at a car."""

    def __init__(self, page, client, path) -> None:
        self.page, self.client, self.path = page, client, path
        self.marks = page.frame_locator("iframe[title='3D scene']").get_by_role("img", name=re.compile("^Layers: "))
        items = client.get(f"/api/scenarios/{ID}/editing").json()["items"]
        self.car = next(each for each in items if each["name"] == "first")["figures"][0]

    @property
    def frame(self):
        return next(each for each in self.page.frames if "/scene/" in each.url)

    def row(self, name, **state):
        """A thing in the list."""
        listed = self.page.get_by_role("navigation", name="Everything in the scenario")
        return listed.get_by_role("button", name=name, exact=True, **state)

    def on_screen(self, ahead=0.0, left=0.0, height=0.7):
        """Where a place beside the car is on the screen [px], by metres ahead of it and to its left."""
        c, s = cos(self.car["heading"]), sin(self.car["heading"])
        return self.of(self.car["x"] + ahead * c - left * s, self.car["y"] + ahead * s + left * c, height)

    def of(self, x, y, height=0.0):
        """Where a place on the map is on the screen [px], as the page is laid out now."""
        x, y, _ = self.frame.evaluate(SPOT, [x, y, height])
        box = self.page.locator("iframe[title='3D scene']").bounding_box()
        return box["x"] + x, box["y"] + y

    def look(self):
        """Until the camera stands still before the car, which is in the middle of the scene."""
        self.row("first").click()
        self.page.get_by_role("application").focus()
        self.page.keyboard.press("f")
        box = self.page.locator("iframe[title='3D scene']").bounding_box()

        def is_in_the_middle():
            found = self.frame.evaluate(SPOT, [self.car["x"], self.car["y"], 0.0])
            return found and abs(found[0] - box["width"] / 2) < 2 and abs(found[1] - box["height"] / 2) < 2 and found[2] < 27

        until(is_in_the_middle, "the camera to be before the car")
        until(lambda: self.frame.evaluate(REST) == 0, "the scene to rest")

    def done(self, name):
        """Until a step is the last."""
        expect(self.page.get_by_role("button", name=f"Undo: {name}")).to_be_enabled()

    def corners(self):
        return yaml.safe_load(self.path.read_text())["script"]["area"]["when"]["area"]["corners"]

    def along(self):
        return yaml.safe_load(self.path.read_text())["vehicles"]["first"]["position"]["along"]


@pytest.fixture(scope="module")
def board(place):
    path = place / "scenarios" / f"{ID}.yaml"
    with browser() as opened, served(place) as (client, _, _):
        page, complaints = watched(opened, viewport={"width": 1280, "height": 900})
        page.goto(f"{client.base_url}/edit/{ID}")
        page.get_by_role("button", name="3D", exact=True).click()
        expect(page.get_by_role("button", name="From above")).to_be_visible()
        found = Board(page, client, path)
        found.look()
        yield found
        assert complaints == []
        opened.close()


def test_a_car_is_chosen_dragged_along_its_lane_and_taken_back(board):
    """One selection with the list, an echo before it is let go, one step by name; its undo gives back the same bytes."""
    page, before, start = board.page, board.path.read_bytes(), board.along()
    page.mouse.click(*board.on_screen(left=-9.0, height=0.0))  # beside the road
    expect(board.row("first", pressed=False)).to_be_visible()
    page.mouse.click(*board.on_screen())
    expect(board.row("first", pressed=True)).to_be_visible()
    expect(board.marks).to_have_attribute("aria-label", re.compile("chosen first"))
    page.keyboard.press("Escape")
    expect(board.row("first", pressed=False)).to_be_visible()

    page.mouse.move(*board.on_screen())
    page.mouse.down()
    page.mouse.move(*board.on_screen(ahead=4.0))
    page.mouse.move(*board.on_screen(ahead=8.0))
    expect(board.marks).to_have_attribute("aria-label", re.compile("held first"))
    assert board.path.read_bytes() == before
    page.mouse.up()
    board.done("Move first")
    assert board.along() - start == pytest.approx(8.0, abs=1.2)  # taken hold of at its roof, somewhat nearer to the eye
    expect(page.get_by_role("textbox", name="Along the route")).to_have_value(re.compile(f"^{board.along():g}"))
    page.keyboard.press("Control+z")
    expect(page.get_by_role("button", name="Redo: Move first")).to_be_enabled()
    assert board.path.read_bytes() == before
    steps = board.client.get(f"/api/scenarios/{ID}/editing").json()
    assert (steps["done"], [each["name"] for each in steps["undone"]]) == ([], ["Move first"])  # it was one step


def test_a_drag_that_is_broken_off_changes_nothing(board):
    page, before = board.page, board.path.read_bytes()
    page.mouse.move(*board.on_screen())
    page.mouse.down()
    page.mouse.move(*board.on_screen(ahead=6.0))
    expect(board.marks).to_have_attribute("aria-label", re.compile("held first"))
    page.keyboard.press("Escape")
    expect(board.marks).not_to_have_attribute("aria-label", re.compile("held"))
    page.mouse.up()
    drawn(page)
    assert board.path.read_bytes() == before
    expect(board.row("first", pressed=True)).to_be_visible()


def test_a_cone_is_placed_by_a_click_and_deleted(board):
    page, before = board.page, board.path.read_bytes()
    page.get_by_role("button", name="Add", exact=True).click()
    page.get_by_role("menuitem", name="Cone", exact=True).click()
    page.mouse.click(*board.on_screen(ahead=3.0, left=-6.0, height=0.0))
    board.done("Add cone")
    cone = yaml.safe_load(board.path.read_text())["script"]["cone"]["do"]
    c, s = cos(board.car["heading"]), sin(board.car["heading"])
    east, north = cone["x"] - board.car["x"], cone["y"] - board.car["y"]
    assert (c * east + s * north, c * north - s * east) == (pytest.approx(3.0, abs=0.2), pytest.approx(-6.0, abs=0.2))
    expect(board.row("cone", pressed=True)).to_be_visible()
    page.keyboard.press("Delete")
    board.done("Delete cone")
    expect(board.row("cone")).to_have_count(0)
    page.keyboard.press("Control+z")
    expect(board.row("cone")).to_be_visible()
    page.keyboard.press("Control+z")
    expect(board.row("cone")).to_have_count(0)
    assert board.path.read_bytes() == before


def test_a_rectangle_chooses_several(board):
    """Drawn with Shift, since the drag alone is the camera's; a broken one chooses nothing."""
    page = board.page
    page.get_by_role("button", name="Select", exact=True).click()
    page.mouse.click(*board.on_screen(left=-9.0, height=0.0))
    expect(board.row("first", pressed=False)).to_be_visible()
    x, y = board.on_screen(height=0.0)
    page.keyboard.down("Shift")
    try:
        page.mouse.move(x - 150, y - 120)
        expect(board.marks).not_to_have_attribute("aria-label", re.compile("under the pointer"))
        page.mouse.down()
        page.mouse.move(x + 60, y + 60)
        expect(page.get_by_test_id("rectangle-in-scene")).to_be_visible()
        page.mouse.move(x + 150, y + 120)
        page.mouse.up()
    finally:
        page.keyboard.up("Shift")
    expect(board.row("first", pressed=True)).to_be_visible()
    expect(page.get_by_test_id("rectangle-in-scene")).to_be_hidden()


def test_the_menu_behind_the_right_button(board):
    page = board.page
    page.mouse.click(*board.on_screen(), button="right")
    expect(page.get_by_role("menu", name="What to do with first")).to_be_visible()
    page.keyboard.press("Escape")


def test_an_area_is_drawn_and_reshaped(board):
    """Its corners are clicked one after the other, faster than the page is drawn."""
    page = board.page
    board.look()
    page.get_by_role("button", name="Add", exact=True).click()
    page.get_by_role("menuitem", name="Area with a trigger", exact=True).click()
    places = [board.on_screen(ahead, left, 0.0) for ahead, left in ((3.0, -6.0), (9.0, -6.0), (9.0, -10.0))]
    for place in places:
        page.mouse.click(*place)
    page.keyboard.press("Enter")
    board.done("Add area")
    before = board.corners()
    assert len(before) == 3
    expect(board.marks).to_have_attribute("aria-label", re.compile("chosen area"))
    x, y = before[0]
    page.mouse.move(*board.of(x, y))
    page.mouse.down()
    page.mouse.move(*board.of(x + 1.5, y))
    page.mouse.move(*board.of(x + 3.0, y))
    page.mouse.up()
    board.done("Reshape area")
    after = board.corners()
    assert after[1:] == before[1:]
    assert hypot(after[0][0] - before[0][0], after[0][1] - before[0][1]) == pytest.approx(3.0, abs=0.3)
    for name in ("Reshape area", "Add area"):
        page.keyboard.press("Control+z")
        expect(page.get_by_role("button", name=f"Redo: {name}")).to_be_enabled()


def test_the_scene_rests(board):
    until(lambda: board.frame.evaluate(REST) == 0, "the scene to rest")
