"""CSV as it is found: any delimiter, decimal comma, units in the names or in a line of their own, times as numbers or as of a clock.

The head is the first line of names; a mark like # or % before it is taken away, and lines until the first numbers that say units are
used. A unit stands in brackets behind its name, `Speed [km/h]`, or after an underscore as the rig writes it, `vx_mps`. The time is
the column that is called so, or the first one; 08:42:52.043 is read as seconds since midnight, and a drive may cross it.
"""

import csv
import gzip
import io
import re
import zlib
from pathlib import Path

import numpy as np

from studio.errors import Problem, ScenarioError
from studio.kind.log import Log, signal

KIND = "logformat"
TITLE = "Table of text"
SUFFIXES = (".csv", ".tsv", ".dat")
SAMPLE = b"Time [s];Speed [km/h];Yaw rate [deg/s]\n0;72;0\n0,01;72,1;0,5\n0,02;72;0,9\n"
SIZE_LIMIT = 500_000_000  # [B] unpacked
MOST_HEAD = 20  # lines before the first numbers
DAY = 86_400.0  # [s]
TIME = re.compile(r"^(t|time|zeit|timestamps?|time ?stamp)\b", re.IGNORECASE)
BRACKETED = re.compile(r"^(.*?)\s*[\[(]([^\])]*)[\])]\s*$")
CLOCK = re.compile(r"^(\d{1,2}):(\d{2}):(\d{2}(?:[.,]\d*)?)$")
ENDINGS = {
    "s": "s", "ms": "ms", "m": "m", "mps": "m/s", "kmh": "km/h", "mps2": "m/s²", "rad": "rad", "deg": "deg", "radps": "rad/s",
    "rps": "rad/s", "degps": "deg/s", "rpm": "rpm", "Nm": "Nm", "Pa": "Pa",
}  # fmt: skip


def read(path: Path, dbc: Path | None = None) -> Log:
    """All columns; raises ScenarioError that names the line."""
    lines = text(path).splitlines()
    delimiter = delimiter_of(lines, path)
    rows = list(csv.reader(io.StringIO("\n".join(lines)), delimiter=delimiter))
    first = first_numbers(rows, delimiter, path)
    names, units = head(rows[:first], len(rows[first]), path)
    columns = numbers(rows[first:], names, first, delimiter, path)
    at = next((i for i, name in enumerate(names) if TIME.match(name)), 0)
    time = clock(columns[at], units[at])
    known = np.isfinite(time)
    return Log(path.name, {
        name: signal(name, units[i], time[known], columns[i][known]) for i, name in enumerate(names) if i != at
    })  # fmt: skip


def text(path: Path) -> str:
    """Text of a plain or gzipped file, in UTF-8 or, where it is not, as Latin-1."""
    try:
        with (gzip.open if path.suffix == ".gz" else open)(path, "rb") as file:
            data = file.read(SIZE_LIMIT + 1)
    except OSError as error:
        raise refused(path, f"cannot be read: {error.strerror or error}") from None
    except (EOFError, zlib.error) as error:
        raise refused(path, f"is damaged: {error}", remedy="pack it again with gzip") from None
    if len(data) > SIZE_LIMIT:
        raise refused(path, "is too large", f"{SIZE_LIMIT} bytes", "cut it into parts")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def delimiter_of(lines: list[str], path: Path) -> str:
    """The one that cuts the lines in the middle of the file into the most cells, the same number in all of them."""
    some = [line for line in lines[len(lines) // 3 :][:50] if line.strip()]
    if not some:
        raise refused(path, "is empty")
    counts = {mark: {line.count(mark) for line in some} for mark in (";", "\t", ",", "|")}
    even = [mark for mark, found in counts.items() if len(found) == 1 and found != {0}]
    return even[0] if even else ","


def first_numbers(rows: list[list[str]], delimiter: str, path: Path) -> int:
    """The first row that begins with a number or a time of day."""
    for i, row in enumerate(rows[:MOST_HEAD]):
        if row and (CLOCK.match(row[0].strip()) or np.isfinite(number(row[0], delimiter))):
            return i
    raise refused(path, "has no row of numbers", f"a head of at most {MOST_HEAD} lines, then numbers", "the first column must be one")


def head(rows: list[list[str]], width: int, path: Path) -> tuple[list[str], list[str]]:
    """Names and units of the columns."""
    lines = [[cell.strip().lstrip("#%").strip().strip('"').strip() for cell in row] for row in rows if len(row) == width]
    if not lines:
        raise refused(path, "has no head", remedy="put the names of the columns into its first line")
    found = [split(name) for name in lines[0]]
    below = lines[-1] if len(lines) > 1 else [""] * width
    names = [name or f"column {i + 1}" for i, (name, _) in enumerate(found)]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise refused(path, f"has a column twice: {', '.join(twice[:5])}", remedy="name every column once")
    return names, [unit or below[i] for i, (_, unit) in enumerate(found)]


def split(name: str) -> tuple[str, str]:
    """Name and unit: `Speed [km/h]` is Speed in km/h; a name with the unit at its end keeps it as a part of the name."""
    if found := BRACKETED.match(name):
        return found[1], found[2]
    return name, ENDINGS.get(name.rpartition("_")[2], "") if "_" in name else ""


def numbers(rows: list[list[str]], names: list[str], before: int, delimiter: str, path: Path) -> list[np.ndarray]:
    """The columns; an empty cell is not a number, which is a gap; raises ScenarioError for a row of another width."""
    kept = [row for row in rows if any(cell.strip() for cell in row)]
    for i, row in enumerate(kept):
        if len(row) != len(names):
            what = f"line {before + i + 1} has {len(row)} cells, the head {len(names)}"
            raise refused(path, what, remedy="the file may be cut off: take that line away, or record again")
    return [np.array([number(row[column], delimiter) for row in kept]) for column in range(len(names))]


def number(cell: str, delimiter: str) -> float:
    """A number or a time of day [s]; not a number for anything else."""
    cell = cell.strip()
    if found := CLOCK.match(cell):
        return 3600.0 * int(found[1]) + 60.0 * int(found[2]) + float(found[3].replace(",", "."))
    try:
        return float(cell if delimiter == "," else cell.replace(",", "."))
    except ValueError:
        return float("nan")


def clock(values: np.ndarray, unit: str) -> np.ndarray:
    """Times [s]; where the time of day falls by half a day, midnight was crossed."""
    time = values * {"ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0}.get(unit, 1.0)
    known = np.isfinite(time)
    past = np.cumsum(np.diff(time[known], prepend=time[known][:1]) < -0.5 * DAY)
    time[known] += DAY * past
    return time


def refused(path: Path, what: str, allowed: str = "", remedy: str = "") -> ScenarioError:
    """What is told of a file that is no table."""
    return ScenarioError(f"{path.name} cannot be read as CSV.", [Problem(str(path), what, allowed=allowed, remedy=remedy)])
