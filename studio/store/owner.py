"""Who works on a run: a process of some machine; and whether it has gone.

A process is known by its number and by when it began. On Linux that is counted in ticks of the kernel since this start of the machine,
which no step of the clock changes; the start has an identity of its own. A number can be given to another process later, so can it in
another container, and nobody can see the processes of another machine: of those it is not said that they have gone.
"""

import json
import os
import socket
from contextlib import suppress
from pathlib import Path
from typing import Any

import psutil

PARTS = 4  # of a mark
STATE, STARTED = 0, 19  # fields of /proc/PID/stat behind the name, proc(5)


def mark(process: int) -> str:
    """What a process is known by: host, start of the machine, container, and when it began. Raises psutil.NoSuchProcess."""
    return json.dumps([socket.gethostname(), *this_system(), began(process)])


def is_gone(process: int, known: str | None) -> bool:
    """Whether a process, known by its mark, has gone for sure; an older studio made no mark."""
    if (marked := parts(known)) is None:
        return not psutil.pid_exists(process)
    host, start, container, when = marked
    now, here = this_system()
    if (now, here) != (start, container):
        return host == socket.gethostname() and now != start  # the machine was started again
    try:
        return began(process) != when
    except psutil.NoSuchProcess:
        return True


def is_here(known: str | None) -> bool:
    """Whether a process, known by its mark, is one of this machine since its last start, and of this container."""
    marked = parts(known)
    return marked is not None and (marked[1], marked[2]) == this_system()


def parts(known: str | None) -> list[Any] | None:
    """What a mark says; nothing when there is none, or when it is damaged."""
    with suppress(ValueError, RecursionError):
        found = json.loads(known or "null")
        return found if isinstance(found, list) and len(found) == PARTS else None
    return None


def this_system() -> tuple[str, str]:
    """This start of the machine, and this container; empty where nobody tells."""
    try:
        return Path("/proc/sys/kernel/random/boot_id").read_text().strip(), os.readlink("/proc/self/ns/pid")
    except OSError:
        return "", ""


def began(process: int) -> float:
    """When a process began, in ticks of the kernel or by the clock [s]. Raises psutil.NoSuchProcess, for one that has ended too."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return psutil.Process(process).create_time()
    if fields[STATE] in "ZX":
        raise psutil.NoSuchProcess(process)
    return float(fields[STARTED])
