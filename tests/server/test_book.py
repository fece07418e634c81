"""The documentation under /docs/: shown when it is there, made in a checkout, explained where it is not."""

import sys

import pytest
from fastapi.testclient import TestClient

from studio.server import book, page


@pytest.fixture
def site(tmp_path, monkeypatch):
    """A small site, and nothing that makes another."""
    (tmp_path / "how").mkdir()
    (tmp_path / "index.html").write_text("<h1>first</h1>")
    (tmp_path / "how" / "index.html").write_text("<h1>how</h1>")
    (tmp_path / "policy.json").write_text('{"scripts": ["abc="]}')
    monkeypatch.setattr(book, "SITE", tmp_path)
    monkeypatch.setattr(book, "press", book.Press())
    monkeypatch.setattr(book, "CHECKOUT", tmp_path / "none")
    return tmp_path


@pytest.fixture
def client():
    return TestClient(page.app)


def test_pages_of_the_site(site, client):
    assert "first" in client.get("/docs").text
    assert "first" in client.get("/docs/").text
    assert "how" in client.get("/docs/how").text
    assert client.get("/docs/how", follow_redirects=False).headers["location"] == "/docs/how/"


def test_nothing_from_elsewhere_is_permitted(site, client):
    policy = client.get("/docs/").headers["content-security-policy"]
    assert "default-src 'none'" in policy and "script-src 'self' 'sha256-abc='" in policy
    assert "http" not in policy


@pytest.mark.parametrize("path", ["none/", "none.css", "../secret", "%2e%2e/secret", "..%2f..%2fetc/passwd", "a%00b"])
def test_what_is_not_there(site, client, path):
    (site.parent / "secret").write_text("secret")
    answer = client.get(f"/docs/{path}")
    assert answer.status_code == 404 or answer.url.path == "/secret"
    assert "secret" not in answer.text or answer.url.path == "/secret"


def test_a_package_without_it_says_how_to_get_it(site, client):
    (site / "index.html").unlink()
    answer = client.get("/docs/")
    assert answer.status_code == 503 and "python -m docs.book" in answer.text


def checkout(site, monkeypatch, program: str):
    """A checkout in which making the site is this program."""
    (site / "index.html").unlink()
    (site / "docs").mkdir()
    (site / "docs" / "book.py").write_text("")
    monkeypatch.setattr(book, "CHECKOUT", site)
    monkeypatch.setattr(book, "COMMAND", (sys.executable, "-c", program))


def test_in_a_checkout_the_first_visit_has_it_made(site, client, monkeypatch):
    checkout(site, monkeypatch, "open('index.html', 'w').write('<h1>made</h1>')")
    answer = client.get("/docs/")
    assert "refresh" in answer.text or "made" in answer.text
    assert book.press.process.wait(60) == 0
    assert "made" in client.get("/docs/").text


def test_a_failure_is_told_and_the_next_visit_tries_again(site, client, monkeypatch):
    checkout(site, monkeypatch, "import sys; sys.exit('page.md:3 <does not exist>')")
    client.get("/docs/")
    assert book.press.process.wait(60) == 1
    answer = client.get("/docs/")
    assert answer.status_code == 500 and "page.md:3 &lt;does not exist&gt;" in answer.text
    client.get("/docs/")
    assert book.press.process is not None
    book.press.process.wait(60)


def test_an_older_site_is_shown_while_a_newer_one_is_made(site, client, monkeypatch):
    checkout(site, monkeypatch, "import time; time.sleep(60)")
    (site / "index.html").write_text("<h1>older</h1>")
    assert "older" in client.get("/docs/").text
    book.press.process.kill()
    book.press.process.wait(60)
