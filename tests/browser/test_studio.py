"""The product's main job once around, in a real browser: see the city, run, watch, tune, run again, compare."""

import time

import numpy as np
import pytest
from playwright.sync_api import expect

from tests.browser.browser import browser, pixels
from tests.server.server import served

PATIENCE = 180_000  # [ms] the first start compiles
SIZE = {"width": 1100, "height": 640}  # a software renderer draws every pixel of it
HEADWAY = "param-applications.platoon.parameters.headway"


@pytest.fixture(scope="module")
def studio(tmp_path_factory, sample):
    """A page of a server with an empty database, and what its console complained about."""
    folder = tmp_path_factory.mktemp("browser")
    with browser() as opened, served(folder, "--scenarios", sample.parent) as (client, _, _):
        page = opened.new_page(viewport=SIZE)
        page.set_default_timeout(PATIENCE)
        expect.set_options(timeout=PATIENCE)
        complaints = []
        page.on("console", lambda message: complaints.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.goto(str(client.base_url))
        yield page, complaints
        opened.close()


@pytest.fixture(scope="module")
def page(studio):
    return studio[0]


def scene(page) -> np.ndarray:
    """The picture of the scene, without its controls at the top."""
    box = page.get_by_test_id("scene-frame").bounding_box()
    clip = {"x": box["x"], "y": box["y"] + 60, "width": box["width"], "height": box["height"] - 90}
    return pixels(page.screenshot(clip=clip))


def is_a_picture(picture) -> bool:
    """Neither white nor black nor empty: light and dark, in many tones."""
    tones = np.unique((picture // 16).astype(int).reshape(-1, 3), axis=0)
    return picture.std() > 20 and 40 < picture.mean() < 220 and len(tones) > 60


def wait_for(condition, patience=60.0):
    """Until something is true."""
    end = time.monotonic() + patience
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.5)
    raise AssertionError("waited in vain")


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
    wait_for(lambda: is_a_picture(scene(page)))


def test_2_a_run_is_seen_moving(page):
    """The picture changes, time goes on, the charts get their lines."""
    standing = scene(page)
    page.get_by_test_id("run").click()
    wait_for(lambda: sim_time(page) > 2)
    first = scene(page)
    wait_for(lambda: sim_time(page) > 4)
    second = scene(page)
    assert np.abs(first - standing).mean() > 2 and np.abs(second - first).mean() > 1
    assert is_a_picture(second)
    assert page.locator("canvas").count() >= 2


def test_3_pause_and_step(page):
    page.get_by_test_id("pause").click()
    expect(page.get_by_test_id("resume")).to_be_visible()
    time.sleep(1)
    stood = sim_time(page)
    time.sleep(1)
    assert sim_time(page) == stood
    page.get_by_test_id("step").click()
    wait_for(lambda: sim_time(page) > stood)
    assert sim_time(page) == pytest.approx(stood + 0.02, abs=0.011)
    page.get_by_test_id("resume").click()


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
    assert "0.6" in parameters.inner_text() and "1.2" in parameters.inner_text()
    assert "duration" not in parameters.inner_text()
    metrics = page.get_by_test_id("compare-metrics").inner_text()
    assert "Min TTC [s]" in metrics and "Worst hop gain" in metrics
    assert "better" in metrics or "worse" in metrics
    expect(page.get_by_test_id("compare-charts").locator("canvas").first).to_be_visible()


def test_8_the_table_of_runs(page):
    page.get_by_test_id("nav-runs").click()
    table = page.get_by_test_id("runs-table")
    expect(table).to_contain_text("Min TTC")
    assert "[s]" in table.inner_text() and "[m/s²]" in table.inner_text()
    page.reload()
    expect(page.get_by_test_id("runs-table")).to_contain_text("done")


def test_9_dark(page):
    """The theme's switch goes through light, dark and the system's; one of them is dark."""
    seen = []
    for _ in range(3):
        seen.append(pixels(page.screenshot()).mean())
        page.get_by_test_id("theme-toggle").click()
        time.sleep(0.5)
    assert min(seen) < 90 < 180 < max(seen)


def test_the_console_is_clean(studio):
    assert studio[1] == []
