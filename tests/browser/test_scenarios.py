"""Scenario files in a real browser: made, renamed, duplicated, deleted and brought back, imported, exported, edited as text, saved as."""

import base64
import re
import shutil
from pathlib import Path

import pytest
from playwright.sync_api import expect

from tests.browser.browser import browser, watched
from tests.server.server import served

SIZE = {"width": 1280, "height": 800}
DROP = """([content, name]) => {
  const bytes = Uint8Array.from(atob(content), (each) => each.charCodeAt(0));
  const dataTransfer = new DataTransfer();
  dataTransfer.items.add(new File([bytes], name));
  const over = { dataTransfer, bubbles: true, cancelable: true };
  document.querySelector("main").dispatchEvent(new DragEvent("dragenter", over));
  document.querySelector("main").dispatchEvent(new DragEvent("drop", over));
}"""


@pytest.fixture(scope="module")
def place(tmp_path_factory, sample):
    """A folder with maps and no scenario."""
    folder = tmp_path_factory.mktemp("scenarios")
    maps = folder / "scenarios" / "maps"
    maps.mkdir(parents=True)
    for name in ("urban_grid.osm", "berlin_siegessaeule_grosser_stern.osm.gz"):
        shutil.copy(sample.parent / "maps" / name, maps)
    return folder


@pytest.fixture(scope="module")
def view(place):
    """A page of a server at its scenarios, what its console complained about, and the server's client."""
    with browser() as opened, served(place) as (client, _, _):
        page, complaints = watched(opened, viewport=SIZE, color_scheme="light")
        page.goto(f"{client.base_url}/scenarios")
        yield page, complaints, client
        opened.close()


@pytest.fixture(scope="module")
def page(view):
    return view[0]


@pytest.fixture(scope="module")
def complaints(view):
    return view[1]


@pytest.fixture(scope="module")
def client(view):
    return view[2]


@pytest.fixture(scope="module")
def files(place) -> Path:
    return place / "scenarios"


def names(files) -> set[str]:
    return {path.name for path in files.glob("*.yaml")}


def row(page, title):
    """The row of a scenario."""
    return page.get_by_role("table", name="Scenarios").get_by_role("row").filter(has_text=title)


def choose(page, title, deed):
    """Chooses from the menu behind the button of a row."""
    page.get_by_role("button", name=f"What to do with {title}", exact=True).click()
    page.get_by_role("menuitem", name=deed).click()


def dialog(page, name):
    return page.get_by_role("dialog", name=name)


def drop(page, content: bytes, name: str):
    page.evaluate(DROP, [base64.b64encode(content).decode(), name])


def excused(complaints, *words):
    """What the browser itself says of refusals that were meant is taken away; anything else stays."""
    meant = [each for each in complaints if any(word in each for word in words)]
    for each in meant:
        complaints.remove(each)


def text_of(page):
    return page.get_by_role("textbox", name=re.compile("^Text of "))


def line(page, text):
    """A line in the editor."""
    return page.locator(".cm-line").filter(has_text=text)


def test_1_a_first_scenario_from_a_template(page, files):
    """An empty place says what to do; the new scenario opens in the studio."""
    expect(page.get_by_text("No scenarios yet")).to_be_visible()
    page.get_by_role("button", name="New scenario").click()
    asked = dialog(page, "New scenario")
    asked.get_by_label("Template").select_option(label="Platoon, CACC")
    asked.get_by_label("Map").select_option("urban_grid.osm")
    expect(asked.get_by_label("File name")).to_have_value("platoon_cacc_in_urban_grid")
    asked.get_by_label("Title").fill("My platoon")
    expect(asked.get_by_label("File name")).to_have_value("my_platoon")
    asked.get_by_label("File name").fill("../mine")
    expect(asked.get_by_text("A name leads to no other folder")).to_be_visible()
    expect(asked.get_by_role("button", name="Make it")).to_be_disabled()
    asked.get_by_label("File name").fill("mine")
    asked.get_by_role("button", name="Make it").click()
    expect(page).to_have_url(re.compile("/studio/mine$"))
    expect(page.get_by_role("combobox", name="Scenario")).to_have_value("mine")
    assert names(files) == {"mine.yaml"}


def test_2_the_list_and_another_name(page, files):
    """`g f` leads to the list; F2 renames, title and file at once."""
    page.locator("body").click(position={"x": 5, "y": 5})
    page.keyboard.press("g")
    page.keyboard.press("f")
    expect(page.get_by_role("heading", name="Scenarios")).to_be_visible()
    expect(row(page, "My platoon").get_by_role("link", name="urban_grid.osm")).to_be_visible()
    row(page, "My platoon").get_by_role("link", name="My platoon").focus()
    page.keyboard.press("F2")
    asked = dialog(page, "Rename My platoon")
    asked.get_by_label("Title").fill("Town platoon")
    asked.get_by_label("File name").fill("town platoon")
    page.keyboard.press("Enter")
    expect(row(page, "Town platoon")).to_be_visible()
    expect(asked).to_have_count(0)
    assert names(files) == {"town platoon.yaml"}


def test_3_duplicate_by_the_right_button(page, files):
    """A name that is taken is told while it is typed."""
    row(page, "Town platoon").click(button="right")
    page.get_by_role("menuitem", name="Duplicate").click()
    asked = dialog(page, "Duplicate Town platoon")
    expect(asked.get_by_label("File name")).to_have_value("town platoon_2")
    asked.get_by_label("File name").fill("Town Platoon")
    expect(asked.get_by_text("There is a scenario Town Platoon already.")).to_be_visible()
    asked.get_by_label("File name").fill("second")
    asked.get_by_label("Title").fill("Second platoon")
    asked.get_by_role("button", name="Duplicate").click()
    expect(row(page, "Second platoon")).to_be_visible()
    assert names(files) == {"town platoon.yaml", "second.yaml"}


def test_4_search_and_order(page):
    page.keyboard.press("/")
    page.keyboard.type("second")
    expect(row(page, "Town platoon")).to_have_count(0)
    expect(page).to_have_url(re.compile("q=second"))
    page.get_by_label("Search scenarios").fill("nothing like it")
    expect(page.get_by_text("No scenario matches")).to_be_visible()
    page.get_by_role("button", name="Clear the search").last.click()
    expect(row(page, "Town platoon")).to_be_visible()
    page.get_by_role("button", name="Changed").click()
    expect(page.get_by_role("columnheader", name="Changed")).to_have_attribute("aria-sort", "descending")


def test_5_delete_and_undo(page, files):
    """By the notice at once, by the list of deleted ones later; beside another of its name under a new one."""
    row(page, "Second platoon").get_by_role("link", name="Second platoon").focus()
    page.keyboard.press("Delete")
    expect(row(page, "Second platoon")).to_have_count(0)
    assert names(files) == {"town platoon.yaml"}
    page.get_by_role("button", name="Undo").click()
    expect(row(page, "Second platoon")).to_be_visible()
    choose(page, "Second platoon", "Delete")
    expect(row(page, "Second platoon")).to_have_count(0)
    (files / "second.yaml").write_text((files / "town platoon.yaml").read_text().replace("Town platoon", "Other platoon"))
    page.reload()
    page.get_by_text("Deleted (1)").click()
    page.get_by_role("button", name=re.compile("^Bring back second")).click()
    asked = dialog(page, "There is another scenario second now")
    expect(asked.get_by_label("File name")).to_have_value("second_2")
    asked.get_by_role("button", name="Bring it back under this name").click()
    expect(row(page, "Second platoon")).to_be_visible()
    assert names(files) == {"town platoon.yaml", "second.yaml", "second_2.yaml"}


def test_6_import_by_drop_and_by_button(page, files, sample, tmp_path, complaints):
    """What is no scenario is refused with its lines, and nothing is written."""
    good = sample.read_bytes()
    bad = good.replace(b"duration: 60", b"duration: -60")
    drop(page, bad, "bad.yaml")
    expect(page.get_by_role("alert").filter(has_text="bad.yaml was not taken")).to_contain_text("line 13, column 3")
    assert "bad.yaml" not in names(files)
    drop(page, b"\xff\xfe", "binary.yaml")
    expect(page.get_by_role("alert").filter(has_text="binary.yaml")).to_contain_text("is not a text")
    page.get_by_role("button", name="Close this message").click()
    (tmp_path / "stern.yaml").write_bytes(good)
    page.get_by_label("Scenario file", exact=True).set_input_files(tmp_path / "stern.yaml")
    expect(row(page, "Großer Stern platoon")).to_be_visible()
    assert (files / "stern.yaml").read_bytes() == good
    drop(page, good, "stern.yaml")
    asked = dialog(page, "There is a scenario stern already")
    asked.get_by_label("File name").fill("star")
    asked.get_by_role("button", name="Import under this name").click()
    expect(row(page, "star.yaml")).to_be_visible()
    excused(complaints, "422", "409")


def test_7_export(page, sample):
    page.get_by_role("button", name="What to do with Großer Stern platoon", exact=True).first.click()
    with page.expect_download() as download:
        page.get_by_role("menuitem", name="Download the file").click()
    assert download.value.suggested_filename in ("stern.yaml", "star.yaml")
    assert Path(download.value.path()).read_bytes() == sample.read_bytes()


def test_8_text_with_errors_at_their_lines(page, files, sample):
    """Comments are kept, Ctrl+S saves, and the form of the studio shows the new file."""
    page.get_by_role("button", name="What to do with Großer Stern platoon", exact=True).last.click()
    page.get_by_role("menuitem", name="Edit as text").click()
    expect(text_of(page)).to_be_focused()
    expect(page.get_by_text("No problem found")).to_be_visible()
    name = re.search(r"/scenarios/(\w+)/text", page.url)[1]
    line(page, "duration: 60").click()
    page.keyboard.press("End")
    page.keyboard.type("-")
    expect(page.get_by_test_id("text-state")).to_have_text("not saved")
    problems = page.get_by_role("list", name="Problems of this text")
    expect(problems).to_contain_text("clock.duration")
    expect(page.locator(".cm-lint-marker-error")).to_have_count(1)
    page.keyboard.press("Control+End")
    problems.get_by_role("button", name="Line 13").click()
    expect(page.locator(".cm-activeLine")).to_contain_text("duration: 60-")
    page.keyboard.press("Control+z")
    expect(page.get_by_test_id("text-state")).to_have_text("saved")
    expect(page.get_by_text("No problem found")).to_be_visible()
    page.keyboard.press("End")
    page.keyboard.press("Backspace")
    page.keyboard.type("5  # longer")
    page.keyboard.press("Control+s")
    expect(page.get_by_test_id("text-state")).to_have_text("saved")
    assert (files / f"{name}.yaml").read_text() == sample.read_text().replace("duration: 60", "duration: 65  # longer")
    page.get_by_role("link", name="Open in the studio").click()
    page.get_by_label("Search parameters").fill("clock.duration")
    expect(page.get_by_test_id("param-clock.duration")).to_have_value("65")
    page.get_by_label("Search parameters").fill("")


def test_9_unsaved_text_is_told_before_it_is_left(page, files):
    page.get_by_role("link", name="Scenarios", exact=True).click()
    choose(page, "Town platoon", "Edit as text")
    expect(page.get_by_text("No problem found")).to_be_visible()
    text_of(page).press("Control+Home")
    page.keyboard.type("# mine\n")
    page.get_by_role("link", name="Runs", exact=True).click()
    asked = dialog(page, "Leave without saving?")
    asked.get_by_role("button", name="Stay").click()
    expect(text_of(page)).to_contain_text("# mine")
    page.get_by_role("link", name="Runs", exact=True).click()
    asked.get_by_role("button", name="Save, then leave").click()
    expect(page).to_have_url(re.compile("/runs"))
    assert (files / "town platoon.yaml").read_text().startswith("# mine\n")


def test_a_somebody_else_has_written(page, files, complaints):
    """Nothing is lost of either side; the way on is the user's choice."""
    path = files / "second_2.yaml"
    page.get_by_role("link", name="Scenarios", exact=True).click()
    choose(page, "Second platoon", "Edit as text")
    expect(page.get_by_text("No problem found")).to_be_visible()
    text_of(page).press("Control+Home")
    page.keyboard.type("# mine\n")
    theirs = path.read_text().replace("seed: 1", "seed: 2")
    path.write_text(theirs)
    page.keyboard.press("Control+s")
    told = page.get_by_role("alert").filter(has_text="has changed meanwhile")
    expect(told).to_contain_text("seed")
    assert path.read_text() == theirs
    told.get_by_role("button", name="Save over theirs").click()
    expect(page.get_by_test_id("text-state")).to_have_text("saved")
    assert path.read_text().startswith("# mine\n") and "seed: 1" in path.read_text()
    text_of(page).press("Control+Home")
    page.keyboard.type("# more\n")
    path.unlink()
    page.keyboard.press("Control+s")
    told = page.get_by_role("alert").filter(has_text="There is no scenario")
    told.get_by_role("button", name="Write it again as second_2.yaml").click()
    expect(page.get_by_test_id("text-state")).to_have_text("saved")
    assert path.read_text().startswith("# more\n# mine\n")
    excused(complaints, "412", "404")


def test_b_the_form_over_its_file_and_as_another(page, files, sample):
    """What is saved is taken back by the notice; saved as another file the old one stays as it was, and the new one is shown."""
    path, before = files / "town platoon.yaml", (files / "town platoon.yaml").read_text()
    page.get_by_role("link", name="Scenarios", exact=True).click()
    row(page, "Town platoon").get_by_role("link", name="Town platoon").click()
    page.get_by_label("Search parameters").fill("parameters.headway")
    headway = page.get_by_test_id("param-applications.platoon.parameters.headway")
    headway.fill("0.9")
    headway.press("Control+s")
    expect(page.get_by_text("Nothing is changed from the scenario's file.")).to_be_visible()
    assert "headway: 0.9" in path.read_text() and path.read_text().startswith("# mine\n")
    expect(headway).to_have_value("0.9")
    page.get_by_role("alert").filter(has_text="Saved in town platoon.yaml").get_by_role("button", name="Undo").click()
    expect(page.get_by_test_id("changes")).to_contain_text("1 changed")
    expect(headway).to_have_value("0.9")
    assert path.read_text() == before
    page.get_by_role("button", name="Save as …").click()
    asked = dialog(page, "Save as another scenario")
    asked.get_by_label("Title").fill("Town platoon, wider")
    asked.get_by_label("File name").fill("wider")
    asked.get_by_role("button", name="Save").click()
    expect(page).to_have_url(re.compile("/studio/wider$"))
    page.get_by_label("Search parameters").fill("parameters.headway")
    expect(headway).to_have_value("0.9")
    expect(page.get_by_text("Nothing is changed from the scenario's file.")).to_be_visible()
    assert path.read_text() == before and "title: Town platoon, wider" in (files / "wider.yaml").read_text()


def test_c_the_console_is_clean(complaints):
    assert complaints == []
