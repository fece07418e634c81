"""Everybody can use the page: axe's automatic checks of every place, light and dark."""

from pathlib import Path

import pytest
from playwright.sync_api import expect

from tests.browser.browser import browser, watched
from tests.patience import until
from tests.server.server import served

AXE = Path(__file__).parents[2] / "web" / "node_modules" / "axe-core" / "axe.min.js"
# What is looked for: WCAG 2.2 up to AA, and what axe's authors hold to be good practice. The scene's frame is another program's page.
TAGS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]
CHECK = """async (tags) => (await axe.run({exclude: ['iframe']}, {runOnly: tags}))
    .violations.map(({id, nodes}) => `${id}: ${nodes.map(({html}) => html.slice(0, 160)).slice(0, 4).join(' | ')}`)"""


@pytest.fixture(scope="module", params=["light", "dark"])
def page(request, tmp_path_factory, sample):
    """A page with two runs that are over, in one of the themes."""
    folder = tmp_path_factory.mktemp("axe")
    with browser() as opened, served(folder, "--scenarios", sample.parent) as (client, _, _):
        for seed in (1, 2):
            client.post("/api/runs", json={"scenario": sample.stem, "seed": seed, "set": {"clock.duration": 0.4}}).raise_for_status()
        until(lambda: {each["status"] for each in client.get("/api/runs").json()} == {"done"}, "the end of the runs")
        scheme = {"color_scheme": request.param, "viewport": {"width": 1280, "height": 800}}
        found, _ = watched(opened, base_url=str(client.base_url), reduced_motion="reduce", **scheme)
        found.add_init_script(path=AXE)
        yield found
        opened.close()


PLACES = {
    "/studio/{sample}": "param-clock.duration",
    "/studio/{sample}?run=1": "history-row",
    "/scenarios": "new-scenario",
    "/scenarios/{sample}/text": "",
    "/edit/{sample}": "on-plan-vehicles.leader",
    "/runs": "runs-table",
    "/runs?as=space": "space",
    "/runs?as=lineage": "lineage",
    "/runs?as=board": "board",
    "/runs/1": "verdict-give",
    "/queue": "",
    "/compare?runs=1,2": "compare-metrics",
    "/maps": "",
    "/validate": "",
    "/kinds": "",
}


@pytest.mark.parametrize("place", PLACES)
def test_nothing_is_found(page, place, sample):
    page.goto(place.format(sample=sample.stem))
    if PLACES[place]:
        expect(page.get_by_test_id(PLACES[place]).first).to_be_attached()
    expect(page.get_by_role("status").filter(has_text="Loading")).to_have_count(0)
    assert page.evaluate(CHECK, TAGS) == []
