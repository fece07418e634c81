"""Whether the cache is well: machine code of old sources, what is made from maps, how much of both. All of it can be made again."""

import hashlib
import shutil
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from studio.cache import FORGOTTEN_AFTER, TOUCHED_AGAIN_AFTER, cache_root
from studio.doctor.finding import Finding, Patient, good, size
from studio.road.kept import MOST_KEPT, make_room

MOST_STALE = 500e6  # [B] of machine code that nobody uses
UNUSED_AFTER = 2 * TOUCHED_AGAIN_AFTER  # [s] what is used is touched once a day
CHECKSUM = 32  # [B] at the beginning of a file


def code(_: Patient) -> Iterator[Finding]:
    """Machine code of other sources than these, which nobody has used for days."""
    from studio.compiled import CACHE, folder_of
    from studio.warmup import files

    present = {folder_of(path) for path in files()}
    stale = [each for each in CACHE.iterdir() if each not in present and age(each) > UNUSED_AFTER]
    total = sum(map(weight, stale))
    what = f"{CACHE}: {size(weight(CACHE))}, {size(total)} of it of other sources and unused for days"
    if total < MOST_STALE:
        yield good("compiled", what)
    else:
        yield Finding("compiled", False, what, "removes what is unused", lambda: remove(stale))


def maps(_: Patient) -> Iterator[Finding]:
    """What is made from maps, kind by kind: files that are torn, long unused or left over, and too many of them."""
    for folder in sorted(each for each in cache_root().iterdir() if each.is_dir() and each.name != "compiled"):
        stale = [each for each in folder.iterdir() if each.is_file() and is_stale(each)]
        what = f"{folder}: {size(weight(folder))}"
        if stale:
            what += f", {len(stale)} files torn, left over or unused for two months"
            yield Finding(folder.name, False, what, "removes them", lambda stale=stale: remove(stale))
        elif weight(folder) > MOST_KEPT:
            yield Finding(
                folder.name,
                False,
                f"{what}, more than {size(MOST_KEPT)}",
                "removes what was used least lately",
                lambda f=folder: lighten(f),
            )
        else:
            yield good(folder.name, what)


def is_stale(file: Path) -> bool:
    """Whether nobody will read a file: unused for long, half written by somebody who has gone, or not as it was written."""
    try:
        if file.suffix != ".pickle":
            return age(file) > UNUSED_AFTER
        return age(file) > FORGOTTEN_AFTER or is_torn(file)
    except FileNotFoundError:
        return False


def is_torn(file: Path) -> bool:
    """Whether a file is not as it was written."""
    with file.open("rb") as content:
        checksum = content.read(CHECKSUM)
        return hashlib.file_digest(content, "sha256").digest() != checksum


def age(path: Path) -> float:
    """How long nobody has used it [s]."""
    return time.time() - path.stat().st_mtime


def weight(path: Path) -> int:
    """Size of a file, or of all files in a folder [B]."""
    total = 0
    for each in path.rglob("*") if path.is_dir() else [path]:
        with suppress(FileNotFoundError):
            total += each.stat().st_size if each.is_file() else 0
    return total


def remove(stale: list[Path]) -> str:
    """Removes files and folders; somebody else may be doing the same."""
    total = sum(map(weight, (each for each in stale if each.exists())))
    for each in stale:
        with suppress(FileNotFoundError):
            shutil.rmtree(each) if each.is_dir() else each.unlink()
    return f"{len(stale)} are removed, {size(total)}"


def lighten(folder: Path) -> str:
    """Removes what was used least lately."""
    make_room(folder, MOST_KEPT)
    return f"{size(weight(folder))} are left"
