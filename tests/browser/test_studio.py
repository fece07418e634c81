"""The product's main job once around, in a real browser: see the city, run, watch, tune, run again, compare."""

import numpy as np
import pytest
from playwright.sync_api import expect

from tests.browser.browser import browser, drawn, pixels, watched
from tests.patience import until
from tests.server.server import served

SIZE = {"width": 1100, "height": 640}  # a software renderer draws every pixel of it
HEADWAY = "param-applications.platoon.parameters.headway"


@pytest.fixture(scope="module")
def studio(tmp_path_factory, sample):
    """A page of a server with an empty database, and what its console complained about."""
    folder = tmp_path_factory.mktemp("browser")
    with browser() as opened, served(folder, "--scenarios", sample.parent) as (client, _, _):
        page, complaints = watched(opened, viewport=SIZE)
        page.goto(str(client.base_url))
        yield page, complaints, client
        opened.close()


@pytest.fixture(scope="module")
def page(studio):
    return studio[0]


@pytest.fixture(scope="module")
def client(studio):
    return studio[2]


def scene(page) -> np.ndarray:
    """The picture of the scene, without its controls at the top."""
    box = page.get_by_test_id("scene-frame").bounding_box()
    clip = {"x": box["x"], "y": box["y"] + 60, "width": box["width"], "height": box["height"] - 90}
    return pixels(page.screenshot(clip=clip))


def is_a_picture(picture) -> bool:
    """Neither white nor black nor empty: light and dark, in many tones."""
    tones = np.unique((picture // 16).astype(int).reshape(-1, 3), axis=0)
    return picture.std() > 20 and 40 < picture.mean() < 220 and len(tones) > 60


def sim_time(page) -> float:
    """The simulated time that the page shows [s]."""
    return float(page.get_by_test_id("sim-time").inner_text().split()[0])


def start_fast(page):
    """Runs as fast as possible, until the history says done for the newest run."""
    page.get_by_test_id("pace").select_option("fast")
    before = page.get_by_test_id("history-row").count()
    page.get_by_test_id("run").click()
    expect(page.get_by_test_id("history-row")).to_have_count(before + 1)
    expect(page.get_by_test_id("history-row").first).to_contain_text("done")


def test_1_the_city_is_seen(page):
    expect(page.get_by_test_id("attribution")).to_have_text("© OpenStreetMap contributors")
    until(lambda: is_a_picture(scene(page)), "a picture")


def test_2_a_run_is_seen_moving(page):
    """The picture changes, time goes on, the charts get their lines."""
    standing = scene(page)
    page.get_by_test_id("pace").select_option("0.25")  # so that it is still going on when a slow machine wants to pause it
    page.get_by_test_id("run").click()
    until(lambda: sim_time(page) > 2, "two seconds")
    first = until_changed(page, standing, by=2)
    until(lambda: sim_time(page) > 4, "four seconds")
    assert is_a_picture(until_changed(page, first, by=1))
    assert page.locator("canvas").count() >= 2


def until_changed(page, before, *, by) -> np.ndarray:
    """The picture of the scene as soon as it differs from another by so much in the mean of its pixels."""
    pictures = [before]

    def changed():
        pictures.append(scene(page))
        return np.abs(pictures[-1] - before).mean() > by

    until(changed, "another picture")
    return pictures[-1]


def test_3_pause_and_step(page, client):
    """The run stands where the server says, and a step is one tick from there: nothing went on between the two."""
    page.get_by_test_id("pause").click()
    expect(page.get_by_test_id("resume")).to_be_visible()
    until(lambda: live(client)["status"] == "paused", "the pause")
    stood = live(client)["time"]
    until(lambda: sim_time(page) == pytest.approx(stood, abs=0.006), "the time of the pause")
    page.get_by_test_id("step").click()
    until(lambda: live(client)["time"] > stood, "the step")
    assert live(client)["time"] == pytest.approx(stood + 0.02) and live(client)["status"] == "paused"
    until(lambda: sim_time(page) == pytest.approx(stood + 0.02, abs=0.006), "the time of the step")
    page.get_by_test_id("resume").click()


def live(client):
    """The newest live run, as the server sees it."""
    return client.get("/api/live").json()[0]


def test_4_the_run_ends_in_the_history(page):
    page.get_by_test_id("pace").select_option("fast")
    expect(page.get_by_test_id("history-row").first).to_contain_text("done")
    assert page.get_by_test_id("history-row").count() == 1


def test_5_a_changed_headway_makes_a_child(page):
    field = page.get_by_test_id(HEADWAY)
    field.fill("1.2")
    field.press("Tab")
    start_fast(page)
    expect(page.get_by_test_id("history-row").first).to_contain_text("1.2")


def test_6_a_wrong_value_is_told_at_its_field(page):
    field = page.get_by_test_id(HEADWAY)
    field.fill("99")
    field.press("Tab")
    expect(page.get_by_test_id(HEADWAY)).to_have_attribute("aria-invalid", "true")
    field.fill("1.2")
    field.press("Tab")
    expect(page.get_by_test_id(HEADWAY)).not_to_have_attribute("aria-invalid", "true")


def test_7_compare(page):
    """Only the headway differs; every metric has a verdict in words; the charts are there."""
    page.goto(page.url.partition("/studio")[0] + "/compare?a=1&b=2")
    parameters = page.get_by_test_id("compare-parameters")
    expect(parameters).to_contain_text("headway")
    for value in ("0.6", "1.2"):
        expect(parameters).to_contain_text(value)
    expect(parameters).not_to_contain_text("duration")
    metrics = page.get_by_test_id("compare-metrics")
    for words in ("Least time to collision [s]", "Greatest gain from car to car", "better"):
        expect(metrics).to_contain_text(words)  # the server's words come a moment after its figures
    expect(page.get_by_test_id("compare-charts").locator("canvas").first).to_be_visible()


def test_8_the_table_of_runs(page):
    page.get_by_test_id("nav-runs").click()
    table = page.get_by_test_id("runs-table")
    expect(table).to_contain_text("Least time to collision")
    assert "[s]" in table.inner_text() and "[m/s²]" in table.inner_text()
    page.reload()
    expect(page.get_by_test_id("runs-table")).to_contain_text("done")


def test_9_dark(page):
    """The theme's switch goes through light, dark and the system's; one of them is dark."""
    seen = []
    for _ in range(3):
        seen.append(pixels(page.screenshot()).mean())
        toggle = page.get_by_test_id("theme-toggle")
        scheme = toggle.get_attribute("data-scheme")
        toggle.click()
        expect(toggle).not_to_have_attribute("data-scheme", scheme)
        drawn(page)
    assert min(seen) < 90 < 180 < max(seen)


def test_the_console_is_clean(studio):
    assert studio[1] == []
