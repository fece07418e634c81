"""What files are packed in: what is inside is mutated, for a mutated archive is refused by its checksum before anything reads it."""

import gzip
import io
import struct
import zlib

import pyarrow.parquet as pq

HEADER, TYPE, DATA_SIZE, ZLIB, RAW, RAW_SIZE = 0, 1, 3, 3, 1, 2  # fields of the blobs of a .pbf
MARK = b"\0--blob--"  # between the unpacked blobs


def identity(data: bytes) -> bytes:
    """Packed in nothing."""
    return data


def gzipped(data: bytes) -> bytes:
    """As gzip, the same bytes every time."""
    return gzip.compress(data, 1, mtime=0)


def varint(data: bytes, at: int) -> tuple[int, int]:
    """A number of protobuf, and where the next one begins."""
    value, shift = 0, 0
    while True:
        byte = data[at]
        value, shift, at = value | (byte & 0x7F) << shift, shift + 7, at + 1
        if byte < 0x80:
            return value, at


def number(value: int) -> bytes:
    """A number as protobuf has it."""
    head = []
    while value > 0x7F:
        head.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes([*head, value])


def fields(data: bytes) -> dict[int, bytes | int]:
    """The fields of a message of bytes and numbers."""
    found: dict[int, bytes | int] = {}
    at = 0
    while at < len(data):
        key, at = varint(data, at)
        value, at = varint(data, at)
        found[key >> 3] = value
        if key & 7 == 2:
            found[key >> 3], at = data[at : at + value], at + value
    return found


def from_pbf(data: bytes) -> bytes:
    """The blobs of a .pbf with their types, unpacked."""
    found, at = [], 0
    while at < len(data):
        (size,) = struct.unpack_from(">I", data, at)
        head = fields(data[at + 4 : at + 4 + size])
        at += 4 + size
        blob = fields(data[at : at + head[DATA_SIZE]])
        at += head[DATA_SIZE]
        found.append(head[TYPE] + b"\0" + (zlib.decompress(blob[ZLIB]) if ZLIB in blob else blob[RAW]))
    return MARK.join(found)


def as_pbf(data: bytes) -> bytes:
    """The same packed again, whatever has become of it."""
    packed = []
    for each in data.split(MARK):
        kind, _, content = each.partition(b"\0")
        squeezed = zlib.compress(content, 1)
        blob = number(RAW_SIZE << 3) + number(len(content)) + number(ZLIB << 3 | 2) + number(len(squeezed)) + squeezed
        head = number(TYPE << 3 | 2) + number(len(kind)) + kind + number(DATA_SIZE << 3) + number(len(blob))
        packed.append(struct.pack(">I", len(head)) + head + blob)
    return b"".join(packed)


def plain_parquet(data: bytes) -> bytes:
    """A Parquet file whose columns are not compressed."""
    made = io.BytesIO()
    pq.write_table(pq.read_table(io.BytesIO(data)), made, compression="none", use_dictionary=False)
    return made.getvalue()
