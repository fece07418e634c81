"""Verdicts in a real browser: decided by the keyboard in the table, taken back, decided at the run, and found again."""

import pytest
from playwright.sync_api import expect

from tests.browser.browser import browser, watched
from tests.patience import until
from tests.server.server import served

SIZE = {"width": 1280, "height": 800}


@pytest.fixture(scope="module")
def studio(tmp_path_factory, sample):
    """A page with three runs that are over, what its console complained about, and a client."""
    folder = tmp_path_factory.mktemp("verdicts")
    with browser() as opened, served(folder, "--scenarios", sample.parent) as (client, _, _):
        for seed in (1, 2, 3):
            client.post("/api/runs", json={"scenario": sample.stem, "seed": seed, "set": {"clock.duration": 0.2}}).raise_for_status()
        until(lambda: {each["status"] for each in client.get("/api/runs").json()} == {"done"}, "the end of the runs")
        page, complaints = watched(opened, viewport=SIZE, color_scheme="light")
        page.goto(f"{client.base_url}/runs")
        yield page, complaints, client
        opened.close()


@pytest.fixture(scope="module")
def page(studio):
    return studio[0]


def verdicts(client, run):
    return [(each["verdict"], each["reason"]) for each in client.get(f"/api/runs/{run}").json()["verdicts"]]


def test_1_a_row_is_decided_by_the_keyboard(page, studio):
    expect(page.locator("tr[data-run='3']")).to_be_focused()
    page.keyboard.press("c")
    dialog = page.get_by_role("dialog", name="Verdict on run #3")
    expect(dialog.get_by_label("Reason")).to_be_focused()
    expect(dialog.get_by_role("button", name="Decide")).to_be_disabled()
    page.keyboard.type("the smallest gap of all")
    page.keyboard.press("Enter")
    expect(dialog).to_be_hidden()
    expect(page.locator("tr[data-run='3']")).to_contain_text("candidate")
    assert verdicts(studio[2], 3) == [("candidate", "the smallest gap of all")]


def test_2_it_is_taken_back_and_both_are_kept(page, studio):
    page.get_by_role("button", name="Undo").click()
    expect(page.locator("tr[data-run='3']")).to_contain_text("open")
    given = [("candidate", "the smallest gap of all"), ("open", "Taken back: candidate, the smallest gap of all")]
    assert verdicts(studio[2], 3) == given


def test_3_a_run_is_decided_and_named_on_its_page(page, studio):
    page.goto(f"{studio[2].base_url}/runs/2")
    expect(page.get_by_text("Nobody has decided about this run yet.")).to_be_visible()
    page.keyboard.press("d")
    expect(page.get_by_label("Reason")).to_be_focused()
    page.keyboard.type("brakes too hard")
    page.keyboard.press("Enter")
    expect(page.get_by_test_id("verdict-now")).to_contain_text("discarded")
    expect(page.get_by_role("list", name="Verdicts so far")).to_contain_text("brakes too hard")
    page.get_by_role("textbox", name="Name").fill("hard brake")
    page.get_by_role("textbox", name="Tags").fill("wet, night")
    page.get_by_role("textbox", name="Note").fill("At 0.1 s.")
    save = page.get_by_role("button", name="Save")
    with page.expect_response(lambda answer: answer.request.method == "PUT"):
        save.click()
    expect(save).not_to_have_attribute("data-loading", "true")
    expect(save).to_be_disabled()  # nothing is left to be saved
    told = studio[2].get("/api/runs/2").json()
    assert (told["name"], told["tags"], told["note"]) == ("hard brake", ["wet", "night"], "At 0.1 s.")
    elsewhere = {"verdict": "discarded", "reason": "seen by somebody else, too"}
    studio[2].post("/api/runs/2/verdicts", json=elsewhere).raise_for_status()
    expect(page.get_by_role("list", name="Verdicts so far")).to_contain_text("seen by somebody else, too")


def test_4_the_table_shows_only_what_is_wanted(page, studio):
    page.goto(f"{studio[2].base_url}/runs")
    expect(page.locator("tr[data-run]")).to_have_count(3)
    expect(page.locator("tr[data-run='2']")).to_contain_text("hard brake")
    chip = page.get_by_role("button", name="1 discarded")
    chip.click()
    expect(chip).to_have_attribute("aria-pressed", "true")
    expect(page.locator("tr[data-run]")).to_have_count(1)
    page.reload()
    expect(page.locator("tr[data-run]")).to_have_count(1)
    page.get_by_role("button", name="1 discarded").click()
    page.get_by_label("Filter the runs").fill("night")
    expect(page.locator("tr[data-run]")).to_have_count(1)


def heads(page):
    return [each.get_attribute("data-heap") for each in page.locator("tr[data-heap]").all()]


def test_5_the_runs_are_grouped_and_folded(page, studio):
    page.goto(f"{studio[2].base_url}/runs")
    page.get_by_role("combobox", name="Group by").click()
    page.get_by_role("option", name="Verdict").click()
    expect(page.locator("tr[data-heap]")).to_have_count(2)
    assert heads(page) == ["Verdict open", "Verdict discarded"]
    opened = page.locator("tr[data-heap='Verdict open']")
    expect(opened).to_contain_text("2 runs")
    expect(opened).to_contain_text("±")
    opened.get_by_role("button", expanded=True).click()
    expect(page.locator("tr[data-run]")).to_have_count(1)
    page.reload()  # how they are grouped stands in the address
    expect(page.locator("tr[data-heap]")).to_have_count(2)
    expect(page.locator("tr[data-run]")).to_have_count(3)


def test_6_many_runs_are_tagged_and_decided_about_at_once(page, studio):
    client = studio[2]
    page.get_by_role("checkbox", name="Select the runs of Verdict open").check()
    bar = page.get_by_role("toolbar", name="Chosen runs")
    expect(bar).to_contain_text("2 runs chosen")
    bar.get_by_role("button", name="Tags").click()
    page.get_by_role("dialog").get_by_role("combobox", name="Put on").fill("dry, slow,")
    page.get_by_role("button", name="Change the tags of 2 runs").click()
    expect(page.get_by_text("The tags of 2 runs are changed.")).to_be_visible()
    assert [client.get(f"/api/runs/{run}").json()["tags"] for run in (1, 3)] == [["dry", "slow"]] * 2
    page.get_by_role("button", name="Undo").click()
    expect(page.get_by_text("The tags of 2 runs are as they were.")).to_be_visible()
    assert [client.get(f"/api/runs/{run}").json()["tags"] for run in (1, 2, 3)] == [[], ["wet", "night"], []]
    page.get_by_role("checkbox", name="Select all shown runs").check()
    bar.get_by_role("button", name="Verdict").click()
    dialog = page.get_by_role("dialog", name="Verdict on 3 runs")
    dialog.get_by_label("Reason").fill("the idea does not work")
    dialog.get_by_role("button", name="Decide about 3 runs").click()
    expect(page.get_by_text("3 runs are discarded.")).to_be_visible()
    assert [verdicts(client, run)[-1] for run in (1, 2, 3)] == [("discarded", "the idea does not work")] * 3
    page.get_by_role("button", name="Undo").click()
    expect(page.get_by_text("The verdict on 3 runs is taken back.")).to_be_visible()
    assert [verdicts(client, run)[-1][0] for run in (1, 2, 3)] == ["open", "discarded", "open"]
    page.get_by_role("button", name="Choose none").click()
    expect(bar).to_be_hidden()


def test_the_console_is_clean(studio):
    assert studio[1] == []
