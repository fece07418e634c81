"""The cache: a folder for everything that can be made again, machine code and what is made from maps.

Versions and programs lie beside each other in it. Nobody deletes what another uses: whatever is used is touched, and what
nobody has touched for two months is removed.
"""

import os
import shutil
import time
from contextlib import suppress
from pathlib import Path

import platformdirs

FORGOTTEN_AFTER = 60 * 86400.0  # [s]
TOUCHED_AGAIN_AFTER = 86400.0  # [s]


def cache_root() -> Path:
    """The folder, the user's own; STUDIO_CACHE names another."""
    return Path(os.environ.get("STUDIO_CACHE") or platformdirs.user_cache_dir("cooperative-adas-studio"))


def touch(path: Path) -> None:
    """Notes, once a day, that a file or folder is in use."""
    if time.time() - path.stat().st_mtime > TOUCHED_AGAIN_AFTER:
        os.utime(path)


def forget_old(folder: Path) -> None:
    """Removes what nobody has used for long; another program may be doing the same."""
    oldest = time.time() - FORGOTTEN_AFTER
    for stale in folder.iterdir():
        with suppress(FileNotFoundError):
            if stale.stat().st_mtime < oldest:
                shutil.rmtree(stale) if stale.is_dir() else stale.unlink()
