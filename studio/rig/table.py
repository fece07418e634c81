"""Tables of numbers as CSV, plain or gzipped: reading with everything that can be wrong, and writing."""

import csv
import gzip
import io
import os
import zlib
from collections.abc import Iterable
from dataclasses import dataclass
from math import isnan
from pathlib import Path

import numpy as np

from studio.errors import Problem, ScenarioError, nearest

SIZE_LIMIT = 200_000_000  # [B] of a table, unpacked
MOST = 20  # problems that a message lists

Ranges = dict[str, tuple[float, float, str]]  # of each column: lowest and highest value, and how a message says it


@dataclass(frozen=True)
class Table:
    """A table as text: its head, its rows, and the line of the file that each row stands in."""

    name: str
    head: list[str]
    rows: list[list[str]]
    lines: list[int]

    def where(self, row: int, column: str) -> str:
        """Place of a cell for a message."""
        return f"{self.name}, line {self.lines[row]}, column {column}"


def read(path: Path, *, needed: Iterable[str], known: Iterable[str] | None = None) -> Table:
    """A CSV file with the needed columns, and no others than the known ones when these are given; raises ScenarioError."""
    reader = csv.reader(io.StringIO(text(path), newline=""), strict=True)
    rows, lines = [], []
    try:
        for row in reader:
            if any(cell.strip() for cell in row):
                rows.append([cell.strip() for cell in row])
                lines.append(reader.line_num)
    except csv.Error as error:
        refuse(path.name, [Problem(f"{path.name}, line {reader.line_num}", f"is not CSV: {error}")])
    if not rows:
        refuse(path.name, [Problem(str(path), "is empty", allowed=f"a head with {', '.join(needed)}, then rows")])
    table = Table(path.name, rows[0], rows[1:], lines[1:])
    refuse(path.name, head_problems(table, list(needed), known) or shape_problems(table))
    return table


def text(path: Path) -> str:
    """Text of a plain or gzipped file."""
    try:
        opened = gzip.open if path.suffix == ".gz" else open
        with opened(path, "rb") as file:
            data = file.read(SIZE_LIMIT + 1)
        if len(data) > SIZE_LIMIT:
            problem = Problem(str(path), "is too large", allowed=f"{SIZE_LIMIT} bytes", remedy="cut it into parts")
        else:
            return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        problem = Problem(str(path), "is not a text file", allowed="CSV in UTF-8")
    except OSError as error:
        problem = Problem(str(path), f"cannot be opened: {error.strerror or error}")
    except (EOFError, zlib.error) as error:
        problem = Problem(str(path), f"is damaged: {error}", remedy="pack it again with gzip")
    raise refusal(path.name, [problem])


def head_problems(table: Table, needed: list[str], known: Iterable[str] | None) -> list[Problem]:
    """Columns that are missing, stand twice, or are not known."""
    where = f"{table.name}, line 1"
    if len(table.head) == 1 and any(mark in table.head[0] for mark in ";\t"):
        return [Problem(where, "has one column only", table.head[0][:MOST], "columns separated by commas")]
    missing = [name for name in needed if name not in table.head]
    twice = sorted({name for name in table.head if table.head.count(name) > 1})
    strange = [name for name in dict.fromkeys(table.head) if known is not None and name not in known]
    return [
        *(Problem(where, f"has no column {name}", remedy=nearest(name, table.head)) for name in missing),
        *(Problem(where, "has a column twice", name, "every name once") for name in twice),
        *(Problem(where, "has a column that is not known", name or "no name", remedy=nearest(name, known or ())) for name in strange),
    ]


def shape_problems(table: Table) -> list[Problem]:
    """No rows, or rows that do not fit the head."""
    if not table.rows:
        return [Problem(table.name, "has a head but no rows")]
    width = len(table.head)
    return [
        Problem(f"{table.name}, line {line}", "has another number of cells than the head", str(len(row)), str(width))
        for row, line in zip(table.rows, table.lines, strict=True)
        if len(row) != width
    ]


def numbers(table: Table, ranges: Ranges) -> np.ndarray:
    """The columns of the ranges, shaped [column, row]; raises ScenarioError that names the cells out of their range."""
    at = [table.head.index(name) for name in ranges]
    values = [[number(row[column]) for row in table.rows] for column in at]
    problems = [
        cell_problem(table, i, name, value, allowed)
        for (name, (low, high, allowed)), column in zip(ranges.items(), values, strict=True)
        for i, value in enumerate(column)
        if not low <= value <= high
    ]
    refuse(table.name, problems)
    return np.array(values)


def number(cell: str) -> float:
    """A number, or NaN for what is none."""
    try:
        return float(cell)
    except ValueError:
        return float("nan")


def cell_problem(table: Table, row: int, column: str, value: float, allowed: str) -> Problem:
    """A cell that is no number or out of range."""
    what = "is not a number" if isnan(value) else "is out of range"
    cell = table.rows[row][table.head.index(column)]
    return Problem(table.where(row, column), what, cell or "nothing", allowed)


def write(path: Path, rows: list[list[str]]) -> None:
    """Writes CSV, gzipped when the name ends in .gz: beside, and renames, so that no half of it ever stands there."""
    beside = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        opened = gzip.open if path.suffix == ".gz" else open
        with opened(beside, "wt", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)
        os.replace(beside, path)
    except OSError as error:
        beside.unlink(missing_ok=True)
        refuse(path.name, [Problem(str(path), f"cannot be written: {error.strerror or error}")], "cannot be written")


def check_output(out: Path, *inputs: Path) -> None:
    """Refuses a result that would overwrite an input, or whose folder does not take it; raises ScenarioError."""
    for given in inputs:
        if out.exists() and given.exists() and out.samefile(given):
            refuse(out.name, [Problem(str(out), "is an input of this command", remedy="name another file")], "cannot be written")
    why = "it is a folder" if out.is_dir() else "" if out.parent.is_dir() else "there is no such folder"
    if why or not os.access(out.parent, os.W_OK):
        what = f"cannot be written: {why or 'no permission in its folder'}"
        refuse(out.name, [Problem(str(out), what, allowed="a file in a folder that can be written")], "cannot be written")


def refuse(name: str, problems: list[Problem], what: str = "cannot be used as a table") -> None:
    """Raises ScenarioError when there are problems."""
    if problems:
        raise refusal(name, problems, what)


def refusal(name: str, problems: list[Problem], what: str = "cannot be used as a table") -> ScenarioError:
    """What is told of problems: the first of many."""
    more = f" The first {MOST} of {len(problems)} problems:" if len(problems) > MOST else ""
    return ScenarioError(f"{name} {what}.{more}", problems[:MOST])
