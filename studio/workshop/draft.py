"""A new kind: a small working file of a sort, a test for it, and a scenario that uses it.

They are written from the templates beside this file. The scenario is on a map of its own, a motorway that is drawn for it, so that
a folder of kinds needs nothing from elsewhere. What no scenario uses, a format of logs, comes with a log instead.
"""

import keyword
import re
from pathlib import Path
from string import Template

from studio.errors import KindError, Problem, nearest
from studio.kind import registry
from studio.kind.sort import SORTS
from studio.road.drawn.motorway import motorway

TEMPLATES = Path(__file__).parent / "template"
MAP = "motorway.xodr"
NAME = re.compile(r"[a-z][a-z0-9_]*")


def draft(sort: str, name: str, folder: Path) -> list[Path]:
    """Writes the files; raises KindError, and nothing is written, when the name does not fit or a file is there already."""
    wrong = problems(sort, name, folder)
    if wrong:
        raise KindError(f"The {sort} {name!r} cannot be begun.", wrong)
    written = texts(sort, name, folder)
    for path, text in written.items():
        path.write_text(text, encoding="utf-8")
    return list(written)


def texts(sort: str, name: str, folder: Path) -> dict[Path, str]:
    """What is written where; a map that is there stays."""
    words = {"name": name, "title": name.replace("_", " ").capitalize(), "map": MAP}
    files = {
        path: Template(template.read_text(encoding="utf-8")).substitute(words) for path, template in places(sort, name, folder).items()
    }
    return files if (folder / MAP).exists() or not SORTS[sort].is_run else files | {folder / MAP: motorway()}


def places(sort: str, name: str, folder: Path) -> dict[Path, Path]:
    """Which file is made of which template."""
    named = {f"{name}.py": "py", f"test_{name}.py": "test.py"} | (
        {f"{name}.yaml": "yaml"} if SORTS[sort].is_run else {f"drive.{name}": "log"}
    )
    if sort == "message":
        named[f"{name}_talk.py"] = "talk.py"  # an application: nobody else would tell or hear it
    return {folder / file: TEMPLATES / f"{sort}.{ending}.txt" for file, ending in named.items()}


def use(sort: str, name: str, folder: Path) -> str:
    """The command that uses it."""
    return f"run {folder / name}.yaml" if SORTS[sort].is_run else f"logs import {folder / 'drive'}.{name}"


def problems(sort: str, name: str, folder: Path) -> list[Problem]:
    """Why it cannot be done."""
    if sort not in SORTS:
        return [Problem("SORT", "is no sort of kinds", repr(sort), ", ".join(SORTS), nearest(sort, SORTS))]
    if not folder.is_dir():
        return [Problem("--folder", "is not a folder", str(folder), remedy="make it first")]
    if not NAME.fullmatch(name) or keyword.iskeyword(name) or name.startswith("test_"):
        return [Problem("NAME", "is no name of a file of Python", repr(name), "small letters, digits and _, a letter first")]
    registry.load_all()
    if taken := registry.taken_by(sort, name):
        return [Problem("NAME", f"is the name of a {sort} already: {taken}", repr(name), remedy="choose another name")]
    present = [path for path in places(sort, name, folder) if path.exists()]
    return [Problem(str(path), "is there already", remedy="choose another name, or another --folder") for path in present]
