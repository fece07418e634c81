"""Formulas: LaTeX in a page becomes MathML, which browsers draw by themselves, without a script or a font.

`$...$` stands in a line, a fenced block ```math by itself. A formula that cannot be read ends the build.
"""

import re
import xml.etree.ElementTree as ElementTree
from typing import Any

from latex2mathml.converter import convert
from markdown import Markdown
from markdown.extensions import Extension
from markdown.inlinepatterns import InlineProcessor

IN_LINE = r"(?<![\\$])\$(?!\s)([^$\n]+?)(?<!\s)\$(?!\d)"
NAMESPACE = re.compile(r"\sxmlns=\"[^\"]*\"")


class Formula(InlineProcessor):
    """A formula in a line."""

    def handleMatch(self, m: re.Match[str], data: str) -> tuple[ElementTree.Element, int, int]:
        return ElementTree.fromstring(NAMESPACE.sub("", convert(m.group(1)))), m.start(0), m.end(0)


class Formulas(Extension):
    """Formulas for Python-Markdown."""

    def extendMarkdown(self, md: Markdown) -> None:
        md.inlinePatterns.register(Formula(IN_LINE, md), "formula", 185)  # after code, before escapes and emphasis


def block(source: str, language: str, class_name: str, options: dict[str, Any], md: Markdown, **others: Any) -> str:
    """A formula by itself, for a fenced block."""
    return f'<div class="formula">{convert(source.strip(), display="block")}</div>'


def makeExtension(**options: Any) -> Formulas:
    """Found by Python-Markdown under this name."""
    return Formulas(**options)
