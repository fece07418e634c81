"""What is made from a map, kept on disk: the second time it is only read back.

A file is named by the digest of everything that it is made of, so those of several versions lie side by side; what nobody reads
for long is removed, and of too much what was used least lately. Anything unreadable counts as nothing and is made again; a full disk
only costs the next making.
"""

import hashlib
import os
import pickle
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from studio.cache import cache_root, forget_old, touch
from studio.source import closure

DIGEST_LENGTH = 64  # hexadecimal digits of SHA-256, as an import gives its map
Made = TypeVar("Made")
MOST_KEPT = 2_000_000_000  # [B] of one kind


def digest_of(*parts: object, maker: str) -> str:
    """Digest of what something is made of, and of the file that makes it with all that this depends on."""
    made_by = [file.read_bytes() for file in closure(Path(maker))]
    digest = hashlib.sha256(repr([part for part in parts if not isinstance(part, bytes)]).encode())
    for part in (*made_by, *(part for part in parts if isinstance(part, bytes))):
        digest.update(part)
    return digest.hexdigest()


def kept_at(kind: str, digest: str) -> Path:
    """The file that keeps the thing of this kind and digest."""
    return cache_root() / kind / f"{digest}.pickle"


def recall(kind: str, digest: str) -> object | None:
    """What was kept, or None."""
    path = kept_at(kind, digest)
    try:
        with path.open("rb") as file:
            checksum, body = file.read(32), file.read()
        touch(path)
        return pickle.loads(body) if hashlib.sha256(body).digest() == checksum else None
    except Exception:  # a damaged pickle can raise anything
        return None


def of_map(digest: str, kind: str, sort: type[Made], make: Callable[[], Made], *parts: object, maker: str) -> Made:
    """What is made of the map of a digest and of `parts`: kept, or made anew and kept; for a map that no import made nothing is."""
    if len(digest) != DIGEST_LENGTH:
        return make()
    name = digest_of(digest, *parts, maker=maker)
    found = recall(kind, name)
    if isinstance(found, sort):
        return found
    made = make()
    keep(kind, name, made)
    return made


def keep(kind: str, digest: str, thing: object) -> None:
    """Writes beside and renames, so that nobody reads a half-written file."""
    body = pickle.dumps(thing, protocol=pickle.HIGHEST_PROTOCOL)
    target = kept_at(kind, digest)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        forget_old(target.parent)
        make_room(target.parent, MOST_KEPT - len(body))
        handle, beside = tempfile.mkstemp(dir=target.parent)
    except OSError:
        return
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(hashlib.sha256(body).digest() + body)
        os.replace(beside, target)
    except OSError:
        Path(beside).unlink(missing_ok=True)


def make_room(folder: Path, most: int) -> None:
    """Removes what was used least lately, until no more than `most` [B] is left; another program may be doing the same."""
    found = sorted(((each, each.stat()) for each in folder.iterdir()), key=lambda pair: pair[1].st_mtime, reverse=True)
    total = 0
    for each, about in found:
        total += about.st_size
        if total > most:
            each.unlink(missing_ok=True)
