"""The modules of the package, room by room, from their docstrings."""

from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2] / "studio"
HEAD = """# Modules

Every module of the package with its functions and classes, from their docstrings. What users import is in `studio` itself:
`load`, `run`, `drive`, `open_runs`, `StudioError`. The rooms stand in the order of their names; the floors on which they lie, and
which may import which, stand in [Architecture](../../explanation/architecture.md).
"""


def pages() -> dict[str, str]:
    """A page for the modules at the top, and one for each room."""
    rooms = [path for path in sorted(PACKAGE.iterdir()) if (path / "__init__.py").is_file()]
    top = [path for path in sorted(PACKAGE.glob("*.py")) if path.stem != "__init__"]
    first = {"reference/modules/index.md": HEAD + described(top)}
    return first | {f"reference/modules/{room.name}.md": f"# {room.name}\n\n{described(files(room))}" for room in rooms}


def files(room: Path) -> list[Path]:
    """The modules of a room, the room itself first."""
    return sorted(room.rglob("*.py"), key=lambda path: (path.parent != room, path.parent, path.stem != "__init__", path.stem))


def described(paths: list[Path]) -> str:
    """What mkdocstrings replaces by the docstrings of modules."""
    return "\n".join(f"\n::: {name_of(path)}\n" for path in paths)


def name_of(path: Path) -> str:
    """The dotted name of a module."""
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
