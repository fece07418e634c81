"""The token in a real browser: the printed address opens page and scene, the form asks once, a link from elsewhere is followed."""

from urllib.parse import urlparse

import pytest
from playwright.sync_api import expect

from tests.browser.browser import browser, watched
from tests.server.server import served

TOKEN = "a-token.of_16~or-more"


@pytest.fixture(scope="module")
def opened(tmp_path_factory, sample):
    """A browser, and the address of a server that is open to a network."""
    folder = tmp_path_factory.mktemp("gate")
    options = ("--host", "0.0.0.0", "--scenarios", sample.parent)
    with browser() as started, served(folder, *options, STUDIO_TOKEN=TOKEN) as (client, _, _):
        yield started, str(client.base_url).rstrip("/")
        started.close()


def is_in(page, address: str) -> None:
    """The page shows a scenario at an address without a token, and the scene's client is connected by its socket."""
    expect(page.get_by_test_id("attribution")).to_have_text("© OpenStreetMap contributors")
    assert page.url.startswith(address) and TOKEN not in page.url
    assert page.evaluate("document.cookie") == ""


def test_the_printed_address_opens_page_and_scene(opened):
    started, address = opened
    page, complaints = watched(started)
    sockets = []
    page.on("websocket", lambda each: sockets.append(each))
    page.goto(f"{address}/?token={TOKEN}")
    is_in(page, address)
    (scene,) = [each for each in sockets if urlparse(each.url).path.rstrip("/") == "/scene"]
    assert not scene.is_closed() and complaints == []
    page.reload()
    is_in(page, address)
    page.close()


def test_the_form_asks_once(opened):
    started, address = opened
    page, _ = watched(started)
    page.goto(f"{address}/runs")
    page.get_by_label("Token").fill("wrong")
    page.get_by_role("button", name="Open").click()
    expect(page.get_by_text("That is not the token")).to_be_visible()
    page.get_by_label("Token").fill(TOKEN)
    page.get_by_role("button", name="Open").click()
    page.wait_for_url(f"{address}/runs")
    expect(page.get_by_label("Token")).to_have_count(0)
    page.goto(address)
    is_in(page, address)
    page.close()


def test_links_from_elsewhere_lead_in(opened):
    """One with the token opens the page; one without asks who has been in before for a click."""
    started, address = opened
    page, _ = watched(started)
    page.goto(f"data:text/html,<a href='{address}/?token={TOKEN}'>in</a>")
    page.get_by_text("in").click()
    is_in(page, address)
    page.goto(f"data:text/html,<a href='{address}/'>in</a>")
    page.get_by_text("in").click()
    page.get_by_role("link", name="Go on").click()
    is_in(page, address)
    page.close()
