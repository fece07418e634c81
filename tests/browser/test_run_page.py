"""The page of a run in a real browser: whom its measures are about, and why something happened."""

from playwright.sync_api import expect

from tests.browser.browser import browser, watched
from tests.patience import until
from tests.server.server import served

BRAKE = {"script.hard_brake.do.deceleration": 8, "script.hard_brake.when.at": 0.2, "clock.duration": 3}


def test_whom_and_why(tmp_path, sample):
    """A leader that brakes with 8 m/s²: the least gap says behind whom, the hard brake opens and tells what was known."""
    with browser() as opened, served(tmp_path, "--scenarios", sample.parent) as (client, _, _):
        run = client.post("/api/runs", json={"scenario": sample.stem, "set": BRAKE}).json()["run"]
        until(lambda: client.get(f"/api/runs/{run}").json()["status"] == "done", "the end of the run")
        page, complaints = watched(opened, viewport={"width": 1100, "height": 900})
        page.goto(f"{client.base_url}/runs/{run}")
        expect(page.get_by_test_id("metrics")).to_contain_text("follower_1 behind leader at")
        listed = page.get_by_test_id("explanations")
        expect(listed).to_contain_text("brakes hard, with up to")
        lines = listed.get_by_text("follower 1 knew leader by front")
        expect(lines.first).to_be_hidden()
        listed.locator("summary", has_text="Follower 1").first.click()
        expect(lines.first).to_be_visible()
        assert complaints == []
        opened.close()
