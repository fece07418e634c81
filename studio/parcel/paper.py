"""A report on paper: a page of ours as PDF, vectors and texts, with numbered pages and the headings in its outline.

A report is HTML of few elements, all of which are here: headings, paragraphs, lists, tables, pictures as SVG. What stands in the page
stands in the PDF, in its order.
"""

import re
from collections.abc import Callable, Sequence
from functools import cache
from io import BytesIO
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from studio.errors import Problem, ScenarioError

MEDIA = "application/pdf"
ENDINGS = (".html", ".htm", ".pdf")
SANS, MONO = "sans", "mono"
INK, DIM, GOOD, BAD, LINE = (26, 26, 26), (90, 90, 90), (11, 110, 79), (179, 38, 30), (200, 200, 200)
TONES = {"good": GOOD, "bad": BAD, "dim": DIM}
MARGIN, WIDTH = 16.0, 178.0  # [mm]; of A4
TEXT, SMALL = 9.0, 7.5  # [pt]
LEADING = 1.4  # of a line over the size of its letters
POINT = 25.4 / 72.0  # [mm]
SVG = "http://www.w3.org/2000/svg"
UNPRINTABLE = re.compile("[^\\t\\n\\r\\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")  # what XML has no room for


def check(out: Path) -> None:
    """Refuses a file whose ending is that of no report, before anything is done; raises ScenarioError."""
    if out.suffix.lower() not in ENDINGS:
        problem = Problem(
            str(out), "has an ending that no report has", out.suffix, ", ".join(ENDINGS), "name it so that it ends with one of them"
        )
        raise ScenarioError("A report is a page or a PDF.", [problem])


def write(page: str, out: Path) -> None:
    """Writes a report, which is HTML, as what the ending of the file says; raises ScenarioError when it cannot."""
    check(out)
    content = pdf(page) if out.suffix.lower() == ".pdf" else page.encode()
    try:
        out.write_bytes(content)
    except OSError as error:
        raise ScenarioError(f"{out} cannot be written.", [Problem(str(out), f"cannot be written: {error.strerror or error}")]) from None


def pdf(page: str) -> bytes:
    """A report, which is HTML, as PDF."""
    body = UNPRINTABLE.sub("\ufffd", page[page.index("<body>") : page.index("</body>") + len("</body>")])
    blocks = list(ElementTree.fromstring(body))
    sheet = blank(text_of(blocks[0]))
    for each in blocks:
        BLOCKS[name(each)](sheet, each)
    return bytes(sheet.output())


def blank(title: str):
    """Paper with nothing on it yet."""
    made = kind()(format="A4")
    made.set_title(title)
    made.set_lang("en")
    for family, style, file in ((SANS, "", "DejaVuSans"), (SANS, "B", "DejaVuSans-Bold"), (MONO, "", "DejaVuSansMono")):
        made.add_font(family, style, fonts() / f"{file}.ttf")
    made.set_margins(MARGIN, MARGIN, MARGIN)
    made.set_auto_page_break(True, MARGIN + 4.0)
    made.add_page()
    write_with(made, TEXT)
    return made


@cache
def kind() -> type:
    """Paper whose pages have title and number at their foot."""
    from fpdf import FPDF

    class Sheet(FPDF):
        """A report on paper."""

        def footer(self) -> None:
            """The foot of a page."""
            self.set_y(-MARGIN)
            write_with(self, SMALL, tone=DIM)
            self.cell(WIDTH - 20.0, 5.0, self.title or "")
            self.cell(20.0, 5.0, f"{self.page_no()} of {{nb}}", align="R")

    return Sheet


@cache
def fonts() -> Path:
    """Letters with all signs that a report has: those that come with matplotlib."""
    import matplotlib

    return Path(matplotlib.get_data_path()) / "fonts" / "ttf"


def write_with(sheet, size: float, *, style: str = "", family: str = SANS, tone: Sequence[int] = INK) -> None:
    """What follows is written so; `size` in points."""
    sheet.set_font(family, style, size)
    sheet.set_text_color(*tone)


# -- parts of a page -------------------------------------------------------------------------------------


def name(of: Element) -> str:
    """The name of an element without that of its namespace."""
    return of.tag.rpartition("}")[2]


def text_of(of: Element) -> str:
    """All that is written in an element, its lines joined."""
    return " ".join("".join(of.itertext()).split())


def tone_of(of: Element) -> tuple[int, ...]:
    """The colour of an element."""
    return TONES.get(of.get("class", ""), INK)


def title(sheet, of: Element) -> None:
    """The title of the report."""
    write_with(sheet, 15.0, style="B")
    lines(sheet, text_of(of), 15.0)


def heading(sheet, of: Element) -> None:
    """A heading, which goes to the next page with what it is about when this one ends."""
    sheet.ln(4.0)
    if sheet.will_page_break(26.0):
        sheet.add_page()
    sheet.start_section(text_of(of))
    write_with(sheet, 11.0, style="B")
    lines(sheet, text_of(of), 11.0)
    sheet.ln(1.0)


def paragraph(sheet, of: Element) -> None:
    """A paragraph with what stands out in it."""
    spoken(sheet, [(of.text, tone_of(of), ""), *((part, *how) for each in of for part, *how in inner(each, of))])
    sheet.ln(LEADING * TEXT * POINT + 1.0)


def inner(of: Element, around: Element) -> list[tuple]:
    """What stands out in a paragraph, and what follows it."""
    return [(text_of(of), tone_of(of), "B" if name(of) == "b" else ""), (of.tail, tone_of(around), "")]


def spoken(sheet, parts: Sequence[tuple]) -> None:
    """Parts of a text behind each other."""
    for text, tone, style in parts:
        if text:
            write_with(sheet, TEXT, style=style, tone=tone)
            sheet.write(LEADING * TEXT * POINT, re.sub(r"\s+", " ", text))


def points(sheet, of: Element) -> None:
    """A list."""
    for each in of:
        write_with(sheet, TEXT)
        sheet.set_x(MARGIN + 2.0)
        sheet.cell(4.0, LEADING * TEXT * POINT, "•")
        lines(sheet, text_of(each), TEXT, WIDTH - 6.0)
    sheet.ln(1.0)


def verbatim(sheet, of: Element) -> None:
    """Text whose lines are kept."""
    write_with(sheet, SMALL, family=MONO)
    lines(sheet, "".join(of.itertext()), SMALL)
    sheet.ln(1.0)


def lines(sheet, text: str, size: float, width: float = WIDTH) -> None:
    """Text over as many lines as it takes."""
    sheet.multi_cell(width, LEADING * size * POINT, text, align="L", new_x="LMARGIN", new_y="NEXT")


def picture(sheet, of: Element) -> None:
    """A picture over the whole width, on the next page where this one has no room for it."""
    ElementTree.register_namespace("", SVG)
    of.tail = None
    for each in [each for each in of if name(each) == "metadata"]:
        of.remove(each)
    sheet.image(BytesIO(ElementTree.tostring(of)), w=WIDTH)
    sheet.ln(2.0)


# -- tables ----------------------------------------------------------------------------------------------


def table(sheet, of: Element) -> None:
    """A table, whose head is repeated on every page that it goes on to."""
    from fpdf.fonts import FontFace

    rows = [list(row) for row in of.iter() if name(row) == "tr"]
    write_with(sheet, SMALL)
    sheet.set_draw_color(*LINE)
    widths = shares([[held(cell) for cell in row] for row in rows], measured(sheet))
    with sheet.table(
        width=WIDTH, col_widths=widths, align="L", text_align="LEFT", borders_layout="HORIZONTAL_LINES", padding=(0.4, 1.0, 0.4, 0.0),
        line_height=LEADING * SMALL * POINT, headings_style=FontFace(emphasis="BOLD", color=INK),
    ) as made:  # fmt: skip
        for i, row in enumerate(rows):
            line = made.row()
            for cell in row:
                line.cell(held(cell), align="R" if cell.get("class") == "n" else "L", style=face(cell) if i else None)
    sheet.ln(2.0)


def held(cell: Element) -> str:
    """The text of a cell; a number stays with its unit."""
    return text_of(cell).replace(" ", "\u00a0") if cell.get("class") == "n" else text_of(cell)


def face(cell: Element):
    """How the text of a cell is written: as what stands out in it."""
    from fpdf.fonts import FontFace

    inside = cell if cell.text else next(iter(cell), cell)
    return FontFace(emphasis="BOLD" if name(inside) == "b" else None, color=tone_of(inside))


def measured(sheet) -> Callable[[str], float]:
    """How wide a text is [mm], as a head would have it."""

    def width(text: str) -> float:
        return sheet.get_string_width(text) * 1.1 + 2.5

    return width


def shares(rows: Sequence[Sequence[str]], width: Callable[[str], float]) -> list[float]:
    """Widths of columns [mm]: what their longest words need, and of the rest as much more as their longest texts would take."""
    columns = list(zip(*rows, strict=True))
    least = [max(width(word) for text in column for word in text.split(" ")) for column in columns]
    wanted = [max(map(width, column)) for column in columns]
    room, more = WIDTH - sum(least), sum(wanted) - sum(least)
    if room <= 0.0 or more <= 0.0:
        return least
    return [a + (b - a) * room / more if room < more else b for a, b in zip(least, wanted, strict=True)]


BLOCKS = {"h1": title, "h2": heading, "p": paragraph, "ul": points, "pre": verbatim, "table": table, "svg": picture}
