"""The long form: `python -m tests.rush --cars 300 --minutes 30 --seeds 5 --out rush.md`. 1 when something is not as it has to be."""

import argparse
import sys
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

from tests.rush.outcome import Outcome, markdown, outcome
from tests.rush.place import PLACES


def arguments() -> argparse.Namespace:
    """What is asked for."""
    parser = argparse.ArgumentParser(prog="python -m tests.rush", description=__doc__)
    parser.add_argument("--cars", type=int, default=300)
    parser.add_argument("--minutes", type=float, default=30.0, help="of each run, simulated")
    parser.add_argument("--seeds", type=int, default=5, help="from 1 on")
    parser.add_argument("--places", default=",".join(PLACES), help=f"some of {', '.join(PLACES)}")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--out", type=Path, default=Path("rush.md"), help="the table; written anew after each run")
    return parser.parse_args()


def main() -> int:
    """All places with all seeds, several at a time."""
    asked, began, found = arguments(), time.monotonic(), []
    asked_for = [(place, seed) for seed in range(1, asked.seeds + 1) for place in asked.places.split(",")]
    with ProcessPoolExecutor(asked.processes) as pool:
        runs = [pool.submit(outcome, place, asked.cars, 60.0 * asked.minutes, seed) for place, seed in asked_for]
        for run in as_completed(runs):
            found.append(run.result())
            print("  ".join(found[-1].cells()), flush=True)
            about = f"{asked.cars} cars, {asked.minutes:g} minutes each; {(time.monotonic() - began) / 60:.0f} minutes of real time."
            asked.out.write_text(markdown(sorted(found, key=place_and_seed), about), encoding="utf-8")
    return int(any(each.wrong for each in found))


def place_and_seed(each: Outcome) -> tuple[int, int]:
    """The order of the table."""
    return list(PLACES).index(each.place), each.seed


if __name__ == "__main__":
    sys.exit(main())
