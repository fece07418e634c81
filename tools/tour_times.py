"""How long the guided tour takes somebody who does what it says, step by step, on the sample: from the first start to a candidate.

    python -m tools.tour_times

He reads for five seconds at every step; the server's own numerics are compiled already.
"""

import sys
import tempfile
import time
from pathlib import Path

from tests.browser.browser import browser, watched
from tests.server.server import served

SAMPLES = Path(__file__).resolve().parent.parent / "scenarios"
HEADWAY = "applications.platoon.parameters.headway"
READING = 5.0  # [s] of a step
BUDGET = 300.0  # [s] from start to candidate


def play(page) -> list[tuple[str, float]]:
    """The steps with when they were over [s]."""
    steps, began = [], time.monotonic()

    def over(what: str, title: str) -> None:
        page.get_by_role("dialog").get_by_role("heading", name=title).wait_for()
        steps.append((what, time.monotonic() - began))
        page.wait_for_timeout(1000 * READING)

    page.goto("/")
    page.get_by_role("button", name="Begin the tour").click()
    over("begun", "The scenario, as it will start")
    page.get_by_role("button", name="Next").click()
    over("the scene looked at", "Run it")
    page.get_by_role("button", name="Run", exact=True).click()
    over("run", "Change one thing")
    page.keyboard.press("/")
    page.keyboard.type("headway")
    page.get_by_test_id(f"param-{HEADWAY}").fill("0.8")
    page.keyboard.press("Tab")
    over("headway changed", "Run it again")
    page.get_by_role("combobox", name="Pace").select_option("fast")
    page.get_by_role("button", name="Run again").click()
    over("run again", "Every run is here")
    for run in (2, 3):
        page.get_by_role("checkbox", name=f"Select run {run}").check()
    page.keyboard.press("Shift+X")
    over("compared", "Which one is better?")
    page.get_by_role("button", name="Next").click()
    over("metrics read", "Decide")
    page.locator("tr[data-run='3']").focus()
    page.keyboard.press("c")
    page.get_by_label("Reason").fill("calmer at the same speed")
    page.keyboard.press("Enter")
    over("a candidate", "The next scenario is your own")
    return steps


def main() -> None:
    """Plays and prints."""
    with tempfile.TemporaryDirectory() as folder, browser() as opened, served(Path(folder), "--scenarios", SAMPLES) as (client, _, _):
        page, complaints = watched(opened, tour=True, base_url=str(client.base_url), viewport={"width": 1280, "height": 800})
        steps = play(page)
        candidates = [each["run"] for each in client.get("/api/runs").json() if each["verdict"] == "candidate"]
        opened.close()
    for what, when in steps:
        sys.stdout.write(f"{when:6.1f} s  {what}\n")
    late = "" if steps[-1][1] <= BUDGET else "   OVER"
    sys.stdout.write(f"candidates {candidates}; budget {BUDGET:g} s{late}; console: {complaints or 'nothing to complain about'}\n")


if __name__ == "__main__":
    main()
