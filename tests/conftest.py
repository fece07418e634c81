"""What all tests share: the project's folder, the sample scenario, an open-loop proving ground."""

import os
import sys
from pathlib import Path

import pytest
from hypothesis import settings

ROOT = Path(__file__).parent.parent
SAMPLE = ROOT / "scenarios" / "grosser_stern_platoon.yaml"

settings.register_profile("patient", deadline=None)  # the first call compiles, and a machine may be busy
settings.load_profile("patient")


@pytest.fixture(scope="session")
def root() -> Path:
    """The project's folder."""
    return ROOT


@pytest.fixture(scope="session")
def sample() -> Path:
    """The sample scenario."""
    return SAMPLE


@pytest.fixture(scope="session")
def sample_setting():
    """The sample with its map and cars; 10 s long."""
    from studio import job

    return job.prepare(job.load(SAMPLE, {"clock.duration": 10}))


@pytest.fixture(scope="module", autouse=True)
def same_kinds():
    """What the tests of a file load stays in it: whichever come next in this process know the built-in kinds only."""
    from studio.kind import registry

    kept = list(registry.every())
    yield
    registry.restore(kept)


@pytest.fixture
def own_kinds():
    """Loads a folder of kinds as `--kinds` does; they are gone again when the test is over."""
    from studio.kind import registry

    kept = list(registry.every())
    yield registry.load_folder
    registry.restore(kept)


# What takes longest comes first, so that no process is left alone with it at the end.
LONGEST_FIRST = (
    "tests/world/test_random_routes.py",
    "tests/test_readme.py",
    "tests/test_portable.py",
    "tests/world",
    "tests/vehicle",
    "tests/browser",
    "tests/server",
)


def pytest_collection_modifyitems(items):
    """Long files first; within a file the order stays."""
    rank = {start: i for i, start in enumerate(LONGEST_FIRST)}
    items.sort(key=lambda item: next((rank[start] for start in LONGEST_FIRST if item.nodeid.startswith(start)), len(rank)))


# -- tables that a test run prints -------------------------------------------------------------------

MEASURED: dict[str, list[str]] = {}  # by heading; several processes test, and one of them prints


def pytest_sessionfinish(session):
    """What was measured here: on the track, and against the multi-body references."""
    ground, multibody = sys.modules.get("tests.proving_ground"), sys.modules.get("tests.multibody")
    if ground and ground.FIGURES:
        MEASURED["track tests"] = [*MEASURED.get("track tests", []), *ground.FIGURES]
    if multibody and multibody.table.cache_info().currsize:
        folder = Path(os.environ.get("STUDIO_TABLES") or session.config.rootpath / ".pytest_cache")
        folder.mkdir(parents=True, exist_ok=True)
        file = folder / "vehicle_reference.txt"
        file.write_text(multibody.full_table(), encoding="utf-8")
        MEASURED["multi-body references"] = [*multibody.short_table(), "", *multibody.halving_table(), "", f"Every row: {file}"]
    if hasattr(session.config, "workeroutput"):
        session.config.workeroutput["measured"] = MEASURED


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node):
    """A testing process has ended: what it measured is printed by this one."""
    for heading, lines in getattr(node, "workeroutput", {}).get("measured", {}).items():
        MEASURED[heading] = [*MEASURED.get(heading, []), *lines]


def pytest_terminal_summary(terminalreporter):
    """The tables, where they were made."""
    for heading, lines in MEASURED.items():
        terminalreporter.section(heading)
        terminalreporter.write_line("\n".join(lines))
