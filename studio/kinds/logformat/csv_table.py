"""CSV as it is found: any delimiter, decimal comma, units in the names or in a line of their own, times as numbers or as of a clock.

The head is the first line of names; a mark like # or % before it is taken away, and lines until the first numbers that say units are
used. A unit stands in brackets behind its name, `Speed [km/h]`, or after an underscore as the rig writes it, `vx_mps`. The time is
the column that is called so, or the first one if it rises and has no other unit; 08:42:52.043 is read as seconds since midnight, and a
drive may cross it.
"""

import csv
import gzip
import io
import re
import zlib
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from studio.errors import Problem, ScenarioError, short
from studio.kind.log import Log, signal

KIND = "logformat"
TITLE = "Table of text"
SUFFIXES = (".csv", ".tsv", ".dat")
SAMPLE = b"Time [s];Speed [km/h];Yaw rate [deg/s]\n0;72;0\n0,01;72,1;0,5\n0,02;72;0,9\n"
SIZE_LIMIT = 500_000_000  # [B] unpacked
MOST_HEAD = 20  # lines before the first numbers
DAY = 86_400.0  # [s]
TIME = re.compile(r"^(t|time|zeit|timestamps?|time ?stamp)(\b|_(s|ms|us|min|h)$)", re.IGNORECASE)
SCALES = {"s": 1.0, "": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "min": 60.0, "h": 3600.0}  # units of times [s]
BRACKETED = re.compile(r"^(.*?)\s*[\[(]([^\])]*)[\])]\s*$")
CLOCK = re.compile(r"^(\d{1,2}):(\d{2}):(\d{2}(?:[.,]\d*)?)$")
DATE = re.compile(r"^\d{4}-\d{2}-\d{2}[T ]\d{2}:")
WIDE = (b"\xff\xfe", b"\xfe\xff")  # how UTF-16 begins
ENDINGS = {
    "s": "s", "ms": "ms", "m": "m", "mps": "m/s", "kmh": "km/h", "mps2": "m/s²", "rad": "rad", "deg": "deg", "radps": "rad/s",
    "rps": "rad/s", "degps": "deg/s", "rpm": "rpm", "Nm": "Nm", "Pa": "Pa",
}  # fmt: skip


def read(path: Path, dbc: Path | None = None) -> Log:
    """All columns; raises ScenarioError that names the line."""
    lines = text(path).splitlines()
    delimiter = delimiter_of(lines, path)
    rows = list(csv.reader(io.StringIO("\n".join(lines)), delimiter=delimiter))
    first = first_numbers(rows, path)
    names, units = head(rows[:first], len(rows[first]), path)
    columns = numbers(rows[first:], names, first, path)
    at = clock_of(names, units, columns, path)
    time = clock(columns[at], units[at])
    known = np.isfinite(time)
    return Log(path.name, {
        name: signal(name, units[i], time[known], columns[i][known]) for i, name in enumerate(names) if i != at
    })  # fmt: skip


def text(path: Path) -> str:
    """Text of a plain or gzipped file, in UTF-8, in UTF-16 where it says so, or else as Latin-1."""
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
        return data.decode("utf-16" if data.startswith(WIDE) else "utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def delimiter_of(lines: list[str], path: Path) -> str:
    """The one that cuts the lines in the middle of the file into the most cells, the same number in all of them."""
    some = [line for line in lines[len(lines) // 3 :][:50] if line.strip()]
    if not some:
        raise refused(path, "is empty")
    counts = {mark: {len(row) for row in csv.reader(some, delimiter=mark)} for mark in (";", "\t", ",", "|")}
    even = [mark for mark, found in counts.items() if len(found) == 1 and found != {1}]
    return even[0] if even else ","


def first_numbers(rows: list[list[str]], path: Path) -> int:
    """The first row that begins with a number or a time of day."""
    for i, row in enumerate(rows[:MOST_HEAD]):
        if row and np.isfinite(number(row[0])):
            return i
    raise refused(
        path,
        "has no row of numbers",
        f"a head of at most {MOST_HEAD} lines, then numbers",
        f"the first column must be one, or a time of day; it begins with {short(rows[0][0]) if rows[0] else 'nothing'}",
    )


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


def numbers(rows: list[list[str]], names: list[str], before: int, path: Path) -> list[np.ndarray]:
    """The columns; an empty cell is not a number, which is a gap; raises ScenarioError for a row of another width."""
    kept = [row for row in rows if any(cell.strip() for cell in row)]
    for i, row in enumerate(kept):
        if len(row) != len(names):
            what = f"line {before + i + 1} has {len(row)} cells, the head {len(names)}"
            raise refused(path, what, remedy="the file may be cut off: take that line away, or record again")
    return [np.array([number(row[column]) for row in kept]) for column in range(len(names))]


def number(cell: str) -> float:
    """A number, or a time of day or of the calendar [s]; not a number for anything else.

    Where it has points and commas the last of them is that of the decimals, and the others part thousands: 1.234,5 and 1,234.5.
    """
    cell = cell.strip()
    if found := CLOCK.match(cell):
        return 3600.0 * int(found[1]) + 60.0 * int(found[2]) + float(found[3].replace(",", "."))
    try:
        return moment(cell) if DATE.match(cell) else float(with_point(cell))
    except ValueError:
        return float("nan")


def with_point(cell: str) -> str:
    """A number without marks between its thousands, its decimals behind a point."""
    if "." in cell and "," in cell:
        cell = cell.replace(min(".,", key=cell.rfind), "")
    return cell.replace(",", ".")


def moment(cell: str) -> float:
    """A date with its time as ISO 8601 writes it, in seconds since 1970; without a zone it is meant in UTC."""
    found = datetime.fromisoformat(cell.replace(",", "."))
    return (found if found.tzinfo else found.replace(tzinfo=UTC)).timestamp()


def clock_of(names: list[str], units: list[str], columns: list[np.ndarray], path: Path) -> int:
    """Which column is the time: by its name, else the first one if it can be; raises ScenarioError."""
    at = next((i for i, name in enumerate(names) if TIME.match(name)), None)
    if at is not None:
        return at
    steps = np.diff(columns[0][np.isfinite(columns[0])])
    if units[0] in SCALES and (steps > 0.0).sum() > 0.5 * steps.size:
        return 0
    what = f"has no column of time: none is called time, and the first, {names[0]}, does not rise as one or has another unit"
    raise refused(path, what, "time [s], t, timestamp ... in the head", "record the time too, or give its column that name")


def clock(values: np.ndarray, unit: str) -> np.ndarray:
    """Times [s]; where the time of day falls by half a day, midnight was crossed."""
    time = values * SCALES.get(unit, 1.0)
    known = np.isfinite(time)
    past = np.cumsum(np.diff(time[known], prepend=time[known][:1]) < -0.5 * DAY)
    time[known] += DAY * past
    return time


def refused(path: Path, what: str, allowed: str = "", remedy: str = "") -> ScenarioError:
    """What is told of a file that is no table."""
    return ScenarioError(f"{path.name} cannot be read as CSV.", [Problem(str(path), what, allowed=allowed, remedy=remedy)])
