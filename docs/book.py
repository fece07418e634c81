"""The documentation: pages that are written, and pages that are made from the code, become the site in studio/_docs.

    uv run python -m docs.book

Zensical makes the site and refuses what does not fit: a link or an anchor that leads nowhere is an error with its page and line.
Nothing is fetched when the site is read: no font, script or image from elsewhere. Nothing is done twice: a digest of all
sources stands beside the site.
"""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from base64 import b64encode
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SITE = ROOT / "studio" / "_docs"
STAMP = "digest.txt"
POLICY = "policy.json"  # digests of the scripts that stand in the pages, for the header that permits no others
SOURCES = ("docs", "studio", "web/public", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE")
ENDINGS = (".py", ".md", ".toml", ".css", ".svg", ".yaml", ".tir", ".png", "LICENSE")
SCRIPT = re.compile(r"<script>(.*?)</script>", re.DOTALL)
STRICT = "RuntimeError: Aborted because --strict flag is set"  # ends what Zensical says when a page does not fit
TRACEBACK = "Traceback (most recent call last):"
ANSI = re.compile(r"\x1b\[[0-9;]*m")

HINT = """The documentation could not be built.
{what}
  A page that does not fit is named above with its line; pages stand in docs/pages, generated ones are made in docs/reference.
  Without the tools: uv sync --extra dev"""


class BookError(Exception):
    """The site cannot be made; the message says why."""


def digest() -> str:
    """sha256 of everything that the site is made from."""
    total = hashlib.sha256()
    for path in sorted(source for name in SOURCES for source in files(ROOT / name)):
        total.update(path.relative_to(ROOT).as_posix().encode() + b"\0" + hashlib.sha256(path.read_bytes()).digest())
    return total.hexdigest()


def files(path: Path) -> list[Path]:
    """A file, or the files of a folder that pages are made from; built ones are left out."""
    if path.is_file():
        return [path]
    hidden = ("_web", "_docs", "__pycache__")
    return [each for each in path.rglob("*") if each.is_file() and each.name.endswith(ENDINGS) and not set(hidden) & set(each.parts)]


def current() -> bool:
    """Whether the site was made from the sources as they are."""
    stamp = SITE / STAMP
    return stamp.is_file() and stamp.read_text() == digest()


def written() -> dict[str, str]:
    """The pages that are written, and the files of the project that are pages too."""
    pages = ROOT / "docs" / "pages"
    found = {path.relative_to(pages).as_posix(): path.read_text(encoding="utf-8") for path in sorted(pages.rglob("*.md"))}
    for name in ("CHANGELOG", "CONTRIBUTING"):
        found[f"project/{name.lower()}.md"] = (ROOT / f"{name}.md").read_text(encoding="utf-8")
    licence = (ROOT / "LICENSE").read_text(encoding="utf-8")
    return found | {"project/licence.md": f"# Licence\n\n```text\n{licence}```\n"}


def made() -> dict[str, str]:
    """The pages that are made from the code."""
    from docs.reference import catalogue, channel, command, event, kind, module, rest, scenario, vehicle

    single = {"scenario": scenario, "vehicle": vehicle, "catalogue": catalogue, "channels": channel, "events": event,
              "commands": command, "rest": rest}  # fmt: skip
    return {f"reference/{name}.md": each.page() for name, each in single.items()} | kind.pages() | module.pages()


def lay_out(folder: Path) -> None:
    """Puts pages and settings together as Zensical wants them."""
    pages = written() | made()
    for name, text in pages.items():
        path = folder / "pages" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    for source in (ROOT / "docs" / "pages").rglob("*.svg"):
        target = folder / "pages" / source.relative_to(ROOT / "docs" / "pages")
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, target)
    for source in (ROOT / "docs" / "style.css", ROOT / "web" / "public" / "favicon.svg"):
        shutil.copy(source, folder / "pages")
    rooms = ", ".join(f'"{name}"' for name in pages if name.startswith("reference/modules/") and not name.endswith("index.md"))
    settings = (ROOT / "docs" / "zensical.toml").read_text(encoding="utf-8")
    (folder / "zensical.toml").write_text(settings.replace("{ROOT}", ROOT.as_posix()).replace("{MODULES}", rooms), encoding="utf-8")


def press(folder: Path) -> Path:
    """The site made from a laid out folder; raises BookError with what Zensical says."""
    paths = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        [sys.executable, "-m", "zensical", "build", "--strict"],
        cwd=folder, env=os.environ | {"PYTHONPATH": paths}, capture_output=True, text=True,
    )  # fmt: skip
    said = ANSI.sub("", done.stdout + done.stderr)
    if done.returncode != 0:
        raise BookError(HINT.format(what=(said.partition(TRACEBACK)[0] if STRICT in said else said).strip()))
    return folder / "site"


def permit(site: Path) -> None:
    """Notes the digests of all scripts that stand in the pages."""
    found = {script for page in site.rglob("*.html") for script in SCRIPT.findall(page.read_text(encoding="utf-8"))}
    digests = sorted(b64encode(hashlib.sha256(each.encode()).digest()).decode() for each in found)
    (site / POLICY).write_text(json.dumps({"scripts": digests}))


def build(target: Path = SITE) -> bool:
    """Makes the site if it is not current; whether it had to be made. The old one stands until the new one is whole."""
    if target == SITE and current():
        return False
    stamp = digest()
    with tempfile.TemporaryDirectory(prefix="studio-docs-") as name:
        folder = Path(name)
        lay_out(folder)
        site = press(folder)
        permit(site)
        (site / STAMP).write_text(stamp)
        replace(site, target)
    return True


def replace(fresh: Path, target: Path) -> None:
    """Swaps a folder for a new one, prepared beside it, so that a server never sees half a site."""
    beside = Path(tempfile.mkdtemp(dir=target.parent, prefix=f".{target.name}-"))
    shutil.copytree(fresh, beside / "new")
    if target.exists():
        target.rename(beside / "old")
    (beside / "new").rename(target)
    shutil.rmtree(beside)


def main() -> int:
    """Builds, and says what was done."""
    try:
        print(f"{SITE}: {'built' if build() else 'is up to date'}")
        return 0
    except BookError as error:
        print(error, file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
