"""Formulas: LaTeX in a page becomes MathML, which browsers draw by themselves, without a script or a font.

`$...$` stands in a line, a fenced block ```math by itself. A formula that cannot be read ends the build.
"""

import re
import xml.etree.ElementTree as ElementTree
from typing import Any, Literal

from latex2mathml.converter import convert
from markdown import Markdown
from markdown.extensions import Extension
from markdown.inlinepatterns import InlineProcessor
from pymdownx.superfences import SuperFencesException

IN_LINE = r"(?<![\\$])\$(?!\s)([^$\n]+?)(?<!\s)\$(?!\d)"
NAMESPACE = re.compile(r"\sxmlns=\"[^\"]*\"")


class Formula(InlineProcessor):
    """A formula in a line."""

    def handleMatch(self, m: re.Match[str], data: str) -> tuple[ElementTree.Element, int, int]:
        return ElementTree.fromstring(NAMESPACE.sub("", drawn(m.group(1), "inline"))), m.start(0), m.end(0)


class Formulas(Extension):
    """Formulas for Python-Markdown."""

    def extendMarkdown(self, md: Markdown) -> None:
        md.inlinePatterns.register(Formula(IN_LINE, md), "formula", 185)  # after code, before escapes and emphasis


def block(source: str, language: str, class_name: str, options: dict[str, Any], md: Markdown, **others: Any) -> str:
    """A formula by itself, for a fenced block."""
    return f'<div class="formula">{drawn(source.strip(), "block")}</div>'


def drawn(source: str, display: Literal["block", "inline"]) -> str:
    """MathML of a formula; raises SuperFencesException, the one that no extension takes for a block of another kind."""
    try:
        return convert(source, display=display)
    except Exception as error:
        raise SuperFencesException(f"The formula {source} cannot be read: {type(error).__name__} {error}") from None


def makeExtension(**options: Any) -> Formulas:
    """Found by Python-Markdown under this name."""
    return Formulas(**options)
