"""Two tabs in a real browser: each has a scene of its own, and keeps it when it is loaded again."""

import pytest
from playwright.sync_api import expect

from tests.browser.browser import browser, watched
from tests.patience import until
from tests.server.server import served

SHOWN = """() => Object.keys(document.querySelector("iframe[title='3D scene']")?.contentWindow.__viserSceneTree?.getState() ?? {})
    .filter((name) => name.startsWith("/map/"))"""


@pytest.fixture(scope="module")
def tabs(tmp_path_factory, sample):
    """Two tabs of one browser, what their consoles complained about, and a client."""
    folder = tmp_path_factory.mktemp("tabs")
    with browser() as opened, served(folder, "--scenarios", sample.parent) as (client, _, _):
        context = opened.new_context(base_url=str(client.base_url), viewport={"width": 900, "height": 600})
        (one, complaints), (other, others) = watched(context), watched(context)
        yield one, other, client
        assert complaints == others == []
        opened.close()


def shown(page, digest):
    """Until the scene of a page has a map, and nothing covers it."""
    until(lambda: page.evaluate(SHOWN) == [f"/map/{digest}"], "the map in the scene")
    expect(page.get_by_role("status", name="The scene is loading")).to_have_count(0)


def place(page):
    return page.locator("iframe[title='3D scene']").get_attribute("src")


def digest(client, scenario):
    """How the server names the map of a scenario, asked for on a stage that nobody looks at."""
    return client.post("/api/scene", json={"stage": 8, "scenario": scenario}).json()["map"]


def test_two_tabs_show_two_scenarios_and_keep_them(tabs):
    one, other, client = tabs
    motorway, town = digest(client, "cacc_brake"), digest(client, "urban_grid")
    one.goto("/studio/cacc_brake")
    shown(one, motorway)
    other.goto("/studio/urban_grid")
    shown(other, town)
    shown(one, motorway)
    mine = place(other)
    assert place(one) != mine
    other.reload()
    shown(other, town)
    assert place(other) == mine
    shown(one, motorway)
