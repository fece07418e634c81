"""Traces as one Parquet file per run: a column per channel with its unit, readable by pandas, polars and MATLAB."""

import io
import json
import mmap
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from tsdownsample import MinMaxDownsampler

from studio.errors import Problem, UnknownError, nearest, short
from studio.execution.about import about, of_about
from studio.execution.happening import Happening
from studio.execution.message import Messages
from studio.execution.record import Record, Traced
from studio.execution.shelf import SMALL
from studio.world.channel import CHANNELS, catalogue

UNIT, LABEL = b"unit", b"label"
FORM: Any = {"compression": "zstd", "use_dictionary": False, "use_byte_stream_split": True, "data_page_size": 1 << 15}
BATCH = 512  # samples that are read at a time
ABOUT = b"record"  # what the columns are about, as JSON


def write(record: Record, quantities: Sequence[str] = ()) -> bytes:
    """The record's channels, or those of some quantities only; floats keep all their bits."""
    buffer = io.BytesIO()
    pq.write_table(table_of(record, quantities), buffer, **FORM)
    return buffer.getvalue()


def write_beside(folder: Path, record: Record, quantities: Sequence[str] = ()) -> bytes | memoryview:
    """The same; what is large is written in a folder, if there is one with room, and is never in memory as a whole."""
    table = table_of(record, quantities)
    if folder.is_dir() and table.nbytes > SMALL:
        with suppress(OSError), (folder / "trace.parquet").open("w+b") as file:
            pq.write_table(table, file, **FORM)
            file.flush()
            return memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ))
    return write(record, quantities)


def table_of(record: Record, quantities: Sequence[str]) -> pa.Table:
    """A column per channel; they lie where the record has them."""
    names = [name for name in record.names() if not quantities or name.partition(".")[2] in quantities]
    columns = {"time": record.time} | {name: record.trace(name) for name in names}
    fields = [field("time", "s", "Time")]
    for name in names:
        channel = record.probes.get(name) or catalogue()[name.partition(".")[2]]
        fields.append(field(name, channel.unit, channel.label))
    schema = pa.schema(fields, metadata={ABOUT: json.dumps(about(record), ensure_ascii=False).encode()})
    return pa.table(list(columns.values()), schema=schema)


def record_of(parquet: bytes, happenings: Sequence[Happening], messages: Messages) -> Record:
    """The record that was written; channels that were not kept are not numbers. Raises UnknownError for one of an older studio."""
    table, known = pq.read_table(io.BytesIO(parquet)), about_of(parquet)
    vehicles = known["vehicles"]
    values = np.full((len(CHANNELS), len(vehicles), table.num_rows), np.nan)
    for channel, row, name in ((c, v, f"{vehicle}.{each.name}") for c, each in enumerate(CHANNELS) for v, vehicle in enumerate(vehicles)):
        if name in table.column_names:
            values[channel, row] = table[name].to_numpy()
    time, own = table["time"].to_numpy(), probes_of(table)
    return Record(time=time, values=values, happenings=tuple(happenings), probes=own, messages=messages, **known)


def about_of(parquet: bytes) -> dict[str, Any]:
    """What of the record is no series over time, by its fields. Raises UnknownError for one of an older studio."""
    metadata = pq.read_schema(io.BytesIO(parquet)).metadata or {}
    if ABOUT not in metadata:
        raise UnknownError("The record of this run does not say who its vehicles are: an older studio wrote it. Run it again.")
    return of_about(json.loads(metadata[ABOUT]))


def probes_of(table: pa.Table) -> dict[str, Traced]:
    """The columns that are no channels of vehicles."""
    own = [each for each in table.schema if each.name != "time" and each.name.partition(".")[2] not in catalogue()]
    return {each.name: Traced(table[each.name].to_numpy(), each.metadata[UNIT].decode(), each.metadata[LABEL].decode()) for each in own}


def field(name: str, unit: str, label: str) -> pa.Field:
    """A column of float64 with unit and label."""
    return pa.field(name, pa.float64(), metadata={UNIT: unit.encode(), LABEL: label.encode()})


def channels(parquet: bytes) -> list[dict[str, str]]:
    """Name, unit and label of every column but the time."""
    schema = pq.read_schema(io.BytesIO(parquet))
    return [
        {"name": each.name, "unit": each.metadata[UNIT].decode(), "label": each.metadata[LABEL].decode()}
        for each in schema
        if each.name != "time"
    ]


def read(parquet: bytes, names: list[str]) -> dict[str, np.ndarray]:
    """Time and the named columns; raises UnknownError with the nearest name."""
    present = {each["name"] for each in channels(parquet)}
    for name in names:
        if name not in present:
            problem = Problem("channel", "was not recorded", short(name), "a channel of the run, vehicle.quantity", nearest(name, present))
            raise UnknownError(f"This run has no channel {short(name)}; {problem.remedy}", [problem])
    table = pq.read_table(io.BytesIO(parquet), columns=["time", *dict.fromkeys(names)])
    return {name: table[name].to_numpy() for name in table.column_names}


def lines(parquet: bytes, names: Sequence[str] = ()) -> Iterator[str]:
    """The recorded channels, or some, as CSV, piece by piece: units in the head, all bits of every number, empty where there is none.

    Raises UnknownError before the first piece.
    """
    units = {each["name"]: each["unit"] for each in channels(parquet)}
    if lacking := [name for name in names if name not in units]:
        read(parquet, lacking)
    return pieces(parquet, {name: units[name] for name in names or units})


def pieces(parquet: bytes, units: Mapping[str, str]) -> Iterator[str]:
    """The head, then some samples at a time."""
    yield ",".join(["time [s]", *(f"{name} [{unit}]" for name, unit in units.items())]) + "\n"
    columns = ["time", *units]
    for batch in pq.ParquetFile(pa.BufferReader(parquet), pre_buffer=False).iter_batches(BATCH, columns=columns):
        rows = zip(*(batch.column(name).to_pylist() for name in columns), strict=True)
        yield "".join(",".join("" if value is None or value != value else repr(value) for value in row) + "\n" for row in rows)


def between(columns: dict[str, np.ndarray], begin: float | None, end: float | None) -> dict[str, np.ndarray]:
    """The rows between two times [s], and one more on either side, so that a curve reaches to the edges of a picture of them."""
    time = columns["time"]
    first = 0 if begin is None else max(int(np.searchsorted(time, begin, side="left")) - 1, 0)
    last = time.size if end is None else int(np.searchsorted(time, end, side="right")) + 1
    return {name: values[first:last] for name, values in columns.items()}


def decimate(columns: dict[str, np.ndarray], points: int) -> dict[str, np.ndarray]:
    """At most about `points` rows: of every bin the rows of each column's least and greatest value are kept.

    A peak that lasts one sample is still in the picture, and a stretch without values is still a gap.
    """
    count = columns["time"].size
    if count <= points:
        return columns
    traces = [values for name, values in columns.items() if name != "time"]
    each = 2 * max(points // (2 * max(len(traces), 1)), 2)
    kept = [MinMaxDownsampler().downsample(values, n_out=each) for values in traces]
    # the library's indices are unsigned, and joined with signed ones they would become floats
    rows = np.unique(np.concatenate([np.array([0, count - 1], np.uint64), *kept]))
    return {name: values[rows] for name, values in columns.items()}
