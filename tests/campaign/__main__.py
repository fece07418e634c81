"""The long form: `python -m tests.campaign --parts rest,files,faults,soak --seed 1 --minutes 60 --out table.md`."""

import argparse
import signal
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from tests.campaign import faults, files, rest, soak
from tests.campaign.formats import FORMATS
from tests.campaign.station import Station, quick_run
from tests.campaign.table import Row, markdown

SHARES = {"rest": 0.25, "files": 0.3, "faults": 0.25, "soak": 0.2}  # of the time, where all parts are asked for
MOST = 10**9


def arguments() -> argparse.Namespace:
    """What is asked for."""
    parser = argparse.ArgumentParser(prog="python -m tests.campaign", description=__doc__)
    parser.add_argument("--parts", default=",".join(SHARES), help="some of rest, files, faults, soak")
    parser.add_argument("--seed", type=int, default=1, help="the same seed makes the same inputs")
    parser.add_argument("--minutes", type=float, default=60.0, help="for all parts together; kinds share the time of their part")
    parser.add_argument("--inputs", type=int, default=MOST, help="of each kind of request and file, at most")
    parser.add_argument("--tries", type=int, default=3, help="of each kind of fault")
    parser.add_argument("--runs", type=int, default=MOST, help="of the soak, at most")
    parser.add_argument("--kind", default="", help="only kinds whose name holds this")
    parser.add_argument("--out", type=Path, default=Path("campaign.md"), help="the table; written anew after each row")
    return parser.parse_args()


def main() -> int:
    """Runs the parts one after another; 1 when something was wrong."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # ends its servers too
    signal.signal(signal.SIGHUP, lambda *_: None)  # what nohup ignores, its servers would ignore too
    asked = arguments()
    parts = asked.parts.split(",")
    whole = sum(SHARES[each] for each in parts)
    rows: dict[tuple[str, str], Row] = {}  # the last word on each kind
    began = time.monotonic()
    for part in parts:
        seconds = 60.0 * asked.minutes * SHARES[part] / whole
        for row in PARTS[part](asked, seconds):
            rows[row.part, row.kind] = row
            print("  ".join(row.cells()), flush=True)
            about = f"Seed {asked.seed}, {(time.monotonic() - began) / 60:.0f} minutes."
            asked.out.write_text(markdown(rows.values(), about), encoding="utf-8")
    return int(any(row.wrongs or row.late for row in rows.values()))


def of_rest(asked: argparse.Namespace, seconds: float) -> Iterator[Row]:
    """Requests to one server."""
    with tempfile.TemporaryDirectory(prefix="studio-campaign-") as folder, Station(Path(folder)) as station:
        quick_run(station)
        siege = rest.Siege(station)
        yield from rest.rows(siege, seed=asked.seed, count=asked.inputs, seconds=seconds, only=asked.kind)


def of_files(asked: argparse.Namespace, seconds: float) -> Iterator[Row]:
    """Files of every kind."""
    chosen = [name for name in FORMATS if asked.kind in name]
    with files.Reader() as reader:
        for name in chosen:
            yield files.campaign(reader, name, seed=asked.seed, count=asked.inputs, seconds=seconds / len(chosen))


def of_faults(asked: argparse.Namespace, seconds: float) -> Iterator[Row]:
    """Faults, each so many times as there is time for, but once at least."""
    with tempfile.TemporaryDirectory(prefix="studio-campaign-") as folder:
        each = seconds / len(faults.FAULTS)
        yield from faults.rows(Path(folder), seed=asked.seed, count=asked.tries, seconds=each, only=asked.kind)


def of_soak(asked: argparse.Namespace, seconds: float) -> Iterator[Row]:
    """Live runs on one server, spread over the time; it is told on the way how it goes."""
    with tempfile.TemporaryDirectory(prefix="studio-campaign-") as folder, Station(Path(folder)) as station:
        for rows in soak.campaign(station, seed=asked.seed, count=asked.runs, seconds=seconds):
            yield from rows


PARTS = {"rest": of_rest, "files": of_files, "faults": of_faults, "soak": of_soak}

if __name__ == "__main__":
    raise SystemExit(main())
