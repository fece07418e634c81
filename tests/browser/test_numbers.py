"""Numbers and pictures that do not mislead, in a real browser: ranks, charts, metrics, the form, lineage, and that all can be read."""

import re
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import expect

from tests.browser.browser import browser, drawn, pixels, watched
from tests.patience import until
from tests.server.server import served

STERN, MOTORWAY = "grosser_stern_platoon", "motorway_platoon"
SHORT = {"clock.duration": 4}
HEADWAY = "applications.platoon.parameters.headway"
CONTRAST = Path(__file__).with_name("contrast.js").read_text(encoding="utf-8").partition("*/\n")[2].rstrip().rstrip(";")


@pytest.fixture(scope="module")
def studio(tmp_path_factory, sample):
    """A browser, and a server with runs: a short one, its child, one that was stopped, one of another scenario, and a whole one."""
    with browser() as opened, served(tmp_path_factory.mktemp("numbers"), "--scenarios", sample.parent) as (client, _, _):
        for scenario, changes, parent in ((STERN, SHORT, None), (STERN, SHORT | {HEADWAY: 0.9}, 1)):
            ended(client, started(client, "runs", scenario=scenario, set=changes, parent=parent))
        stopped = started(client, "live", scenario=STERN, set={"clock.duration": 600}, pace=8.0)
        until(lambda: client.get(f"/api/live/{stopped}").json()["time"] > 1, "a second of the run")
        client.post(f"/api/live/{stopped}/stop")
        ended(client, stopped)
        for scenario, changes in ((MOTORWAY, SHORT), (STERN, {})):
            ended(client, started(client, "runs", scenario=scenario, set=changes))
        yield opened, client
        opened.close()


SHORT_RUN, CHILD, STOPPED, OTHER, WHOLE = range(1, 6)


def started(client, what, **body):
    """The number of a run that has begun."""
    return client.post(f"/api/{what}", json=body).raise_for_status().json()["run"]


def ended(client, run):
    """The run when it is over."""

    def over():
        row = client.get(f"/api/runs/{run}").json()
        return row if row["status"] not in ("running", "waiting") else None

    return until(over, f"the end of run {run}")


@pytest.fixture
def page(studio):
    """A page as somebody has it who was never here; its console has nothing to complain about."""
    opened, client = studio
    context = opened.new_context(base_url=str(client.base_url), viewport={"width": 1280, "height": 860})
    made, complaints = watched(context)
    yield made
    context.close()
    assert complaints == []


@pytest.fixture
def client(studio):
    return studio[1]


def rows(page):
    """The numbers of the runs in the table, from the top."""
    table = page.get_by_test_id("runs-table")
    expect(table.locator("tr[data-run]")).to_have_count(5)
    return [int(each.get_attribute("data-run")) for each in table.locator("tr[data-run]").all()]


def test_what_ended_early_stands_last(page, client):
    """By a metric, rising and falling; the values are there, and say what they are of."""
    gaps = {each["run"]: each["metrics"]["min_gap"]["value"] for each in client.get("/api/runs").json()}
    assert gaps[WHOLE] < gaps[STOPPED]  # by its value alone it would not be last when falling
    for sign, reverse in (("", False), ("-", True)):
        page.goto(f"/runs?sort={sign}metric:min_gap")
        expect(page.get_by_test_id("runs-table")).to_contain_text("Least gap")
        whole = sorted((run for run in gaps if run != STOPPED), key=lambda run: gaps[run], reverse=reverse)
        assert rows(page) == [*whole, STOPPED]
    stopped = page.locator(f"tr[data-run='{STOPPED}']")
    expect(stopped.get_by_title(re.compile("Not ranked: the run is stopped, and was measured only until")).first).to_be_visible()
    assert not re.search(r"[-−]0(\.0+)?(?![\d.])", page.get_by_test_id("runs-table").inner_text())


def test_every_run_has_the_headway(page):
    """Also those that have not set it, and it is marked there; the filter finds them."""
    page.goto(f"/runs?sort=-parameter:{HEADWAY}")
    assert rows(page)[0] == CHILD
    table = page.get_by_test_id("runs-table")
    expect(table.get_by_text("0.6 (not set)")).to_have_count(4)
    page.get_by_label("Filter the runs").fill("headway=0.9")
    expect(table.locator("tr[data-run]")).to_have_count(1)


def test_a_comparison_ranks_only_whole_runs(page):
    page.goto(f"/compare?a={SHORT_RUN}&b={STOPPED}")
    metrics = page.get_by_test_id("compare-metrics")
    expect(metrics.get_by_role("note")).to_contain_text("Nothing is ranked: run 3 is stopped at")
    expect(metrics.locator("[data-verdict=better], [data-verdict=worse]")).to_have_count(0)
    page.goto(f"/compare?a={SHORT_RUN}&b={CHILD}")
    expect(metrics).to_contain_text("1 % and less may be chance")
    for row in metrics.locator("[data-verdict=better], [data-verdict=worse]").all():
        (percent,) = re.findall(r"([+−][\d.]+(?:e[+-]?\d+)?) %", row.inner_text()) or [None]
        assert percent is None or abs(float(percent.replace("−", "-"))) >= 0.99, row.inner_text()


def test_scenarios_are_compared_by_one_question(page):
    """Of pairs that nobody has asked for yet, also of other scenarios: no scene is put up for them, and no map read."""
    page.goto(f"/compare?a={OTHER}")
    expect(page.get_by_test_id("compare-add")).to_be_visible()
    asked = []
    page.on("request", lambda each: asked.append(each.url.partition("/api/")[2].partition("?")[0]) if "/api/" in each.url else None)
    for number, run in enumerate((SHORT_RUN, CHILD, STOPPED, WHOLE), 1):
        page.get_by_test_id("compare-add" if number == 1 else "compare-1").select_option(str(run))
        expect(page.get_by_test_id("compare-metrics").get_by_role("link", name=f"#{run}", exact=True)).to_be_visible()
        assert asked.count("beside") == number, asked
    assert not [each for each in asked if each.split("/")[0] in ("scene", "maps", "live")], asked


def drag(page, chart, begin, end):
    """Draws a range over a chart, in shares of its width."""
    box = chart.bounding_box()
    page.mouse.move(box["x"] + begin * box["width"], box["y"] + 0.5 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + end * box["width"], box["y"] + 0.5 * box["height"], steps=5)
    page.mouse.up()


def coloured(figure) -> int:
    """Pixels of a chart that are neither white nor grey."""
    picture = pixels(figure.locator(".u-wrap").screenshot())
    return int((np.ptp(picture, axis=-1) > 60).sum())


def test_a_zoomed_chart_stays_and_gets_finer(page):
    """Through a change of quantity; both charts show the same stretch, and tell the same time."""
    page.goto(f"/runs/{WHOLE}")
    figures, charts = page.locator("figure"), page.locator(".u-over")
    expect(charts).to_have_count(2)
    asked = []
    page.on("request", lambda request: asked.append(request.url) if "/trace?" in request.url else None)
    drag(page, charts.first, 0.3, 0.5)
    expect(page.get_by_role("button", name="Show all of it")).to_have_count(2)
    until(lambda: len([each for each in asked if "begin=1" in each and "end=" in each]) >= 2, "finer traces of both charts")
    figures.first.locator("select").select_option("acceleration")
    expect(figures.first).to_have_attribute("aria-label", re.compile("Acceleration"))
    until(lambda: coloured(figures.first) > 300, "curves in the chart")
    box = charts.first.bounding_box()
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.4 * box["height"])
    drawn(page)
    times = {re.search(r"t = ([\d.]+) s", each.inner_text()).group(1) for each in figures.locator("figcaption").all()}
    assert len(times) == 1 and 18 < float(times.pop()) < 30
    page.get_by_role("button", name="Show all of it").first.click()
    expect(page.get_by_role("button", name="Show all of it")).to_have_count(0)
    until(lambda: coloured(figures.first) > 300, "curves in the chart")


def test_a_needle_is_outside_and_told(page, studio):
    """The time gap of a car that comes to a stand; a click brings it inside."""
    run = started(studio[1], "runs", scenario=STERN, set={HEADWAY: 0.9})
    ended(studio[1], run)
    page.goto(f"/runs/{run}")
    figure = page.locator("figure").nth(1)
    figure.locator("select").select_option("time_gap")
    outside = figure.get_by_role("button", name=re.compile(r"▲ up to [\d.]+ outside"))
    expect(outside).to_be_visible()
    outside.click()
    expect(figure.get_by_role("button", name=re.compile("inside"))).to_have_attribute("aria-pressed", "true")


def test_a_metric_says_whom_when_and_what(page):
    """Its title opens the definition, its time leads to where it was so."""
    page.goto(f"/runs/{WHOLE}")
    gap = page.get_by_test_id("metrics").locator("[data-metric=min_gap]")
    expect(gap).to_contain_text(re.compile(r"follower_\d behind \w+ at [\d.]+ s"))
    expect(gap.get_by_text("Least bumper-to-bumper distance")).to_be_attached()  # the words have come, and no row moves any more
    gap.locator("summary").click()
    expect(gap.get_by_text("Least bumper-to-bumper distance")).to_be_visible()
    expect(gap.get_by_text("Measured over the whole run; all recorded vehicles.")).to_be_visible()
    when = gap.get_by_role("button")
    at = float(re.search(r"[\d.]+", when.inner_text()).group())
    when.click()
    expect(page.get_by_test_id("playhead")).to_have_value(f"{at:g} s")
    page.get_by_role("tab", name="Metrics").click()
    other = page.get_by_test_id("metrics").locator("[data-metric=max_deceleration]").get_by_role("button")
    at = float(re.search(r"[\d.]+", other.inner_text()).group())
    other.click()
    expect(page.get_by_test_id("playhead")).to_have_value(f"{at:g} s")


def test_form_and_run_are_one(page, client):
    """ACC instead of CACC, with its preset: what the fields show is what the run is made of."""
    page.goto(f"/studio/{STERN}")
    field = lambda name: page.get_by_test_id(f"param-applications.platoon.{name}")  # noqa: E731
    page.get_by_test_id("application-platoon").select_option("acc")
    expect(field("parameters.gap_gain")).to_have_value("0.1")
    field("preset").select_option("series")
    expect(field("parameters.gap_gain")).to_have_value("0.55")
    names = ("headway", "standstill", "gap_gain", "deceleration_max", "response_time")
    shown = {name: float(field(f"parameters.{name}").input_value()) for name in names}
    assert shown["headway"] == 0.6  # which the file gives
    page.get_by_test_id("pace").select_option("fast")
    page.get_by_test_id("run").click()
    expect(page).to_have_url(re.compile(r"run=\d+"))
    run = ended(client, int(re.search(r"run=(\d+)", page.url).group(1)))
    had = run["document"]["applications"]["platoon"]["parameters"]
    assert {name: had[name] for name in names} == shown


def test_a_comma_is_no_thousand(page):
    """It is read as a point, and that is said; what is no number is refused in words, and the value stays."""
    page.goto(f"/studio/{STERN}")
    headway = page.get_by_test_id(f"param-{HEADWAY}")
    expect(headway).to_have_value("0.6")
    headway.fill("0,9")
    expect(page.get_by_role("status").filter(has_text="0,9 is read as 0.9")).to_be_visible()
    headway.press("Tab")
    expect(headway).to_have_value("0.9")
    headway.fill("1.234,5")
    expect(page.get_by_role("status").filter(has_text="is no number")).to_be_visible()
    headway.press("Tab")
    expect(headway).to_have_value("0.9")


def test_defaults_are_marked(page):
    """What the file does not give has its value in the form, and says that nobody has set it."""
    page.goto(f"/studio/{STERN}")
    gain = page.get_by_test_id("param-applications.platoon.parameters.k_p")
    expect(gain).to_have_value("0.2")
    expect(page.get_by_label(re.compile(r"Gain on the gap \(default\)"))).to_have_value("0.2")
    expect(page.get_by_label("Time headway", exact=True)).to_have_value("0.6")


def test_lineage_survives_reopening(page, client):
    """Somebody opens the address of a run, and nothing else: the form is that run's, and the next run its child."""
    page.goto(f"/studio/{STERN}?run={CHILD}")
    expect(page.get_by_test_id("next-parent")).to_contain_text(f"#{CHILD}")
    expect(page.get_by_test_id(f"param-{HEADWAY}")).to_have_value("0.9")
    expect(page.get_by_test_id("other-run")).to_have_count(0)
    page.get_by_test_id("pace").select_option("fast")
    page.get_by_test_id("run").click()
    expect(page).not_to_have_url(re.compile(f"run={CHILD}$"))
    row = ended(client, int(re.search(r"run=(\d+)", page.url).group(1)))
    assert row["parent"] == CHILD and row["parameters"][HEADWAY] == 0.9


def test_a_live_run_has_recorded_something(page, client):
    """Its page is not told that nothing was recorded, and its charts are there while it goes on."""
    run = started(client, "live", scenario=STERN, set={"clock.duration": 600}, paused=True)
    page.goto(f"/runs/{run}")
    expect(page.get_by_test_id("run-detail")).to_contain_text("They are listed here when the run is over")
    expect(page.get_by_test_id("run-detail")).not_to_contain_text("recorded nothing")
    client.post(f"/api/live/{run}/resume")
    expect(page.locator(".u-over")).to_have_count(2)
    client.post(f"/api/live/{run}/stop")
    ended(client, run)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_everything_can_be_read(studio, scheme):
    """Every text has the contrast that people need, in both themes."""
    opened, client = studio
    context = opened.new_context(base_url=str(client.base_url), color_scheme=scheme, viewport={"width": 1280, "height": 860})
    page, _ = watched(context)
    places = {
        f"/studio/{STERN}?run={WHOLE}": "history-row",
        "/runs": "runs-table",
        f"/runs/{SHORT_RUN}": "metrics",
        f"/compare?a={SHORT_RUN}&b={CHILD}": "compare-charts",
        "/queue": "nav-queue",
        "/maps": "nav-maps",
        "/kinds": "nav-kinds",
    }
    pale = {}
    for address, there in places.items():
        page.goto(address)
        page.get_by_test_id(there).first.wait_for()
        page.wait_for_load_state("networkidle") if "studio" not in address else None
        drawn(page)
        pale[address] = page.evaluate(CONTRAST)
    context.close()
    assert not any(pale.values()), pale
