"""A server on a machine where nothing is compiled: it is there at once, tells how far it is, and ends when it is told to."""

import psutil

from tests.server.server import served


def test_the_page_is_there_while_everything_is_compiled(tmp_path, monkeypatch):
    monkeypatch.setenv("STUDIO_CACHE", str(tmp_path / "cache"))
    with served(tmp_path) as (client, _, process):
        assert client.get("/").status_code in (200, 503)  # 503 says that the page was left out when this was installed
        compiling = client.get("/api/info").json()["compiling"]
        assert (
            0 <= compiling["done"] < compiling["of"] and compiling["seconds"] >= 0 and set(compiling) == {"done", "of", "seconds", "latest"}
        )
        working = psutil.Process(process.pid).children(recursive=True)
        assert working
    _, alive = psutil.wait_procs(working, timeout=60)
    assert not alive
