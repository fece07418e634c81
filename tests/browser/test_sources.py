"""An application written in the page, in a real browser: begun, corrected where it is told to be wrong, completed, saved, run.

What the browser's file dialog would give is a file of the test, which the page reads and writes as it would any that its user chose.
"""

import pytest
from playwright.sync_api import expect

from studio.workshop.draft import draft
from tests.browser.browser import browser, watched
from tests.patience import until
from tests.server.server import served

SIZE = {"width": 1280, "height": 800}
DISK = """
window.handle = (name) => ({
  name,
  getFile: async () => ({ text: () => window.readFile(name) }),
  createWritable: async () => {
    let all = '';
    return { write: async (part) => { all += part; }, close: () => window.writeFile(name, all) };
  },
});
window.showOpenFilePicker = async () => [window.handle('mine.py')];
window.showSaveFilePicker = async ({ suggestedName }) => window.handle(suggestedName);
"""


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with an application of one's own and a scenario that uses it."""
    folder = tmp_path_factory.mktemp("sources")
    draft("application", "mine", folder)
    return folder


@pytest.fixture(scope="module")
def studio(place):
    """A page that may write files of that folder, what its console complained about, and a client."""
    with browser() as opened, served(place, "--scenarios", place, "--kinds", place) as (client, _, _):
        page, complaints = watched(opened, viewport=SIZE, base_url=str(client.base_url))
        page.expose_function("readFile", lambda name: (place / name).read_text() if (place / name).exists() else "")
        page.expose_function("writeFile", lambda name, text: (place / name).write_text(text) and None)
        page.add_init_script(DISK)
        yield page, complaints, client
        opened.close()


@pytest.fixture(scope="module")
def page(studio):
    return studio[0]


@pytest.fixture(scope="module")
def text(page):
    return page.get_by_role("textbox", name="Source of mine")


def state(page):
    return page.get_by_test_id("source-state")


def run(client):
    """The hash of what a second of the scenario ends with."""
    begun = client.post("/api/live", json={"scenario": "mine", "set": {"clock.duration": 1}, "pace": "fast"}).raise_for_status()
    number = begun.json()["run"]
    until(lambda: client.get(f"/api/runs/{number}").json().get("status") == "done", f"the end of run {number}")
    return client.get(f"/api/runs/{number}").json()["state_hash"]


def go_to(page, words):
    """Puts the cursor behind words of the text, with the editor's search."""
    page.get_by_role("textbox", name="Source of mine").focus()
    page.keyboard.press("Control+f")
    find = page.get_by_role("textbox", name="Find")
    find.clear()
    find.press_sequentially(words)
    page.keyboard.press("Enter")
    page.keyboard.press("Escape")
    page.keyboard.press("ArrowRight")


def test_1_it_is_opened_from_the_kinds(page, studio, text):
    studio[2].usual = run(studio[2])
    page.goto("/kinds")
    entry = page.get_by_test_id("kind-application.mine")
    entry.locator("summary").first.click()
    entry.get_by_role("button", name="Source").click()
    entry.get_by_role("link", name="Edit mine").click()
    expect(text).to_contain_text("def decide(parameters, memory, sees):")
    expect(state(page)).to_have_text("saved")
    expect(page.get_by_text("Nothing is found wrong by reading.")).to_be_visible()


def test_2_what_is_wrong_is_told_at_its_line(page, text):
    go_to(page, "sees.own.set_speed")
    page.keyboard.type("_limit")
    wrong = page.get_by_role("list", name="What is wrong in this text")
    expect(wrong).to_contain_text("own has no set_speed_limit")
    expect(wrong).to_contain_text("did you mean 'set_speed'?")
    expect(page.locator(".cm-lint-marker-error")).to_have_count(1)
    line = wrong.get_by_role("button", name="Line").inner_text()
    wrong.get_by_role("button", name="Line").click()
    expect(page.locator(".cm-activeLineGutter").first).to_have_text(line.removeprefix("Line "))
    expect(state(page)).to_have_text("not saved")


def test_3_what_is_not_saved_comes_back(page, text):
    page.once("dialog", lambda dialog: dialog.accept())
    page.reload()
    expect(text).to_contain_text("sees.own.set_speed_limit")
    expect(state(page)).to_have_text("not saved")
    page.get_by_role("button", name="Back to the file").click()
    expect(state(page)).to_have_text("saved")


def test_4_the_contract_is_offered_and_explained(page, text):
    go_to(page, "def decide(parameters, memory, sees):")
    page.keyboard.press("End")
    page.keyboard.press("Enter")
    page.keyboard.type("a = sees.own.")
    offers = page.get_by_role("listbox")
    expect(offers).to_contain_text("yaw_rate")
    expect(offers).to_contain_text("[rad/s]")
    page.keyboard.type("yaw")
    expect(page.get_by_text("to the left").first).to_be_visible()
    offers.get_by_role("option", name="yaw_rate").click()  # by key only what has stood long enough to be read is taken
    expect(text).to_contain_text("a = sees.own.yaw_rate")
    page.keyboard.press("Control+z")
    page.get_by_role("button", name="Back to the file").click()


def test_5_saved_it_is_what_runs(page, studio, text, place):
    go_to(page, "min(max(u, -8.0), 2.0)")
    page.keyboard.type(" - 3.0")
    expect(page.get_by_text("Nothing is found wrong by reading.")).to_be_visible()
    page.keyboard.press("Control+s")
    expect(state(page)).to_have_text("saved")
    assert "2.0) - 3.0" in (place / "mine.py").read_text()
    studio[2].braking = run(studio[2])
    assert studio[2].braking != studio[2].usual


def test_6_a_version_that_does_not_load_is_told_and_does_not_run(page, studio, place):
    go_to(page, "headway: float = number(")
    page.keyboard.type("missing, ")
    page.keyboard.press("Control+s")
    expect(page.get_by_role("status").filter(has_text="The file does not load")).to_contain_text("'missing' is not defined")
    assert "missing" in (place / "mine.py").read_text()
    assert run(studio[2]) == studio[2].braking


def test_7_what_others_write_meanwhile_is_not_lost(page, text, place):
    page.get_by_role("textbox", name="Source of mine").press("Control+End")
    page.keyboard.type("# mine\n")
    theirs = (place / "mine.py").read_text().replace("missing, ", "") + "# theirs\n"
    (place / "mine.py").write_text(theirs)
    told = page.get_by_role("alert").filter(has_text="has changed on the disk")
    expect(told).to_be_visible()
    page.keyboard.press("Control+s")
    expect(told).to_be_visible()
    assert (place / "mine.py").read_text() == theirs
    expect(text).to_contain_text("# mine")
    told.get_by_role("button", name="Take the file's").click()
    expect(text).to_contain_text("# theirs")
    expect(told).to_have_count(0)
    expect(page.get_by_role("status").filter(has_text="The file does not load")).to_have_count(0)


def test_8_a_built_in_one_is_copied_and_becomes_ones_own(page, studio, place):
    page.goto("/source/acc")
    expect(state(page)).to_have_text("may be read only")
    page.get_by_role("button", name="Copy as my own").click()
    dialog = page.get_by_role("dialog", name="New application")
    expect(dialog.get_by_role("radio", checked=True)).to_have_count(1)
    dialog.get_by_role("textbox", name="Name").fill("acc")
    expect(dialog.get_by_text("There is an application acc already.")).to_be_visible()
    dialog.get_by_role("textbox", name="Name").fill("my_acc")
    dialog.get_by_role("button", name="Begin").click()
    expect(page.get_by_role("textbox", name="Source of my_acc")).to_contain_text("keeps a time gap with the own radar alone")
    page.get_by_role("button", name="Save as …").click()
    expect(page.get_by_role("button", name="Save", exact=True)).to_be_visible()
    expect(state(page)).to_have_text("saved")
    assert "def keep_gap" in (place / "my_acc.py").read_text()
    assert "my_acc" in [each["name"] for each in studio[2].get("/api/kinds").json()["kinds"]]


def test_9_where_nothing_can_be_written_it_is_told(page):
    page.add_init_script("delete window.showSaveFilePicker")
    page.goto("/source/mine")
    expect(page.get_by_text("This browser cannot write files")).to_be_visible()
    with page.expect_download() as found:
        page.get_by_role("button", name="Download", exact=True).click()
    assert found.value.suggested_filename == "mine.py"


def test_the_console_is_clean(studio):
    assert studio[1] == []
