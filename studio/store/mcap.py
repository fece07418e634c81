"""A run as MCAP, the container of Foxglove and of robotics: samples, scene, events and messages on one clock, as JSON with its schemas.

    /vehicles/NAME  studio.Vehicle        what was recorded of a vehicle at a sample; what is no number then is left out
    /probes/NAME    studio.Probe          the same of what is no vehicle
    /scene          foxglove.SceneUpdate  vehicles as boxes on level ground, in metres east and north of the map's origin
    /log            foxglove.Log          events, as sentences
    /events         studio.Event          the same events with their numbers
    /messages       studio.Message        what was sent, and what became of it at everybody in range

Log times are nanoseconds since the beginning of the run; `time` [s] in a message has all the bits of what was recorded. The units stand in
the schemas, and as metadata of the channels. Sources: the MCAP specification (mcap.dev/spec), for /scene and /log the message schemas of
Foxglove (docs.foxglove.dev, SceneUpdate and Log).
"""

import heapq
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from math import cos, isfinite, sin
from typing import Any, NamedTuple

import pyarrow as pa
import pyarrow.parquet as pq
from mcap.writer import Writer

from studio.errors import UnknownError
from studio.execution.happening import Happening
from studio.execution.message import Messages
from studio.execution.record import Body
from studio.store import trace
from studio.store.runs import Runs
from studio.world.table.cause import CAUSES

MEDIA = "application/octet-stream"  # no name is registered for it
LIBRARY = "Cooperative ADAS Studio"
PIECE = 1 << 20  # [bytes] about so much is given at a time
HEIGHT = 1.5  # [m] of the boxes; an estimate for cars, and for the eye alone
PLACE = ("x", "y", "heading")
COLOUR = {"r": 0.2, "g": 0.5, "b": 0.9, "a": 0.9}
INFO = 2  # level of foxglove.Log
GONE = 0  # type of foxglove.SceneEntityDeletion: that of its id

Plain = dict[str, Any]


class Said(NamedTuple):
    """A message of the file: when [ns], its topic, what it says."""

    when: int
    topic: str
    data: Plain


class Owner(NamedTuple):
    """A vehicle or another thing that was recorded: its topic, its columns by quantity, and the fields of those."""

    name: str
    topic: str
    columns: dict[str, str]
    fields: list[dict[str, str]]


class Drain:
    """A stream of which what was written is taken away piece by piece."""

    def __init__(self) -> None:
        self.parts: list[bytes] = []
        self.size = self.waiting = 0

    def write(self, data: bytes) -> int:
        """Keeps it until it is taken."""
        self.parts.append(bytes(data))
        self.size, self.waiting = self.size + len(data), self.waiting + len(data)
        return len(data)

    def tell(self) -> int:
        """How much was written [bytes], taken or not."""
        return self.size

    def flush(self) -> None:
        """All is there already."""

    def take(self) -> bytes:
        """What was written since the last time."""
        taken = b"".join(self.parts)
        self.parts, self.waiting = [], 0
        return taken


def mcap(runs: Runs, run: int) -> Iterator[bytes]:
    """The file, piece by piece; raises UnknownError before the first one when nothing was recorded, or by an older studio."""
    parquet, row, events = runs.parquet(run), runs.find(run), runs.events(run)
    known, owners = trace.about_of(parquet), owners_of(parquet)
    messages = None
    with suppress(UnknownError):  # not kept by older studios: all else is there
        messages = runs.messages(run)
    topics = topics_of(owners, has_messages=messages is not None)
    about = {"run": str(run), "scenario": row.scenario, "status": row.status, "seed": str(row.seed), "started": row.created}
    streams = [sampled(parquet, owners, known["bodies"]), told(events), *([sent(messages)] if messages is not None else [])]
    return pieces(heapq.merge(*streams, key=lambda each: each.when), topics, about)


def pieces(said: Iterable[Said], topics: Mapping[str, tuple[Plain, dict[str, str]]], about: dict[str, str]) -> Iterator[bytes]:
    """Messages as a file whose topics have these schemas and metadata."""
    drain = Drain()
    writer = Writer(drain)  # pyrefly: ignore[bad-argument-type] what it does with a stream is write, tell and flush
    writer.start(profile="", library=LIBRARY)
    writer.add_metadata("run", about)
    channels = {topic: registered(writer, topic, *each) for topic, each in topics.items()}
    for when, topic, data in said:
        writer.add_message(channels[topic], when, text(data), when)
        if drain.waiting >= PIECE:
            yield drain.take()
    writer.finish()
    yield drain.take()


def registered(writer: Writer, topic: str, schema: Plain, metadata: dict[str, str]) -> int:
    """The number of a channel with a schema of its own."""
    number = writer.register_schema(schema["title"], "jsonschema", text(schema))
    return writer.register_channel(topic, "json", number, metadata)


def text(data: Plain) -> bytes:
    """As JSON, which has no words for what is no number."""
    return json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode()


def owners_of(parquet: bytes) -> list[Owner]:
    """Who has columns, in the order of the columns."""
    vehicles, found = set(trace.about_of(parquet)["vehicles"]), {}
    for each in trace.channels(parquet):
        name, _, quantity = each["name"].partition(".")
        topic = f"/{'vehicles' if name in vehicles else 'probes'}/{name}"
        owner = found.setdefault(name, Owner(name, topic, {}, []))
        owner.columns[quantity or name] = each["name"]
        owner.fields.append(each | {"name": quantity or name})
    return list(found.values())


def sampled(parquet: bytes, owners: Sequence[Owner], bodies: Mapping[str, Body]) -> Iterator[Said]:
    """Everybody sample after sample, and all vehicles as boxes."""
    placed = [each for each in owners if each.name in bodies and set(PLACE) <= each.columns.keys()]
    seen: set[str] = set()
    for batch in pq.ParquetFile(pa.BufferReader(parquet), pre_buffer=False).iter_batches(trace.BATCH):
        values = {name: batch.column(name).to_pylist() for name in batch.schema.names}
        for i, time in enumerate(values["time"]):
            when = nanoseconds(time)
            rows = {each.name: numbers(each.columns, values, i) for each in owners}
            yield from (Said(when, each.topic, {"time": time} | rows[each.name]) for each in owners if rows[each.name])
            there = {each.name: rows[each.name] for each in placed if set(PLACE) <= rows[each.name].keys()}
            if placed:
                yield Said(when, "/scene", scene(when, there, bodies, seen - there.keys()))
            seen = set(there)


def numbers(columns: Mapping[str, str], values: Mapping[str, list[float]], sample: int) -> dict[str, float]:
    """What was a number at a sample, by quantity."""
    return {quantity: value for quantity, column in columns.items() if isfinite(value := values[column][sample])}


def nanoseconds(time: float) -> int:
    """A time [s] as whole nanoseconds."""
    return round(time * 1e9)


def stamp(when: int) -> dict[str, int]:
    """A time [ns] as Foxglove has it."""
    return {"sec": when // 10**9, "nsec": when % 10**9}


def scene(when: int, there: Mapping[str, dict[str, float]], bodies: Mapping[str, Body], gone: Iterable[str]) -> Plain:
    """The vehicles that are there as boxes; those that have left are taken away."""
    entities = [entity(when, name, row, bodies[name]) for name, row in there.items()]
    return {"deletions": [{"timestamp": stamp(when), "type": GONE, "id": name} for name in sorted(gone)], "entities": entities}


def entity(when: int, name: str, row: Mapping[str, float], body: Body) -> Plain:
    """A vehicle as a box, with its speed; its middle is behind the centre of gravity by what the front is less than half ahead."""
    heading, ahead = row["heading"], body.front - body.length / 2
    place = {"x": row["x"] + ahead * cos(heading), "y": row["y"] + ahead * sin(heading), "z": HEIGHT / 2}
    turn = {"x": 0.0, "y": 0.0, "z": sin(heading / 2), "w": cos(heading / 2)}
    box = {"pose": {"position": place, "orientation": turn}, "size": {"x": body.length, "y": body.width, "z": HEIGHT}, "color": COLOUR}
    metadata = [{"key": "speed", "value": f"{row['speed']!r} m/s"}] if "speed" in row else []
    return {
        "timestamp": stamp(when), "frame_id": "map", "id": name, "lifetime": {"sec": 0, "nsec": 0}, "frame_locked": False,
        "metadata": metadata, "cubes": [box],
    }  # fmt: skip


def told(events: Sequence[Happening]) -> Iterator[Said]:
    """Every event twice: as a line of a log, and with its numbers."""
    for each in events:
        when = nanoseconds(each.time)
        line = {"timestamp": stamp(when), "level": INFO, "message": each.text, "name": each.vehicle, "file": each.kind, "line": 0}
        yield Said(when, "/log", line)
        yield Said(when, "/events", {name: value for name, value in each.as_json().items() if value is not None})


def sent(messages: Messages) -> Iterator[Said]:
    """Every message when it was sent, with what became of it at everybody in range."""
    end = 0
    for m, time in enumerate(messages.time.tolist()):
        begin, end = end, end + int(messages.count[m])
        data = {
            "time": time,
            "sender": messages.units[messages.sender[m]],
            "kind": messages.kinds[messages.kind[m]],
            "number": int(messages.number[m]),
            "size": int(messages.size[m]),
            "said": [value for each in (messages.said_0, messages.said_1) if isfinite(value := float(each[m]))],
            "receivers": [arrival(messages, e) for e in range(begin, end)],
        }
        yield Said(nanoseconds(time), "/messages", data)


def arrival(messages: Messages, entry: int) -> Plain:
    """What became of a message at one receiver; no delay where it is lost."""
    delay, cause = float(messages.delay[entry]), CAUSES[messages.cause[entry]].name
    found = {"receiver": messages.units[messages.receiver[entry]], "cause": cause, "distance": float(messages.distance[entry])}
    return found | ({"delay": delay} if isfinite(delay) else {})


def topics_of(owners: Sequence[Owner], *, has_messages: bool) -> dict[str, tuple[Plain, dict[str, str]]]:
    """Schema and metadata of every topic."""
    found = {each.topic: (of_owner(each), {field["name"]: field["unit"] for field in each.fields}) for each in owners}
    found |= {"/scene": (SCENE, {}), "/log": (LOG, {}), "/events": (EVENT, {})}
    return found | ({"/messages": (MESSAGE, {})} if has_messages else {})


def of_owner(owner: Owner) -> Plain:
    """The schema of samples: label and unit of each quantity."""
    fields = {each["name"]: number(each["unit"], each["label"]) for each in owner.fields}
    return record("studio.Vehicle" if owner.topic.startswith("/vehicles") else "studio.Probe", {"time": number("s", "Time")} | fields)


def number(unit: str, label: str) -> Plain:
    """The schema of a number with its unit."""
    return {"type": "number", "title": label, "description": f"[{unit}]"}


def record(title: str, fields: Mapping[str, Plain]) -> Plain:
    """The schema of an object."""
    return {"title": title, "type": "object", "properties": dict(fields)}


def several(item: Plain) -> Plain:
    """The schema of a list."""
    return {"type": "array", "items": item}


WORD: Plain = {"type": "string"}
WHOLE: Plain = {"type": "integer"}
TRUTH: Plain = {"type": "boolean"}
FREE: Plain = {"type": "object"}
TIME = record("time", {"sec": WHOLE, "nsec": WHOLE})
NUMBER: Plain = {"type": "number"}
VECTOR = record("foxglove.Vector3", dict.fromkeys("xyz", NUMBER))
POSE = record("foxglove.Pose", {"position": VECTOR, "orientation": record("foxglove.Quaternion", dict.fromkeys("xyzw", NUMBER))})
CUBE = record("foxglove.CubePrimitive", {"pose": POSE, "size": VECTOR, "color": record("foxglove.Color", dict.fromkeys("rgba", NUMBER))})
PAIR = record("foxglove.KeyValuePair", {"key": WORD, "value": WORD})
ENTITY = record(
    "foxglove.SceneEntity",
    {
        "timestamp": TIME, "frame_id": WORD, "id": WORD, "lifetime": TIME, "frame_locked": TRUTH, "metadata": several(PAIR),
        "cubes": several(CUBE),
    },
)  # fmt: skip
DELETION = record("foxglove.SceneEntityDeletion", {"timestamp": TIME, "type": WHOLE, "id": WORD})
SCENE = record("foxglove.SceneUpdate", {"deletions": several(DELETION), "entities": several(ENTITY)})
LOG = record("foxglove.Log", {"timestamp": TIME, "level": WHOLE, "message": WORD, "name": WORD, "file": WORD, "line": WHOLE})
EVENT = record(
    "studio.Event",
    {
        "time": number("s", "Time"), "text": WORD, "vehicle": WORD, "kind": WORD, "units": several(WORD),
        "x": number("m", "East position"), "y": number("m", "North position"), "numbers": FREE, "words": FREE,
    },
)  # fmt: skip
ARRIVAL = record(
    "studio.Arrival",
    {"receiver": WORD, "cause": WORD, "distance": number("m", "From antenna to antenna"), "delay": number("s", "Delay")},
)
MESSAGE = record(
    "studio.Message",
    {
        "time": number("s", "Time of sending"), "sender": WORD, "kind": WORD, "number": WHOLE, "size": number("bytes", "Size"),
        "said": several(NUMBER), "receivers": several(ARRIVAL),
    },
)  # fmt: skip
