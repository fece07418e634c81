"""What makes iterations easier to read, in a real browser: pins, axes, notes with times, ignored differences, tables, links to a view."""

import re

import pytest
from playwright.sync_api import expect

from tests.browser.browser import browser, watched
from tests.patience import until
from tests.server.server import served

HEADWAY = "applications.platoon.parameters.headway"
CAMERA = "() => document.querySelector('iframe[title=\"3D scene\"]')?.contentWindow?.__studioBridge?.camera?.() ?? null"


@pytest.fixture(scope="module")
def studio(tmp_path_factory, sample):
    """A page, and what its console complained about, with three runs of two seconds."""
    folder = tmp_path_factory.mktemp("ways")
    with browser() as opened, served(folder, "--scenarios", sample.parent) as (client, _, _):
        for run, headway in enumerate((0.6, 0.9, 1.2), 1):
            asked = {"scenario": sample.stem, "set": {"clock.duration": 2, HEADWAY: headway}, "parent": 1 if run > 1 else None}
            client.post("/api/runs", json=asked).raise_for_status()
            until(lambda run=run: client.get(f"/api/runs/{run}").json()["status"] == "done", "the end of the run")
        page, complaints = watched(opened, viewport={"width": 1280, "height": 800}, base_url=str(client.base_url))
        yield page, complaints
        opened.close()


@pytest.fixture(scope="module")
def page(studio):
    return studio[0]


def rows(page):
    return [int(each.get_attribute("data-run")) for each in page.locator("tr[data-run]").all()]


def is_seen_from(page, distance):
    """Whether the scene is up and is looked at from so far away [m]."""
    seen = page.evaluate(CAMERA)
    return seen is not None and round(seen["distance"]) == distance


def test_1_runs_are_pinned_on_top_whatever_is_filtered(page):
    page.goto("/runs")
    page.locator("tr[data-run='1']").focus()
    page.keyboard.press("p")
    expect(page.locator("tr[data-run='1']")).to_contain_text("pinned")
    assert rows(page) == [1, 3, 2]
    page.get_by_label("Filter the runs").fill("headway > 1")
    expect(page.locator("tr[data-run]")).to_have_count(2)
    page.reload()
    expect(page.locator("tr[data-run]")).to_have_count(2)
    assert rows(page) == [1, 3]
    page.get_by_role("button", name="Unpin 1").click()
    expect(page.locator("tr[data-run]")).to_have_count(1)


def test_2_axes_are_moved_flipped_and_made_logarithmic_by_keys(page):
    page.goto("/runs?as=space")
    titles = page.get_by_role("button", name=re.compile("^Axis "))
    expect(titles.first).to_have_accessible_name(re.compile("Headway"))
    before = [each.get_attribute("aria-label") for each in titles.all()]
    titles.first.focus()
    page.keyboard.press("f")
    expect(page.get_by_role("button", name="Axis Headway [s], flipped", exact=True)).to_be_visible()
    page.keyboard.press("l")
    expect(page.get_by_role("button", name="Axis Headway [s], flipped, logarithmic", exact=True)).to_be_visible()
    page.keyboard.press("ArrowRight")
    expect(titles.first).to_have_accessible_name(before[1])
    page.reload()
    expect(titles.nth(1)).to_have_accessible_name("Axis Headway [s], flipped, logarithmic")
    titles.nth(1).hover()  # as soon as it stands still
    page.mouse.down()
    page.mouse.move(5, titles.nth(1).bounding_box()["y"] + 6, steps=5)
    page.mouse.up()
    expect(titles.first).to_have_accessible_name("Axis Headway [s], flipped, logarithmic")


def test_2_no_title_is_drawn_before_there_is_room(page):
    """Until the browser says how wide the axes' room is, their titles would lie on one another, each a target of a few pixels."""
    page.goto("/runs")
    other, _ = watched(page.context.browser, viewport={"width": 1280, "height": 800}, base_url=page.url[: page.url.index("/", 8)])
    other.add_init_script("window.ResizeObserver = class { observe() {} unobserve() {} disconnect() {} }")
    other.goto("/runs?as=space")
    expect(other.get_by_test_id("space")).to_be_attached()
    expect(other.get_by_role("img", name=re.compile("^Parallel axes: ."))).to_be_attached()
    expect(other.get_by_role("button", name=re.compile("^Axis "))).to_have_count(0)
    other.close()


def test_3_a_note_leads_to_its_times_and_holds_no_html(page):
    page.goto("/runs/2")
    page.get_by_label("Note", exact=True).fill(
        "# Late\n**brakes** at @1.5 s <img src=x onerror=alert(1)>\n- [paper](https://example.org/a)"
    )
    form = page.get_by_role("form", name="Name, tags and note of run 2")
    save = form.get_by_role("button", name="Save")
    save.click()
    expect(save).to_be_disabled()  # it is kept now: nothing is left to save
    expect(save).not_to_have_attribute("data-loading", "true")
    read = page.get_by_role("region", name="The note as it is read")
    expect(read.locator("b")).to_have_text("brakes")
    expect(read).to_contain_text("<img src=x onerror=alert(1)>")
    assert read.locator("img").count() == 0
    expect(read.get_by_role("link", name="paper")).to_have_attribute("href", "https://example.org/a")
    page.goto("/runs")
    expect(page.locator("tr[data-run='2']")).to_contain_text("Late; brakes at @1.5 s")
    page.goto("/runs/2")
    read.get_by_role("button", name="@1.5 s").click()
    expect(page).to_have_url(re.compile(r"/studio/.*run=2"))
    expect(page.get_by_role("toolbar", name="Playback").get_by_label("Time", exact=True)).to_have_value(re.compile(r"^1\.5"))


def test_4_a_comparison_counts_goals_and_ignores_what_one_does_not_want_to_see(page):
    page.goto("/compare?runs=1,2")
    expect(page.get_by_test_id("compare-metrics").get_by_role("row", name=re.compile("^Goals met"))).to_contain_text(
        re.compile(r"\d of \d")
    )
    differing = page.get_by_test_id("compare-parameters")
    expect(differing.get_by_role("cell", name=re.compile("headway")).first).to_be_visible()
    page.get_by_label("Ignore").fill("applications.*")
    expect(differing).to_contain_text("1 difference is left out")
    expect(differing).to_contain_text("No parameter differs.")
    page.reload()
    expect(page.get_by_label("Ignore")).to_have_value("applications.*")
    expect(differing).to_contain_text("No parameter differs.")


def test_5_a_chart_is_a_table_too(page):
    page.goto("/runs/1")
    button = page.get_by_role("figure", name=re.compile("^Speed")).get_by_role("button", name="As table")
    button.focus()
    page.keyboard.press("Enter")
    table = page.get_by_role("dialog").get_by_role("table")
    expect(table.get_by_role("columnheader", name="Leader [m/s]")).to_be_visible()
    assert 2 <= table.get_by_role("row").count() <= 201
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_have_count(0)


def test_6_a_link_to_a_view_has_the_camera_in_it(page, sample):
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.goto(f"/studio/{sample.stem}?run=1&time=1&camera=free,,0.5,0.6,90,10,0,-20")
    until(lambda: is_seen_from(page, 90), "the camera of the link")
    seen = page.evaluate(CAMERA)
    assert seen["azimuth"] == pytest.approx(0.5, abs=0.01) and seen["polar"] == pytest.approx(0.6, abs=0.01)
    assert seen["at"] == pytest.approx([10, 0, -20], abs=0.1)
    page.get_by_role("button", name="Copy a link to this view").click()
    expect(page.get_by_role("alert").filter(has_text="The link is copied")).to_be_visible()
    link = page.evaluate("() => navigator.clipboard.readText()")
    assert "run=1" in link and "time=1" in link and "camera=" in link
    page.goto("/runs")
    page.goto(link)
    until(lambda: is_seen_from(page, 90), "the camera of the link")
    assert page.evaluate(CAMERA)["at"] == pytest.approx(seen["at"], abs=0.1)


def test_7_the_console_was_quiet(studio):
    assert studio[1] == []
