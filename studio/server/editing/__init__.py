"""Editing: scenario files changed by named steps that can be undone, by several people at once.

Every edit is checked as a whole, map and routes included, and written to the file at once; what it does not touch stays as it was, to
the letter. An edit to an older revision is done to the present file unless somebody has changed the same thing; then it is refused, and
nothing is lost. What others do to the file, as text or with another program, counts as a step too, and can be undone.
"""

import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from studio import job
from studio.errors import ConflictError, Problem, ScenarioError, SealedError, StoreError, StudioError
from studio.job import Loaded
from studio.scenario import setup
from studio.scenario.schema import Scenario
from studio.scenario.text import source as sources
from studio.scenario.text.document import digest
from studio.scenario.text.migration import migrated
from studio.scenario.text.patch import Operation, operations, patched
from studio.server.documents import Documents, changed, check_text, check_version, names_in
from studio.server.editing.answer import Editing as Edited
from studio.server.editing.answer import NewEdit, NewTurn, Step
from studio.server.editing.figure import items
from studio.server.editing.history import Change, History, steps
from studio.server.editing.merge import conflicts
from studio.server.editing.outlook import Outlook
from studio.server.editing.removal import removal, renaming
from studio.world.setting import Setting

ELSEWHERE = "Changed as text or by another program"


@dataclass
class Editing:
    """The edits of a desk's documents."""

    documents: Documents
    history: History
    lock: threading.RLock = field(default_factory=threading.RLock)
    seen: dict[str, tuple[tuple[int, int], Change | None]] = field(default_factory=dict)
    first: dict[str, str] = field(default_factory=dict)  # texts as they were seen before any change

    # -- what is told ------------------------------------------------------------------------------

    def state(self, path: Path) -> Edited:
        """A scenario as it is edited. Raises ScenarioError, MapError or RouteError when it cannot be shown on its map."""
        with self.lock:
            changes = self.noted(path)
            source = self.documents.read(path)
        loaded = job.loaded(source, path)
        return told(path, loaded, job.prepare(loaded), changes, self.why_sealed(path))

    def latest(self, path: Path) -> Change | None:
        """The last change of a file; quick while nothing has changed, so that one may look often. Raises ScenarioError when it is gone."""
        try:
            stat = path.stat()
        except OSError:
            raise ScenarioError(f"{path.name} is not there any more.") from None
        mark = (stat.st_mtime_ns, stat.st_size)
        with self.lock:
            if path.stem not in self.seen or self.seen[path.stem][0] != mark:
                changes = self.noted(path)
                self.seen[path.stem] = mark, changes[-1] if changes else None
            return self.seen[path.stem][1]

    def noted(self, path: Path) -> list[Change]:
        """All changes of a file; what somebody has done to it past this room is written down first, once it is a scenario again."""
        changes = self.history.changes(path.stem)
        now = self.documents.text(path)
        before = self.before(path, changes)
        if before != now and is_scenario(now, path):
            if before is None:
                self.first[path.stem] = now
            else:
                self.history.add(path.stem, "elsewhere", ELSEWHERE, "", before=before, after=now)
                changes = self.history.changes(path.stem)
        return changes

    def before(self, path: Path, changes: list[Change]) -> str | None:
        """The text that was a scenario last, as far as it is known here: after the last change, else as it was first seen."""
        return self.history.text(changes[-1].after) if changes else self.first.get(path.stem)

    def forget(self, scenario: str) -> None:
        """A new file has this name: what was done to an older one is not its history."""
        with self.lock:
            self.first.pop(scenario, None)
            self.seen.pop(scenario, None)
            self.history.forget(scenario)

    def rename(self, scenario: str, name: str) -> None:
        """The history goes with its file, which has another name now."""
        with self.lock:
            for each in (scenario, name):
                self.first.pop(each, None)
                self.seen.pop(each, None)
            self.history.rename(scenario, name)

    def follow(self, scenario: str, name: str) -> None:
        """The history of a file that was put into the trash, or out of it, goes with it where there is one; that it cannot is no reason
        to lose the file."""
        with suppress(StoreError):
            if self.history.changes(scenario):
                self.rename(scenario, name)

    def why_sealed(self, path: Path) -> str:
        """Why a file cannot be changed; empty when it can."""
        try:
            self.documents.check_open(path)
            check_version(self.documents.read(path))
        except (SealedError, ScenarioError) as error:
            return str(error)
        return ""

    # -- what is done ------------------------------------------------------------------------------

    def edit(self, path: Path, new: NewEdit) -> Edited:
        """Does an edit. Raises ConflictError, SealedError, ScenarioError, MapError or RouteError; then nothing was written."""
        with self.lock:
            changes = self.noted(path)
            before = self.documents.read(path)
            check_version(before)
            base = self.text_at(changes, new.base, before.text)
            patch = patch_of(sources.read(base, path.name), new, path)
            self.check_merge(patch, base, before, changes, new.base)
            now, _ = changed(before, patch, path)
            job.prepare(job.loaded(now, path))
            if now.text != before.text:
                self.documents.put(path, now.text, digest(before.text))
                # What was no scenario is not gone back to: it could not be written.
                good = self.before(path, changes) or before.text
                self.history.add(path.stem, "edit", new.name, new.who, before=good, after=now.text)
            return self.state(path)

    def undo(self, path: Path, asked: NewTurn) -> Edited:
        """Takes the last step back. Raises as `edit` does."""
        return self.turn(path, asked, "undo", lambda change: (change.after, change.before))

    def redo(self, path: Path, asked: NewTurn) -> Edited:
        """Does the last undone step again. Raises as `edit` does."""
        return self.turn(path, asked, "redo", lambda change: (change.before, change.after))

    def turn(self, path: Path, asked: NewTurn, sort: Any, way: Callable[[Change], tuple[str, str]]) -> Edited:
        """Takes a step back or does it again; it must be the one that was seen to be next. Where there is none, nothing happens."""
        with self.lock:
            changes = self.noted(path)
            done, undone = steps(changes)
            pile = done if sort == "undo" else undone
            if not pile:  # a key that is pressed once too often is no mistake
                return self.state(path)
            check_turn(pile, asked, sort, changes)
            before, after = map(self.history.text, way(pile[-1]))
            self.documents.put(path, after, digest(before))
            self.history.add(path.stem, sort, pile[-1].name, asked.who, before=before, after=after)
            return self.state(path)

    def text_at(self, changes: list[Change], revision: int, now: str) -> str:
        """The text at a revision; raises ConflictError for one that never was."""
        if revision == (changes[-1].revision if changes else 0):
            return now
        later = [each for each in changes if each.revision == revision + 1]
        if not later:
            problem = Problem("base", "is no revision of this scenario", str(revision), remedy="read it again")
            raise ConflictError("The scenario is not as the edit expects it.", [problem])
        return self.history.text(later[0].before)

    def check_merge(self, patch: list[Operation], base: str, now: sources.Source, changes: list[Change], revision: int) -> None:
        """Raises ConflictError when somebody has changed the same since the revision to which an edit was made."""
        if base == now.text:
            return
        wrong = conflicts(patch, sources.read(base, now.where).value, now.value)
        if wrong:
            names = ", ".join(f"“{each.name}”" for each in changes if each.revision > revision)
            raise ConflictError(f"Somebody else has changed the same meanwhile: {names}. Nothing of it was lost.", wrong)


def is_scenario(text: str, path: Path) -> bool:
    """Whether a text that stands in a file is a scenario, so that it can be put there again."""
    try:
        check_text(text, path, own=names_in(path))
    except StudioError:
        return False
    return True


def patch_of(base: sources.Source, new: NewEdit, path: Path) -> list[Operation]:
    """The patch that an edit comes to, in a file as it was when the edit was made. Raises ScenarioError."""
    patch = setup.patch_of(migrated(base)[0].value, new.set, path.name) if new.set else []
    patch += operations([each.as_json() for each in new.patch])
    if new.rename:
        scenario, given = after(base, patch, path)
        patch += renaming(scenario, given, {tuple(each.split(".")): name for each, name in new.rename.items()})
    if new.remove:
        scenario, given = after(base, patch, path)
        patch += removal(scenario, given, [tuple(each.split(".")) for each in new.remove])
    if not patch:
        raise ScenarioError("The edit changes nothing.", [Problem("edit", "has neither `set`, `patch` nor `remove`")])
    return patch


def after(base: sources.Source, patch: list[Operation], path: Path) -> tuple[Scenario, dict[str, Any]]:
    """What a file would be with a patch: the scenario, and what stands in the file. Raises ScenarioError."""
    given = patched(base.value, patch)
    return setup.complete(given, path.name), given


def check_turn(pile: list[Change], asked: NewTurn, sort: str, changes: list[Change]) -> None:
    """Raises ConflictError when the next step is another than was seen."""
    if asked.base != (changes[-1].revision if changes else 0):
        problem = Problem("history", "has gone on", f"“{changes[-1].name}”", remedy=f"look at it; the next to {sort} is “{pile[-1].name}”")
        raise ConflictError("Somebody else has changed the scenario meanwhile.", [problem])


def told(path: Path, loaded: Loaded, prepared: Setting, changes: list[Change], sealed: str) -> Edited:
    """A scenario as it is edited, for the page."""
    done, undone = steps(changes)
    return Edited(
        scenario=path.stem,
        title=loaded.scenario.title,
        revision=changes[-1].revision if changes else 0,
        digest=digest(loaded.source.text),
        sealed=sealed,
        document=loaded.document,
        given=loaded.given,
        duration=loaded.scenario.clock.duration,
        items=items(prepared),
        turns=Outlook(prepared).turns(),
        done=list(map(step, done)),
        undone=list(map(step, undone)),
    )


def step(change: Change) -> Step:
    """A change that can be undone, or done again."""
    return Step(revision=change.revision, name=change.name, who=change.who, time=change.time)
