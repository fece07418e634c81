"""What all tests share: the project's folder, the sample scenario, an open-loop proving ground."""

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
