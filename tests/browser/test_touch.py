"""The page under fingers, on an upright tablet: things chosen, dragged and asked for their menu, plan and charts spread by two fingers."""

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
    """A page that is touched, its fingers, a client, and the scenario's file; a run of it is over."""
    folder = tmp_path_factory.mktemp("touch")
    maps = folder / "scenarios" / "maps"
    maps.mkdir(parents=True)
    shutil.copy(sample.parent / "maps" / "urban_grid.osm", maps)
    path = folder / "scenarios" / f"{ID}.yaml"
    shutil.copy(sample.with_name(f"{ID}.yaml"), path)
    with browser() as opened, served(folder) as (client, _, _):
        client.post("/api/runs", json={"scenario": ID, "set": {"clock.duration": 4}}).raise_for_status()
        until(lambda: client.get("/api/runs/1").json()["status"] == "done", "the end of the run")
        page, complaints = watched(opened, viewport=TABLET, has_touch=True, base_url=str(client.base_url))
        yield page, Fingers(page), client, path
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


def test_1_the_plan_of_the_editor(studio):
    page, fingers, _, path = studio
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

    page.keyboard.press("f")  # to what is chosen
    drawn(page)
    fingers.told("touchStart", spot(page, "vehicles.first"))
    menu = page.get_by_role("menu", name="What to do with first")
    expect(menu).to_be_visible()
    fingers.told("touchEnd")
    drawn(page)
    expect(menu).to_be_visible()
    page.keyboard.press("Escape")


def test_2_charts_and_tables(studio):
    page, fingers, *_ = studio
    page.goto("/runs")
    page.touchscreen.tap(*middle(page.locator("tr[data-run='1'] td").nth(2)))
    expect(page).to_have_url(re.compile("/runs/1"))
    chart = page.locator(".u-over").first
    chart.scroll_into_view_if_needed()
    x, y = middle(chart)
    fingers.drag(((x - 30, y), (x - 90, y)), ((x + 30, y), (x + 90, y)))
    whole = page.get_by_role("button", name="Show all of it")
    expect(whole.first).to_be_visible()
    fingers.drag(((x - 90, y), (x - 10, y)), ((x + 90, y), (x + 10, y)))
    expect(whole).to_have_count(0)


def middle(found):
    box = found.bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def test_3_splitters(studio):
    page, fingers, *_ = studio
    page.goto(f"/?scenario={ID}")
    bar = page.get_by_role("separator").first
    expect(bar).to_be_visible()
    x, y = middle(bar)
    before, is_upright = bar.get_attribute("aria-valuenow"), bar.get_attribute("aria-orientation") == "vertical"
    fingers.push((x, y), **({"right": -60} if is_upright else {"down": -60}))
    expect(bar).not_to_have_attribute("aria-valuenow", before)
