"""Iterations in a real browser: filtered by an expression, plotted, as a tree, on a board, several compared, found by the palette."""

import re

import pytest
from playwright.sync_api import expect

from tests.browser.browser import browser, watched
from tests.patience import until
from tests.server.server import served

SIZE = {"width": 1280, "height": 800}
HEADWAY = "applications.platoon.parameters.headway"


@pytest.fixture(scope="module")
def studio(tmp_path_factory, sample):
    """A page, what its console complained about, and a client, with a run, three children, and a grandchild with another application."""
    folder = tmp_path_factory.mktemp("iterations")
    short = {"clock.duration": 2}
    made = [
        ({}, None),
        ({HEADWAY: 0.4}, 1),
        ({HEADWAY: 0.9}, 1),
        ({HEADWAY: 1.2}, 1),
        ({HEADWAY: 0.9, "applications.platoon.parameters.standstill": 4}, 3),
        ({"applications.platoon.application": "acc"}, 3),
    ]
    with browser() as opened, served(folder, "--scenarios", sample.parent) as (client, _, _):
        for run, (changes, parent) in enumerate(made, 1):
            asked = {"scenario": sample.stem, "set": short | changes, "parent": parent}
            client.post("/api/runs", json=asked).raise_for_status()
            until(lambda run=run: client.get(f"/api/runs/{run}").json()["status"] == "done", "the end of the run")
        page, complaints = watched(opened, viewport=SIZE, color_scheme="light", base_url=str(client.base_url))
        yield page, complaints, client
        opened.close()


@pytest.fixture(scope="module")
def page(studio):
    return studio[0]


def rows(page):
    return [int(each.get_attribute("data-run")) for each in page.locator("tr[data-run]").all()]


def test_1_an_expression_filters(page):
    page.goto("/runs")
    expect(page.locator("tr[data-run]")).to_have_count(6)
    page.keyboard.press("/")
    page.keyboard.type("headway < 0.8 and not application = acc")
    expect(page.locator("tr[data-run]")).to_have_count(2)
    assert rows(page) == [2, 1]
    field = page.get_by_label("Filter the runs")
    field.fill("headwy < 0.8")
    expect(page.get_by_test_id("filter-wrong")).to_contain_text("did you mean headway?")
    expect(page.locator("tr[data-run]")).to_have_count(6)  # what cannot be read hides nothing
    page.get_by_role("button", name="What the filter can say").click()
    page.get_by_role("button", name="failed", exact=True).click()
    expect(field).to_have_value("failed")
    expect(page.get_by_text("No run matches “failed”")).to_be_visible()
    page.keyboard.press("Escape")
    page.get_by_role("button", name="Clear the filter").click()
    expect(page.locator("tr[data-run]")).to_have_count(6)


def test_2_the_rows_are_tinted_against_a_baseline(page):
    page.locator("tr[data-run='1']").focus()
    page.keyboard.press("b")
    expect(page.locator("tr[data-run='1']")).to_contain_text("baseline")
    expect(page).to_have_url(re.compile(r"base=1"))
    assert page.locator("tr[data-run='4'] [data-stand=better], tr[data-run='4'] [data-stand=worse]").count() > 0
    assert page.locator("tr[data-run='1'] [data-stand]").count() == 0
    page.reload()
    expect(page.locator("tr[data-base]")).to_have_attribute("data-run", "1")
    assert rows(page)[0] == 1  # it stands first


def test_2_columns_are_hidden_and_moved_and_it_is_remembered(page):
    heads = page.locator("thead tr:nth-child(2) th")
    page.get_by_role("button", name="Columns").click()
    page.get_by_label("Find a column").fill("headway")
    page.get_by_role("button", name="Headway [s] first").click()
    page.get_by_label("Find a column").fill("created")
    page.get_by_role("checkbox", name="Created").uncheck()
    page.keyboard.press("Escape")
    expect(page.get_by_role("button", name="Columns (1 hidden)")).to_be_visible()
    page.reload()
    expect(page.locator("tr[data-run]")).to_have_count(6)
    expect(heads.filter(has_text="Headway [s]")).to_have_count(1)  # units come a moment after the runs
    names = [each.inner_text() for each in heads.all()]
    assert "Created" not in names and names.index("Headway [s]") < names.index("Application")
    page.get_by_role("button", name="Columns (1 hidden)").click()
    page.get_by_role("button", name="As it was").click()
    page.keyboard.press("Escape")
    expect(page.get_by_role("button", name="Columns", exact=True)).to_be_visible()


def test_2_columns_are_pinned_at_the_left_and_lie_beside_each_other(page):
    """By the menu and by a key; scrolled to the side, each begins where the one before it ends, whatever is hidden or grows."""
    page.set_viewport_size({"width": 700, "height": 800})
    page.get_by_role("button", name="Columns").click()
    page.get_by_label("Find a column").fill("headway")
    page.get_by_role("button", name="Pin Headway [s]").click()
    expect(page.get_by_role("button", name="Pin Headway [s]")).to_have_attribute("aria-pressed", "true")
    page.keyboard.press("Escape")
    page.get_by_role("columnheader", name="Standstill").get_by_role("button").focus()
    page.keyboard.press("p")
    expect(page.get_by_role("columnheader", name="Pinned")).to_be_visible()
    page.reload()
    expect(page.locator("tr[data-run]")).to_have_count(6)
    heads = page.locator("thead tr:nth-child(2) th")
    expect(heads.nth(2)).to_contain_text("Headway [s]")  # units come a moment after the runs
    expect(heads.nth(3)).to_contain_text("Standstill")
    side_by_side(page)
    page.get_by_role("button", name="Columns").click()
    page.get_by_label("Find a column").fill("headway")
    page.get_by_role("checkbox", name="Headway [s]").uncheck()
    page.keyboard.press("Escape")
    expect(heads.nth(2)).to_contain_text("Standstill")
    side_by_side(page)
    page.get_by_role("button", name="Columns (1 hidden)").click()
    page.get_by_role("button", name="As it was").click()
    page.keyboard.press("Escape")
    expect(page.get_by_role("columnheader", name="Pinned")).to_have_count(0)
    page.set_viewport_size(SIZE)


def side_by_side(page):
    """Scrolled to the end, the first columns stand at the table's left edge without a gap or an overlap, head and cells alike."""
    table = page.get_by_test_id("runs-table")
    table.evaluate("each => { each.parentElement.scrollLeft = 1e6; }")
    assert table.evaluate("each => each.parentElement.scrollLeft") > 100
    staying = table.evaluate(
        """each => [...each.querySelectorAll("thead tr:nth-child(2), tr[data-run='2']")].map((row) =>
            [...row.children].filter((cell) => cell.matches(":first-child, [data-sticky]")).map((cell) => cell.getBoundingClientRect())
                .map(({ left, right }) => [left, right]))"""
    )
    edge = table.evaluate("each => each.parentElement.getBoundingClientRect().left")
    for row in staying:
        assert len(row) >= 3
        begins, ends = [left for left, _ in row], [right for _, right in row]
        assert begins == pytest.approx([edge, *ends[:-1]], abs=0.6)


def test_2_a_channel_in_one_number_is_a_column(studio):
    """Added by the same fields as on the page of a run, filled while one looks, sorted, filtered, remembered, and taken out again."""
    page, _, client = studio
    page.goto("/runs")
    page.get_by_role("button", name=re.compile("^Columns")).click()
    page.get_by_role("button", name="Add a column: a channel's aggregate").click()
    form = page.get_by_role("dialog", name="A column: a channel's aggregate")
    form.get_by_role("combobox", name="Channel").fill("follower_2.gap")
    page.get_by_role("option", name="follower_2.gap [m]").click()
    form.get_by_label("Number").select_option("Mean")
    form.get_by_label("From [s]").fill("0.5")
    form.get_by_role("button", name="Add the column").click()
    name, title = "follower_2.gap.mean@0.5..", "follower_2.gap mean, from 0.5 s [m]"
    head = page.get_by_role("columnheader", name=title)
    expect(head).to_be_visible()
    place = (
        page.locator("thead tr")
        .nth(1)
        .locator("th")
        .evaluate_all("(all, is) => all.findIndex(({textContent}) => textContent === is)", title)
    )
    cells = page.locator("tr[data-run]").locator(f"td:nth-child({place + 1})")
    expect(cells.filter(has_text="…")).to_have_count(0)
    (told,) = client.get("/api/aggregates", params={"runs": 1, "channel": "follower_2.gap", "begin": 0.5}).json()
    mean = next(each["value"] for each in told["aggregates"] if each["kind"] == "mean")
    assert float(cells.last.inner_text()) == pytest.approx(mean, rel=1e-3)
    head.get_by_role("button").click()
    expect(head).to_have_attribute("aria-sort", re.compile("ascending|descending"))
    page.get_by_label("Filter the runs").fill(f"{name} > 1000")
    expect(page.get_by_text("No run matches")).to_be_visible()
    page.get_by_label("Filter the runs").fill(f"{name} < 1000")
    expect(page.locator("tr[data-run]")).to_have_count(6)
    page.goto("/runs")
    expect(head).to_be_visible()
    with page.expect_download() as kept:
        page.get_by_role("button", name="Export", exact=True).click()
        page.get_by_role("menuitem", name="CSV").click()
    assert f"channel.{name} [m]" in kept.value.path().read_text().splitlines()[0]
    page.get_by_role("button", name=re.compile("^Columns")).click()
    page.get_by_role("button", name=f"Remove {title}").click()
    expect(head).to_have_count(0)
    page.get_by_role("button", name="As it was").click()


def test_3_a_stroke_along_an_axis_is_the_filter(page):
    page.goto("/runs")
    page.get_by_text("Plot", exact=True).click()
    axis = page.locator("[data-axis$=headway]")
    line = axis.locator("rect").first.bounding_box()
    middle = line["x"] + line["width"] / 2
    page.mouse.move(middle, line["y"] - 4)  # above the axis is its end
    page.mouse.down()
    page.mouse.move(middle, line["y"] + line["height"] * 0.45, steps=4)
    page.mouse.up()
    expect(page.get_by_label("Filter the runs")).to_have_value(re.compile(r"^headway >= 0\.\d+ and headway <= 1\.\d+$"))
    expect(page.locator("tr[data-run]")).to_have_count(3)
    assert sorted(rows(page)) == [3, 4, 5]
    page.mouse.click(middle, line["y"] + line["height"] * 0.2)
    expect(page.get_by_label("Filter the runs")).to_have_value("")
    expect(page.locator("tr[data-run]")).to_have_count(6)
    page.get_by_text("Each pair").click()
    cell = page.get_by_role("img", name=re.compile("over Headway")).first
    expect(cell).to_be_visible()
    box = cell.bounding_box()
    page.mouse.move(box["x"] + 1, box["y"] + 1)
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"] * 0.4, box["y"] + box["height"] - 1, steps=4)
    page.mouse.up()
    expect(page.get_by_label("Filter the runs")).to_have_value(re.compile(r"^headway >= .* and \S+ >= .* and \S+ <= \S+$"))
    page.get_by_label("Filter the runs").fill("")


def test_3_what_is_plotted_is_a_table_too(page):
    page.get_by_role("button", name="As table").focus()
    page.keyboard.press("Enter")
    table = page.get_by_role("dialog").get_by_role("table")
    expect(table.get_by_role("columnheader", name="Headway [s]")).to_be_visible()
    expect(table.get_by_role("row")).to_have_count(1 + 6)
    expect(table.get_by_role("row", name=re.compile("^#2 "))).to_contain_text("0.4")
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_have_count(0)


def test_4_the_lineage_says_what_was_changed(page):
    page.get_by_text("Lineage", exact=True).click()
    tree = page.get_by_role("tree", name="Lineage of the runs")
    expect(tree.get_by_role("treeitem")).to_have_count(6)
    assert [each.get_attribute("data-run") for each in tree.get_by_role("treeitem").all()] == list("123564")
    expect(tree.locator("[data-run='2']")).to_contain_text("headway 0.6 0.4")
    expect(tree.locator("[data-run='6']")).to_contain_text("application cacc acc")
    assert tree.locator("[data-run='5']").get_attribute("aria-level") == "3"
    expect(tree.locator("[data-run='1']")).to_contain_text("5 descend from it")


def test_5_a_card_is_carried_to_another_verdict(page, studio):
    page.get_by_text("Board", exact=True).click()
    card = page.get_by_role("article", name="Run 3")
    card.drag_to(page.get_by_role("region", name="Candidates"))
    dialog = page.get_by_role("dialog", name="Verdict on run #3")
    dialog.get_by_label("Reason").fill("comfortable and still near")
    page.keyboard.press("Enter")
    expect(page.get_by_role("region", name="Candidates")).to_contain_text("comfortable and still near")
    page.get_by_role("article", name="Run 2").focus()
    page.keyboard.press("d")
    page.get_by_role("dialog", name="Verdict on run #2").get_by_label("Reason").fill("too near")
    page.keyboard.press("Enter")
    expect(page.get_by_role("region", name="Discarded").get_by_role("article", name="Run 2")).to_be_visible()
    told = {each["run"]: each["verdict"] for each in studio[2].get("/api/runs").json()}
    assert (told[2], told[3], told[1]) == ("discarded", "candidate", "open")


def test_6_several_are_compared(page):
    page.goto("/runs")
    for run in (1, 3, 5):
        page.get_by_test_id(f"select-{run}").click()
    page.locator("tr[data-run='1']").focus()
    page.keyboard.press("X")
    expect(page).to_have_url(re.compile(r"/compare\?runs="))
    differing = page.get_by_test_id("compare-parameters")
    expect(differing).to_contain_text("headway")
    expect(differing).to_contain_text("standstill")
    expect(differing).not_to_contain_text("clock.duration")
    charts = page.get_by_test_id("compare-charts")
    expect(charts.locator("canvas").first).to_be_visible()
    expect(charts).to_contain_text("#3 headway 0.9 standstill 2.5")  # the legend names what differs
    metrics = page.get_by_test_id("compare-metrics")
    expect(metrics.locator("[data-verdict=better], [data-verdict=worse]").first).to_be_visible()
    few = metrics.locator("tr[data-metric]").count()
    page.get_by_role("switch", name="Also what is the same").check()
    expect(differing).to_contain_text("clock.duration")
    expect(metrics.locator("[data-metric=arrivals]")).to_be_visible()
    assert metrics.locator("tr[data-metric]").count() > few
    page.get_by_role("button", name="Make run 5 the baseline").click()
    expect(page.get_by_role("group", name="Baseline").get_by_role("combobox")).to_have_value("5")
    page.get_by_role("button", name="Take run 3 out").click()
    expect(page.get_by_label("Run 3", exact=True)).to_have_count(0)
    page.get_by_test_id("compare-add").select_option("6")
    expect(page.get_by_test_id("compare-sources")).to_contain_text("#6 does not use the application cacc.")
    expect(page.get_by_test_id("compare-sources")).to_contain_text("#6 alone uses the application acc.")


def test_7_the_palette_leads_everywhere(page):
    page.keyboard.press("Control+k")
    search = page.get_by_label("Go to", exact=True)
    expect(search).to_be_focused()
    page.keyboard.type("board")
    expect(page.get_by_text("candidates, discarded")).to_be_visible()
    page.keyboard.press("Enter")
    expect(page.get_by_role("region", name="Discarded")).to_contain_text("too near")
    expect(search).to_have_count(0)
    page.get_by_label("Filter the runs").focus()
    page.keyboard.press("Control+k")
    expect(search).to_be_focused()
    page.keyboard.type("#4")
    expect(page.get_by_role("dialog").get_by_text("#4", exact=False).first).to_be_visible()
    page.keyboard.press("Enter")
    expect(page).to_have_url(re.compile(r"/runs/4$"))


def test_8_nothing_was_complained_about(studio):
    assert studio[1] == []
