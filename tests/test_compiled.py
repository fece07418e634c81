"""Machine code is kept, never stale, and never mixed up."""

import importlib
import os
import subprocess
import sys
from pathlib import Path

import pytest

from studio.compiled import Locator, folder_of
from studio.source import PACKAGE, closure, compiled_functions, digest_of, imports

MOTION, TYRE, SAFETY = (PACKAGE / room / name for room, name in (("vehicle", "motion.py"), ("model", "tyre.py"), ("assess", "danger.py")))


@pytest.fixture
def program(tmp_path, monkeypatch):
    """A folder of modules that somebody loaded; call it with name and text, in the order of their imports."""
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)  # Python tells a file of the same second and size for the same

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


def test_a_function_is_compiled_once_however_many_want_it(program, tmp_path, monkeypatch):
    """Four processes want it at the same moment: one compiles, the others take what it has made."""
    program("helper_of_mine", HELPER.format(3))
    program("own_of_mine", USER)
    script = "from own_of_mine import twice; twice(1.0); print(sum(twice.stats.cache_misses.values()))"
    environment = os.environ | {"PYTHONPATH": str(tmp_path), "STUDIO_CACHE": str(tmp_path / "cache")}
    command = [sys.executable, "-c", script]
    waiting = [subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) for _ in range(4)]
    misses = sorted(int(each.communicate()[0]) for each in waiting)
    assert misses == [0, 0, 0, 1]
    assert len(list((tmp_path / "cache").rglob("*.nbc"))) == 2  # `twice` and `gain`


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


@pytest.mark.parametrize("damage", [lambda whole: b"", lambda whole: whole[: len(whole) // 2], lambda whole: b"noise" * 1000])
@pytest.mark.parametrize("ending", ["nbi", "nbc"])
def test_damaged_machine_code_is_made_anew(program, ending, damage):
    """As it may be found after a loss of power."""
    program("helper_of_mine", HELPER.format(3))
    assert program("own_of_mine", USER).twice(1.0) == 6.0
    files = list(folder_of(Path(sys.modules["own_of_mine"].__file__)).glob(f"*.{ending}"))
    for each in files:
        each.write_bytes(damage(each.read_bytes()))
    assert files and program("own_of_mine", USER).twice(1.0) == 6.0
    again = program("own_of_mine", USER).twice
    assert again(1.0) == 6.0 and sum(again.stats.cache_hits.values()) == 1


def test_without_room_code_is_compiled_and_not_kept(program, tmp_path):
    program("helper_of_mine", HELPER.format(3))
    program("own_of_mine", USER)
    script = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0)); from own_of_mine import twice; print(twice(1.0))"
    assert said(script, os.environ | {"PYTHONPATH": f"{tmp_path}", "STUDIO_CACHE": f"{tmp_path / 'cache'}"}) == "6.0"
    assert not list((tmp_path / "cache").rglob("*.nb?"))


def test_a_function_lies_where_its_digest_says():
    from studio.model.tyre import forces

    assert isinstance(forces._cache._impl.locator, Locator)
    assert forces._cache.cache_path == str(folder_of(TYRE))


def test_compiled_functions_of_a_file_are_known():
    assert "forces" in compiled_functions(TYRE) and "formula_angle" in compiled_functions(TYRE)
    sensing = compiled_functions(PACKAGE / "world" / "board" / "sensing.py")
    assert "unfit" in sensing and "run" not in sensing  # the loop that it writes stands in another file
    assert compiled_functions(PACKAGE / "compiled.py") == []


OF_A_FOLDER = """
from typing import NamedTuple
from studio.compiled import compiled
class Pair(NamedTuple):
    first: float
    second: float
@compiled
def total(pair):
    return pair.first + pair.second
"""
SHARED = "from studio.compiled import compiled\n@compiled\ndef first(pair):\n    return pair[0]\n"


def said(code, environment):
    """What a process of its own says."""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_the_code_of_users_types_is_in_nobodys_way(tmp_path):
    """The same file in two folders of one name; and code that is kept for its types too, when nobody has loaded them."""
    environment = os.environ | {"STUDIO_CACHE": str(tmp_path / "cache"), "PYTHONPATH": str(tmp_path)}
    (tmp_path / "shared_by_all.py").write_text(SHARED)
    load = "from pathlib import Path; from studio.kind.folder import load; from shared_by_all import first\n"
    for folder in (tmp_path / "one" / "kinds", tmp_path / "other" / "kinds"):
        folder.mkdir(parents=True)
        (folder / "mine.py").write_text(OF_A_FOLDER)
        use = f"mine = load(Path({str(folder / 'mine.py')!r})); pair = mine.Pair(1.0, 2.0); print(mine.total(pair), first(pair))"
        assert said(load + use, environment) == "3.0 1.0"
    assert said(load + "print(first((4.0, 5.0)))", environment) == "4.0"


ANSWERS = """
from typing import NamedTuple
from studio.compiled import compiled
class Memory(NamedTuple):
    time: float
class Does(NamedTuple):
    number: int
@compiled
def decide(time):
    return Memory(time), Does(1)
"""


def test_names_that_users_share_are_in_nobodys_way(tmp_path):
    """Two files whose tuples are called alike, loaded together once; then one of them alone, whose kept code may name the other."""
    environment = os.environ | {"STUDIO_CACHE": str(tmp_path / "cache")}
    load = "from pathlib import Path; from studio.kind.folder import load\n"
    use = []
    for folder in (tmp_path / "one", tmp_path / "other"):
        folder.mkdir()
        (folder / "mine.py").write_text(ANSWERS)
        use.append(f"print(load(Path({str(folder / 'mine.py')!r})).decide(2.0)[1].number)\n")
    assert said(load + use[0] + use[1], environment).split() == ["1", "1"]
    assert said(load + use[1], environment) == "1"
    assert said(load + use[0], environment) == "1"
