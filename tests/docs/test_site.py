"""The site: it is made without a warning, complete, and of nothing that would have to be fetched."""

import html
import re
import subprocess
import sys
import threading
from html.parser import HTMLParser
from pathlib import Path
from typing import ClassVar

import pytest
import uvicorn

from docs import book
from docs.formula import block, makeExtension
from docs.reference import field
from studio.kind import registry
from studio.kind.quantity import quantities as numbers
from studio.kind.sort import SORTS
from studio.scenario.datasheet import quantities
from studio.scenario.schema import Scenario
from studio.server import book as shown
from studio.server import page as front
from tests.browser.browser import browser
from tests.conftest import ROOT

PATIENCE = 180_000  # [ms] of the browser


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    """The site, made from the sources as they are; a page that does not fit ends here."""
    target = tmp_path_factory.mktemp("docs") / "site"
    book.build(target)
    return target


class Sources(HTMLParser):
    """What a page has fetched when it is opened, and the links in it."""

    FETCHED: ClassVar = {"script": "src", "img": "src", "link": "href", "iframe": "src", "source": "src", "video": "src"}

    def __init__(self, text: str):
        super().__init__()
        self.fetched: list[str] = []
        self.ids: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        if tag in self.FETCHED and given.get("rel") not in ("canonical", "prev", "next"):
            self.fetched.append(given.get(self.FETCHED[tag]) or "")
        if "id" in given:
            self.ids.add(given["id"])


def pages(site: Path) -> list[Path]:
    return sorted(site.rglob("*.html"))


def test_nothing_is_fetched_from_elsewhere(site):
    for page in pages(site):
        for source in Sources(page.read_text(encoding="utf-8")).fetched:
            assert "://" not in source and not source.startswith("//"), (page, source)
    for sheet in site.rglob("*.css"):
        assert not re.search(r"url\(\s*[\"']?(https?:)?//", sheet.read_text(encoding="utf-8")), sheet


def test_every_page_that_is_written_is_in_the_navigation(site):
    settings = (ROOT / "docs" / "zensical.toml").read_text(encoding="utf-8")
    for name in (*book.written(), *book.made()):
        assert f'"{name}"' in settings or name.startswith("reference/modules/"), name
    rooms = {path.stem for path in (ROOT / "studio").iterdir() if (path / "__init__.py").is_file()}
    first = (site / "reference" / "modules" / "index.html").read_text(encoding="utf-8")
    assert all(f"{room}/" in first for room in rooms)


def test_every_field_of_a_scenario_is_in_the_reference(site):
    text = (site / "reference" / "scenario" / "index.html").read_text(encoding="utf-8")
    schema = Scenario.model_json_schema()
    for name, part in {"Scenario": schema, **schema["$defs"]}.items():
        assert f'id="{field.anchor(name)}"' in text, name
        for each in part["properties"]:
            assert f"<code>{each}</code>" in text, (name, each)
    assert "m/s²" in text and "≥ 0.3 and ≤ 5" in text


def test_every_value_of_the_catalogue_says_where_it_comes_from(site):
    text = (site / "reference" / "catalogue" / "index.html").read_text(encoding="utf-8")
    for path in quantities():
        assert f"<code>{path}</code>" in text, path
    assert "published" in text and "estimated" in text


@pytest.mark.parametrize("sort", SORTS.values(), ids=SORTS)
def test_every_kind_and_every_part_of_a_contract_is_in_the_reference(site, sort):
    text = (site / "reference" / "kinds" / sort.name / "index.html").read_text(encoding="utf-8")
    words = html.unescape(re.sub(r"<[^>]+>", "", text))
    for need in sort.needs:
        assert f"<code>{need.name}</code>" in text and need.meaning.replace("`", "") in words, need.name
    for kind in registry.known(sort.name).values():
        assert f'id="{field.anchor(kind.name)}"' in text and kind.title in words, kind.name
        for each, meaning in fields_of(kind):
            assert f"<code>{each}</code>" in text and meaning and meaning in words, (kind.name, each)


def fields_of(kind) -> list[tuple[str, str]]:
    """What may be set of a kind, and the numbers that it gives: names and meanings."""
    models = [vars(kind.module)[name].model_fields for name in ("Settings", "Parameters") if name in vars(kind.module)]
    given = [numbers(vars(kind.module)[name]) for name in ("Reading", "Payload") if name in vars(kind.module)]
    told = [(each.name, each.meaning) for some in given for each in some]
    return told + [(name, each.title) for fields in models for name, each in fields.items()]


def test_every_command_and_route_is_in_the_reference(site):
    commands = (site / "reference" / "commands" / "index.html").read_text(encoding="utf-8")
    assert all(f"studio {name}" in commands for name in ("run", "check", "generate motorway", "drive"))
    assert "<code>--parent PARENT</code>" in commands
    routes = (site / "reference" / "rest" / "index.html").read_text(encoding="utf-8")
    assert "GET /api/runs/{run}/trace" in routes and 'href="#refusal"' in routes


def test_docstrings_are_in_the_reference(site):
    text = (site / "reference" / "modules" / "model" / "index.html").read_text(encoding="utf-8")
    assert 'id="studio.model.tyre.forces"' in text
    assert "steady state, pure and combined slip" in text


def test_formulas_are_drawn_by_the_browser(site):
    text = (site / "explanation" / "tyre" / "index.html").read_text(encoding="utf-8")
    assert text.count("<math") > 15 and "$F_x$" not in text
    assert "<mfrac>" in block(r"\frac{a}{b}", "math", "formula", {}, None)


@pytest.mark.parametrize(
    ("text", "drawn"), [("$x$", True), ("`$x$`", False), ("5 $ and 6 $", False), (r"\$x$", False), ("$a_1 + b$", True)]
)
def test_what_is_a_formula(text, drawn):
    import markdown

    html = markdown.markdown(text, extensions=[makeExtension()])
    assert ("<math" in html) == drawn, html


def test_the_policy_names_every_script_that_stands_in_a_page(site):
    """Scripts that the build has not counted are not run: the header permits digests only."""
    import base64
    import hashlib
    import json

    permitted = set(json.loads((site / book.POLICY).read_text())["scripts"])
    for page in pages(site):
        for script in book.SCRIPT.findall(page.read_text(encoding="utf-8")):
            assert base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() in permitted, page


@pytest.fixture
def address(site, monkeypatch):
    """The site as the studio's server shows it."""
    monkeypatch.setattr(shown, "SITE", site)
    monkeypatch.setattr(shown, "press", shown.Press())
    monkeypatch.setattr(shown, "CHECKOUT", site)  # where nothing can be made anew
    server = uvicorn.Server(uvicorn.Config(front.app, port=0, log_level="warning"))
    socket = server.config.bind_socket()
    thread = threading.Thread(target=server.run, kwargs={"sockets": [socket]})
    thread.start()
    yield f"http://127.0.0.1:{socket.getsockname()[1]}"
    server.should_exit = True
    thread.join()


def test_a_browser_shows_and_searches_it_and_calls_nobody(address):
    """In the dark theme too; whatever the policy forbids would stand in the console."""
    said, called = [], []
    with browser() as chromium:
        opened = chromium.new_page(color_scheme="dark")
        opened.set_default_timeout(PATIENCE)
        opened.on("console", lambda message: said.append(message.text))
        opened.on("request", lambda request: called.append(request.url))
        opened.goto(f"{address}/docs/explanation/drivers/")
        assert opened.locator("math").count() > 5
        colour = opened.locator("body").evaluate("body => getComputedStyle(body).backgroundColor")
        red, green, blue = map(int, re.findall(r"\d+", colour)[:3])
        assert max(red, green, blue) < 80
        opened.get_by_role("button", name="Search").first.click()
        opened.locator("input:focus").fill("Intelligent Driver Model")
        opened.locator("a", has_text="The Intelligent Driver Model (M. Treiber").first.wait_for()
        opened.goto(f"{address}/docs/reference/scenario/")
        opened.get_by_role("link", name="Clock", exact=True).first.click()
        assert opened.url.endswith("/docs/reference/scenario/#clock")
    assert said == []
    assert called and all(url.startswith(address) for url in called)


def test_a_wrong_link_ends_the_build_with_page_and_line(tmp_path, monkeypatch):
    monkeypatch.setattr(book, "written", lambda: {"index.md": "# One\n\nSee [two](two.md).\n"})
    monkeypatch.setattr(book, "made", dict)
    with pytest.raises(book.BookError) as told:
        book.build(tmp_path / "site")
    message = str(told.value)
    assert "index.md:3" in message and "page does not exist" in message and "docs/pages" in message
    assert not (tmp_path / "site").exists()


@pytest.mark.parametrize("text", ["```math\na^1^2\n```\n", "In a line $a^1^2$ too.\n"])
def test_a_formula_that_cannot_be_read_ends_the_build(tmp_path, monkeypatch, text):
    monkeypatch.setattr(book, "written", lambda: {"index.md": f"# One\n\n{text}"})
    monkeypatch.setattr(book, "made", dict)
    with pytest.raises(book.BookError, match=r"The formula a\^1\^2 cannot be read"):
        book.build(tmp_path / "site")


def test_the_site_is_current_until_a_source_changes(tmp_path, monkeypatch):
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "page.md").write_text("one")
    monkeypatch.setattr(book, "ROOT", tmp_path)
    monkeypatch.setattr(book, "SITE", tmp_path / "site")
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / book.STAMP).write_text(book.digest())
    assert book.current() and book.build(book.SITE) is False
    (tmp_path / "docs" / "page.md").write_text("two")
    assert not book.current()


def test_the_command_is_the_one_that_is_told():
    """What CONTRIBUTING and the server name exists."""
    done = subprocess.run([sys.executable, "-c", "import docs.book as b; print(b.main.__doc__)"], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    for text in ((ROOT / "CONTRIBUTING.md").read_text(), (ROOT / "studio" / "server" / "book.py").read_text()):
        assert "docs.book" in text
