"""The file of a kind over REST: its text follows the disk, what Python cannot read is told with its line, and nothing is run."""

import pytest

from tests.broken import FLAWLESS
from tests.server.server import served


@pytest.fixture(scope="module")
def studio(tmp_path_factory, sample):
    """A client, and the file of a sensor of one's own."""
    folder = tmp_path_factory.mktemp("manuscript")
    (folder / "kinds").mkdir()
    file = folder / "kinds" / "flawless.py"
    file.write_text(FLAWLESS)
    with served(folder, "--scenarios", sample.parent, "--kinds", folder / "kinds") as (client, _, _):
        yield client, file


def told(client, kind="sensor/flawless"):
    answer = client.get(f"/api/kinds/{kind}/source")
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_the_text_is_that_of_the_file_and_follows_it(studio):
    client, file = studio
    assert told(client) == {"file": str(file), "text": FLAWLESS, "loaded": True, "missing": "", "slips": [], "own": True, "refused": ""}
    ran = file.with_name("ran")
    file.write_text(f"open({str(ran)!r}, 'w')\n" + FLAWLESS)
    now = told(client)
    assert now["text"] == file.read_text() and not now["loaded"] and not ran.exists()
    file.write_text("def measure(:\n    pass\n")
    (slip,) = told(client)["slips"]
    assert (slip["line"], slip["column"]) == (1, 13) and slip["what"]
    file.unlink()
    gone = told(client)
    assert gone["text"] == FLAWLESS and "No such file" in gone["missing"]


def test_a_built_in_kind_has_a_file_and_a_strange_one_is_refused(studio):
    client, _ = studio
    acc = told(client, "application/acc")
    assert acc["file"].endswith("acc.py") and "def decide(" in acc["text"] and acc["loaded"]
    assert client.get("/api/kinds/application/acd/source").status_code == 404
    assert client.get("/api/kinds/nothing/acc/source").status_code == 404
