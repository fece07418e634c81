"""The file of a kind as its author sees it: its text as it stands on the disk now, whether that is what was loaded, and what Python cannot
read in it.

It is only read. What a browser sends is never run: it may write the file itself, where its user allows that, and the text here follows it.
"""

import ast
from dataclasses import dataclass

from studio.kind.registry import Kind

LONGEST = 400_000  # letters that are shown of a file


@dataclass(frozen=True)
class Slip:
    """What Python cannot read: in which line and column, from 1 on, and what it says."""

    line: int
    column: int
    what: str


@dataclass(frozen=True)
class Manuscript:
    """A kind's file: where it lies, its text, whether it is as it was loaded, why it cannot be shown, and what is wrong in it.

    `own` is a file that its author may write in, and `refused` why what stands in it is not used.
    """

    file: str
    text: str
    loaded: bool
    missing: str
    slips: tuple[Slip, ...]
    own: bool = False
    refused: str = ""


def manuscript(kind: Kind, refused: str = "") -> Manuscript:
    """The file of a kind now; what was loaded of it where it cannot be read any more."""
    path = kind.file
    known = kind.texts.get(path.name, "") if path else ""
    if path is None:
        return Manuscript("", known, True, "it stands in no file", ())
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        return Manuscript(str(path), known[:LONGEST], True, error.strerror or str(error), ())
    except UnicodeDecodeError:
        return Manuscript(str(path), known[:LONGEST], True, "it is no text in UTF-8", ())
    return Manuscript(str(path), text[:LONGEST], text == known, "", slips(text), not kind.is_built_in, refused)


def slips(text: str) -> tuple[Slip, ...]:
    """Where Python cannot read a text; it is not run for that."""
    try:
        ast.parse(text)
    except SyntaxError as error:
        return (Slip(error.lineno or 1, error.offset or 1, error.msg),)
    except (ValueError, RecursionError, MemoryError) as error:
        return (Slip(1, 1, str(error) or type(error).__name__),)
    return ()
