"""A server on a machine where nothing is compiled: it is there at once, tells how far it is, and ends when it is told to."""

import psutil

from tests.patience import until
from tests.server.server import served


def over(client, job):
    """An errand when it is over."""
    now = client.get(f"/api/validation-jobs/{job}").json()
    return now if now["status"] != "running" else None


def test_the_page_is_there_while_everything_is_compiled(tmp_path, monkeypatch):
    monkeypatch.setenv("STUDIO_CACHE", str(tmp_path / "cache"))
    (tmp_path / "scenarios").mkdir()  # or it would take the project's own
    with served(tmp_path) as (client, _, process):
        assert client.get("/").status_code in (200, 503)  # 503 says that the page was left out when this was installed
        compiling = client.get("/api/info").json()["compiling"]
        assert set(compiling) == {"done", "of", "seconds", "latest", "since"}
        assert 0 <= compiling["done"] < compiling["of"] and 0 <= compiling["since"] <= compiling["seconds"]
        assert client.post("/api/validations", json={"name": "mine", "vehicle": "bmw_320i"}).status_code == 201
        assert client.put("/api/validations/mine/files/drive.csv", content=b"time_s,speed [m/s]\n0,20\n1,21\n2,22\n").status_code == 201
        job = client.post("/api/validations/mine/jobs", json={"task": "look", "log": "drive.csv"}).json()
        looked = until(lambda: over(client, job["id"]), "the look at a log")
        assert looked["status"] == "done" and looked["looked"]["ours"][0]["name"] == "speed"
        compiling = client.get("/api/info").json()["compiling"]
        assert compiling["done"] < compiling["of"]  # a log was looked at without any of it
        working = psutil.Process(process.pid).children(recursive=True)
        assert working
    _, alive = psutil.wait_procs(working, timeout=60)
    assert not alive
