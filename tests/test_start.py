"""A command waits for nothing that it does not need. What is imported is looked at, not the clock."""

import subprocess
import sys

import pytest

HEAVY = ("numba", "llvmlite", "scipy", "shapely", "pyproj", "pyarrow", "matplotlib", "viser", "fastapi", "uvicorn", "osmium", "trimesh")
SCRIPT = """
import sys
from studio.cli import main
try:
    main(sys.argv[1:])
except SystemExit as end:
    assert not end.code, end.code
print(*[name for name in {heavy} if name in sys.modules], file=sys.stderr)
"""


def imported(*arguments, cwd):
    """Which of the heavy packages a command imports."""
    done = subprocess.run([sys.executable, "-c", SCRIPT.format(heavy=HEAVY), *arguments], cwd=cwd, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stderr.split()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a database of one run."""
    from studio.provenance import Provenance
    from studio.store.runs import open_runs

    cwd = tmp_path_factory.mktemp("work")
    open_runs(cwd / "runs.db").begin(
        scenario="stern", title="Stern", document={"goals": {"min_ttc": {"least": 1.0}}}, scenario_hash="0" * 64, map_digest="",
        parent=None, seed=1,
        parameters={}, provenance=Provenance((), "1", "host", {}, ()),
    )  # fmt: skip
    return cwd


@pytest.mark.parametrize("command", [["runs"], ["show", "1"], ["--version"], ["--help"], ["generate", "--help"]])
def test_reading_and_asking_does_not_wait_for_the_compiler(command, folder):
    assert imported(*command, cwd=folder) == []


def test_the_package_alone_imports_nothing(tmp_path):
    script = f"import sys, studio; print(*[name for name in {(*HEAVY, 'numpy', 'pydantic')} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout.split() == []
