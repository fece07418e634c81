"""The plan of the editor under fingers, on an upright tablet: things chosen and dragged, the plan spread by two fingers."""

import re
import shutil

import pytest
import yaml
from playwright.sync_api import expect

from tests.browser.browser import browser, drawn, watched
from tests.patience import until
from tests.server.server import served

TABLET = {"width": 768, "height": 1024}
ID = "stepping_out"


class Fingers:
    """Several fingers on a page, by the browser's own protocol: what a screen would tell it."""

    def __init__(self, page) -> None:
        self.protocol = page.context.new_cdp_session(page)

    def told(self, kind, *places):
        points = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(places)]
        self.protocol.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    def push(self, start, right=0, down=0):
        """One finger from a place, by the browser itself: it does not rest on the way, however busy the machine is."""
        way = {"x": start[0], "y": start[1], "xDistance": right, "yDistance": down, "preventFling": True, "gestureSourceType": "touch"}
        self.protocol.send("Input.synthesizeScrollGesture", way)

    def drag(self, *ways):
        """Several fingers, each from one place to another, all at once."""
        for step in range(6):
            places = [(a + (c - a) * step / 5, b + (d - b) * step / 5) for (a, b), (c, d) in ways]
            self.told("touchMove" if step else "touchStart", *places)
        self.told("touchEnd")


@pytest.fixture(scope="module")
def studio(tmp_path_factory, sample):
    """A page that is touched, its fingers, and the scenario's file."""
    folder = tmp_path_factory.mktemp("touch")
    maps = folder / "scenarios" / "maps"
    maps.mkdir(parents=True)
    shutil.copy(sample.parent / "maps" / "urban_grid.osm", maps)
    path = folder / "scenarios" / f"{ID}.yaml"
    shutil.copy(sample.with_name(f"{ID}.yaml"), path)
    with browser() as opened, served(folder) as (client, _, _):
        page, complaints = watched(opened, viewport=TABLET, has_touch=True, base_url=str(client.base_url))
        yield page, Fingers(page), path
        assert complaints == []
        opened.close()


def name_of(page, path):
    """The name of a thing on the plan."""
    return page.get_by_test_id(f"on-plan-{path}")


def spot(page, path):
    """Where a thing is on the screen: under its name."""
    box = name_of(page, path).bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] + 8


def scale(page):
    """How large a metre is on the plan [px]: by its bar, which has a round length."""
    bar = page.get_by_role("application").locator("span[style*='width']").first
    number, unit = bar.inner_text().split()
    width = float(re.search(r"width: ([\d.]+)px", bar.get_attribute("style")).group(1))
    return width / (float(number) * {"cm": 0.01, "m": 1.0, "km": 1000.0}[unit])


def test_the_plan_of_the_editor(studio):
    page, fingers, path = studio
    page.goto(f"/edit/{ID}")
    expect(name_of(page, "vehicles.first")).to_be_visible()
    drawn(page)
    listed = page.get_by_role("navigation", name="Everything in the scenario")
    page.touchscreen.tap(*spot(page, "script.cyclist"))
    expect(listed.get_by_role("button", name="cyclist", exact=True, pressed=True)).to_be_visible()

    x, y = spot(page, "vehicles.first")
    before = yaml.safe_load(path.read_text())["vehicles"]["first"]["position"]["along"]
    fingers.push((x, y), down=-60)  # to the north, where it drives
    expect(page.get_by_role("button", name="Undo: Move first")).to_be_enabled()
    assert yaml.safe_load(path.read_text())["vehicles"]["first"]["position"]["along"] > before + 3

    box = page.get_by_role("application").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    before, text = scale(page), path.read_text()
    fingers.drag(((x - 40, y), (x - 80, y)), ((x + 40, y), (x + 80, y)))
    until(lambda: scale(page) == pytest.approx(2 * before, rel=0.02), "twice the size")
    assert path.read_text() == text  # what lay under the fingers was not dragged
