"""What a campaign keeps: a file with a line of JSON for each run that is over, so that one that was broken off goes on where it ended.

A file belongs to one size of runs, and holds them to it. Runs of several commits may stand in it; each line says of which it is, and the
table tells so. Who wants all of them of the present code begins a new file.
"""

import json
import subprocess
from collections.abc import Iterable
from pathlib import Path

from studio.source import code_version
from tests.conftest import ROOT
from tests.rush.outcome import Outcome


def kept(file: Path) -> list[Outcome]:
    """All runs in a file; a last line that was broken off while it was written is none."""
    text = file.read_text(encoding="utf-8") if file.exists() else ""
    return [Outcome(**json.loads(line)) for line in text.splitlines(keepends=True) if line.endswith("\n")]


def keep(file: Path, found: Outcome) -> None:
    """One more line; what was broken off before it is gone."""
    whole = file.read_bytes() if file.exists() else b""
    with file.open("r+b" if whole else "wb") as lines:
        lines.truncate(whole.rfind(b"\n") + 1)
        lines.seek(0, 2)
        lines.write(json.dumps(found._asdict(), ensure_ascii=False).encode() + b"\n")


def left(asked: Iterable[tuple[str, int]], runs: Iterable[Outcome]) -> list[tuple[str, int]]:
    """Places and seeds that have not been run yet, in their order."""
    over = {(each.place, each.seed) for each in runs}
    return [each for each in asked if each not in over]


def of_other_size(runs: Iterable[Outcome], cars: int, minutes: float) -> list[Outcome]:
    """Runs with another number of cars, or of another length."""
    return [each for each in runs if (each.cars, each.minutes) != (cars, minutes)]


def commit() -> str:
    """The commit that is checked out, with `-dirty` where something is not committed, and the digest of the code that computes."""
    asked = ["git", "-C", str(ROOT), "describe", "--always", "--dirty", "--match", "no tag"]
    told = subprocess.run(asked, capture_output=True, text=True, check=False).stdout.strip()
    return " ".join(filter(None, (told, code_version().rpartition("+")[2])))
