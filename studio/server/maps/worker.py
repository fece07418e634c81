"""The process of one import: whatever a map does to it, it ends that import and nothing else.

News go out over a pipe as tuples that begin with a word:

    out   stage, commit, done | failed
    in    go        the answer to commit: from here on the folder is written, and nobody ends the process any more
"""

import tempfile
from contextlib import suppress
from dataclasses import dataclass, field, replace
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from studio.errors import MapError, Problem, StudioError
from studio.road.library import intake
from studio.server.errand import MOST_MEMORY, ServerGone, confine, tell

SHARES = {"reading": 0.05, "building": 0.3, "placing": 0.7, "writing": 0.95}  # of the work, by the first word of a stage


@dataclass(frozen=True)
class Order:
    """What to do: a function of `intake` with its arguments, the folder to make, and where to put what is temporary."""

    task: str  # take, fetch, correct or undo
    out: Path
    scratch: Path
    given: dict[str, Any] = field(default_factory=dict)


def main(pipe: Connection, order: Order) -> None:
    """The process: does what it is ordered to do, and tells how it goes."""
    tempfile.tempdir = str(order.scratch)
    confine()
    with suppress(ServerGone):
        tell(pipe, *outcome(pipe, order))


def outcome(pipe: Connection, order: Order) -> tuple[Any, ...]:
    """Does it; the last word about it. Raises ServerGone."""
    try:
        told = {"progress": lambda text: tell(pipe, "stage", text, SHARES.get(text.split()[0])), "commit": lambda: ask(pipe)}
        getattr(intake, order.task)(out=order.out, **order.given, **told)
        return "done", None
    except StudioError as error:
        return "failed", without(error, order)
    except MemoryError:
        limit = f"{MOST_MEMORY / 2**30:g} GiB"
        return "failed", MapError(
            "The map needs more memory than an import may take.", [Problem("map", "is too large", "", limit, "cut out a smaller place")]
        )
    except ServerGone:
        raise
    except Exception as error:
        return "failed", MapError("The map cannot be imported.", [Problem("importer", "failed", f"{type(error).__name__}: {error}"[:300])])


def without(error: StudioError, order: Order) -> StudioError:
    """The error without the places of this machine in its texts."""

    def cleaned(text: str) -> str:
        return text.replace(f"{order.scratch}/", "").replace(f"{order.out.parent}/", "")

    problems = [replace(each, **{key: cleaned(value) for key, value in vars(each).items()}) for each in error.problems]
    return type(error)(cleaned(error.message), problems)


def ask(pipe: Connection) -> None:
    """Asks whether the folder may be written, and waits until it may; raises ServerGone."""
    tell(pipe, "commit")
    try:
        pipe.recv()
    except (EOFError, OSError):
        raise ServerGone from None
