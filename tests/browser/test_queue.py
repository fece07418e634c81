"""The queue in a real browser: who waits and in which order, cancelled by mouse and by keyboard, in the light and in the dark."""

import pytest
from playwright.sync_api import expect

from tests.browser.browser import browser, watched
from tests.patience import until
from tests.server.server import served

SIZE = {"width": 1100, "height": 640}
SCENARIO, LONG = "motorway_platoon", {"clock.duration": 3600}


@pytest.fixture(scope="module")
def studio(tmp_path_factory, sample):
    """A page of a server that does one run at a time, what its console complained about, and a client."""
    folder = tmp_path_factory.mktemp("queue")
    with browser() as opened, served(folder, "--scenarios", sample.parent, "--at-once", "1") as (client, _, _):
        page, complaints = watched(opened, viewport=SIZE, color_scheme="dark")
        page.goto(f"{client.base_url}/queue")
        yield page, complaints, client
        opened.close()


def ask(client, address="runs", **options):
    return client.post(f"/api/{address}", json={"scenario": SCENARIO, "set": LONG, **options}).json()["run"]


def test_runs_wait_are_seen_and_cancelled(studio):
    page, _, client = studio
    expect(page.get_by_text("No run goes on or waits")).to_be_visible()
    goes, *waiting = ask(client, "live", paused=True), *(ask(client) for _ in range(4))
    page.reload()
    expect(page.get_by_test_id("queue-counts")).to_have_text("1 going on, 4 waiting")
    expect(page.get_by_test_id("nav-queue")).to_contain_text("4 waiting")
    rows = page.get_by_test_id("queue").locator("tbody tr")
    assert [row.split("\t")[0] for row in rows.all_inner_texts()] == ["goes on", "1", "2", "3", "4"]
    background = page.evaluate("getComputedStyle(document.body).backgroundColor")
    assert sum(map(int, background.strip("rgb()").split(","))) < 200, background
    page.get_by_test_id(f"cancel-{waiting[1]}").click()
    expect(page.get_by_test_id(f"queue-{waiting[1]}")).to_have_count(0)
    expect(page.get_by_test_id(f"queue-{waiting[2]}").locator("td").first).to_have_text("2")
    page.get_by_test_id(f"cancel-{goes}").focus()
    for key in ("ArrowDown", "j", "j", "k"):
        page.keyboard.press(key)
    expect(page.get_by_test_id(f"cancel-{waiting[2]}")).to_be_focused()
    page.keyboard.press("Enter")
    expect(page.get_by_test_id(f"queue-{waiting[2]}")).to_have_count(0)
    page.get_by_test_id(f"queue-{waiting[0]}").get_by_role("link").click()
    expect(page.get_by_text("waiting").first).to_be_visible()
    for each in (waiting[0], waiting[3], goes):
        assert client.post(f"/api/runs/{each}/cancel").status_code == 200
    page.keyboard.press("g")
    page.keyboard.press("q")
    expect(page.get_by_text("No run goes on or waits")).to_be_visible()
    statuses = {each["run"]: each["status"] for each in client.get("/api/runs").json()}
    assert statuses == dict.fromkeys(waiting, "cancelled") | {goes: "stopped"}


def test_a_run_of_the_studio_waits_too(studio):
    """The bar says its place, and stop takes it out; as it has nothing to play back, the scene shows the scenario again."""
    page, _, client = studio
    goes = ask(client, "live", paused=True)
    page.goto(f"{client.base_url}/studio/{SCENARIO}")
    page.get_by_test_id("run").click()
    expect(page.get_by_test_id("position")).to_have_text("place 1")
    with page.expect_request(lambda each: each.url.endswith("/api/scene") and each.post_data_json.get("scenario") == SCENARIO) as shown:
        page.get_by_test_id("stop").click()
    assert shown.value.response().status == 200
    expect(page.get_by_test_id("history-row").first).to_contain_text("cancelled")
    client.post(f"/api/runs/{goes}/cancel")
    until(lambda: client.get("/api/queue").json() == [], "the end of all")


def test_the_console_is_clean(studio):
    assert studio[1] == []
