"""The first minutes in a real browser: a tour is offered, makes three runs, and leads through one loop by what one does."""

import re

import pytest
from playwright.sync_api import expect

from tests.browser.browser import browser, watched
from tests.patience import until
from tests.server.server import served

SIZE = {"width": 1280, "height": 800}
HEADWAY = "applications.platoon.parameters.headway"


@pytest.fixture(scope="module")
def studio(tmp_path_factory, sample):
    """The page of somebody who has never been here, on a scenario that lasts 1 s, with complaints and a client."""
    folder = tmp_path_factory.mktemp("tour")
    with browser() as opened, served(folder, "--scenarios", sample.parent) as (client, _, _):
        page, complaints = watched(opened, tour=True, viewport=SIZE, color_scheme="light", base_url=str(client.base_url))
        page.goto(f"/studio/{sample.stem}")
        yield page, complaints, client
        opened.close()


@pytest.fixture(scope="module")
def page(studio):
    return studio[0]


def step(page, title):
    return expect(page.get_by_role("dialog", name="Tour").get_by_role("heading", name=title))


def test_1_it_is_offered_and_makes_three_runs(page, studio):
    page.get_by_role("dialog", name="A tour is offered").get_by_role("button", name="Begin the tour").click()
    step(page, "The scenario, as it will start").to_be_visible()
    rows = until(lambda: len(found := studio[2].get("/api/runs").json()) == 3 and found, "three runs")
    assert [(each["run"], each["parent"], each["parameters"]) for each in sorted(rows, key=lambda each: each["run"])] == [
        (1, None, {}),
        (2, 1, {HEADWAY: 0.42}),
        (3, 1, {HEADWAY: 0.9}),
    ]
    expect(page.get_by_test_id("history-row")).to_have_count(3)


def test_2_what_is_done_leads_on(page):
    page.get_by_test_id("tour-next").click()
    step(page, "Run it").to_be_visible()
    page.get_by_test_id("run").click()
    step(page, "Change one thing").to_be_visible()
    field = page.get_by_test_id(f"param-{HEADWAY}")
    field.fill("0.8")
    field.press("Tab")
    step(page, "Run it again").to_be_visible()


def test_3_it_is_there_again_after_a_reload_and_goes_on_to_the_end(page):
    page.reload()
    step(page, "Run it again").to_be_visible()
    page.get_by_test_id("tour-next").click()
    step(page, "Every run is here").to_be_visible()
    expect(page).to_have_url(re.compile("/runs"))
    for run in (2, 3):
        page.get_by_test_id(f"select-{run}").click()
    page.get_by_test_id("compare-button").click()
    step(page, "Which one is better?").to_be_visible()
    page.get_by_test_id("tour-next").click()
    step(page, "Decide").to_be_visible()
    page.get_by_test_id("tour-next").click()
    step(page, "The next scenario is your own").to_be_visible()
    page.get_by_test_id("tour-next").click()
    expect(page.get_by_role("dialog", name="Tour")).to_have_count(0)


def test_4_it_is_not_offered_again_but_can_be_taken(page):
    page.reload()
    expect(page.get_by_test_id("new-scenario")).to_be_visible()
    expect(page.get_by_role("dialog", name="A tour is offered")).to_have_count(0)
    page.keyboard.press("?")
    page.get_by_role("button", name="Take the tour of ninety seconds").click()
    step(page, "The scenario, as it will start").to_be_visible()
    page.get_by_role("button", name="End the tour").click()
    expect(page.get_by_role("dialog", name="Tour")).to_have_count(0)


def test_5_nothing_was_complained_about(studio):
    assert studio[1] == []
