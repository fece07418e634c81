"""What the pages show works: every block of every page is run, in the order of the page."""

from pathlib import Path

import pytest

from tests.conftest import ROOT
from tests.docs.block import Block, BlockError, blocks, reader

PAGES = sorted((ROOT / "docs" / "pages").rglob("*.md"))


@pytest.fixture
def following(tmp_path, monkeypatch, own_kinds):
    """A reader in a folder of its own; kinds of the page are gone again afterwards."""
    monkeypatch.chdir(tmp_path)
    with reader(tmp_path) as made:
        yield made


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT / "docs" / "pages").as_posix())
def test_every_block_works(following, page):
    for block in blocks(page):
        following.follow(block)


def test_how_to_pages_show_something_that_is_run():
    for page in PAGES:
        if page.parent.name == "how":
            assert any(block.language in ("sh", "python") for block in blocks(page)), page


def test_blocks_are_found_with_their_lines(tmp_path):
    page = tmp_path / "page.md"
    page.write_text('one\n\n```sh\nls\npwd\n```\n\n```python title="a/b.py"\nx = 1\n```\n\n```\nbare\n```\n')
    found = blocks(page)
    assert [(each.line, each.language, each.title) for each in found] == [(4, "sh", ""), (9, "python", "a/b.py"), (13, "", "")]
    assert found[0].text == "ls\npwd\n"


FAILING = {
    "a command of the studio": ("sh", "uv run studio vehicles\nuv run studio vehicles smart\n", 11, ["vehicles smart\n", "smart_fortwo"]),
    "a command without output": ("sh", "echo before\nfalse\n", 10, ["failed: false", "before"]),
    "a program": ("python", "x = 1\nassert x == 2\n", 11, ["assert x == 2", "AssertionError"]),
    "no program": ("python", "x = (\n", 10, ["SyntaxError"]),
    "a part of a scenario": ("yaml", "weather: {friction: 7}\n", 10, ["weather.friction", "less than or equal to 1.5"]),
    "no YAML": ("yaml", "weather: {friction\n", 10, ["line 2"]),
    "an unknown language": ("", "uv run studio\n", 9, ["text", "python"]),
}  # fmt: skip


@pytest.mark.parametrize("name", FAILING)
def test_a_failing_block_is_told(following, name):
    """With page, line, command, output, and what to do."""
    language, text, line, parts = FAILING[name]
    with pytest.raises(BlockError) as told:
        following.follow(Block("page.md", 10, language, "", text))
    message = str(told.value)
    assert message.startswith(f"page.md, line {line}: ")
    assert "marked as text" in message
    for part in parts:
        assert part in message


def test_a_block_with_a_title_is_a_file(following):
    following.follow(Block("page.md", 1, "python", "rooms/one.py", "VALUE = 3\n"))
    assert Path("rooms/one.py").read_text() == "VALUE = 3\n"
