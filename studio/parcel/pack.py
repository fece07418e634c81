"""Packs a run into a folder that another machine repeats to the same bits.

    scenario.yaml          all of the scenario, as it ran
    maps/..., vehicles/... the files that it names, at the same places
    kinds/                 the texts of the user's own kinds, as they were
    run.json               its row: state, seed, versions, metrics, verdicts
    traces.parquet         what was recorded
    report.html            one page for people

What was packed is read back and must be what ran, by its hash: a map or a vehicle that has changed since is told, and nothing is packed.
"""

import json
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

import yaml

from studio import job
from studio.errors import Problem, StoreError, StudioError
from studio.kind import registry
from studio.parcel.report import report
from studio.store.runs import Row, Runs
from studio.store.verdict import remark_of, verdicts

SCENARIO, RUN, KINDS, TRACES, REPORT = "scenario.yaml", "run.json", "kinds", "traces.parquet", "report.html"
HEAD = "# Run {run} of {name}, as it ran. Repeat it: studio repeat .\n"


@dataclass(frozen=True)
class Parcel:
    """What was packed: where, which files, and what one should know."""

    folder: Path
    files: tuple[str, ...]
    notes: tuple[str, ...]


def pack(runs: Runs, run: int, folder: Path, scenarios: Path) -> Parcel:
    """Packs a run that is over; `scenarios` is the folder with the file that it stems from, for the files that this names.

    Raises UnknownError for a run that is not there, StoreError when the folder is there or cannot be made, or when the run cannot be
    repeated because something that it needs has changed or is gone.
    """
    row = runs.find(run)
    if row.state_hash is None:
        raise StoreError(f"Run {run} cannot be packed.", [Problem("run", "did not come to its end", row.status, "done", "run it again")])
    if folder.exists():
        raise StoreError(f"{folder} is there already.", [Problem("folder", "exists", str(folder), "a new folder", "name another")])
    try:
        folder.mkdir(parents=True)
        return filled(runs, row, folder, scenarios)
    except BaseException as error:
        shutil.rmtree(folder, ignore_errors=True)
        if isinstance(error, OSError):
            raise StoreError(f"{folder} cannot be written.", [Problem(str(folder), error.strerror or str(error))]) from None
        raise


def filled(runs: Runs, row: Row, folder: Path, scenarios: Path) -> Parcel:
    """The folder with everything in it."""
    document = runs.document(row)
    for name in sorted(set(named_files(document))):
        copy(name, scenarios, folder)
    head = HEAD.format(run=row.run, name=row.scenario)
    (folder / SCENARIO).write_text(head + yaml.safe_dump(document, sort_keys=False, allow_unicode=True), encoding="utf-8")
    notes = tuple(put_kinds(runs, row, folder / KINDS))
    check(row, folder)
    told = row.as_json() | {"verdicts": [each.as_json() for each in verdicts(runs, row.run)], "note": remark_of(runs, row.run).note}
    (folder / RUN).write_text(json.dumps(told, indent=1, ensure_ascii=False), encoding="utf-8")
    (folder / TRACES).write_bytes(runs.parquet(row.run))
    (folder / REPORT).write_text(report(runs, row.run), encoding="utf-8")
    files = sorted(str(each.relative_to(folder)) for each in folder.rglob("*") if each.is_file())
    return Parcel(folder, tuple(files), notes)


# -- the files that a scenario names -----------------------------------------------------------------


def named_files(document: dict[str, Any]) -> Iterator[str]:
    """Paths in a scenario that lead to files beside it."""
    yield document["map"]["file"]
    traffic = document.get("traffic") or {}
    if traffic.get("routes"):
        yield traffic["routes"]
    for each in texts(document):
        if each.lower().endswith((".yaml", ".yml", ".tir")):
            yield each


def texts(value: Any) -> Iterator[str]:
    """All texts in a document."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict | list):
        for each in value.values() if isinstance(value, dict) else value:
            yield from texts(each)


def copy(name: str, scenarios: Path, folder: Path) -> None:
    """Copies a file to the same place, with what an import has put beside a map, and the tyres beside a vehicle; a folder whole."""
    if PurePosixPath(name).is_absolute() or ".." in PurePosixPath(name).parts:
        raise StoreError(
            "The scenario cannot be packed.", [Problem("scenario", "names a file outside its folder", name, "a file beside it")]
        )
    source, target = scenarios / name, folder / name
    if not source.exists():
        raise StoreError("The scenario cannot be packed.", [Problem(str(source), "is gone", remedy="name its folder with --scenarios")])
    if source.is_dir():
        shutil.copytree(source, target, dirs_exist_ok=True)
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, target)
    for each in source.parent.glob("*.tir") if source.suffix in (".yaml", ".yml") else ():
        shutil.copyfile(each, target.with_name(each.name))


# -- kinds -------------------------------------------------------------------------------------------


def put_kinds(runs: Runs, row: Row, folder: Path) -> Iterator[str]:
    """Writes the user's own kinds of a run; tells which of the studio's own are others now."""
    sources = runs.sources(row)
    for name, digest in row.kinds.items():
        sort, _, short = name.partition(".")
        known = registry.known(sort).get(short)
        if known and known.is_built_in:
            if known.digest != digest:
                yield f"{name} of this studio is another than the one that ran"
        else:
            folder.mkdir(exist_ok=True)
            for file, text in sources[name].items():
                (folder / Path(file).name).write_text(text, encoding="utf-8")


# -- the proof ---------------------------------------------------------------------------------------


def check(row: Row, folder: Path) -> None:
    """What was packed is what ran; raises StoreError."""
    try:
        loaded = job.load(folder / SCENARIO)
        found = job.scenario_hash(loaded, job.prepare(loaded))
    except StudioError as error:
        problem = Problem("scenario", f"cannot be prepared any more: {error.message}", remedy="load the kinds that it needs with --kinds")
        raise StoreError(f"Run {row.run} cannot be packed.", [problem, *error.problems]) from None
    if found != row.scenario_hash:
        problem = Problem("map, vehicles or route file", "are others than when it ran", found[:12], row.scenario_hash[:12], "run it again")
        raise StoreError(f"Run {row.run} cannot be packed as it ran.", [problem])
