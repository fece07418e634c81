"""A check of conformance: what is looked at, and what is wrong, with what to do about it."""

import traceback
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Check:
    """One thing that a kind must keep. `wrong` says what was found and what to do; empty when all is well."""

    what: str
    wrong: str = ""

    def __str__(self) -> str:
        return f"{'failed' if self.wrong else 'ok':6}  {self.what}" + "".join(f"\n        {line}" for line in self.wrong.splitlines())


def tried(what: str, action: Callable[[], str | None]) -> Check:
    """A check that is done by a function: it returns what is wrong, or nothing; what it raises is wrong too."""
    try:
        return Check(what, action() or "")
    except Exception:
        return Check(what, f"it raised:\n{traceback.format_exc().strip()}")
