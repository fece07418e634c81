"""Provenance: of what code a run is made, on which machine, so that it can be understood and repeated years later.

provenance(scenario)   →  Provenance       the kinds that a run of it uses, with their texts, versions, and what git says
"""

import hashlib
import os
import platform
import socket
import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from studio.application import port
from studio.kind import registry
from studio.kind.registry import Kind
from studio.scenario.schema import Scenario
from studio.source import PACKAGE, code_version

PACKAGES = ("numba", "llvmlite", "numpy", "pydantic")
LONGEST_PATCH = 1_000_000  # [B] of what is not committed that is kept; a longer one is cut, and says so
PATIENCE = 20.0  # [s] for git to answer


@dataclass(frozen=True)
class Revision:
    """What git says of a folder: the commit, and what has been changed since, as a patch."""

    folder: str
    commit: str
    patch: str
    is_cut: bool = False


@dataclass(frozen=True)
class Provenance:
    """The kinds that a run uses, the version of all its code, the machine, versions of what it stands on, revisions of its folders."""

    kinds: tuple[Kind, ...]
    code_version: str
    host: str
    versions: dict[str, str]
    revisions: tuple[Revision, ...]


def provenance(scenario: Scenario) -> Provenance:
    """Of a run that starts now."""
    kinds = tuple(used(scenario))
    folders = [PACKAGE, *sorted({kind.file.parent for kind in kinds if kind.file and not kind.is_built_in})]
    revisions = tuple(found for folder in folders if (found := revision(folder)))
    return Provenance(kinds, version_with(kinds), socket.gethostname(), versions(), revisions)


# -- kinds -------------------------------------------------------------------------------------------


def used(scenario: Scenario) -> Iterator[Kind]:
    """Every kind that a run of a scenario uses: those that it names, and all that judge or follow from what is recorded."""
    parts = {type(part) for part in parts_of(scenario)}
    applications = [registry.find("application", group.application) for group in scenario.applications.values()]
    for kind in registry.every():
        is_named = vars(kind.module).get("Chosen") in parts or kind in applications or kind.name in heard_or_sent(kind.sort, applications)
        if is_named or kind.sort in ("metric", "channel"):
            yield kind


def heard_or_sent(sort: str, applications: Sequence[Kind]) -> set[str]:
    """The messages that applications have ports for; there are no others on the air."""
    modules = [each.module for each in applications] if sort == "message" else []
    return {one.kind for module in modules for one in (*port.seen(module), *port.done(module)) if one.what in (port.INBOX, port.OUTBOX)}


def parts_of(value: Any) -> Iterator[BaseModel]:
    """A part of a scenario and all parts in it."""
    if isinstance(value, BaseModel):
        yield value
        for name in type(value).model_fields:
            yield from parts_of(getattr(value, name))
    elif isinstance(value, dict | list | tuple):
        for each in value.values() if isinstance(value, dict) else value:
            yield from parts_of(each)


def version_with(kinds: Sequence[Kind]) -> str:
    """The version of the studio; with kinds that did not come with it, a digest of theirs behind it."""
    own = [f"{kind.sort}.{kind.name} {kind.digest}" for kind in kinds if not kind.is_built_in]
    digest = hashlib.sha256("\n".join(sorted(own)).encode()).hexdigest()[:16]
    return f"{code_version()}.{digest}" if own else code_version()


# -- the machine -------------------------------------------------------------------------------------


@cache
def versions() -> dict[str, str]:
    """Versions of Python and of the packages that compute."""
    return {"python": platform.python_version()} | {name: version(name) for name in PACKAGES}


@cache
def revision(folder: Path) -> Revision | None:
    """What git says of a folder when this process first asks; nothing when the folder is in no repository, or git cannot tell."""
    if not (commit := said(folder, "rev-parse", "--verify", "HEAD").strip()) or not is_kept(folder):
        return None
    patch = said(folder, "diff", "--no-ext-diff", "--no-textconv", "HEAD", "--", ".")
    cut = patch.encode()[:LONGEST_PATCH].decode(errors="ignore")
    return Revision(str(folder), commit, cut, cut != patch)


def is_kept(folder: Path) -> bool:
    """Whether its repository does not ignore it, as it does an environment that lies in somebody's project."""
    return not said(folder, "check-ignore", ".")


def said(folder: Path, *arguments: str) -> str:
    """What git answers; nothing where there is no git, or no answer."""
    environment = os.environ | {"GIT_OPTIONAL_LOCKS": "0", "LC_ALL": "C"}
    try:
        done = subprocess.run(["git", "-C", folder, *arguments], capture_output=True, timeout=PATIENCE, env=environment)
    except (OSError, subprocess.SubprocessError):
        return ""
    return done.stdout.decode(errors="replace") if done.returncode == 0 else ""
