"""What the doctor finds: good or bad, in one line, what would mend it, and how he does so himself where he can."""

import sqlite3
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from studio.errors import StudioError

GIGA, MEGA = 1e9, 1e6


@dataclass(frozen=True)
class Patient:
    """What is looked at: a run database, whether somebody has named it, and the address to serve on."""

    db: Path
    is_named: bool
    host: str
    port: int


@dataclass(frozen=True)
class Finding:
    """One line. `mend` does what the remedy says, and tells what it has done; it raises StudioError, OSError or an error of SQLite."""

    name: str
    is_good: bool
    what: str
    remedy: str = ""
    mend: Callable[[], str] | None = None

    def as_json(self, mended: str = "") -> dict[str, Any]:
        """For scripts; `mended` is what has been done."""
        plain = {"name": self.name, "good": self.is_good, "what": self.what, "remedy": self.remedy}
        return plain | {"can_mend": self.mend is not None, "mended": mended}


Check = Callable[[Patient], Iterator[Finding]]
TROUBLE = (StudioError, OSError, sqlite3.Error)


def in_one_line(trouble: object) -> str:
    """What went wrong."""
    return " ".join(str(trouble).split())


def good(name: str, what: str) -> Finding:
    """All is well."""
    return Finding(name, True, what)


def size(count: float) -> str:
    """Bytes for people."""
    return f"{count / GIGA:.1f} GB" if count >= GIGA else f"{count / MEGA:.1f} MB"
