"""The documentation under /docs/: the site that `python -m docs.book` makes of a checkout, and that a released package carries.

In a checkout the first visit has it made, in a process of its own; until it is there, a page says so and looks again. An older
site is shown while a newer one is being made.
"""

import html
import importlib.util
import json
import subprocess
import sys
import threading
from pathlib import Path

from fastapi import APIRouter
from fastapi.responses import FileResponse, HTMLResponse, RedirectResponse, Response

SITE = Path(__file__).parent.parent / "_docs"
CHECKOUT = Path(__file__).parent.parent.parent
COMMAND = (sys.executable, "-m", "docs.book")
ALWAYS_ASK = {"Cache-Control": "no-cache"}
# Nothing from elsewhere, and of scripts in the pages only those that the build has counted.
POLICY = (
    "default-src 'none'; script-src 'self'{scripts}; style-src 'self' 'unsafe-inline'; img-src 'self' data:; font-src 'self'; "
    "connect-src 'self'; worker-src 'self'; base-uri 'self'; form-action 'self'; frame-ancestors 'none'"
)
FRAME = """<!doctype html><meta charset="utf-8"><title>Cooperative ADAS Studio: documentation</title>{refresh}
<style>body {{ font: 1rem/1.5 system-ui, sans-serif; max-width: 46rem; margin: 4rem auto; padding: 0 1rem; color-scheme: light dark }}
pre {{ white-space: pre-wrap }}</style>
{body}
"""
WAITING = "<p>The documentation is being made from the sources; that takes some seconds. This page looks again by itself.</p>"
FAILED = "<p>The documentation could not be made:</p><pre>{said}</pre><p>Mend that and reload this page.</p>"
MISSING = """<p>This installation has no documentation. A released package carries it; in a checkout of the project</p>
<pre>uv run python -m docs.book</pre><p>makes it.</p>"""

UNKNOWN = '<p>There is no such page. <a href="/docs/">The documentation</a> begins there.</p>'


class Press:
    """Has the site made, once in a server's life, and again when that failed."""

    def __init__(self) -> None:
        self.process: subprocess.Popen[str] | None = None
        self.lock = threading.Lock()

    def can(self) -> bool:
        """Whether sources and tools are here."""
        return (CHECKOUT / "docs" / "book.py").is_file() and importlib.util.find_spec("zensical") is not None

    def visit(self) -> str:
        """Called at every visit; what is wrong when a making has failed, and then the next visit begins another."""
        with self.lock:
            if self.process is None:
                if self.can():
                    self.process = subprocess.Popen(
                        COMMAND, cwd=CHECKOUT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, encoding="utf-8"
                    )
                return ""
            if not self.process.poll():  # works still, or has succeeded
                return ""
            said, self.process = self.process.communicate()[1], None
            return said


press = Press()
router = APIRouter()


@router.get("/docs")
def door() -> Response:
    """Its pages link relatively, so the address needs its stroke."""
    return RedirectResponse("/docs/")


@router.get("/docs/{path:path}")
def answer(path: str) -> Response:
    """A file of the site, the page of a folder, or why there is none."""
    wrong = press.visit() if not path or path.endswith("/") else ""
    if not (SITE / "index.html").is_file():
        return without(wrong)
    if (wanted := found(SITE, path)) is None:
        return framed(UNKNOWN, status=404)
    if wanted.is_dir() and path and not path.endswith("/"):
        return RedirectResponse(f"/docs/{path}/")
    if wanted.is_dir():
        wanted /= "index.html"
    if not wanted.is_file():
        return framed(UNKNOWN, status=404)
    return FileResponse(wanted, headers=headers())


def found(folder: Path, path: str) -> Path | None:
    """What an address means in a folder, whether it is there or not; nothing when it means no file of it."""
    try:
        wanted = (folder / path).resolve()
        wanted.exists()
    except (OSError, ValueError):  # too long, or with a character that no name has
        return None
    return wanted if wanted.is_relative_to(folder) else None


def without(wrong: str) -> Response:
    """The page while there is no site."""
    if wrong:
        return framed(FAILED.format(said=html.escape(wrong)), status=500)
    return framed(WAITING, refresh=2, status=503) if press.process else framed(MISSING, status=503)


def framed(body: str, *, status: int, refresh: int = 0) -> Response:
    """A plain page; `refresh` [s] is when it looks again."""
    again = f'<meta http-equiv="refresh" content="{refresh}">' if refresh else ""
    return HTMLResponse(FRAME.format(refresh=again, body=body), status_code=status, headers=ALWAYS_ASK)


def headers() -> dict[str, str]:
    """What every answer of the site carries."""
    digests = json.loads((SITE / "policy.json").read_text(encoding="utf-8"))["scripts"]
    return ALWAYS_ASK | {"Content-Security-Policy": POLICY.format(scripts="".join(f" 'sha256-{each}'" for each in digests))}
