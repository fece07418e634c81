"""The kinds of files: good ones, what they are packed in, what is done to them, and how the studio reads them."""

import json
import os
import shutil
import sqlite3
import sys
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from studio import job
from studio.errors import StudioError
from studio.kind import folder as kind_folder
from studio.kind import registry
from studio.rig import drive, tyre
from studio.road import kept, load
from studio.road.library import folder as import_folder
from studio.road.library import intake
from studio.scenario import catalogue, tir
from studio.scenario.text.document import applied
from studio.scenario.text.patch import Operation, operations
from studio.server.documents import Documents
from studio.server.maps import Maps
from studio.store import owner, recording, waiting
from studio.store.comparison import compare
from studio.store.explanation import explanation
from studio.store.queue import queue
from studio.store.runs import open_runs, read_runs
from tests.broken import BROKEN, FLAWLESS
from tests.campaign import container, mutation, place

ROOT = Path(__file__).parent.parent.parent
SCENARIOS, REFERENCE = ROOT / "scenarios", ROOT / "tests" / "reference"
SHORT = {"clock.duration": 0.2}
Bytes = Callable[[bytes], bytes]
SLIPS = b"kappa,alpha_rad,gamma_rad,Fz_N\n0.1,0.02,0,4000\n-0.05,0,0.01,3000\n"


@dataclass(frozen=True)
class Format:
    """A kind of file: `samples` are good ones, `read` reads one as the studio does, in a folder for each process."""

    name: str
    ending: str
    samples: Callable[[Path], list[bytes]]
    mutators: tuple[mutation.Mutator, ...]
    read: Callable[[Path], object]
    unpack: Bytes = container.identity
    pack: Bytes = container.identity


def files(*patterns: str) -> Callable[[Path], list[bytes]]:
    """Files of the repository."""
    return lambda _: [path.read_bytes() for pattern in patterns for path in sorted(ROOT.glob(pattern))]


def made(*texts: bytes) -> Callable[[Path], list[bytes]]:
    """Texts as they are."""
    return lambda _: list(texts)


# -- scenarios, vehicles, tyres, tables ----------------------------------------------------------------


def scenario(path: Path) -> object:
    """As the command line and REST check one: without the map."""
    registry.load_folder(ROOT / "examples")
    loaded = job.load(path)
    job.check(loaded)
    return loaded


def prepared(path: Path) -> object:
    """As a run is prepared, on the map of the samples."""
    beside = path.parent / "maps"
    if not beside.exists():
        beside.symlink_to(SCENARIOS / "maps")
    return job.prepare(job.load(path))


def patch(path: Path) -> object:
    """A JSON patch of a sample, checked as the server does."""
    try:
        given = TypeAdapter(list[Operation]).validate_json(path.read_bytes())
    except ValidationError as error:  # as FastAPI refuses it
        raise StudioError(str(error)[:1000]) from None
    sample = Documents(SCENARIOS).read(SCENARIOS / "motorway_platoon.yaml")
    return applied(sample, operations(given))


def vehicle(path: Path) -> object:
    """A vehicle of one's own, with the step that it needs."""
    return catalogue.step_limit(catalogue.find_vehicle(str(path)).values)


def property_file(path: Path) -> object:
    """A tyre of one's own."""
    return tir.coefficients(tir.read(path))


def slips(path: Path) -> object:
    """A table for the tyre bench."""
    return tyre.bench(REFERENCE / "mf_185_80R14.tir", path, path.with_suffix(".out"))


# -- maps ----------------------------------------------------------------------------------------------


def map_file(path: Path) -> object:
    """A map, imported anew."""
    shutil.rmtree(kept.kept_at("maps", "x").parent, ignore_errors=True)
    return load(path)


def tiny(name: str) -> Callable[[Path], list[bytes]]:
    """The small place as one kind of file."""
    makers = {
        ".osm": lambda _: place.xml(),
        ".json": lambda _: place.overpass(),
        ".osm.gz": lambda _: place.packed(),
        ".osm.pbf": place.pbf,
    }
    return lambda folder: [makers[name](folder)]


@cache
def imported(folder: Path) -> Path:
    """The folder of an import of the small place."""
    source = folder / "source.osm"
    source.write_bytes(place.xml())
    out = folder / "maps" / "stern"
    out.parent.mkdir(exist_ok=True)
    intake.take(source, out)
    return out


def in_import(name: str, path: Path) -> object:
    """The folder of an import in which one file is another."""
    folder = imported(path.parent)
    good = (folder / name).read_bytes() if (folder / name).exists() else None
    (folder / name).write_bytes(path.read_bytes())
    try:
        maps = Maps(path.parent)
        maps.rows()
        return maps.detail("stern"), maps.plan("stern"), import_folder.opened(folder)
    finally:
        (folder / name).unlink() if good is None else (folder / name).write_bytes(good)


CORRECTIONS = json.dumps([{"element": "way 20", "tags": {"lanes": "4", "maxspeed": "30"}, "removed": ["name"]}]).encode()


def kept_map(path: Path) -> object:
    """A map as it was kept: damaged, it counts as nothing."""
    target = kept.kept_at("maps", "0" * 64)
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(path.read_bytes())
    return kept.recall("maps", "0" * 64)


def kept_sample(folder: Path) -> list[bytes]:
    """A map as it is kept."""
    source = folder / "source.osm"
    source.write_bytes(place.xml())
    network = load(source)
    kept.keep("maps", network.digest, network)
    return [kept.kept_at("maps", network.digest).read_bytes()]


# -- kinds ---------------------------------------------------------------------------------------------


def kind(path: Path) -> object:
    """A kind in a file of its own."""
    with forgotten():
        return registry.load_file(path)


def kinds(path: Path) -> object:
    """A folder of kinds; what is broken of them is told."""
    place = path.parent / "kinds"
    place.mkdir(exist_ok=True)
    shutil.copyfile(path, place / "mutant.py")
    with forgotten():
        registry.load_folder(place)
        for each in registry.broken():
            raise each.error


@contextmanager
def forgotten() -> Iterator[None]:
    """Kinds that are loaded here are loaded anew the next time."""
    sys.dont_write_bytecode = True
    present = list(registry.every())
    try:
        yield
    finally:
        registry.restore(present)
        for name in [each for each in sys.modules if each.startswith(kind_folder.PREFIX)]:
            del sys.modules[name]


# -- runs.db -------------------------------------------------------------------------------------------


@cache
def database(folder: Path) -> Path:
    """A database with two runs of the sample."""
    db = folder / "good.db"
    runs = open_runs(db)
    for seed in (1, 2):
        job.run(job.seeded(job.load(SCENARIOS / "grosser_stern_platoon.yaml", SHORT), seed), runs=runs)
    runs.database.execute("pragma wal_checkpoint(truncate)")
    runs.close()
    return db


def look(db: Path, run: int = 1) -> None:
    """Everything that is told of the runs of a database; what is refused about one run does not keep the others back."""
    runs = read_runs(db)
    refused = None
    try:
        for ask in (
            runs.select,
            partial(queue, runs),
            *(partial(ask, run) for ask in (runs.find, runs.events, runs.channels, runs.record)),
            lambda: runs.messages(run) if run == 1 else None,
            lambda: runs.document(runs.find(run)),
            lambda: runs.sources(runs.find(run)),
            lambda: runs.trace(run, ["leader.speed"]),
            lambda: compare(runs, run, 2),
            lambda: explanation(runs, run, ""),
        ):
            try:
                ask()
            except StudioError as error:
                refused = error
    finally:
        runs.close()
    if refused:
        raise refused


def whole(path: Path) -> object:
    """A file that is mutated as it lies there: read first, then opened to be written."""
    for rest in path.parent.glob("mutant.db-*"):
        rest.unlink()
    try:
        look(path)
    finally:
        open_runs(path).close()


def cell(table_name: str, column: str, path: Path) -> object:
    """A database in which a column of a table is another."""
    db = path.parent / "cell.db"
    for rest in path.parent.glob("cell.db*"):
        rest.unlink()
    shutil.copyfile(database(path.parent), db)
    value: bytes | str = path.read_bytes()
    if column not in ("parquet", "sent", "entries"):
        value = value.decode("utf-8", "replace")
    with closing(sqlite3.connect(db)) as connection:
        connection.execute(f"update {table_name} set {column} = ?", [value])
        connection.commit()
    return look(db)


def going_on(column: str, path: Path) -> object:
    """A database in which a column of a run is another, that is said to go on."""
    with closing(sqlite3.connect(database(path.parent))) as connection:
        connection.execute("update runs set status = 'running' where run = 1")
        connection.commit()
    try:
        return cell("runs", column, path)
    finally:
        open_runs(path.parent / "cell.db").close()
        with closing(sqlite3.connect(database(path.parent))) as connection:
            connection.execute("update runs set status = 'done'")
            connection.commit()


def cells(table_name: str, column: str, *, plain: Bytes = container.identity) -> Callable[[Path], list[bytes]]:
    """What stands in a column of a table."""

    def found(folder: Path) -> list[bytes]:
        with closing(sqlite3.connect(database(folder))) as connection:
            rows = connection.execute(f"select distinct {column} from {table_name} where {column} is not null").fetchall()
        return [plain(each if isinstance(each, bytes) else each.encode()) for (each,) in rows] or [b"{}"]

    return found


OF_RUN = ("metrics", "events", "traces", "messages", "pieces")


def result(folder: Path) -> list[bytes]:
    """A result as it waits beside a database."""
    runs = read_runs(database(folder))
    rows = {name: runs.rows(f"select * from {name} where run = 1") for name in (*OF_RUN, "runs")}
    runs.close()
    return [waiting.written(folder / "result.db", rows).read_bytes()]


def in_waiting(path: Path) -> object:
    """A result that waits beside a database."""
    db = path.parent / "later.db"
    for rest in path.parent.glob("later.db*"):
        shutil.rmtree(rest) if rest.is_dir() else rest.unlink()
    shutil.copyfile(database(path.parent), db)
    with closing(sqlite3.connect(db)) as connection:
        connection.execute("update runs set status = 'running' where run = 1")
        connection.commit()
    beside = path.parent / "later.db.waiting"
    beside.mkdir()
    (beside / "run-1.db").write_bytes(path.read_bytes())
    try:
        look(db)
    finally:
        open_runs(db).close()


# -- recordings of runs whose processes have gone --------------------------------------------------------

LEFT_RUN = 3


@cache
def left(folder: Path) -> Path:
    """A database with a run in the middle of which its process has gone, and what it had recorded."""
    db = folder / "left.db"
    shutil.copyfile(database(folder), db)
    runs = open_runs(db)
    loaded = job.load(SCENARIOS / "grosser_stern_platoon.yaml", {"clock.duration": 60})
    prepared = job.prepare(loaded)
    assert job.begin(loaded, prepared, runs, None) == LEFT_RUN
    gone = json.dumps([*json.loads(owner.mark(os.getpid()))[:-1], 0.0])
    with runs.writing():
        runs.database.conn.execute("update runs set process_mark = ? where run = ?", [gone, LEFT_RUN])
    current = job.recorded(prepared, runs, LEFT_RUN)
    current.advance(200)
    current.put_down()
    for post in current.world.units.posts:
        post.log.put_away()
    recording.put_down(runs.folder(LEFT_RUN), "failed", "The disk was full.")
    runs.close()
    return db


def of_recording(name: str) -> Callable[[Path], list[bytes]]:
    """A file of that recording."""

    def found(folder: Path) -> list[bytes]:
        ((_, recorded),) = recording.found(left(folder))
        return [(recorded / name).read_bytes() or b'{"time": 1.0, "text": "x", "kind": "y", "units": [], "numbers": {}, "words": {}}\n']

    return found


def in_recording(name: str, path: Path) -> object:
    """A recording in which one file is another: looked at where it lies, taken in, and looked at again."""
    db, good = path.parent / "again.db", left(path.parent)
    for rest in path.parent.glob("again.db*"):
        shutil.rmtree(rest) if rest.is_dir() else rest.unlink()
    shutil.copyfile(good, db)
    shutil.copytree(good.with_name(f"{good.name}.recording"), db.with_name(f"{db.name}.recording"))
    ((_, recorded),) = recording.found(db)
    (recorded / name).write_bytes(path.read_bytes())
    try:
        look(db, LEFT_RUN)
    finally:
        open_runs(db).close()
        look(db, 1)
    return look(db, LEFT_RUN)


def first_numbers(content: bytes) -> bytes:
    """What stands at the beginning of a block, which is followed by zeros."""
    return content[:16]


def in_block(content: bytes) -> bytes:
    """The same, in a block again."""
    return content[:4096].ljust(4096, b"\0")


RECORDED = {
    "recording: what it means": ("about.jsonl", mutation.TREE),
    "recording: why it ended": ("why.jsonl", mutation.TREE),
    "recording: events": ("events.jsonl", mutation.TEXT),
    "recording: where messages lie": ("log_0.jsonl", mutation.TEXT),
    "recording: messages": ("log_0.arrays", mutation.BYTES),
    "recording: samples": ("values.roll", mutation.BYTES),
}
PATCH = json.dumps(
    [
        {"op": "test", "path": "/version", "value": 3},
        {"op": "replace", "path": "/clock/duration", "value": 20},
        {"op": "add", "path": "/vehicles/new", "value": {"route": "motorway", "position": {"along": 5}, "speed": 3}},
        {"op": "move", "from": "/vehicles/new", "path": "/vehicles/other"},
        {"op": "copy", "from": "/vehicles/other", "path": "/vehicles/third"},
        {"op": "remove", "path": "/vehicles/third"},
    ]
).encode()
TABLES = {
    "parameters of a run": ("runs", "parameters"),
    "kinds of a run": ("runs", "kinds"),
    "revisions of a run": ("runs", "revisions"),
    "the scenario of a run": ("scenarios", "document"),
    "numbers of events": ("events", "numbers"),
    "words of events": ("events", "words"),
    "subjects of metrics": ("metrics", "about"),
}
OPENDRIVE = files("examples/motorway.xodr", "tests/reference/opendrive/StraightRoad*.xodr", "tests/reference/opendrive/highway_merge.xodr")

FORMATS = {
    each.name: each
    for each in (
        Format("scenario", ".yaml", files("scenarios/*.yaml", "examples/*.yaml", "tests/scenario/version_2.yaml"), mutation.TREE, scenario),
        Format("scenario with its map", ".yaml", files("scenarios/motorway_platoon.yaml"), mutation.TREE, prepared),
        Format("JSON patch", ".json", made(PATCH), mutation.TREE, patch),
        Format("vehicle", ".yaml", files("studio/scenario/vehicles/*.yaml"), mutation.TREE, vehicle),
        Format("tyre", ".tir", files("tests/reference/*.tir", "studio/scenario/tyres/*.tir"), mutation.TEXT, property_file),
        Format("inputs of a drive", ".csv", files("scenarios/drives/*.csv"), mutation.TEXT, drive.given_inputs),
        Format(
            "inputs of a drive, gzipped",
            ".csv.gz",
            files("scenarios/drives/*.csv"),
            mutation.TEXT,
            drive.given_inputs,
            pack=container.gzipped,
        ),
        Format("slips of a tyre", ".csv", made(SLIPS), mutation.TEXT, slips),
        Format("OSM XML", ".osm", tiny(".osm"), mutation.XML, map_file),
        Format("OSM XML, gzipped", ".osm.gz", tiny(".osm"), mutation.XML, map_file, pack=container.gzipped),
        Format("gzip itself", ".osm.gz", tiny(".osm.gz"), mutation.BYTES, map_file),
        Format("OSM PBF", ".osm.pbf", tiny(".osm.pbf"), mutation.BYTES, map_file, container.from_pbf, container.as_pbf),
        Format("PBF itself", ".osm.pbf", tiny(".osm.pbf"), mutation.BYTES, map_file),
        Format("Overpass answer", ".json", tiny(".json"), mutation.TREE, map_file),
        Format("OpenDRIVE", ".xodr", OPENDRIVE, mutation.XML, map_file),
        Format(
            "report of an import",
            ".json",
            lambda folder: [(imported(folder) / "report.json").read_bytes()],
            mutation.TREE,
            partial(in_import, "report.json"),
        ),
        Format("corrections of an import", ".json", made(CORRECTIONS), mutation.TREE, partial(in_import, "corrections.json")),
        Format("kept map", ".pickle", kept_sample, mutation.BYTES, kept_map),
        Format("kind", ".py", made(*(each.encode() for each in (BROKEN, FLAWLESS))), mutation.TEXT, kind),
        Format("folder of kinds", ".py", files("examples/[cfgst]*.py"), mutation.TEXT, kinds),
        Format("runs.db", ".db", lambda folder: [database(folder).read_bytes()], mutation.BYTES, whole),
        Format("result that waits", ".db", result, mutation.BYTES, in_waiting),
        Format(
            "traces",
            ".parquet",
            cells("traces", "parquet", plain=container.plain_parquet),
            mutation.BYTES,
            partial(cell, "traces", "parquet"),
        ),
        Format(
            "messages sent",
            ".parquet",
            cells("messages", "sent", plain=container.plain_parquet),
            mutation.BYTES,
            partial(cell, "messages", "sent"),
        ),
        Format(
            "messages heard",
            ".parquet",
            cells("messages", "entries", plain=container.plain_parquet),
            mutation.BYTES,
            partial(cell, "messages", "entries"),
        ),
        Format("the mark of a process", ".json", cells("runs", "process_mark"), mutation.TREE, partial(going_on, "process_mark")),
        *(Format(name, ".part", of_recording(file), how, partial(in_recording, file)) for name, (file, how) in RECORDED.items()),
        Format(
            "recording: how far it is",
            ".roll",
            of_recording("progress.roll"),
            mutation.BYTES,
            partial(in_recording, "progress.roll"),
            first_numbers,
            in_block,
        ),
        *(Format(name, ".json", cells(*column), mutation.TREE, partial(cell, *column)) for name, column in TABLES.items()),
    )
}
