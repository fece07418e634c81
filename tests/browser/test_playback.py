"""The playback of a run in a real browser: one playhead for the scene, the charts, the events and the clock."""

import re

from playwright.sync_api import expect

from tests.browser.browser import browser, watched
from tests.patience import until
from tests.server.server import served

SHORT = {"clock.duration": 4}


def test_a_run_is_played_back(tmp_path, sample):
    """By its keys and buttons, by an exact time, by a click into a chart, and by what happened; nothing plays by itself."""
    with browser() as opened, served(tmp_path, "--scenarios", sample.parent) as (client, _, _):
        run = client.post("/api/runs", json={"scenario": sample.stem, "set": SHORT}).json()["run"]
        until(lambda: client.get(f"/api/runs/{run}").json()["status"] == "done", "the end of the run")
        page, complaints = watched(opened, viewport={"width": 1280, "height": 800})
        page.goto(f"{client.base_url}/studio/{sample.stem}?run={run}")
        bar = page.get_by_role("toolbar", name="Playback")
        time = bar.get_by_label("Time", exact=True)
        slider = bar.get_by_role("slider", name="Time of the playback")
        expect(time).to_have_value("4 s")
        expect(bar.get_by_role("button", name="Play (space)")).to_be_visible()
        expect(bar.get_by_role("note")).to_contain_text("were not recorded and are not shown")
        assert "Traffic" not in page.get_by_label("Follow a car").inner_text()  # nobody is followed who is not there

        bar.get_by_role("button", name=re.compile("Back by one sample, 20 ms")).click()
        expect(time).to_have_value("3.98 s")
        page.keyboard.press("<")
        expect(time).to_have_value("2.98 s")
        expect(slider).to_have_attribute("aria-valuenow", re.compile(r"^2\.9[78]"))
        time.fill("1.5")
        time.press("Enter")
        assert shown(client, run, 1.5)

        client.post("/api/scene", json={"scenario": sample.stem}).raise_for_status()  # as from another page
        assert not client.put("/api/scene/time", json={"run": run, "time": 1.5}).json()["shown"]
        bar.get_by_role("button", name=re.compile("On by one sample")).click()
        expect(time).to_have_value("1.52 s")
        until(lambda: shown(client, run, 1.52), "the run in the scene again")

        bar.get_by_role("combobox", name="Pace of the playback").select_option("8")
        bar.get_by_role("button", name="Play (space)").click()
        expect(time).to_have_value("4 s")  # by itself, and there it stops
        expect(bar.get_by_role("button", name="Play (space)")).to_be_visible()

        chart = page.locator(".u-over").first
        size = chart.bounding_box()
        chart.click(position={"x": 0.5 * size["width"], "y": 0.5 * size["height"]})
        expect(time).to_have_value(re.compile(r"^(1\.9|2(\.0)?)\d* s$"))

        page.get_by_role("tab", name="Events").click()
        event = page.get_by_test_id("events").get_by_role("button").last
        event.click()
        expect(time).to_have_value(re.compile(re.escape(event.text_content().removesuffix(" s").rstrip("0").rstrip("."))))
        expect(page.get_by_test_id("events").locator("[aria-current=time]")).to_have_count(1)
        assert complaints == []
        opened.close()


def shown(client, run, time):
    """Whether the scene shows this run, and no other; it does not go on by itself."""
    assert not client.put("/api/scene/time", json={"run": run + 1, "time": time}).json()["shown"]
    return client.put("/api/scene/time", json={"run": run, "time": time}).json()["shown"]
