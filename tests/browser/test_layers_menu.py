"""Layers over the scene, in a real browser: switched in a menu, remembered, for a run that goes on and one that is played back."""

import re

from playwright.sync_api import expect

from tests.browser.browser import browser, drawn, pixels, watched
from tests.patience import until
from tests.server.server import served

SHORT = {"clock.duration": 4, "script.hard_brake.when.at": 1}
REST = """async () => {
    const frames = () => window.__viserTestpoints.rendererInfo.render.frame;
    const before = frames();
    await new Promise((resolve) => setTimeout(resolve, 3000));
    return frames() - before;
}"""


def test_layers_are_drawn_switched_and_remembered(tmp_path, sample):
    """What stands in the label of what is drawn, and that the picture is another."""
    with browser() as opened, served(tmp_path, "--scenarios", sample.parent) as (client, _, _):
        run = client.post("/api/runs", json={"scenario": sample.stem, "set": SHORT}).json()["run"]
        until(lambda: client.get(f"/api/runs/{run}").json()["status"] == "done", "the end of the run")
        page, complaints = watched(opened, viewport={"width": 1280, "height": 800})
        page.goto(f"{client.base_url}/studio/{sample.stem}?run={run}")
        scene = page.frame_locator("iframe[title='3D scene']")
        layers = scene.get_by_role("img", name=re.compile("^Layers: "))
        menu = page.get_by_role("button", name="Layers")
        page.get_by_role("combobox", name="Follow a car").select_option(label="Follower 2")
        expect(layers).to_have_attribute("aria-label", re.compile(r"lamps \d+, names [1-5]"))
        bar = page.get_by_role("toolbar", name="Playback")
        time = bar.get_by_label("Time", exact=True)
        time.fill("1.8")
        time.press("Enter")
        expect(layers).to_have_attribute("aria-label", re.compile("lamps [1-9]"))  # they brake

        frame = next(each for each in page.frames if "/scene/" in each.url)
        until(lambda: frame.evaluate(REST) == 0, "the scene to rest")  # while a car is followed
        before = pixels(page.get_by_test_id("scene-frame").screenshot())
        menu.click()
        for name in ("Gaps to the car ahead", "Sensors and what they see", "Messages", "Speed as colour", "Planned ways", "Trails"):
            page.get_by_role("checkbox", name=name).check()
        page.keyboard.press("Escape")
        shown = r"speed [1-5], trails 5, paths 5, sensors \d, gaps [4-5], messages [1-9]\d*, lamps [1-9]\d*, names [1-5]"
        expect(layers).to_have_attribute("aria-label", re.compile(shown))
        drawn(page)
        after = pixels(page.get_by_test_id("scene-frame").screenshot())
        assert (abs(after - before).max(axis=2) > 20).mean() > 0.01
        assert frame.evaluate(REST) == 0  # a layer alone has nothing drawn again in three dimensions

        page.reload()
        expect(layers).to_have_attribute("aria-label", re.compile(r"speed [1-5], .*messages \d+"))
        menu.click()
        expect(page.get_by_role("checkbox", name="Messages")).to_be_checked()
        page.keyboard.press("Escape")

        page.get_by_role("button", name="Run again").click()
        page.get_by_text("is done").first.wait_for()
        expect(layers).to_have_attribute("aria-label", re.compile("speed [1-5], .*gaps [4-5]"))
        assert complaints == []
        opened.close()


def test_before_a_run_the_menu_says_what_there_is_nothing_of(tmp_path, sample):
    """And never the city before under a new title."""
    with browser() as opened, served(tmp_path, "--scenarios", sample.parent) as (client, _, _):
        page, complaints = watched(opened, viewport={"width": 1280, "height": 800})
        page.goto(f"{client.base_url}/studio/{sample.stem}")
        loading = page.get_by_role("status", name="The scene is loading")
        expect(loading).to_contain_text("Großer Stern platoon")
        expect(loading).to_have_count(0)
        page.get_by_role("button", name="Layers").click()
        panel = page.get_by_role("dialog", name="Layers", exact=True)
        expect(panel.get_by_text("Not shown: nothing of it before a run")).to_have_count(9)
        page.keyboard.press("Escape")
        page.get_by_role("combobox", name="Scenario").select_option("parking_deck")
        expect(loading).to_contain_text("Parking deck")
        expect(loading).to_have_count(0)
        assert complaints == []
        opened.close()
