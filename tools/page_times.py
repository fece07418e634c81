"""How fast the page is: medians of a few tries, on a server and a browser of this machine.

    python tools/page_times.py             everything
    python tools/page_times.py --runs 2000 a smaller table

The table is filled with copies of one real run, each with a headway of its own. Budgets are those of the product; a machine that does
other work meanwhile is slower than its own.
"""

import argparse
import gzip
import json
import random
import sqlite3
import statistics
import sys
import tempfile
import time
from contextlib import closing
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from playwright.sync_api import expect  # noqa: E402 - the tests' browser and server are those that are measured

from tests.browser.browser import browser, watched  # noqa: E402
from tests.patience import until  # noqa: E402
from tests.server.server import served  # noqa: E402

SAMPLE = ROOT / "scenarios" / "grosser_stern_platoon.yaml"
BUDGET = {
    "main bundle, gzip [kB]": 350.0, "Runs, first row [s]": 1.0, "Runs, filtered [s]": 0.3, "all runs, REST [s]": 2.0,
    "compare two runs, REST [s]": 0.5, "compare eight runs, REST [s]": 1.0, "compare two runs, page [s]": 0.5,
}  # fmt: skip
REPEATS = 5
HEADWAY = "applications.platoon.parameters.headway"


def main() -> None:
    """Measures, and prints a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=10_000, help="rows of the table of runs")
    runs = parser.parse_args().runs
    with tempfile.TemporaryDirectory() as place, browser() as opened, served(Path(place), "--scenarios", SAMPLE.parent) as (client, db, _):
        first(client)
        copies(db, runs)
        page, _ = watched(opened, base_url=str(client.base_url), viewport={"width": 1920, "height": 1080})
        found = {"main bundle, gzip [kB]": bundle()} | measured(client, page)
        opened.close()
    print(f"{runs} runs; medians of {REPEATS}")
    for name, value in found.items():
        print(f"{name:32} {value:8.2f}   budget {BUDGET[name]:g}{'   OVER' if value > BUDGET[name] else ''}")


def bundle() -> float:
    """What a browser loads before anything is shown [kB]: the script that the page names."""
    page = (ROOT / "studio" / "_web" / "index.html").read_text(encoding="utf-8")
    name = page.split('src="/assets/')[1].split('"')[0]
    return len(gzip.compress((ROOT / "studio" / "_web" / "assets" / name).read_bytes(), 9)) / 1000


def first(client) -> None:
    """Eight real runs to compare, one of them to be copied."""
    for seed in range(1, 9):
        changes = {"clock.duration": 5.0, HEADWAY: 0.5 + seed / 10}
        client.post("/api/runs", json={"scenario": SAMPLE.stem, "seed": seed, "set": changes}).raise_for_status()
    until(lambda: {each["status"] for each in client.get("/api/runs").json()} == {"done"}, "the end of the runs")


def copies(db: Path, count: int) -> None:
    """Fills the table with copies of run 1."""
    with closing(sqlite3.connect(db, timeout=60.0)) as connection, connection:
        copied(connection, "runs", count)
        copied(connection, "metrics", count)


def copied(connection: sqlite3.Connection, table: str, count: int) -> None:
    """Copies the rows of run 1 in a table, with other headways, other dates, and values that differ."""
    names = [row[1] for row in connection.execute(f"pragma table_info({table})")]
    rows = [dict(zip(names, row, strict=True)) for row in connection.execute(f"select * from {table} where run = 1")]
    draw = random.Random(1)
    for run in range(9, count + 1):
        for row in rows:
            new = row | {"run": run} | ({"id": None} if "id" in row else {})
            if "parameters" in row:
                new["parameters"] = json.dumps(json.loads(row["parameters"]) | {HEADWAY: round(draw.uniform(0.4, 2.0), 2)})
            if isinstance(row.get("value"), float):
                new["value"] = row["value"] * draw.uniform(0.8, 1.2)
            connection.execute(
                f"insert into {table} ({', '.join(names)}) values ({', '.join('?' * len(names))})", [new[each] for each in names]
            )


def measured(client, page) -> dict[str, float]:
    """Everything that takes time [s]."""
    return {
        "Runs, first row [s]": median(lambda: listed(page)),
        "Runs, filtered [s]": median(lambda: filtered(page)),
        "all runs, REST [s]": median(lambda: client.get("/api/runs?limit=10000").raise_for_status()),
        "compare two runs, REST [s]": median(lambda: client.get("/api/beside?runs=1,2").raise_for_status()),
        "compare eight runs, REST [s]": median(lambda: client.get("/api/beside?runs=1,2,3,4,5,6,7,8").raise_for_status()),
        "compare two runs, page [s]": median(lambda: compared(page)),
    }


def median(action) -> float:
    """The median time of an action [s]."""
    times = []
    for _ in range(REPEATS):
        began = time.perf_counter()
        action()
        times.append(time.perf_counter() - began)
    return statistics.median(times)


def listed(page) -> None:
    """The table of runs, from its address to its first row."""
    page.goto("/runs")
    expect(page.get_by_test_id("runs-table").locator("tbody tr").first).to_be_visible()


def filtered(page) -> None:
    """A filter, from its last key to the count of what it leaves."""
    before = page.get_by_label("Filter the runs")
    before.fill(f"headway < {random.uniform(0.6, 1.0):.3f}")
    expect(page.get_by_test_id("runs-table").locator("tbody tr").first).to_be_visible()


def compared(page) -> None:
    """Two other runs beside each other, from the choice to the table of metrics: a place of the page that is open."""
    a, b = random.sample(range(1, 9), 2)
    page.evaluate("(to) => { history.pushState({}, '', to); dispatchEvent(new PopStateEvent('popstate')); }", f"/compare?runs={a},{b}")
    expect(page.get_by_test_id("compare-metrics")).to_contain_text(f"#{a}")


if __name__ == "__main__":
    main()
