"""An application that its author changes while the studio runs: the next run uses it if it loads, else the version before."""

import pytest

from studio.workshop.draft import draft
from tests.patience import until
from tests.server.server import served

CALM = '    calm: float = number(0.7, unit="1", title="Calm", ge=0, le=1)\n'


@pytest.fixture(scope="module")
def studio(tmp_path_factory):
    """A client, and the file of an application of one's own, with the scenario that uses it."""
    folder = tmp_path_factory.mktemp("edition")
    draft("application", "mine", folder)
    with served(folder, "--scenarios", folder, "--kinds", folder) as (client, _, _):
        yield client, folder / "mine.py"


def told(client, name="mine"):
    answer = client.get(f"/api/kinds/application/{name}/source")
    assert answer.status_code == 200, answer.text
    return answer.json()


def run(client, **changes):
    """A finished run of a second; its row."""
    begun = client.post("/api/live", json={"scenario": "mine", "set": {"clock.duration": 1, **changes}, "pace": "fast"})
    assert begun.status_code == 201, begun.text
    number = begun.json()["run"]

    def over():
        row = client.get(f"/api/runs/{number}").json()
        return row if row.get("status") not in (None, "running", "starting") else None

    row = until(over, f"run {number}")
    assert row["status"] == "done", row["error"]
    return row


def test_a_version_that_loads_is_used_and_one_that_does_not_is_not(studio):
    client, file = studio
    first = file.read_text()
    assert told(client)["loaded"] and told(client)["own"]
    usual = run(client)

    file.write_text(first.replace("max(u, -8.0), 2.0", "max(u, -8.0), -3.0"))
    assert told(client)["loaded"] and not told(client)["refused"]
    braking = run(client)
    assert braking["state_hash"] != usual["state_hash"]

    for broken, why in (("def decide(:\n", "line 1"), (first.replace("number(1.0", "nomber(1.0"), "nomber")):
        file.write_text(broken)
        now = told(client)
        assert not now["loaded"] and why in now["refused"] and now["text"] == broken
        assert run(client)["state_hash"] == braking["state_hash"], "the last version that loads runs"

    file.write_text(first)
    assert told(client)["loaded"] and not told(client)["refused"]
    assert run(client)["state_hash"] == usual["state_hash"]


def test_settings_follow_the_file(studio):
    client, file = studio
    first = file.read_text()
    file.write_text(first.replace("    headway: float", f"{CALM}    headway: float"))
    kinds = client.get("/api/kinds").json()["kinds"]
    (mine,) = (each for each in kinds if (each["sort"], each["name"]) == ("application", "mine"))
    assert mine["settings"]["properties"]["calm"]["default"] == 0.7
    run(client, **{"applications.mine.parameters.calm": 0.2})
    file.write_text(first)


def test_a_file_that_ends_its_process_while_it_loads_ends_nobody_else(studio):
    """It is tried in a process of its own."""
    client, file = studio
    first = file.read_text()
    file.write_text("import os\nos._exit(3)\n" + first)
    assert "ended with code 3" in told(client)["refused"]
    assert client.get("/api/kinds").status_code == 200
    file.write_text(first)
    assert told(client)["loaded"]


def test_a_new_file_is_a_new_application(studio):
    client, file = studio
    other = file.with_name("other.py")
    other.write_text(file.read_text().replace('TITLE = "Mine"', 'TITLE = "Other"'))
    names = [each["name"] for each in client.get("/api/kinds").json()["kinds"] if each["sort"] == "application"]
    assert "other" in names and told(client, "other")["loaded"]
