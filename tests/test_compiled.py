"""Machine code is kept, never stale, and never mixed up."""

import importlib
import os
import sys
from pathlib import Path

import pytest

from studio import compiled
from studio.compiled import PACKAGE, Locator, closure, digest_of, folder_of, imports

MOTION, TYRE, SAFETY = (PACKAGE / room / name for room, name in (("world", "motion.py"), ("model", "tyre.py"), ("assess", "safety.py")))


@pytest.fixture
def program(tmp_path, monkeypatch):
    """A folder of modules that somebody loaded; call it with name and text, in the order of their imports."""
    monkeypatch.syspath_prepend(tmp_path)

    def write(name, text):
        (tmp_path / f"{name}.py").write_text(text)
        importlib.invalidate_caches()
        sys.modules.pop(name, None)
        imports.cache_clear()
        digest_of.cache_clear()
        return importlib.import_module(name)

    yield write
    for path in tmp_path.glob("*.py"):
        sys.modules.pop(path.stem, None)
    imports.cache_clear()
    digest_of.cache_clear()


@pytest.mark.parametrize(
    "text",
    [
        "import helper_of_mine\n",
        "import math, helper_of_mine as h  # a comment\n",
        "from helper_of_mine import gain\n",
        "from helper_of_mine import (\n    gain,  # the one\n    gain as other,\n)\n",
        "from helper_of_mine import *\n",
        "def f():\n    from helper_of_mine import gain\n",
    ],
)
def test_whatever_a_file_imports_is_known(program, text):
    helper = program("helper_of_mine", "gain = 1\n")
    own = program("own_of_mine", text)
    assert [path.name for path in closure(Path(own.__file__))] == ["helper_of_mine.py", "own_of_mine.py"]
    assert helper.__file__ in map(str, imports(Path(own.__file__)))


def test_a_vehicle_depends_on_its_tyre_and_not_on_metrics():
    assert TYRE in closure(MOTION) and SAFETY not in closure(MOTION)
    assert MOTION in closure(SAFETY)
    assert not [path for path in closure(MOTION) if "site-packages" in path.parts]


USER = "from studio.compiled import compiled\nfrom helper_of_mine import gain\n\n@compiled\ndef twice(x):\n    return 2 * gain(x)\n"
HELPER = "from studio.compiled import compiled\n\n@compiled\ndef gain(x):\n    return {} * x\n"


def test_a_changed_helper_is_compiled_anew(program):
    """The file of `twice` stays as it is; what it calls has changed."""
    program("helper_of_mine", HELPER.format(3))
    assert program("own_of_mine", USER).twice(1.0) == 6.0
    program("helper_of_mine", HELPER.format(5))
    assert program("own_of_mine", USER).twice(1.0) == 10.0
    again = program("own_of_mine", USER).twice
    assert again(1.0) == 10.0 and sum(again.stats.cache_hits.values()) == 1


def test_two_processes_that_compile_at_once_do_not_mix_their_code(program):
    """Both find an empty index; each writes code for another type."""
    program("helper_of_mine", HELPER.format(3))
    one, other = program("own_of_mine", USER).twice, program("own_of_mine", USER).twice
    read = other._cache._cache_file._load_index
    other._cache._cache_file._load_index = dict  # what it read before the first had written
    assert one(1.5) == 9.0 and other(2) == 12
    other._cache._cache_file._load_index = read
    later = program("own_of_mine", USER).twice
    assert later(1.5) == 9.0 and later(2) == 12


def test_what_is_long_unused_is_forgotten(tmp_path):
    for name in ("old", "used"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "code.nbc").touch()
        (tmp_path / f"{name}.py").touch()
    for name in ("old", "old.py"):
        os.utime(tmp_path / name, (0, 0))
    compiled.forget_old(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"used", "used.py"}


def test_a_function_lies_where_its_digest_says():
    from studio.model.tyre import forces

    assert isinstance(forces._cache._impl.locator, Locator)
    assert forces._cache.cache_path == str(folder_of(TYRE))
