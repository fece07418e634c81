"""What the process of an errand has around it: bounded memory, and news to the server over a pipe as long as somebody listens."""

import sys
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

MOST_MEMORY = 6 * 2**30  # [B] of address space of a process


class ServerGone(Exception):
    """Nobody listens any more."""


def confine() -> None:
    """Takes no more memory than allowed, and is the first to go when the machine has none left."""
    if sys.platform == "win32":
        return  # knows no such limits
    import resource

    _, most = resource.getrlimit(resource.RLIMIT_AS)
    limit = MOST_MEMORY if most == resource.RLIM_INFINITY else min(MOST_MEMORY, most)
    with suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_AS, (limit, most))
    if sys.platform == "linux":
        with suppress(OSError):
            Path("/proc/self/oom_score_adj").write_text("1000")


def tell(pipe: Connection, *words: Any) -> None:
    """Tells the server something; raises ServerGone."""
    try:
        pipe.send(words)
    except OSError:
        raise ServerGone from None
