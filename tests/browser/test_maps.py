"""Maps in a real browser: drop a file, see it come in, see the place, correct what was guessed, drive there."""

import base64
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import expect

from tests.browser.browser import browser, drawn, pixels, watched
from tests.patience import until
from tests.server.server import served

SIZE = {"width": 1280, "height": 760}
REFERENCE = Path(__file__).parents[1] / "reference" / "maps"
SEATTLE, PERTH = "seattle_triangle_small", "perth_peanut_roundabout_lht"
ASPHALT, BUILDING, GREEN = (134, 140, 149), (207, 200, 191), (207, 229, 195)  # of the light plan
SELECTED = (28, 126, 214)

DROP = """([content, name]) => {
  const bytes = Uint8Array.from(atob(content), (each) => each.charCodeAt(0));
  const dataTransfer = new DataTransfer();
  dataTransfer.items.add(new File([bytes], name));
  const over = { dataTransfer, bubbles: true, cancelable: true };
  document.querySelector("main").dispatchEvent(new DragEvent("dragenter", over));
  window.dropped = () => document.querySelector("main").dispatchEvent(new DragEvent("drop", over));
}"""

# Notes what the page tells of imports: on a slow machine one may be over before anybody looks.
NOTE = """window.told = [];
const note = () => {
  for (const { textContent } of document.querySelectorAll('[data-testid="map-job"]')) window.told.push(textContent);
};
new MutationObserver(note).observe(document, { subtree: true, childList: true, characterData: true });"""


@pytest.fixture(scope="module")
def place(tmp_path_factory, sample):
    """A folder of scenarios with the sample, which imports may be put into."""
    folder = tmp_path_factory.mktemp("maps")
    (folder / "scenarios" / "maps").mkdir(parents=True)
    shutil.copy(sample, folder / "scenarios")
    shutil.copy(sample.parent / "maps" / "berlin_siegessaeule_grosser_stern.osm.gz", folder / "scenarios" / "maps")
    return folder


@pytest.fixture(scope="module")
def maps(place):
    """A page of a server, at its maps, and what its console complained about."""
    with browser() as opened, served(place) as (client, _, _):
        page, complaints = watched(opened, viewport=SIZE, color_scheme="light")
        page.add_init_script(NOTE)
        page.goto(f"{client.base_url}/maps")
        yield page, complaints
        opened.close()


@pytest.fixture(scope="module")
def page(maps):
    return maps[0]


def drop(page, path: Path):
    """Drops a file on the view, after a look at what it says while the file is held over it."""
    page.evaluate(DROP, [base64.b64encode(path.read_bytes()).decode(), path.name])
    expect(page.get_by_test_id("drop-veil")).to_be_visible()
    page.evaluate("window.dropped()")
    expect(page.get_by_test_id("drop-veil")).to_have_count(0)


def plan(page) -> np.ndarray:
    """The picture of the plan, when it stands still."""
    pictures = [looked(page)]

    def still():
        pictures.append(looked(page))
        return np.array_equal(*pictures[-2:])

    until(still, "the plan to come to rest")
    return pictures[-1]


def looked(page) -> np.ndarray:
    """The picture of the plan, with all that was to be drawn when it was asked for."""
    drawn(page)
    return pixels(page.get_by_test_id("plan").screenshot())


def share(picture, colour) -> float:
    """How much of a picture has this colour."""
    return float((np.abs(picture - np.array(colour)).max(axis=2) <= 3).mean())


def inside(picture, colour, reach) -> tuple[int, int]:
    """Column and row in the middle of a patch of this colour, `reach` pixels to each side."""
    has = np.abs(picture - np.array(colour)).max(axis=2) <= 3
    whole = np.lib.stride_tricks.sliding_window_view(has, (2 * reach + 1, 2 * reach + 1)).all(axis=(2, 3))
    rows, columns = np.nonzero(whole)
    assert len(rows), "there is no such patch"
    # In the middle of all, so that nothing that lies over the plan is in the way.
    middle = np.argmin(np.hypot(rows - whole.shape[0] / 2, columns - whole.shape[1] / 2))
    return int(columns[middle]) + reach, int(rows[middle]) + reach


def click_plan(page, column, row):
    page.get_by_test_id("plan").click(position={"x": column, "y": row})


def row(page, text):
    """The first finding whose row has this text."""
    return page.get_by_test_id("finding-row").filter(has_text=text).first


def details(page):
    return page.get_by_test_id("details")


def corrected(page):
    """Sends the correction in the form, and waits until the map was imported again."""
    before = page.evaluate("told.length")
    page.get_by_test_id("correct").click()
    page.wait_for_function("before => told.length > before", arg=before)
    expect(page.get_by_test_id("map-job")).to_have_count(0)


def test_1_a_dropped_file_becomes_a_map(page):
    """What is being done is told; then the map opens by itself, with its numbers and its source."""
    expect(page.get_by_test_id("map-row")).to_have_count(1)
    drop(page, REFERENCE / f"{SEATTLE}.osm.gz")
    page.wait_for_url(f"**/maps/{SEATTLE}*")
    told = page.evaluate("told")
    assert any(SEATTLE in each and re.search(r"\d s", each) for each in told), told
    summary = page.get_by_test_id("map-summary")
    expect(summary).to_contain_text("right")
    expect(summary).to_contain_text("2 of 4")
    expect(summary).to_contain_text("5 of 5")
    expect(page.get_by_test_id("map-attribution")).to_have_text("© OpenStreetMap contributors")
    expect(page.get_by_test_id("scale-bar")).to_have_text(re.compile(r"\d+ m"))


def test_2_the_plan_shows_the_place(page):
    until(lambda: share(looked(page), ASPHALT) > 0.04, "roads in the plan")
    picture = plan(page)
    assert share(picture, ASPHALT) > 0.04 and share(picture, BUILDING) > 0.04 and share(picture, GREEN) > 0.004


def test_3_the_plan_is_moved_and_enlarged(page):
    canvas = page.get_by_test_id("plan")
    canvas.focus()
    page.keyboard.press("f")
    whole = plan(page)
    page.keyboard.press("ArrowRight")
    moved = plan(page)
    step = round(0.15 * whole.shape[1])
    # The same picture, further to the left; the controls over it stay where they are.
    assert np.abs(moved[120:-40, 150:400] - whole[120:-40, 150 + step : 400 + step]).mean() < 1.5
    page.keyboard.press("f")
    assert np.abs(plan(page) - whole).mean() < 0.01
    canvas.hover()
    page.mouse.wheel(0, -480)
    until(lambda: share(looked(page), ASPHALT) > 1.3 * share(whole, ASPHALT), "a larger plan")
    page.keyboard.press("f")


def test_4_rows_and_marks_lead_to_each_other(page):
    row(page, "signal").click()
    expect(details(page)).to_contain_text("Because")
    picture = plan(page)
    height, width = picture.shape[:2]
    ring = picture[height // 2 - 22 : height // 2 + 22, width // 2 - 22 : width // 2 + 22]
    assert share(ring, SELECTED) > 0.01, "the mark is not in the middle of the plan"
    page.keyboard.press("Escape")
    expect(details(page)).to_have_count(0)
    click_plan(page, width // 2, height // 2)
    expect(row(page, "signal")).to_have_attribute("aria-selected", "true")


def test_5_the_keyboard_moves_through_the_table(page):
    page.keyboard.press("Escape")
    row(page, "height").focus()
    page.keyboard.press("Home")
    first = page.get_by_test_id("finding-row").nth(0)
    expect(first).to_have_attribute("aria-selected", "true")
    page.keyboard.press("ArrowDown")
    expect(page.get_by_test_id("finding-row").nth(1)).to_be_focused()
    expect(first).to_have_attribute("aria-selected", "false")


def test_6_filters_count_and_hide(page):
    """The table says how many rows it has; only those near what is seen are drawn."""
    table, chip = page.get_by_test_id("findings"), page.get_by_test_id("filters").get_by_role("button", name=re.compile(r"^Height \d+$"))
    every, height = int(table.get_attribute("aria-rowcount")), int(re.search(r"\d+", chip.inner_text())[0])
    assert 0 < height < every
    chip.click()
    expect(table).to_have_attribute("aria-rowcount", str(every - height))
    chip.click()
    expect(table).to_have_attribute("aria-rowcount", str(every))


def test_7_a_road_is_corrected_where_it_is_clicked(page):
    """Its limit in the plan and in the report; the correction is the map's from then on."""
    page.keyboard.press("Escape")
    page.keyboard.press("f")
    column, line = inside(plan(page), ASPHALT, 3)
    click_plan(page, column, line)
    expect(details(page)).to_contain_text("km/h")
    limit = page.get_by_test_id("edit-speed-limit")
    assert limit.input_value() != "60"
    limit.fill("60")
    corrected(page)
    expect(details(page)).to_contain_text("maxspeed = 60")
    expect(page.get_by_test_id("filters").get_by_role("button", name="Corrected 1")).to_be_visible()


def test_8_a_value_out_of_range_is_told_and_not_sent(page):
    page.get_by_test_id("edit-width-of-a-lane").fill("9")
    expect(page.get_by_test_id("correction").get_by_role("alert")).to_contain_text("2.5 to 4.5 m")
    expect(page.get_by_test_id("correct")).to_be_disabled()
    page.keyboard.press("Escape")


def test_9_a_guess_is_corrected_and_taken_back(page):
    """It is a correction then, also after the page was loaded anew; taken back, it is the guess again."""
    drop(page, REFERENCE / f"{PERTH}.osm.gz")
    page.get_by_role("link", name=PERTH).click()
    summary = page.get_by_test_id("map-summary")
    expect(summary).to_contain_text("left")
    expect(summary).to_contain_text("more guessed")
    guessed = int(re.search(r"(\d+) more guessed", summary.inner_text())[1])
    page.get_by_label("Search the findings").fill("speed limit")
    row(page, "speed limit").click()
    expect(details(page)).to_contain_text("medium")
    page.get_by_test_id("edit-speed-limit").fill("30")
    corrected(page)
    expect(details(page)).to_contain_text("the map says no maxspeed")
    expect(summary).to_contain_text(f"{guessed - 1} more guessed")
    page.reload()
    expect(details(page)).to_contain_text("maxspeed = 30")
    page.get_by_test_id("take-back").click()
    expect(summary).to_contain_text(f"{guessed} more guessed")
    expect(details(page)).to_contain_text("Speed limit")


def test_a_map_is_deleted_after_a_question(page):
    page.get_by_role("button", name="Delete").click()
    page.get_by_test_id("delete-map").click()
    expect(page.get_by_test_id("map-row")).to_have_count(2)
    expect(page.get_by_test_id("maps-table")).not_to_contain_text(PERTH)


def test_b_a_broken_file_is_told_and_nothing_is_lost(page, tmp_path):
    broken = tmp_path / "broken.osm.gz"
    broken.write_bytes((REFERENCE / f"{SEATTLE}.osm.gz").read_bytes()[:2000])
    drop(page, broken)
    failed = page.get_by_test_id("import-failed")
    expect(failed).to_contain_text("broken")
    expect(failed.get_by_role("button", name="Try again")).to_be_visible()
    expect(page.get_by_test_id("map-row")).to_have_count(2)
    failed.get_by_role("button", name="Dismiss").click()
    expect(failed).to_have_count(0)


def test_c_an_upload_is_cancelled(page):
    """How much is sent is told; cancelled, nothing of it is there, and the same file can be chosen again."""
    line = page.context.new_cdp_session(page)
    slow = {"offline": False, "latency": 0, "downloadThroughput": -1, "uploadThroughput": 400}
    line.send("Network.emulateNetworkConditions", slow)
    for _ in range(2):
        page.get_by_test_id("file-input").set_input_files(REFERENCE / f"{SEATTLE}.osm.gz")
        expect(page.get_by_test_id("map-job-stage")).to_contain_text(re.compile(r"sending \d+ %"))
        page.get_by_test_id("cancel-import").click()
        expect(page.get_by_test_id("map-job")).to_have_count(0)
    line.send("Network.emulateNetworkConditions", slow | {"uploadThroughput": -1})
    expect(page.get_by_test_id("map-row")).to_have_count(2)


def test_d_it_is_dark_when_the_page_is(page):
    page.keyboard.press("g")
    page.keyboard.press("m")
    page.get_by_role("link", name=SEATTLE).click()
    until(lambda: share(looked(page), ASPHALT) > 0.04, "roads in the plan")
    light = plan(page).mean()
    page.get_by_test_id("theme-toggle").click()
    until(lambda: looked(page).mean() < light, "another plan")
    assert plan(page).mean() < 90 < 180 < light


def test_e_one_drives_there(page):
    """The studio opens with a scenario on this map, which can be run."""
    page.get_by_test_id("drive-here").click()
    page.wait_for_url(f"**/studio/{SEATTLE}*")
    expect(page.get_by_test_id("scenario")).to_have_value(re.compile(SEATTLE))
    page.get_by_test_id("pace").select_option("fast")
    page.get_by_test_id("run").click()
    expect(page.get_by_test_id("history-row").first).to_contain_text("done")


def test_the_console_is_clean(maps):
    assert maps[1] == []
