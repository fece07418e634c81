"""A report on paper: everything of the page is in the PDF, in as many pages as it takes, and files are what their endings say."""

import re
import zlib

import pytest

from studio.errors import ScenarioError
from studio.parcel import paper
from studio.parcel.report import listed, section, table

SVG = '<svg xmlns="http://www.w3.org/2000/svg" width="200pt" height="80pt" viewBox="0 0 200 80"><path d="M 3 4 L 97 51"/></svg>'


def page(*parts, title="A car"):
    return f'<!doctype html><html lang="en"><head><meta charset="utf-8"></head><body><h1>{title}</h1>{"".join(parts)}</body></html>\n'


def streams(content):
    """All packed parts of a PDF, one after another."""
    found = re.findall(rb"stream\r?\n(.*?)\r?\nendstream", content, re.DOTALL)
    return b"\n".join(zlib.decompress(each) if each[:1] == b"\x78" else each for each in found)


def signs(content):
    """The signs that the fonts of a PDF were made for, read off their tables of Unicode."""
    tables = re.findall(rb"beginbf(?:char|range)(.*?)endbf", streams(content), re.DOTALL)
    return {chr(int(each, 16)) for part in tables for each in re.findall(rb"<([0-9A-Fa-f]{4})>\s*$", part, re.MULTILINE)}


def pages(content):
    return int(re.search(rb"/Count (\d+)", content)[1])


def test_all_parts_of_a_page_are_printed():
    """Also what a font of Latin letters alone would not have, and what XML has no room for."""
    parts = (
        section("Verdict", '<p class="dim">It is <b class="good">valid</b>: Δψ ≤ 3 %.</p>'),
        section("Span", listed(["speed 14 m/s", "yaw rate ± 0.2 rad/s"])),
        section("Tabelle", table(["maß", "m/s²"], [("Straße", '<b class="bad">√2</b>')], numeric=[1])),
        section("Noted", "<pre>a\n  b \x1b[0m</pre>"),
        SVG,
    )
    made = paper.pdf(page(*parts))
    assert made.startswith(b"%PDF-") and pages(made) == 1
    assert set("Δψ≤%±²ß√•\ufffd") <= signs(made)
    assert re.search(rb"\d+(\.\d+)? \d+(\.\d+)? m", streams(made)), "the line of the picture"


@pytest.mark.parametrize(("rows", "least"), [(3, 1), (200, 4)])
def test_a_long_table_goes_on_over_pages_and_its_head_with_it(rows, least):
    made = paper.pdf(page(table(["Ω", "value"], [(f"row {i}", f"{i}") for i in range(rows)], numeric=[1])))
    assert pages(made) >= least and (rows > 3) == (pages(made) > 1)


def test_columns_take_the_width_and_no_more():
    """A word is never cut while there is room: each column has its longest, and texts share the rest."""
    shares = paper.shares([["a", "criterion", "b"], ["1", "a long text of many words " * 10, "2"]], lambda text: float(len(text)))
    assert sum(shares) == pytest.approx(paper.WIDTH) and shares[0] == shares[2] == 1.0
    assert paper.shares([["a", "b"]], lambda text: 10.0) == [10.0, 10.0]


def test_a_file_is_what_its_ending_says(tmp_path):
    text = page("<p>in words</p>")
    for name in ("a.html", "a.pdf", "b.PDF"):
        paper.write(text, tmp_path / name)
    assert (tmp_path / "a.html").read_text() == text
    assert all((tmp_path / each).read_bytes().startswith(b"%PDF-") for each in ("a.pdf", "b.PDF"))
    with pytest.raises(ScenarioError, match=r"has an ending that no report has \(got '?\.docx"):
        paper.write(text, tmp_path / "a.docx")
    with pytest.raises(ScenarioError, match="cannot be written"):
        paper.write(text, tmp_path / "nowhere" / "a.pdf")
    assert sorted(each.name for each in tmp_path.iterdir()) == ["a.html", "a.pdf", "b.PDF"]
