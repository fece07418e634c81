"""One server for the tests of REST and live runs."""

import pytest

from tests.broken import BROKEN, HANGING
from tests.server.server import served


@pytest.fixture(scope="module")
def server(tmp_path_factory, sample):
    """Client, database and process of a server with the samples, a broken scenario and a broken application."""
    folder = tmp_path_factory.mktemp("server")
    scenarios = folder / "scenarios"
    scenarios.mkdir()
    (scenarios / "maps").symlink_to(sample.parent / "maps")
    for each in (sample, sample.with_name("motorway_platoon.yaml")):
        (scenarios / each.name).write_bytes(each.read_bytes())
    (scenarios / "bad.yaml").write_text("title: bad\nclok: {}\n")
    (folder / "applications").mkdir()
    (folder / "applications" / "broken.py").write_text(BROKEN)
    (folder / "applications" / "hanging.py").write_text(HANGING)
    with served(folder, "--applications", folder / "applications") as running:
        yield running


@pytest.fixture(scope="module")
def client(server):
    """The HTTP client of that server."""
    return server[0]
