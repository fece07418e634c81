"""A stretch of a run, charts of any channel, ghosts and seeds, in a real browser."""

import re

import pytest
from playwright.sync_api import expect

from tests.browser.browser import browser, watched
from tests.patience import until
from tests.server.server import served

SHORT = {"clock.duration": 4, "script.hard_brake.when.at": 1, "recording.traffic": True}


@pytest.fixture(scope="module")
def place(tmp_path_factory, sample):
    """A server with two runs, and a browser."""
    folder = tmp_path_factory.mktemp("stretch")
    with browser() as opened, served(folder, "--scenarios", sample.parent) as (client, _, _):
        for headway in (0.6, 1.2):
            changes = SHORT | {"applications.platoon.parameters.headway": headway}
            run = client.post("/api/runs", json={"scenario": sample.stem, "set": changes}).json()["run"]
            until(lambda run=run: client.get(f"/api/runs/{run}").json()["status"] == "done", "the end of the run")
        yield opened, client, sample.stem
        opened.close()


def test_a_stretch_is_played_over_and_over_and_measured(place):
    opened, client, scenario = place
    page, complaints = watched(opened, viewport={"width": 1280, "height": 800})
    page.goto(f"{client.base_url}/studio/{scenario}?run=1")
    bar = page.get_by_role("toolbar", name="Playback")
    time = bar.get_by_label("Time", exact=True)
    time.fill("1")
    time.press("Enter")
    bar.get_by_role("button", name="Play (space)").focus()
    page.keyboard.press("i")
    bar.get_by_role("button", name="1.00–4.00 s").click()
    panel = page.get_by_role("dialog")
    panel.get_by_label("To", exact=True).fill("1.5")
    expect(bar.get_by_role("button", name="1.00–1.50 s")).to_be_visible()
    measures = panel.get_by_role("table", name="Metrics of this stretch")
    expect(measures.get_by_role("row").filter(has_text="Least gap")).to_contain_text(re.compile(r"\d\.\d+ ?m"))
    expect(panel.get_by_text("have no value here")).to_be_visible()
    panel.get_by_label("To", exact=True).fill("0.5")
    expect(panel.get_by_text("1.00 to 4.00 s")).to_be_visible()  # what it may be; the stretch stays
    expect(bar.get_by_role("button", name="1.00–1.50 s")).to_be_visible()
    page.keyboard.press("Escape")
    bar.get_by_role("button", name="Play (space)").click()
    page.wait_for_timeout(2500)  # five times as long as the stretch
    expect(bar.get_by_role("button", name="Pause playback (space)")).to_be_visible()
    assert 1.0 <= float(time.input_value().removesuffix(" s")) <= 1.5
    assert complaints == []
    page.close()


def test_charts_take_other_channels_and_are_remembered(place):
    opened, client, scenario = place
    page, complaints = watched(opened, viewport={"width": 1280, "height": 800})
    page.goto(f"{client.base_url}/studio/{scenario}?run=1")
    charts = page.get_by_role("region", name="Charts")
    speed = charts.get_by_role("figure", name="Speed [m/s] over time")
    speed.get_by_role("button", name="Channels of this chart").click()
    page.get_by_role("textbox", name="Add a channel").or_(page.get_by_role("combobox", name="Add a channel")).first.fill("traffic_03.gap")
    page.get_by_role("option", name=re.compile(r"^traffic_03\.gap")).click()
    page.keyboard.press("Escape")
    page.keyboard.press("Escape")
    expect(speed).to_contain_text("Traffic 03 gap to the car ahead")
    charts.get_by_role("button", name="XY chart").click()
    curve = charts.get_by_role("figure", name=re.compile("Speed.* over Gap"))
    expect(curve.get_by_role("img", name="5 curves")).to_be_attached()
    page.reload()
    expect(speed).to_contain_text("Traffic 03 gap to the car ahead")
    expect(curve).to_be_attached()
    curve.get_by_role("button", name="Remove this chart").click()
    expect(curve).to_have_count(0)
    assert complaints == []
    page.close()


def test_the_runs_of_a_comparison_drive_as_ghosts(place):
    opened, client, scenario = place
    page, complaints = watched(opened, viewport={"width": 1280, "height": 800})
    page.goto(f"{client.base_url}/compare?runs=1,2")
    page.get_by_label("Align the runs by").select_option("script_begun")
    page.get_by_role("link", name="Show in the scene").click()
    expect(page.get_by_role("list", name="Ghosts of other runs")).to_contain_text("#2")
    frame = page.get_by_test_id("scene-frame").element_handle().content_frame()
    frame.wait_for_function("Object.keys(window.__viserSceneTree.getState()).some((name) => name.startsWith('/ghosts/body_'))")
    page.get_by_role("button", name="Layers").click()
    page.get_by_role("checkbox", name="Lines to ghosts").check()
    page.keyboard.press("Escape")
    drawn_over = page.frame_locator("iframe[title='3D scene']").get_by_role("img", name=re.compile("^Layers: "))
    expect(drawn_over).to_have_attribute("aria-label", re.compile(r"ghosts [1-5]"))
    assert f"/studio/{scenario}?run=1&ghosts=" in page.url and "align=script_begun" in page.url
    assert complaints == []
    page.close()


def test_several_seeds_are_run_and_their_spread_is_told(place):
    opened, client, scenario = place
    page, complaints = watched(opened, viewport={"width": 1280, "height": 800})
    page.goto(f"{client.base_url}/studio/{scenario}?from=1")
    page.get_by_label("Seeds at once").fill("3")
    page.get_by_role("button", name="Run 3 seeds").click()
    page.get_by_role("tab", name="Seeds").click()
    spread = page.get_by_role("table", name="Spread over seeds")
    expect(page.get_by_text("3 seeds of this setting: 1, 2, 3")).to_be_visible()
    expect(spread.get_by_role("row").filter(has_text="Least gap")).to_contain_text("±")
    assert complaints == []
    page.close()
