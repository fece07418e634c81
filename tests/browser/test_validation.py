"""Validation in the page, as a person goes through it: from the sample to a car that is valid, and a project of one's own from a log."""

import re

import numpy as np
import pytest
from playwright.sync_api import expect

from tests.browser.browser import browser, watched
from tests.browser.test_axe import AXE, CHECK, TAGS
from tests.server.server import served


@pytest.fixture(scope="module")
def studio(tmp_path_factory):
    """A page, and what its console complained about."""
    folder = tmp_path_factory.mktemp("validation")
    (folder / "scenarios").mkdir()
    with browser() as opened, served(folder) as (client, _, _):
        page, complaints = watched(opened, base_url=str(client.base_url), viewport={"width": 1280, "height": 800})
        page.add_init_script(path=AXE)
        yield page, complaints
        opened.close()


@pytest.fixture(scope="module")
def page(studio):
    return studio[0]


def test_1_the_sample_is_calibrated_and_then_valid(page):
    page.goto("/validate")
    expect(page.get_by_role("heading", name="No projects yet")).to_be_visible()
    page.get_by_role("button", name="Make the sample").click()
    expect(page.get_by_role("heading", name="A car with worn front tyres")).to_be_visible()
    page.get_by_role("button", name="Validate", exact=True).click()
    expect(page.get_by_role("region", name="Verdict")).to_contain_text("not valid")
    expect(page.get_by_role("region", name="Verdict")).to_contain_text("Nothing is validated")
    page.get_by_role("button", name="Calibrate", exact=True).click()
    found = page.get_by_test_id("estimates").get_by_role("row", name="tyres.front_cornering")
    expect(found).to_contain_text(re.compile(r"0\.8[45]\d+"))
    page.get_by_role("button", name="Validate", exact=True).click()
    verdict = page.get_by_role("region", name="Verdict")
    expect(verdict).to_contain_text("8 of 8 criteria met")
    expect(verdict).to_contain_text("With the values of iteration 2.")
    expect(verdict).to_contain_text("Validated span: speed")
    chart = page.get_by_role("figure", name="turn: yaw rate")
    expect(chart).to_contain_text("6 recorded runs")
    chart.get_by_role("button", name="As table").press("Enter")
    table = page.get_by_role("dialog").get_by_role("table")
    expect(table.get_by_role("columnheader", name="recorded [rad/s]")).to_be_visible()
    assert 3 <= table.get_by_role("row").count() <= 201
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_have_count(0)
    expect(page.get_by_test_id("iterations").get_by_role("row")).to_have_count(4)


def test_2_the_report_is_the_page_of_that_iteration(page):
    with page.expect_popup() as opened:
        page.get_by_role("link", name="Open the report, to be read and printed").click()
    report = opened.value
    expect(report.get_by_role("heading", name="A car with worn front tyres: iteration 3")).to_be_visible()
    assert report.locator("svg").count() == 2
    report.close()
    with page.expect_download() as sent:
        page.get_by_role("link", name="Download the report as PDF").click()
    assert sent.value.path().read_bytes().startswith(b"%PDF-")
    row = page.get_by_test_id("verdicts").get_by_role("row").filter(has_text="steady yaw_rate, averaged simulation")
    expect(row).to_contain_text(re.compile(r"0\.\d+ rad/s.* %5 %pass"))


def test_3_a_criterion_that_failed_is_judged_otherwise_with_a_reason(page):
    page.get_by_test_id("iterations").get_by_role("button", name="1", exact=True).click()
    row = page.get_by_test_id("verdicts").get_by_role("row").filter(has_text="steady yaw_rate, averaged simulation")
    row.get_by_role("button", name="Judge otherwise …").click()
    keep = page.get_by_role("button", name="Keep it")
    expect(keep).to_be_disabled()
    page.get_by_label("Why it counts as valid all the same").fill("the sensor was mounted askew that day")
    keep.click()
    page.get_by_role("tab", name="Text").click()
    expect(page.get_by_label("Text of project.yaml")).to_contain_text("the sensor was mounted askew that day")


def test_4_a_project_of_ones_own_from_a_log_in_other_units(page):
    page.get_by_role("link", name="Validation").first.click()
    page.get_by_role("button", name="New project").click()
    page.get_by_label("Title").fill("Our own car")
    page.get_by_role("button", name="Make it").click()
    expect(page.get_by_role("heading", name="No logs yet")).to_be_visible()
    page.set_input_files("input[type=file]", files=[log("turn.csv")])
    signals = page.get_by_test_id("signals")
    expect(signals.get_by_role("row", name="Gierrate")).to_contain_text("deg/s")
    mapping = page.get_by_test_id("mapping")
    expect(mapping.get_by_label("Yaw rate comes from")).to_have_value("Gierrate")
    mapping.get_by_label("Road wheel angle comes from", exact=True).select_option("Radlenkwinkel")
    mapping.get_by_label("Road wheel angle is recorded in").select_option("deg")
    mapping.get_by_label("Speed comes from", exact=True).select_option("Tempo")
    mapping.get_by_label("Speed is recorded in", exact=True).select_option("km/h")
    mapping.get_by_label("Sign of Lateral acceleration").select_option("turned round")
    mapping.get_by_label("x of the sensor of Lateral acceleration").fill("0.3")
    mapping.get_by_label("x of the sensor of Lateral acceleration").press("Enter")
    page.get_by_role("button", name="Save as mapping.yaml").click()
    cuts = page.get_by_role("region", name="Maneuvers in this log")
    expect(cuts).to_contain_text("J-turn")
    expect(signals.get_by_role("row", name="speed", exact=False).first).to_contain_text("20")
    page.get_by_role("button", name="Which signal is which …").click()
    expect(mapping.get_by_label("Road wheel angle comes from", exact=True)).to_have_value("Radlenkwinkel")
    expect(mapping.get_by_label("Sign of Lateral acceleration")).to_have_value("-1")
    expect(mapping.get_by_label("x of the sensor of Lateral acceleration")).to_have_value("0.3")
    mapping.get_by_label("Offset of Speed").fill("36")
    page.get_by_role("button", name="Save as mapping.yaml").click()
    expect(page.get_by_role("alert").filter(has_text="The logs are read by mapping.yaml now.").first).to_be_visible()
    expect(signals.get_by_role("row", name="speed", exact=False).first).to_contain_text("10")
    expect(page.get_by_role("alert").filter(has_text="lateral_acceleration is 2 times speed × yaw_rate")).to_be_visible()
    cuts.get_by_role("button", name="Take it").first.click()
    page.get_by_role("tab", name="Maneuvers").click()
    expect(page.get_by_role("region", name="Maneuver j_turn")).to_contain_text("turn.csv")
    begin = page.get_by_label("Begin of turn.csv for validation")
    begin.clear()
    begin.press_sequentially("0.55", delay=120)
    expect(begin).to_be_focused()
    begin.press("Enter")
    page.get_by_role("tab", name="Text").click()
    expect(page.get_by_label("Text of project.yaml")).to_contain_text("begin: 0.55")


def log(name):
    """A J-turn as somebody else's logger writes it: decimal commas, km/h, degrees, the other side positive."""
    time = np.arange(0.0, 6.0, 0.01)
    wheel = np.clip((time - 1.5) / 0.15, 0.0, 1.0)
    columns = {"t [s]": time, "Tempo [km/h]": 72.0 + 0 * time, "Radlenkwinkel [deg]": 2.0 * wheel}
    columns |= {"Gierrate [deg/s]": 12.0 * wheel, "ay_sensor [m/s²]": -4.2 * wheel}
    rows = [";".join(columns)] + [
        ";".join(f"{value:.4f}".replace(".", ",") for value in row) for row in zip(*columns.values(), strict=True)
    ]
    return {"name": name, "mimeType": "text/csv", "buffer": "\n".join(rows).encode()}


def test_5_what_is_wrong_in_the_text_is_told_and_nothing_is_lost(page):
    editor = page.get_by_label("Text of project.yaml")
    editor.click()
    page.keyboard.press("Control+End")
    page.keyboard.type("confidnce: one-sided\n")
    page.get_by_role("button", name="Save", exact=True).click()
    told = page.get_by_role("alert").filter(has_text="Your text is still here")
    expect(told).to_contain_text("did you mean 'confidence'?")
    expect(editor).to_contain_text("confidnce")


def test_6_an_unreadable_log_says_why(page):
    page.get_by_role("tab", name="Logs").click()
    page.set_input_files("input[type=file]", files=[{"name": "bad.mf4", "mimeType": "", "buffer": b"MDF     4.10" + bytes(40)}])
    expect(page.get_by_role("alert").filter(has_text="bad.mf4")).to_be_visible()
    expect(page.get_by_role("button", name="turn.csv", exact=True)).to_be_visible()
    page.get_by_role("tab", name="Text").click()
    expect(page.get_by_label("Text of project.yaml")).to_contain_text("confidnce")


def test_7_unsaved_text_is_not_lost_by_leaving(page):
    page.get_by_role("link", name="Queue").click()
    expect(page.get_by_role("dialog")).to_contain_text("is not saved")
    page.get_by_role("button", name="Stay").click()
    expect(page.get_by_label("Text of project.yaml")).to_contain_text("confidnce")
    page.get_by_role("link", name="Queue").click()
    page.get_by_role("button", name="Leave, lose it").click()
    expect(page.get_by_role("heading", name="No run goes on or waits")).to_be_visible()


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("tab", ["logs&log=turn_0.csv", "maneuvers", "calibration", "verdicts", "text"])
def test_8_everybody_can_use_it(page, tab, scheme):
    page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
    page.goto(f"/validate/known_truth?tab={tab}")
    expect(page.get_by_test_id("iterations")).to_be_visible()
    expect(page.get_by_test_id(SEEN[tab]) if tab in SEEN else page.get_by_role("tabpanel").filter(visible=True)).to_be_visible()
    expect(page.get_by_role("status").filter(has_text="Loading")).to_have_count(0)
    assert page.evaluate(CHECK, TAGS) == []


SEEN = {"logs&log=turn_0.csv": "signals", "calibration": "estimates", "verdicts": "verdicts"}


@pytest.mark.parametrize("tab", ["logs&log=turn_0.csv", "maneuvers", "calibration", "verdicts"])
def test_8_nothing_sticks_out_of_a_narrow_window(page, tab):
    """What is wider scrolls in a part of its own, so that the page itself never does sideways."""
    page.set_viewport_size({"width": 800, "height": 900})
    page.goto(f"/validate/known_truth?tab={tab}")
    expect(page.get_by_test_id("iterations")).to_be_visible()
    expect(page.get_by_role("status").filter(has_text="Loading")).to_have_count(0)
    article = page.get_by_role("article")
    assert article.evaluate("each => each.scrollWidth") <= article.evaluate("each => each.clientWidth")
    page.set_viewport_size({"width": 1280, "height": 800})


def test_8_the_last_change_is_taken_back_and_made_again_by_keys(page):
    page.goto("/validate/known_truth?tab=maneuvers")
    begin = page.get_by_label("Begin of turn_4.csv for validation")
    begin.fill("0.25")
    begin.press("Enter")
    back = page.get_by_role("button", name="Take back the last change")
    expect(back).to_be_visible()
    page.get_by_role("tab", name="Maneuvers").focus()
    page.keyboard.press("Control+z")
    expect(back).to_be_disabled()
    expect(begin).to_have_value(re.compile(r"^0\b(?!\.25)"))
    page.keyboard.press("Control+y")
    expect(begin).to_have_value(re.compile(r"^0\.25\b"))
    expect(page.get_by_role("button", name="Make it again")).to_be_disabled()
    page.keyboard.press("Control+z")
    expect(begin).to_have_value(re.compile(r"^0\b(?!\.25)"))
    begin.fill("0.75")
    begin.press("Enter")
    expect(page.get_by_role("button", name="Make it again")).to_be_disabled()
    begin.fill("0.5")
    expect(page.get_by_text("Not saved yet")).to_be_visible()
    back.click()  # the field is left by it, and sends what was typed: that is the last change
    expect(begin).to_have_value(re.compile(r"^0\.75\b"))
    expect(page.get_by_text("Not saved.")).to_have_count(0)


def test_8_a_parameter_is_chosen_by_its_title_with_its_unit_and_range(page):
    page.goto("/validate/known_truth?tab=calibration")
    page.get_by_placeholder("by title or path").fill("rolling res")
    page.get_by_role("option", name=re.compile("Rolling resistance over load")).click()
    new = page.get_by_role("region", name="Another parameter")
    expect(new.get_by_label("Lowest")).to_have_value("0.01")
    expect(new.get_by_label("Highest")).to_have_value("0.015")
    expect(new).to_contain_text("Now 0.012")
    new.get_by_role("button", name="Look for it").click()
    drop = page.get_by_role("button", name="Look for wheels.rolling_resistance no longer")
    drop.click()
    expect(drop).to_have_count(0)


def test_9_the_console_was_quiet(studio):
    """The browser itself notes the one text that was refused."""
    (refused,) = studio[1]
    assert "422" in refused
