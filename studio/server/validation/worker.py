"""The process of one errand about a project: whatever a log does to it, it ends that errand and nothing else.

News go out over a pipe: stage, then done with what came out, or failed. Results appear whole; the row of an iteration in the run database
is written when its step is over.
"""

import json
from contextlib import suppress
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from studio.errors import Problem, ScenarioError, StudioError
from studio.server.errand import MOST_MEMORY, ServerGone, confine, tell
from studio.server.validation import PROJECT, RESULTS, Projects, courses_of, report_of, vehicle_of
from studio.server.validation.answer import NewJob

POINTS = 1500  # of a signal that is drawn


@dataclass(frozen=True)
class Order:
    """What to do, in which folder, with which run database, and the folders of the user's own kinds."""

    job: NewJob
    folder: Path
    db: Path
    kinds: tuple[Path, ...] = ()


def main(pipe: Connection, order: Order) -> None:
    """The process: does what it is ordered to do, and tells how it goes."""
    from studio.kind.registry import load_folder

    confine()
    for folder in order.kinds:
        load_folder(folder)
    with suppress(ServerGone):
        tell(pipe, *outcome(pipe, order))


def outcome(pipe: Connection, order: Order) -> tuple[Any, ...]:
    """Does it; the last word about it. Raises ServerGone."""
    try:
        return "done", TASKS[order.job.task](pipe, order)
    except StudioError as error:
        return "failed", without(error, order)
    except MemoryError:
        limit = f"{MOST_MEMORY / 2**30:g} GiB"
        problem = Problem("log", "is too large", "", limit, "cut the log, or leave signals out")
        return "failed", ScenarioError("This needs more memory than it may take.", [problem])
    except ServerGone:
        raise
    except Exception as error:
        problem = Problem(order.job.task, "failed", f"{type(error).__name__}: {error}"[:300], remedy="tell us, with the file")
        return "failed", ScenarioError("The studio has made a mistake.", [problem])


def without(error: StudioError, order: Order) -> StudioError:
    """The error without the places of this machine in its texts."""

    def cleaned(text: str) -> str:
        return text.replace(f"{order.folder}/", "").replace(str(order.folder), order.folder.name)

    problems = [replace(each, **{key: cleaned(value) for key, value in vars(each).items()}) for each in error.problems]
    return type(error)(cleaned(error.message), problems)


# -- looking at a log --------------------------------------------------------------------------------


def look(pipe: Connection, order: Order) -> dict[str, Any]:
    """What is in a log, and what a mapping makes of it; a mapping that fits badly is told beside what was recorded."""
    from studio.log import mapping, reading, recording
    from studio.log.hint import contradictions, hints
    from studio.validation import known

    tell(pipe, "stage", "reading", None)
    wanted = mapping.read(order.folder / order.job.mapping) if order.job.mapping else mapping_of(order.folder)
    log = reading.read(order.folder / (order.job.log or ""), wanted.dbc if wanted else None)
    used = wanted.mapping.model_dump(mode="json", by_alias=True) if wanted else None
    recorded = list(map(facts, log.signals.values()))
    found = {"log": log.name, "recorded": recorded, "mapping": used, "ours": [], "cuts": [], "hints": [], "problem": None}
    if wanted is None and not mapping.has_named(log):
        return found | {"drawn": [drawn(each) for each in log.signals.values()]}
    try:
        tell(pipe, "stage", "mapping", None)
        made = recording.of_log(log, wanted.mapping if wanted else None)
        cuts = [{"kind": kind, "begin": begin, "end": end} for kind, begin, end in known.cuts(made)]
    except StudioError as error:
        return found | {"drawn": [drawn(each) for each in log.signals.values()], "problem": without(error, order).as_json()}
    ours = [recording.Signal(name, recording.QUANTITIES[name].unit, made.time, values) for name, values in made.signals.items()]
    return found | {
        "ours": [named(each) for each in made.facts()],
        "cuts": cuts,
        "hints": [*(contradictions(wanted.mapping, log) if wanted else []), *hints(made)],
        "drawn": [drawn(each) for each in ours],
    }


def mapping_of(folder: Path):
    """The mapping of the project, where it has one; none of a project that cannot be read."""
    from studio.log import mapping
    from studio.validation import project

    with suppress(StudioError):
        if name := project.read(folder / PROJECT).mapping:
            return mapping.read(folder / name)
    return None


def facts(signal) -> dict[str, Any]:
    """A recorded signal as it is told."""
    return named(signal.facts())


def named(found: dict[str, Any]) -> dict[str, Any]:
    """Facts with the names that REST has for them."""
    gaps = [{"since": since, "until": until} for since, until in found["gaps"]]
    return {{"from": "since", "to": "until"}.get(key, key): value for key, value in found.items()} | {"gaps": gaps}


def drawn(signal) -> dict[str, Any]:
    """A signal thinned for a chart, its extremes kept."""
    from studio.store import trace
    from studio.validation.course import plain

    thin = trace.decimate({"time": signal.time, "value": signal.values}, POINTS)
    return {"name": signal.name, "unit": signal.unit, "time": [float(each) for each in thin["time"]], "values": plain(thin["value"])}


# -- iterations --------------------------------------------------------------------------------------


def calibrate(pipe: Connection, order: Order) -> dict[str, Any]:
    """One step of calibration, or all in their order."""
    from studio.store.runs import open_runs
    from studio.validation import iterate, project

    tell(pipe, "stage", "reading the logs", None)
    loaded = project.load(order.folder / PROJECT)
    steps = [order.job.step] if order.job.step else list(loaded.project.calibration)
    if not steps:
        problem = Problem("calibration", "is missing", remedy="say what to look for: a step with its parameters and their ranges")
        raise ScenarioError("The project does not say what to calibrate.", [problem])
    runs, found = open_runs(order.db), []
    for i, name in enumerate(steps):
        begun = iterate.begin(loaded, runs, afresh=order.job.afresh and i == 0)
        found.append(iterate.calibrate(begun, name, runs, telling(pipe, f"calibrating: {name}", i, len(steps)))[0])
    return {"iterations": found}


def validate(pipe: Connection, order: Order) -> dict[str, Any]:
    """All criteria, with report, courses and vehicle file beside the project."""
    from studio.store.runs import open_runs
    from studio.validation import course, iterate, project, sheet
    from studio.validation.report import report
    from studio.validation.zone import WORDS

    tell(pipe, "stage", "reading the logs", None)
    loaded, runs = project.load(order.folder / PROJECT), open_runs(order.db)
    step = iterate.begin(loaded, runs, afresh=order.job.afresh)
    number, found = iterate.validate(step, runs, telling(pipe, "validating", 0, 1))
    tell(pipe, "stage", "drawing", 1.0)
    (order.folder / RESULTS).mkdir(exist_ok=True)
    put(courses_of(order.folder, number), json.dumps({"interval": WORDS[found.confidence], "courses": course.courses(found)}))
    estimates, title = iterate.estimates(runs, number), loaded.project.title
    sheet.write(step.loaded.model, vehicle_of(order.folder, number), title=title, estimates=estimates, span=found.span)
    put(report_of(order.folder, number), report(step.loaded, found, estimates, number))
    return {"iterations": [number]}


def put(path: Path, text: str) -> None:
    """Writes a result, at once; raises ScenarioError."""
    from studio.scenario import file

    path.unlink(missing_ok=True)  # of a database that is gone, whose numbers begin again
    file.write_new(path, text)


def telling(pipe: Connection, stage: str, done: int, of: int):
    """Tells the share of the work, whenever a hundredth more is done."""
    last = [-1]

    def told(share: float) -> None:
        now = int(100 * (done + min(max(share, 0.0), 1.0)) / of)
        if now != last[0]:
            last[0] = now
            tell(pipe, "stage", stage, now / 100)

    return told


def sample(pipe: Connection, order: Order) -> dict[str, Any]:
    """Drives whose truth is known, in a folder that is there and empty."""
    from studio.validation import sample as samples

    tell(pipe, "stage", "driving", None)
    samples.write(order.folder, Projects(order.folder.parent.parent).free_title(samples.TITLE))
    return {"iterations": []}


TASKS = {"look": look, "calibrate": calibrate, "validate": validate, "sample": sample}
