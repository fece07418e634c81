"""What can be made again lies beside that of other versions, and goes when nobody has used it for long."""

import os
import time

import pytest

from studio import cache
from studio.road import kept


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty cache."""
    monkeypatch.setenv("STUDIO_CACHE", str(tmp_path))
    return tmp_path


def test_what_is_long_unused_is_forgotten(tmp_path):
    for name in ("old", "used"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "code.nbc").touch()
        (tmp_path / f"{name}.py").touch()
    for name in ("old", "old.py"):
        os.utime(tmp_path / name, (0, 0))
    cache.forget_old(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"used", "used.py"}


def test_use_is_noted_once_a_day(tmp_path):
    path, now = tmp_path / "thing", time.time()
    path.touch()
    for age, noted in ((3600.0, False), (3 * 86400.0, True)):
        os.utime(path, (now - age, now - age))
        cache.touch(path)
        assert (path.stat().st_mtime > now - 60.0) is noted


def test_a_map_that_is_read_stays_and_one_that_is_not_goes(folder):
    """Another version's map lies beside; it goes only when nobody has read it for two months."""
    kept.keep("maps", "read", 1)
    kept.keep("maps", "unread", 2)
    for name in ("read", "unread"):
        os.utime(kept.kept_at("maps", name), (0, 0))
    assert kept.recall("maps", "read") == 1
    kept.keep("maps", "new", 3)
    assert {path.stem for path in (folder / "maps").iterdir()} == {"read", "new"}


def test_of_too_much_what_was_used_least_lately_goes(tmp_path):
    for age, name in enumerate(("newest", "older", "oldest")):
        (tmp_path / name).write_bytes(b"x" * 100)
        os.utime(tmp_path / name, (1e9 - age, 1e9 - age))
    kept.make_room(tmp_path, 250)
    assert {path.name for path in tmp_path.iterdir()} == {"newest", "older"}
    kept.make_room(tmp_path, -1)
    assert not list(tmp_path.iterdir())
