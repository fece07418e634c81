"""What people say of runs: a verdict with its reason, by whom and when; a name, tags and a note.

Verdicts are a history: a new one stands behind those before it, and nothing is overwritten. The last one counts, and a run of which
nobody has said anything is open. Name, tags and note are what they were set to last.
"""

import getpass
import json
import unicodedata
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from typing import Any

from studio.errors import Problem, StudioError, short
from studio.store.runs import VERDICTS, Runs

OPEN, CANDIDATE, DISCARDED = VERDICTS
UNFINISHED = ("waiting", "running")
LONGEST_LINE, LONGEST_NOTE, MOST_TAGS = 500, 20_000, 20  # letters, letters, tags


@dataclass(frozen=True)
class Verdict:
    """What somebody has decided about a run, why, who he is, and when, in UTC."""

    verdict: str
    reason: str
    who: str
    when: str

    def as_json(self) -> dict[str, Any]:
        """Plain data."""
        return asdict(self)


@dataclass(frozen=True)
class Remark:
    """What a run is called, what it is found by, and a text about it."""

    name: str = ""
    tags: tuple[str, ...] = ()
    note: str = ""


def judge(runs: Runs, run: int, verdict: str, reason: str, who: str = "") -> Verdict:
    """A verdict about a run that is over; without `who` it is that of the user of this machine.

    Raises StudioError for a run that goes on, a candidate that did not come to its end, a verdict that there is not, and a reason that
    says nothing or is no line; UnknownError when there is no such run.
    """
    made = checked(runs, run, verdict, reason, who)
    with runs.writing():
        runs.database.table("verdicts").insert({"run": run, **made.as_json()})
    return made


def checked(runs: Runs, run: int, verdict: str, reason: str, who: str) -> Verdict:
    """A verdict that may be given, and is not yet; raises what `judge` raises."""
    check(verdict in VERDICTS, "verdict", "is none", verdict, ", ".join(VERDICTS))
    status = runs.find(run).status
    what, remedy = f"is about run {run}, which is not over", "wait for its end, or stop it"
    check(status not in UNFINISHED, "verdict", what, status, "a run that is over", remedy)
    what = f"is candidate, but run {run} did not come to its end"
    check(verdict != CANDIDATE or status == "done", "verdict", what, status, "done", "run it again")
    made = Verdict(verdict, line(reason, "reason"), line(who or user(), "who"), datetime.now(UTC).isoformat(timespec="milliseconds"))
    check(bool(made.reason), "reason", "is missing", "", "one line", "say why, for who reads it later")
    return made


def verdicts(runs: Runs, run: int) -> list[Verdict]:
    """All that was decided about a run, the first first; raises UnknownError when there is none of that number."""
    runs.find(run)
    return [Verdict(**row) for row in runs.rows('select verdict, reason, who, "when" from verdicts where run = ? order by rowid', [run])]


def remark(runs: Runs, run: int, *, name: str, tags: Sequence[str], note: str) -> Remark:
    """Sets name, tags and note of a run, all three; raises StudioError for what is too long or no line, and UnknownError."""
    runs.find(run)
    made = as_remark(name=name, tags=tags, note=note)
    row = {"run": run, "name": made.name, "tags": json.dumps(made.tags, ensure_ascii=False), "note": made.note}
    with runs.writing():
        runs.database.table("remarks").insert(row, pk="run", replace=True)
    return made


def as_remark(*, name: str, tags: Sequence[str], note: str) -> Remark:
    """A remark as it may be kept, each tag once; raises StudioError for what is too long or no line."""
    check(len(note) <= LONGEST_NOTE, "note", "is too long", f"{len(note)} letters", f"at most {LONGEST_NOTE}")
    kept = [line(each, f"tags[{i}]") for i, each in enumerate(tags)]
    check(all(kept), "tags", "has one that says nothing", "", "words")
    made = Remark(line(name, "name"), tuple(dict.fromkeys(kept)), storable(note, "note"))
    check(len(made.tags) <= MOST_TAGS, "tags", "are too many", str(len(made.tags)), f"at most {MOST_TAGS}")
    return made


def remark_of(runs: Runs, run: int) -> Remark:
    """What it is called; raises UnknownError when there is no such run."""
    runs.find(run)
    for row in runs.rows("select name, tags, note from remarks where run = ?", [run]):
        with runs.intact(run, "remark"):
            return Remark(row["name"], tuple(json.loads(row["tags"])), row["note"])
    return Remark()


# -- what may be said ------------------------------------------------------------------------------------


def line(text: str, where: str) -> str:
    """A text of one line, without room around it; raises StudioError for anything else."""
    found = storable(text, where).strip()
    is_line = all(unicodedata.category(letter) not in ("Cc", "Zl", "Zp") for letter in found)
    check(is_line, where, "is more than a line", short(found), "one line")
    check(len(found) <= LONGEST_LINE, where, "is too long", f"{len(found)} letters", f"at most {LONGEST_LINE}")
    return found


def storable(text: str, where: str) -> str:
    """A text as it is, if it is one; raises StudioError for half a character."""
    check(not any(unicodedata.category(letter) == "Cs" for letter in text), where, "holds half a character", "", "text")
    return text


def check(is_right: bool, where: str, what: str, value: str, allowed: str, remedy: str = "") -> None:
    """Raises StudioError when something is not as it may be."""
    if not is_right:
        raise StudioError("That cannot be said of a run.", [Problem(where, what, short(value), allowed, remedy)])


def user() -> str:
    """Who uses this machine."""
    try:
        return getpass.getuser()
    except (OSError, KeyError):  # a user without a name
        return "somebody"
