"""Whether the machine is well: room on its disks, folders that can be written, a port to serve on."""

import errno
import os
import shutil
import socket
from collections.abc import Iterator
from pathlib import Path

import httpx

from studio.cache import cache_root
from studio.doctor.finding import GIGA, Finding, Patient, good, size
from studio.store import waiting

LEAST_FREE = 1 * GIGA  # [B]; a long run with all channels takes some hundred megabytes
PATIENCE = 5.0  # [s] for who serves on a port to answer


def space(patient: Patient) -> Iterator[Finding]:
    """The folders that the studio writes to: database, results that wait, cache."""
    folders = {"database": patient.db.absolute().parent, "results": waiting.folders(patient.db)[1], "cache": cache_root()}
    for what, folder in folders.items():
        yield room("space", what, nearest_there(folder))


def nearest_there(folder: Path) -> Path:
    """A folder, or the one in which it would be made."""
    return folder if folder.is_dir() else next(each for each in folder.absolute().parents if each.is_dir())


def room(name: str, what: str, folder: Path) -> Finding:
    """Whether a folder can be written, and has room."""
    free = shutil.disk_usage(folder).free
    told = f"{size(free)} are free for the {what}, in {folder}"
    if not os.access(folder, os.W_OK | os.X_OK):
        return Finding(name, False, f"{folder}, for the {what}, cannot be written", "make it writable for you")
    if free < LEAST_FREE:
        return Finding(name, False, told, f"make room: a long run may want {size(LEAST_FREE)}")
    return good(name, told)


def port(patient: Patient) -> Iterator[Finding]:
    """Whether the studio can serve there, or does so already."""
    where = f"{patient.host} port {patient.port}"
    taken = refused(patient.host, patient.port)
    if taken is None:
        yield good("port", f"{where} is free")
    elif taken.errno == errno.EADDRINUSE and (served := studio_at(patient.host, patient.port)):
        yield good("port", f"{where}: {served}")
    else:
        yield Finding("port", False, f"{where} cannot be served on: {taken.strerror or taken}", f"try --port {patient.port % 65535 + 1}")


def refused(host: str, number: int) -> OSError | None:
    """Why nobody can serve there; None when one can."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.socket(family, socket.SOCK_STREAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((host, number))
            probe.listen()
        except OSError as error:
            return error
    return None


def studio_at(host: str, number: int) -> str:
    """What a studio that serves there says of itself; "" when it is none."""
    named = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(host, host)
    try:
        answer = httpx.get(f"http://{f'[{named}]' if ':' in named else named}:{number}/api/info", timeout=PATIENCE, trust_env=False)
        said = answer.json()
        if answer.status_code == 401 and "problems" in said:
            return "a studio serves there that wants its token"
        return f"a studio serves {said['db']} there"
    except (httpx.HTTPError, ValueError, LookupError, TypeError):
        return ""
