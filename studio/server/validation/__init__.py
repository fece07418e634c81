"""The folder of validation projects beside the scenarios: each a folder with its project file, its logs and what came out.

    scenarios/validation/my_car/project.yaml      what `studio validate` takes too
                               /drive_1.mf4       logs, mappings, DBCs, vehicle files
                               /results/12.html   report of iteration 12; its courses (.json), its vehicle (.yaml)

A project and its files are found by name in listings and in no other way, and what is sent names no file outside of its folder.
"""

import json
from collections.abc import Collection, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import chain, count
from pathlib import Path, PurePosixPath, PureWindowsPath
from threading import Lock
from typing import Any

from studio.errors import ConflictError, Problem, ScenarioError, StaleError, StudioError, UnknownError, nearest, short
from studio.log import reading, unit
from studio.log.quantity import QUANTITIES
from studio.scenario import catalogue, file
from studio.scenario.datasheet import quantities
from studio.scenario.text import document as texts
from studio.scenario.text import source
from studio.scenario.text.document import digest
from studio.scenario.text.patch import Operation
from studio.scenario.text.source import Source
from studio.server.scenarios import name as names
from studio.server.validation import answer
from studio.server.validation.length import Lengths
from studio.store import iteration
from studio.store.iteration import VALIDATION, Iteration
from studio.store.runs import Runs
from studio.validation import known, project
from studio.validation.criterion import UNJUDGED
from studio.validation.project import Run

CALLED, PROJECT, RESULTS = "validation", "project.yaml", "results"
OTHERS: dict[str, answer.FileKind] = {".yaml": "mapping", ".dbc": "dbc", ".tir": "tyre"}
PATHS = ("log", "mapping", "dbc", "vehicle", "front", "rear")  # what names a file in a project, a mapping or a vehicle, also as tyres.front
DOCUMENTS = ("mapping", "vehicle")  # of them those that name files themselves
LARGEST = 500 * 2**20  # [B] of a log that is sent
LONGEST_TITLE = 110  # characters of the 120 that a title may have: a number may come behind it


@dataclass
class Projects:
    """The projects beside the scenarios."""

    scenarios: Path
    lock: Lock = field(default_factory=Lock)
    lengths: Lengths = field(default_factory=Lengths)

    @property
    def folder(self) -> Path:
        """Where the projects are."""
        return self.scenarios / CALLED

    def names(self) -> list[str]:
        """All projects."""
        found = sorted(self.folder.iterdir()) if self.folder.is_dir() else []
        return [each.name for each in found if (each / PROJECT).is_file() and not each.name.startswith(".")]

    def find(self, name: str) -> Path:
        """The folder of a project; raises UnknownError."""
        known_names = self.names()
        if name not in known_names:
            problem = Problem("project", "does not exist", short(name), remedy=nearest(name, known_names))
            raise UnknownError(f"There is no validation project {short(name)}.", [problem])
        return self.folder / name

    def file(self, name: str, wanted: str) -> Path:
        """A file of a project; raises UnknownError."""
        folder = self.find(name)
        there = {each.name for each in files(folder)}
        if wanted not in there:
            problem = Problem("file", "does not exist", short(wanted), remedy=nearest(wanted, there))
            raise UnknownError(f"{name} has no file {short(wanted)}.", [problem])
        return folder / wanted

    # -- what is told ------------------------------------------------------------------------------

    def rows(self, runs: Runs) -> list[answer.ProjectRow]:
        """All projects for the list."""
        return [self.row(each, runs) for each in self.names()]

    def row(self, name: str, runs: Runs) -> answer.ProjectRow:
        """A project; one that cannot be read says why."""
        empty = {"name": name, "title": name, "vehicle": "", "maneuvers": 0, "runs": 0, "latest": None, "valid": None}
        try:
            found = project.read(self.folder / name / PROJECT)
        except StudioError as error:
            return answer.ProjectRow(**empty, problem=str(error))
        history = iteration.history(runs, found.title)
        judged = [each for each in history if not each.is_calibration]
        return answer.ProjectRow(
            name=name, title=found.title, vehicle=found.vehicle, maneuvers=len(found.maneuvers),
            runs=sum(len(each.calibration) + len(each.validation) for each in found.maneuvers.values()),
            latest=history[-1].iteration if history else None, valid=judged[-1].result["valid"] if judged else None, problem=None,
        )  # fmt: skip

    def detail(self, name: str, runs: Runs) -> answer.ProjectDetail:
        """A project with everything about it; raises UnknownError."""
        folder = self.find(name)
        text = self.text(name)
        try:
            found, problems = project.of_text(source.read(text, PROJECT)), []
            history = iteration.history(runs, found.title)
        except StudioError as error:
            found, problems, history = None, error.as_json()["problems"], []
        return answer.ProjectDetail(
            name=name, text=text, digest=digest(text), document=found.model_dump(mode="json") if found else None, problems=problems,
            files=files(folder), iterations=[row_of(each, folder) for each in reversed(history)], parameters=self.parameters(name, found),
        )  # fmt: skip

    def text(self, name: str) -> str:
        """The text of a project file; raises UnknownError, or ScenarioError when it is no text."""
        return source.decoded(file.content(self.find(name) / PROJECT, "project", project.SIZE_LIMIT), PROJECT)

    # -- what is done ------------------------------------------------------------------------------

    def add(self, new: answer.NewProject) -> str:
        """A new project without runs; its name. Raises ConflictError or ScenarioError."""
        name = names.checked(new.name)
        if new.vehicle not in catalogue.vehicle_names():
            problem = Problem(
                "vehicle", "is not in the catalogue", short(new.vehicle), remedy=nearest(new.vehicle, catalogue.vehicle_names())
            )
            raise ScenarioError("There is no such vehicle.", [problem])
        with self.lock:
            self.make(name)
            file.write_new(self.folder / name / PROJECT, begun(self.free_title(new.title or name), new.vehicle))
        return name

    def free_title(self, title: str) -> str:
        """The title, or with a number behind it when another project has it."""
        short_title, taken = title[:LONGEST_TITLE], {each.casefold() for each in self.titles()}
        numbered = chain([short_title], (f"{short_title}, {i}" for i in count(2)))
        return next(each for each in numbered if each.casefold() not in taken)

    def titles(self, but: str = "") -> list[str]:
        """The titles of all projects that can be read, but for one."""
        found = []
        for name in self.names():
            with suppress(StudioError):
                found += [project.read(self.folder / name / PROJECT).title] if name != but else []
        return found

    def make(self, name: str) -> Path:
        """An empty folder for a project; raises ConflictError when its name is taken, or ScenarioError."""
        target = self.folder / name
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            check_free(name, [each.name for each in self.folder.iterdir()])
            target.mkdir()
        except OSError as error:
            raise file.unwritten(target, error) from None
        return target

    def put(self, name: str, text: str, expected: str | None) -> str:
        """Puts a text in the place of a project file if it is a project, and what stands there is expected; its digest.

        Raises UnknownError, StaleError, or ScenarioError with the lines; then nothing was written.
        """
        self.check_cuts(name, self.expected(name, expected), checked(text, PROJECT))
        with self.lock:
            before = self.expected(name, expected)
            self.write(name, before, checked(text, PROJECT))
        return digest(text)

    def patch(self, name: str, patch: list[Operation], expected: str | None) -> tuple[str, list[Operation]]:
        """Changes a project file by a JSON patch that leaves it a project; its digest, and the inverse. Raises as `put` does."""
        before = self.expected(name, expected)
        self.check_cuts(name, before, applied(before, patch)[0])
        with self.lock:
            before = self.expected(name, expected)
            after, inverse = applied(before, patch)
            self.write(name, before, after)
        return digest(after.text), inverse

    def expected(self, name: str, expected: str | None) -> str:
        """The text that stands there, if it is the expected one."""
        before = self.text(name)
        if expected is not None and expected != digest(before):
            problem = Problem(PROJECT, "is not as it was when you read it", remedy="read it again, then change it")
            raise StaleError(f"The project {name} has changed meanwhile.", [problem])
        return before

    def write(self, name: str, before: str, after: Source) -> None:
        """Writes a project that is one, whose title is its own, and whose files are its own or were named before."""
        made = project.of_text(after)
        self.check_title(name, made.title, before)
        check_inside(after.value, named(before))
        self.check_parameters(name, made, before)
        file.write(self.folder / name / PROJECT, after.text)

    def check_title(self, name: str, title: str, before: str) -> None:
        """Raises ConflictError for a title that another project has, unless it stood there already: iterations are kept by title."""
        if title in self.titles(but=name) and title != title_of(before):
            remedy = f"iterations are kept by title: choose another, such as {self.free_title(title)}"
            raise ConflictError("Another project has this title.", [Problem("title", "is taken", short(title), remedy=remedy)])

    def check_parameters(self, name: str, made: project.Project, before: str) -> None:
        """Raises ScenarioError for what is looked for anew and is no number of the vehicle, where that can be read."""
        old = parameters_of(before)
        new = {step: each for step, each in made.calibration.items() if not set(each.parameters) <= old}
        if new and (model := self.model(name, made)):
            project.check_parameters(new, model, PROJECT)

    def model(self, name: str, made: project.Project) -> catalogue.VehicleModel | None:
        """The vehicle of a project; none where it cannot be read, of which whoever uses it is told."""
        with suppress(StudioError):
            return catalogue.find_vehicle(made.vehicle, made.changes, folder=self.folder / name)
        return None

    def parameters(self, name: str, made: project.Project | None) -> list[answer.ProjectParameter]:
        """What may be calibrated of the vehicle of a project."""
        model = self.model(name, made) if made else None
        return [parameter_of(model, path, value) for path, value in project.numbers(model).items()] if model else []

    def check_cuts(self, name: str, before: str, after: Source) -> None:
        """Raises ScenarioError for runs cut beyond their logs that were not so before. Logs are read here, so nobody waits at the lock."""
        made = project.of_text(after)
        check_inside(after.value, named(before))
        new = [each for each in made.cuts if each[1:] not in cuts_of(before)]
        lengths = self.lengths.of(self.folder / name, {(run.log, by) for _, run, by in new})
        project.check_cuts((where, run, lengths[run.log, by]) for where, run, by in new if (run.log, by) in lengths)

    def delete_file(self, name: str, wanted: str) -> None:
        """Removes a file; raises UnknownError, or ConflictError for the project itself and for what it names."""
        path = self.file(name, wanted)
        if wanted == PROJECT or wanted in named(self.text(name)):
            problem = Problem("file", "is named by the project", wanted, remedy="take it out of the project first")
            raise ConflictError(f"{wanted} is in use.", [problem])
        try:
            path.unlink()
        except OSError as error:
            raise file.unwritten(path, error) from None


# -- parts -------------------------------------------------------------------------------------------


def check_free(name: str, taken: list[str]) -> None:
    """Raises ConflictError for a name that is taken; on many systems capitals make no difference."""
    if (free := names.free(name, taken)) != name:
        problem = Problem("name", "is taken", short(name), remedy=f"choose another name, such as {free}")
        raise ConflictError(f"There is a validation project {short(name)} already.", [problem])


def begun(title: str, vehicle: str) -> str:
    """The text of a project that has no runs yet: what is missing is told when it is opened."""
    return f"title: {json.dumps(title, ensure_ascii=False)}\nvehicle: {vehicle}\n# confidence: one-sided\nmaneuvers: {{}}\n"


def title_of(text: str) -> str | None:
    """The title in a text of a project; None of one that cannot be read."""
    with suppress(ScenarioError):
        return project.of_text(source.read(text, PROJECT)).title
    return None


def cuts_of(text: str) -> list[tuple[Run, str | None]]:
    """The cuts in a text of a project, each with its mapping; none of one that cannot be read."""
    with suppress(ScenarioError):
        return [each[1:] for each in project.of_text(source.read(text, PROJECT)).cuts]
    return []


def parameters_of(text: str) -> set[str]:
    """What is looked for by a text of a project; nothing by one that cannot be read."""
    with suppress(ScenarioError):
        return {path for each in project.of_text(source.read(text, PROJECT)).calibration.values() for path in each.parameters}
    return set()


def parameter_of(model: catalogue.VehicleModel, path: str, value: float) -> answer.ProjectParameter:
    """A number of a vehicle, with the range that its file gives."""
    quantity, (low, high) = quantities()[path], model.origins[path].range or (None, None)
    return answer.ProjectParameter(path=path, title=quantity.title, unit=quantity.unit, value=value, low=low, high=high)


def applied(text: str, patch: list[Operation]) -> tuple[Source, list[Operation]]:
    """A text changed by a JSON patch, and the inverse; raises ScenarioError."""
    return texts.applied(file.checked(source.read(text, PROJECT), "project"), patch)


def checked(text: str, where: str) -> Source:
    """A text as a mapping; raises ScenarioError."""
    return file.checked(source.read(text, where), "project")


def files(folder: Path) -> list[answer.ProjectFile]:
    """The files in a project's folder."""
    found = [each for each in sorted(folder.iterdir()) if each.is_file() and not each.name.startswith(".")]
    return [answer.ProjectFile(name=each.name, bytes=each.stat().st_size, kind=kind_of(each)) for each in found]


def kind_of(path: Path) -> answer.FileKind:
    """What a file is, by its name; of a YAML file by what it says."""
    if path.name == PROJECT:
        return "project"
    if reading.suffix(path) in reading.known():
        return "log"
    if is_document(path.name):
        return "mapping" if b"signals:" in path.read_bytes()[:100_000] else "vehicle"
    return OTHERS.get(path.suffix.lower(), "other")


def is_document(name: str) -> bool:
    """Whether a file is one that may name others, by its ending; on many systems capitals make no difference."""
    return name.lower().endswith((".yaml", ".yml"))


def endings() -> list[str]:
    """Of files that are taken."""
    logs = [each for each in reading.known() if not each.startswith("/")]
    return [*logs, *(f"{each}{reading.PACKED}" for each in logs if each != ".npz"), *OTHERS]


def kinds() -> answer.ValidationKinds:
    """What a project may name."""
    maneuvers = [
        answer.ManeuverKind(name=name, title=each.TITLE, fed=list(each.FED), judged=list(each.JUDGED))
        for name, each in known.maneuvers().items()
    ]
    signals = [
        answer.SignalKind(name=name, unit=each.unit, meaning=each.meaning, units=list(unit.FACTORS[each.unit]))
        for name, each in QUANTITIES.items()
    ]
    vehicles = [answer.CarName(name=each, title=catalogue.find_vehicle(each).values.title) for each in catalogue.vehicle_names()]
    return answer.ValidationKinds(maneuvers=maneuvers, signals=signals, vehicles=vehicles, endings=endings())


def row_of(each: Iteration, folder: Path) -> answer.ProjectIteration:
    """An iteration for the list."""
    return answer.ProjectIteration(
        iteration=each.iteration, step=each.step, parent=each.parent, created=each.created, valid=each.result.get("valid"),
        told=told(each), has_report=report_of(folder, each.iteration).is_file(),
    )  # fmt: skip


def told(each: Iteration) -> str:
    """What came out, in a line."""
    if each.step == VALIDATION:
        verdicts = [verdict["verdict"] for verdict in each.result["verdicts"]]
        doubt = f", {wide} by a wide interval alone" if (wide := each.result.get("doubtful", 0)) else ""
        left = f", {unknown} unjudged" if (unknown := verdicts.count(UNJUDGED)) else ""
        return f"{verdicts.count('pass')} of {len(verdicts)} criteria met{left}{doubt}"
    return ", ".join(f"{found['path']} {found['value']:.5g} ± {2 * found['spread']:.2g}" for found in each.result["estimates"])


def report_of(folder: Path, number: int) -> Path:
    """The report of an iteration."""
    return folder / RESULTS / f"{number}.html"


def courses_of(folder: Path, number: int) -> Path:
    """The courses of an iteration."""
    return folder / RESULTS / f"{number}.json"


def vehicle_of(folder: Path, number: int) -> Path:
    """The vehicle of an iteration, with its validated span."""
    return folder / RESULTS / f"{number}.yaml"


# -- what is named -----------------------------------------------------------------------------------


def named(text: str) -> set[str]:
    """The files that a text names; none of one that cannot be read."""
    try:
        return set(dict(paths(source.read(text, PROJECT).value)).values())
    except ScenarioError:
        return set()


def paths(value: Any, where: str = "") -> Iterator[tuple[str, str]]:
    """Whatever may be a path to a file, and where it stands: fields that name files, and tyres."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, each in items:
        place = f"{where}.{key}" if where else str(key)
        if isinstance(each, str):
            if str(key).rpartition(".")[2] in PATHS or each.lower().endswith(".tir"):
                yield place, each
        else:
            yield from paths(each, place)


def check_inside(value: Any, before: Collection[str] = ()) -> None:
    """Raises ScenarioError where a document that was sent names a file outside of its folder that it did not name before."""
    found = [
        Problem(place, "leads out of the project's folder", short(each), remedy="send the file, and name it without a folder")
        for place, each in paths(value)
        if each not in before and leads_out(each)
    ]
    found += [
        Problem(place, "is no YAML file", short(each), "a name that ends with .yaml", "send the file with this ending")
        for place, each in paths(value)
        if each not in before and is_disguised(place, each)
    ]
    if found:
        raise ScenarioError("A project uses files of its own folder.", found)


def is_disguised(place: str, text: str) -> bool:
    """Whether a mapping or a vehicle is taken from a file that was not looked at for what it names when it was sent."""
    what = place.rpartition(".")[2]
    is_file = what == "mapping" or "/" in text or "\\" in text
    return what in DOCUMENTS and is_file and not is_document(text)


def leads_out(text: str) -> bool:
    """Whether a path leaves the folder that it starts from, on any system."""
    path = PurePosixPath(text.replace("\\", "/"))
    return path.is_absolute() or ".." in path.parts or bool(PureWindowsPath(text).drive)
