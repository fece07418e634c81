"""What all tests share: the project's folder, the sample scenario, an open-loop proving ground."""

import os
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
SAMPLE = ROOT / "scenarios" / "grosser_stern_platoon.yaml"


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


def pytest_terminal_summary(terminalreporter, config):
    """What the vehicles were compared with, where that was tested: in short here, every row in a file."""
    ground, multibody = sys.modules.get("tests.proving_ground"), sys.modules.get("tests.multibody")
    if ground and ground.FIGURES:
        terminalreporter.section("track tests")
        terminalreporter.write_line("\n".join(ground.FIGURES))
    if multibody and multibody.table.cache_info().currsize:
        folder = Path(os.environ.get("STUDIO_TABLES") or config.rootpath / ".pytest_cache")
        folder.mkdir(parents=True, exist_ok=True)
        file = folder / "vehicle_reference.txt"
        file.write_text(multibody.full_table(), encoding="utf-8")
        terminalreporter.section("multi-body references")
        lines = [*multibody.short_table(), "", *multibody.halving_table(), "", f"Every row: {file}"]
        terminalreporter.write_line("\n".join(lines))
