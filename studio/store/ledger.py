"""The table of runs as a file for other programs: a row for each run, a column for each parameter that one of them set, and each metric.

What of a recorded channel is wanted in one number (column.py) is a column too.

csv       the unit of a metric stands behind its name, `metric.min_ttc [s]`; what there is none of is empty
parquet   numbers as numbers; units are in the columns' own words
json      a list of objects, units left out
"""

import csv
import io
import json
from collections.abc import Callable, Sequence
from typing import Any, Literal

import pyarrow as pa
import pyarrow.parquet as pq

from studio.store import column
from studio.store.runs import Row, Runs
from studio.store.setting import settings

Form = Literal["csv", "parquet", "json"]
MEDIA: dict[Form, str] = {"csv": "text/csv", "parquet": "application/vnd.apache.parquet", "json": "application/json"}
ABOUT = (
    "run", "scenario", "name", "tags", "parent", "seed", "status", "verdict", "reason", "created", "sim_time_s", "wall_time_s",
    "code_version", "state_hash", "error",
)  # fmt: skip
UNITS = {"sim_time_s": "s", "wall_time_s": "s"}


def ledger(runs: Runs, form: Form, *, where: str = "1", values: Sequence[Any] = (), channels: Sequence[str] = ()) -> bytes:
    """The table of runs, newest first; `channels` names columns of a channel in one number each. Raises ScenarioError for others."""
    wanted = [column.wanted(each) for each in channels]
    rows = runs.select(where=where, values=values)
    columns, units = table(runs, rows)
    for each in wanted:
        found = column.filled(runs, each, [row.run for row in rows])
        cells = [found.get(row.run) for row in rows]
        columns[f"channel.{each.name}"] = [cell and cell.value for cell in cells]
        units[f"channel.{each.name}"] = next((cell.unit for cell in cells if cell and cell.unit), "")
    return FORMS[form](columns, {name: unit for name, unit in units.items() if unit not in ("", "1")})


def table(runs: Runs, rows: Sequence[Row]) -> tuple[dict[str, list[Any]], dict[str, str]]:
    """Columns by name, and the units of those that have one."""
    had = settings(runs, rows)
    paths = sorted({path for each in had.values() for path in each})
    units = {name: each.unit for row in reversed(rows) for name, each in row.metrics.items()}
    columns: dict[str, list[Any]] = {name: [plain(getattr(row, name)) for row in rows] for name in ABOUT}
    columns |= {f"parameter.{path}": [plain(had[row.run].get(path)) for row in rows] for path in paths}
    columns |= {f"metric.{name}": [row.metrics[name].value if name in row.metrics else None for row in rows] for name in units}
    return columns, UNITS | {f"metric.{name}": unit for name, unit in units.items() if unit != "1"}


def plain(value: Any) -> Any:
    """A value that fits into a cell: lists and objects as JSON."""
    return json.dumps(value, ensure_ascii=False) if isinstance(value, (list, dict)) else value


def as_csv(columns: dict[str, list[Any]], units: dict[str, str]) -> bytes:
    """Comma-separated, in UTF-8; what begins like a formula is no formula for a spreadsheet."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([f"{name} [{units[name]}]" if name in units and name not in UNITS else name for name in columns])
    writer.writerows([[harmless(value) for value in row] for row in zip(*columns.values(), strict=True)])
    return text.getvalue().encode()


def harmless(value: Any) -> Any:
    """A text that a spreadsheet would take for a formula gets an apostrophe before it (OWASP, CSV injection)."""
    return f"'{value}" if isinstance(value, str) and value[:1] in ("=", "+", "-", "@", "\t", "\r") else value


def as_parquet(columns: dict[str, list[Any]], units: dict[str, str]) -> bytes:
    """A column of one type each; of values of several sorts their texts."""
    arrays = {name: array(values) for name, values in columns.items()}
    fields = [pa.field(name, each.type, metadata={b"unit": units.get(name, "").encode()}) for name, each in arrays.items()]
    buffer = io.BytesIO()
    pq.write_table(pa.table(list(arrays.values()), schema=pa.schema(fields)), buffer, compression="zstd")
    return buffer.getvalue()


def array(values: list[Any]) -> pa.Array:
    """Values as an array."""
    if all(value is None or (isinstance(value, (int, float)) and not isinstance(value, bool)) for value in values):
        is_whole = any(value is not None for value in values) and all(value is None or isinstance(value, int) for value in values)
        return pa.array(values, pa.int64() if is_whole else pa.float64())
    if all(value is None or isinstance(value, bool) for value in values):
        return pa.array(values, pa.bool_())
    return pa.array([value if value is None or isinstance(value, str) else json.dumps(value) for value in values], pa.string())


def as_json(columns: dict[str, list[Any]], units: dict[str, str]) -> bytes:
    """A list of rows."""
    rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    return json.dumps(rows, ensure_ascii=False).encode()


FORMS: dict[Form, Callable[[dict[str, list[Any]], dict[str, str]], bytes]] = {"csv": as_csv, "parquet": as_parquet, "json": as_json}
