"""One server for the tests of REST and live runs."""

import pytest

from tests.broken import BROKEN, FLAWLESS, HANGING, TORN
from tests.server.server import served


@pytest.fixture(scope="module")
def server(tmp_path_factory, sample):
    """Client, database and process of a server with the samples, a broken scenario, and kinds of one's own, some of them broken."""
    folder = tmp_path_factory.mktemp("server")
    scenarios = folder / "scenarios"
    scenarios.mkdir()
    (scenarios / "maps").symlink_to(sample.parent / "maps")
    for each in (sample, sample.with_name("motorway_platoon.yaml")):
        (scenarios / each.name).write_bytes(each.read_bytes())
    (scenarios / "bad.yaml").write_text("title: bad\nclok: {}\n")
    (folder / "kinds").mkdir()
    (folder / "kinds" / "broken.py").write_text(BROKEN)
    (folder / "kinds" / "hanging.py").write_text(HANGING)
    (folder / "kinds" / "torn.py").write_text(TORN)
    (folder / "kinds" / "flawless.py").write_text(FLAWLESS)
    with served(folder, "--kinds", folder / "kinds") as running:
        yield running


@pytest.fixture(scope="module")
def client(server):
    """The HTTP client of that server."""
    return server[0]
