"""The long form: `python -m tests.rush --cars 300 --minutes 30 --seeds 5 --kept rush.jsonl`. 1 when something is not as it has to be.

Each run that is over is kept in the file; broken off and begun again, by the same command, it goes on with those that are left.
"""

import argparse
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

from tests.rush.kept import commit, keep, kept, left, of_other_size
from tests.rush.outcome import Outcome, markdown, outcome
from tests.rush.place import PLACES


def arguments(given: list[str] | None = None) -> argparse.Namespace:
    """What is asked for."""
    parser = argparse.ArgumentParser(prog="python -m tests.rush", description=__doc__)
    parser.add_argument("--cars", type=int, default=300)
    parser.add_argument("--minutes", type=float, default=30.0, help="of each run, simulated")
    parser.add_argument("--seeds", type=int, default=5, help="from 1 on")
    parser.add_argument("--places", default=",".join(PLACES), help="some of %(default)s, one after the other")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--kept", type=Path, default=Path("rush.jsonl"), help="what is over; the table stands beside it, as .md")
    return parser.parse_args(given)


def main(given: list[str] | None = None) -> int:
    """All places with all seeds, several at a time, but for those that are kept."""
    asked = arguments(given)
    places = asked.places.split(",")
    if unknown := [each for each in places if each not in PLACES]:
        print(f"--places: there is no {', '.join(unknown)}; there are {', '.join(PLACES)}.")
        return 2
    if others := of_other_size(kept(asked.kept), asked.cars, asked.minutes):
        print(f"{asked.kept} has runs with {others[0].cars} cars for {others[0].minutes:g} minutes: ask for these, or keep elsewhere.")
        return 2
    wanted = [(place, seed) for place in places for seed in range(1, asked.seeds + 1)]
    for found in runs(asked, left(wanted, kept(asked.kept))):
        keep(asked.kept, found)
        print("  ".join(found.cells()), flush=True)
        write(asked.kept)
    write(asked.kept)
    return int(any(each.wrong for each in kept(asked.kept)))


def runs(asked: argparse.Namespace, wanted: list[tuple[str, int]]) -> Iterator[Outcome]:
    """They come as they are over."""
    code = commit()  # as it was loaded
    with ProcessPoolExecutor(asked.processes) as pool:
        each = [pool.submit(outcome, place, asked.cars, asked.minutes, seed, code) for place, seed in wanted]
        yield from (run.result() for run in as_completed(each))


def write(file: Path) -> None:
    """The table of all that is kept."""
    found = sorted(kept(file), key=place_and_seed)
    codes = {each.commit for each in found}
    about = f"{len(found)} runs of {len(codes)} versions of the code." if len(codes) > 1 else f"{len(found)} runs."
    sizes = [f"{each.cars} cars, {each.minutes:g} minutes each." for each in found[:1]]
    file.with_suffix(".md").write_text(markdown(found, " ".join([*sizes, about])), encoding="utf-8")


def place_and_seed(each: Outcome) -> tuple[int, int]:
    """The order of the table."""
    return list(PLACES).index(each.place), each.seed


if __name__ == "__main__":
    sys.exit(main())
