"""Code blocks of a page, and a reader who does what they say, block by block, in a folder with the samples."""

import contextlib
import io
import os
import re
import shlex
import shutil
import subprocess
import sys
import traceback
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from studio import cli, job
from studio.errors import StudioError
from studio.kind import registry
from studio.scenario import file
from tests.conftest import ROOT
from tests.server.server import served

FENCE = re.compile(r'^```(?P<language>\w+)?(?: title="(?P<title>[^"]+)")?[^\n]*\n(?P<text>.*?)^```$', re.MULTILINE | re.DOTALL)
RUN = ("sh", "python", "yaml")
SHOWN = ("text", "math")
ADDRESS = "http://127.0.0.1:8000"
SAMPLE = Path("scenarios") / "grosser_stern_platoon.yaml"
STUDIO = "uv run studio"
UV = f"""#!/bin/sh
# Stands for uv: everything is installed already.
shift
case "$1" in
  studio) shift; exec {shlex.quote(sys.executable)} -m studio.cli "$@" ;;
  python) shift; exec {shlex.quote(sys.executable)} "$@" ;;
  *) echo "uv run $1: no such command in the tests of the pages" >&2; exit 127 ;;
esac
"""
REMEDY = "Mend the block, or what it shows; a block that only illustrates is marked as text."


class Block(NamedTuple):
    """A block: its page, the line of its first line of text, language, title and text."""

    page: str
    line: int
    language: str
    title: str
    text: str


class BlockError(AssertionError):
    """A block that fails: where, what was done, what came of it, what to do."""

    def __init__(self, block: Block, line: int, command: str, output: str):
        said = "\n".join(f"  | {each}" for each in output.strip().splitlines()[-30:])
        super().__init__(f"{block.page}, line {line}: {command}\n{said}\n  {REMEDY}")


def blocks(page: Path) -> list[Block]:
    """The blocks of a page in their order."""
    text = page.read_text(encoding="utf-8")
    return [
        Block(page.name, text.count("\n", 0, found.start("text")) + 1, found["language"] or "", found["title"] or "", found["text"])
        for found in FENCE.finditer(text)
    ]


@dataclass
class Reader:
    """Somebody who follows a page in a folder: files, names of the Python blocks, and the server if the page has one started."""

    folder: Path
    stack: contextlib.ExitStack
    names: dict[str, Any] = field(default_factory=lambda: {"__name__": "page"})
    address: str = ""
    serving: bool = False

    def follow(self, block: Block) -> None:
        """Does what a block says; raises BlockError when it does not work."""
        if block.language not in (*RUN, *SHOWN):
            raise BlockError(block, block.line - 1, f"```{block.language}", f"languages of blocks: {', '.join((*RUN, *SHOWN))}")
        if block.language in RUN:
            {"sh": self.shell, "python": self.python, "yaml": self.document}[block.language](block)

    def save(self, block: Block) -> None:
        """A block with a title is the content of that file."""
        path = self.folder / block.title
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(block.text, encoding="utf-8")

    # -- sh ------------------------------------------------------------------------------------------

    def shell(self, block: Block) -> None:
        """Commands of the studio are called as functions; a block with any others is given to bash as a whole."""
        lines = [(block.line + i, each.strip()) for i, each in enumerate(block.text.splitlines()) if each.strip()]
        if not all(each == STUDIO or each.startswith(f"{STUDIO} ") for _, each in lines):
            self.bash(block)
            return
        for line, command in lines:
            if command == STUDIO:
                self.serving = True
            else:
                self.studio(block, line, command)

    def studio(self, block: Block, line: int, command: str) -> None:
        """One command line of the studio."""
        said, code = io.StringIO(), 0
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            try:
                cli.main(shlex.split(command)[len(STUDIO.split()) :])
            except SystemExit as end:
                code = end.code or 0
            except Exception:
                code = traceback.format_exc()
        if code or not said.getvalue().strip():
            raise BlockError(block, line, command, f"{said.getvalue()}\nended with {code}")

    def bash(self, block: Block) -> None:
        """A block as a script that ends with its first failing command."""
        script = "set -eu\ntrap 'echo \"failed: $BASH_COMMAND\" >&2' ERR\n" + self.addressed(block.text)
        environment = os.environ | {"PATH": f"{self.stand_in()}{os.pathsep}{os.environ['PATH']}"}
        done = subprocess.run(["bash", "-c", script], cwd=self.folder, env=environment, capture_output=True, text=True)
        if done.returncode:
            raise BlockError(block, block.line, block.text.strip(), done.stdout + done.stderr)

    def stand_in(self) -> Path:
        """A folder with something that stands for uv."""
        folder = self.folder / ".bin"
        folder.mkdir(exist_ok=True)
        (folder / "uv").write_text(UV)
        (folder / "uv").chmod(0o755)
        return folder

    def addressed(self, text: str) -> str:
        """A text that finds the server which the page has told to start; it starts when somebody wants to talk to it."""
        if ADDRESS not in text or not self.serving:
            return text
        if not self.address:
            client, _, _ = self.stack.enter_context(served(self.folder))
            self.address = str(client.base_url).rstrip("/")
        return text.replace(ADDRESS, self.address)

    # -- python --------------------------------------------------------------------------------------

    def python(self, block: Block) -> None:
        """Runs it with the names of the blocks before; a titled block is a file, and must be Python."""
        try:
            program = compile("\n" * (block.line - 1) + self.addressed(block.text), block.page, "exec")
            if block.title:
                self.save(block)
                return
            with contextlib.redirect_stdout(io.StringIO()):
                exec(program, self.names)
        except Exception as error:
            frames = traceback.extract_tb(error.__traceback__)
            line = next((each.lineno for each in reversed(frames) if each.filename == block.page), None) or getattr(error, "lineno", None)
            command = block.text.splitlines()[line - block.line] if line else ""
            raise BlockError(block, line or block.line, command, traceback.format_exc()) from None

    # -- yaml ----------------------------------------------------------------------------------------

    def document(self, block: Block) -> None:
        """A scenario, or a part of one, which is put into the sample: it must be valid, on its map too."""
        try:
            part = yaml.safe_load(block.text)
            if block.title:
                self.save(block)
            path = Path(block.title) if block.title else self.patched(part)
            registry.load_folder(path.parent)
            job.prepare(job.load(path))
        except (StudioError, yaml.YAMLError) as error:
            raise BlockError(block, block.line, "this YAML", str(error)) from None

    def patched(self, part: dict[str, Any]) -> Path:
        """The sample with other values for the fields of a part."""
        path = SAMPLE.with_name("patched.yaml")
        path.write_text(yaml.safe_dump(file.read(SAMPLE) | part, allow_unicode=True), encoding="utf-8")
        return path


@contextlib.contextmanager
def reader(folder: Path):
    """A reader in a folder with the samples; the caller has made it the present folder."""
    shutil.copytree(ROOT / "scenarios", folder / "scenarios")
    (folder / "studio").symlink_to(ROOT / "studio")
    before = list(sys.path)
    with contextlib.ExitStack() as stack:
        try:
            yield Reader(folder, stack)
        finally:
            sys.path[:] = before
