"""Messages of a run as two Parquet tables, one after the other: what was sent, and what became of it at everybody in range."""

import io
import json
from dataclasses import fields

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from studio.execution.message import OF_ENTRIES, Messages

NAMES = b"names"  # of kinds and units, which stand as numbers in the tables
OF_MESSAGES = tuple(each.name for each in fields(Messages) if each.name not in (*OF_ENTRIES, "kinds", "units"))


def write(found: Messages) -> tuple[bytes, bytes]:
    """Messages, and entries."""
    return table(found, OF_MESSAGES), table(found, OF_ENTRIES)


def table(found: Messages, columns: tuple[str, ...]) -> bytes:
    """Some columns, with the names of kinds and units."""
    names = json.dumps({"kinds": found.kinds, "units": found.units}, ensure_ascii=False).encode()
    made = pa.table({name: getattr(found, name) for name in columns}).replace_schema_metadata({NAMES: names})
    buffer = io.BytesIO()
    pq.write_table(made, buffer, compression="zstd", use_dictionary=False, use_byte_stream_split=floating(found, columns))
    return buffer.getvalue()


def floating(found: Messages, columns: tuple[str, ...]) -> list[str]:
    """The columns of numbers that are not whole, whose bytes are kept apart."""
    return [name for name in columns if np.issubdtype(getattr(found, name).dtype, np.floating)]


def read(sent: bytes, entries: bytes) -> Messages:
    """The same as it was written."""
    both = [pq.read_table(io.BytesIO(each)) for each in (sent, entries)]
    names = json.loads(both[0].schema.metadata[NAMES])
    columns = {name: made[name].to_numpy() for made in both for name in made.column_names}
    return Messages(tuple(names["kinds"]), tuple(names["units"]), **columns)
