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


def test_the_console_is_clean(studio):
    assert studio[1] == []
