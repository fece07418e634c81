"""Kinds in a real browser: exchange a sensor for one of one's own, see its fields, run it, find its channel; see what is broken."""

import shutil

import pytest
from playwright.sync_api import expect

from tests.broken import EVERY, FLAWLESS, TORN
from tests.browser.browser import browser, watched
from tests.server.server import served

SIZE = {"width": 1280, "height": 760}
FRONT = "param-vehicles.leader.sensors.front"


@pytest.fixture(scope="module")
def place(tmp_path_factory, sample):
    """A folder with a sample, a sensor of one's own, and a driver that does not load."""
    folder = tmp_path_factory.mktemp("kinds")
    (folder / "scenarios" / "maps").mkdir(parents=True)
    shutil.copy(sample.with_name("motorway_platoon.yaml"), folder / "scenarios")
    shutil.copy(sample.parent / "maps" / "motorway.xodr", folder / "scenarios" / "maps")
    (folder / "kinds").mkdir()
    (folder / "kinds" / "flawless.py").write_text(FLAWLESS)
    (folder / "kinds" / "torn.py").write_text(TORN)
    return folder


@pytest.fixture(scope="module")
def studio(place):
    """A page of a server with these kinds, what its console complained about, and a client."""
    with browser() as opened, served(place, "--kinds", place / "kinds") as (client, _, _):
        page, complaints = watched(opened, viewport=SIZE, color_scheme="light")
        page.goto(str(client.base_url))
        yield page, complaints, client
        opened.close()


@pytest.fixture(scope="module")
def page(studio):
    return studio[0]


def fill(page, test_id, value):
    """Types a value and leaves the field."""
    field = page.get_by_test_id(test_id)
    field.fill(value)
    field.press("Tab")


def test_1_a_sensor_is_exchanged(page, studio):
    """The radar that comes with the studio has noises; what stands in its place shows its own settings instead."""
    kinds = studio[2].get("/api/kinds").json()["kinds"]
    page.get_by_label("Search parameters").fill("leader.sensors")
    expect(page.get_by_test_id(f"{FRONT}.rate_noise")).to_be_visible()
    select = page.get_by_test_id(f"{FRONT}.kind")
    assert set(select.locator("option").all_inner_texts()) == {each["title"] for each in kinds if each["sort"] == "sensor"}
    select.select_option("flawless")
    expect(page.get_by_test_id(f"{FRONT}.patience")).to_have_value("2")
    expect(page.get_by_test_id(f"{FRONT}.range")).to_have_value("80")
    expect(page.get_by_test_id(f"{FRONT}.rate_noise")).to_have_count(0)
    assert "s" in page.get_by_test_id(f"{FRONT}.patience").locator("xpath=ancestor::*[contains(@class, 'row')]").inner_text()


def test_2_what_has_to_be_in_range_is_told(page):
    fill(page, f"{FRONT}.patience", "99")
    expect(page.get_by_test_id(f"{FRONT}.patience")).to_have_attribute("aria-invalid", "true")
    fill(page, f"{FRONT}.patience", "3")
    expect(page.get_by_test_id(f"{FRONT}.patience")).not_to_have_attribute("aria-invalid", "true")


def test_3_what_is_shown_is_what_runs(page, studio):
    page.get_by_label("Search parameters").fill("duration")
    fill(page, "param-clock.duration", "3")
    page.get_by_test_id("pace").select_option("fast")
    page.get_by_test_id("run").click()
    expect(page.get_by_test_id("history-row").first).to_contain_text("done")
    document = studio[2].get("/api/runs/1").json()["document"]
    front = EVERY | {"kind": "flawless", "range": 80, "opening_angle": 0.5, "patience": 3}
    assert document["vehicles"]["leader"]["sensors"]["front"] == front


def test_4_the_sensors_channel_is_offered(page):
    """With its label and unit, in the studio and at the run."""
    charts = page.get_by_label("Quantity of this chart")
    charts.first.select_option(label="Clearance of front [m]")
    expect(page.locator("canvas").first).to_be_visible()
    page.goto(page.url.partition("/studio")[0] + "/runs/1")
    page.get_by_label("Quantity of this chart").first.select_option(label="Clearance of front [m]")


def test_5_the_kinds_are_listed(page):
    """By the keyboard: there, to one that is looked for, and into it."""
    page.locator("body").click()
    page.keyboard.press("g")
    page.keyboard.press("k")
    expect(page.get_by_test_id("nav-kinds")).to_contain_text("1 broken")
    broken = page.get_by_test_id("broken-kind")
    expect(broken).to_contain_text("torn")
    expect(broken).to_contain_text("No module named 'studio.nowhere'")
    page.keyboard.press("/")
    page.keyboard.type("sensor nowhere")
    expect(page.get_by_text("No kind matches")).to_be_visible()
    page.get_by_label("Search kinds").fill("without noise")
    own = page.get_by_test_id("kind-sensor.flawless")
    expect(own).to_contain_text("flawless.py")
    own.locator("summary").focus()
    page.keyboard.press("Enter")
    expect(own).to_contain_text("the gap to the car ahead as it is")
    for words in ("Patience", "at least 0, at most 10 s", "clearance", "to the rear of the car ahead"):
        expect(own).to_contain_text(words)


def test_the_source_follows_the_file_and_tells_what_python_cannot_read(page, studio, place):
    file = place / "kinds" / "flawless.py"
    page.goto(f"{studio[2].base_url}/kinds")
    entry = page.get_by_test_id("kind-sensor.flawless")
    entry.locator("summary").first.click()
    entry.get_by_role("button", name="Source").click()
    source = entry.get_by_role("region", name="Source of flawless")
    expect(source).to_contain_text(str(file))
    expect(source.get_by_role("status")).to_have_count(0)
    try:
        file.write_text("# mine\n" + FLAWLESS)
        expect(source).to_contain_text("# mine")
        expect(source.get_by_role("status")).to_contain_text("has changed since the studio was started")
        file.write_text("def measure(:\n")
        expect(source.get_by_role("status")).to_contain_text("Line 1:")
        expect(source.locator("[data-wrong]")).to_have_count(1)
    finally:
        file.write_text(FLAWLESS)
    expect(source.get_by_role("status")).to_have_count(0)


def test_the_console_is_clean(studio):
    assert studio[1] == []
