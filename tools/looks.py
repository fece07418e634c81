"""Pictures of every place of the page, light and dark, on a small and a large screen: to be looked at before a release.

python -m tools.looks FOLDER                         on a server of its own with seven runs
python -m tools.looks FOLDER --url http://… --only runs,board    of a server that goes on already
"""

import argparse
import re
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import product
from pathlib import Path

import httpx
from playwright.sync_api import expect

from tests.browser.browser import browser, watched
from tests.patience import until
from tests.server.server import served

SAMPLES = Path(__file__).resolve().parent.parent / "scenarios"
SIZES = {"small": {"width": 1280, "height": 800}, "large": {"width": 1920, "height": 1080}}
HEADWAY = "applications.platoon.parameters.headway"
SHOWN = {
    "platoon": ("grosser_stern_platoon", {}),
    "near": ("grosser_stern_platoon", {HEADWAY: 0.42}),
    "far": ("grosser_stern_platoon", {HEADWAY: 1.2}),
    "motorway": ("motorway_platoon", {}),
    "wide": ("motorway_platoon", {HEADWAY: 1.4}),
    "brake": ("cacc_brake", {}),
    "child": ("stepping_out", {}),
}
SETTLING_MS = 1500  # until tables have come and pictures are drawn
PLACES = {
    "studio": "/studio/grosser_stern_platoon",
    "studio_run": "/studio/grosser_stern_platoon?run=1&time=22",
    "studio_motorway": "/studio/motorway_platoon",
    "studio_motorway_run": "/studio/motorway_platoon?run=4&time=20",
    "studio_left": "/studio/left_hand",
    "studio_grid": "/studio/urban_grid",
    "studio_deck": "/studio/parking_pace",
    "scenarios": "/scenarios",
    "edit": "/edit/grosser_stern_platoon",
    "edit_chosen": "/edit/motorway_platoon?at=vehicles.leader",
    "text": "/scenarios/grosser_stern_platoon/text",
    "runs": "/runs",
    "space": "/runs?as=space",
    "scatter": "/runs?as=space&draw=points",
    "lineage": "/runs?as=lineage",
    "board": "/runs?as=board",
    "run": "/runs/1",
    "queue": "/queue",
    "compare": "/compare?runs=1,2",
    "compare_three": "/compare?runs=1,2,4",
    "compare_empty": "/compare",
    "maps": "/maps",
    "map": "/maps/stern",
    "validate": "/validate",
    "kinds": "/kinds",
    "docs": "/docs/",
    "lost": "/nowhere",
}


@contextmanager
def own() -> Iterator[str]:
    """The address of a server of its own, with something to see at every place."""
    with tempfile.TemporaryDirectory() as folder, served(Path(folder), "--scenarios", SAMPLES) as (client, _, _):
        filled(client)
        yield str(client.base_url)


def filled(client: httpx.Client) -> None:
    """Runs of four scenarios, the first the parent of its own kind, and a decision."""
    for scenario, changes in SHOWN.values():
        client.post("/api/runs", json={"scenario": scenario, "set": changes}).raise_for_status()
    until(lambda: {each["status"] for each in client.get("/api/runs").json()} <= {"done", "failed"}, "the end of the runs")


def pictures(url: str, wanted: argparse.Namespace) -> None:
    """Every place that is wanted, in every size and theme that is."""
    with browser() as opened:
        for theme, size in product(wanted.themes.split(","), wanted.sizes.split(",")):
            page, complaints = watched(opened, base_url=url, viewport=SIZES[size], color_scheme=theme)
            for name in wanted.only.split(",") if wanted.only else PLACES:
                page.goto(PLACES[name])
                settled(page)
                page.screenshot(path=wanted.folder / f"{name}_{theme}_{size}.png")
            sys.stdout.write(f"{theme} {size}: {complaints or 'no complaints'}\n")
            page.close()
        opened.close()


def settled(page) -> None:
    """Until a place shows all that it has: its scene too, where there is one."""
    page.wait_for_timeout(SETTLING_MS)
    expect(page.get_by_role("status", name="The scene is loading")).to_have_count(0)
    expect(page.get_by_text(re.compile("^Loading "))).to_have_count(0)
    page.wait_for_timeout(SETTLING_MS)


def main() -> None:
    """Draws them all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--url", help="of a server that goes on already")
    parser.add_argument("--only", default="", help="names of places, with commas")
    parser.add_argument("--themes", default="light,dark")
    parser.add_argument("--sizes", default=",".join(SIZES))
    wanted = parser.parse_args()
    wanted.folder.mkdir(parents=True, exist_ok=True)
    if wanted.url:
        return pictures(wanted.url, wanted)
    with own() as url:
        return pictures(url, wanted)


if __name__ == "__main__":
    main()
