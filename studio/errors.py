"""What can go wrong, and how it is told.

    StudioError
    ├── ScenarioError       a scenario file or a change of it is wrong
    │   ├── ConflictError   a document is not as the change expects it
    │   │   └── StaleError  a document has changed since it was read
    │   └── SealedError     a document that may be read only
    ├── MapError            a map file is missing, unreadable or holds no roads
    ├── RouteError          roads do not connect, or are not on the map
    ├── ApplicationError    an application raised during a run, or did what it must not
    ├── KindError           a kind does not load, or does not keep the contract of its sort
    ├── RunError            a state is not finite any more
    ├── SnapshotError       a snapshot does not belong to this world
    ├── StoreError          runs.db cannot be opened or written
    ├── UnknownError        a run, scenario or channel that does not exist
    ├── SizeError           more was sent than is taken
    └── ServerError         the server cannot start

Every error carries a list of problems; each says where, what, which value, what is allowed, and the remedy.
"""

import difflib
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field

LONGEST = 600  # characters of each part of a problem; what was sent may be of any length
LONGEST_LIST = 50_000  # characters of all problems
LONGEST_MESSAGE = 8000  # characters; the traceback of a user's own code may stand in it


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong: where it stands, what is wrong, the value, what is allowed, how to mend it. Each of some length at most."""

    where: str
    what: str
    value: str = ""
    allowed: str = ""
    remedy: str = ""

    def __post_init__(self) -> None:
        for name, text in vars(self).items():
            object.__setattr__(self, name, cut(text, LONGEST))

    def __str__(self) -> str:
        text = f"{self.where}: {self.what}"
        if self.value:
            text += f" (got {self.value})"
        if self.allowed:
            text += f"; allowed: {self.allowed}"
        if self.remedy:
            text += f"; {self.remedy}"
        return text


@dataclass(eq=False)
class StudioError(Exception):
    """Base of all errors that the studio tells its user about."""

    message: str
    problems: list[Problem] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.message, self.problems = cut(self.message, LONGEST_MESSAGE), first(self.problems)

    def __str__(self) -> str:
        return "\n".join([self.message, *(f"  {problem}" for problem in self.problems)])

    def __reduce__(self):
        return type(self), (self.message, self.problems)

    def as_json(self) -> dict:
        """The body of a REST error; it has a problem at least, as much as is known of it."""
        where, colon, what = self.message.partition(": ")
        problems = self.problems or [Problem(where, what) if colon else Problem("", self.message)]
        return {"message": self.message, "problems": [asdict(problem) for problem in problems]}


class ScenarioError(StudioError):
    """A scenario file, or a change of it, is wrong."""


class ConflictError(ScenarioError):
    """A document is not as the change expects it."""


class StaleError(ConflictError):
    """A document has changed since it was read."""


class SealedError(ScenarioError):
    """A document that may be read only."""


class MapError(StudioError):
    """A map file is missing, unreadable, or holds no roads."""


class RouteError(StudioError):
    """Roads do not connect, or are not on the map."""


class ApplicationError(StudioError):
    """An application raised during a run, or did what it must not."""


class KindError(StudioError):
    """A kind does not load, or does not keep the contract of its sort."""


class RunError(StudioError):
    """A state is not finite any more."""


class SnapshotError(StudioError):
    """A snapshot is of another world, scenario or version."""


class StoreError(StudioError):
    """runs.db cannot be opened or written."""


class UnknownError(StudioError):
    """A run, scenario or channel that does not exist."""


class SizeError(StudioError):
    """More was sent than is taken."""


class ServerError(StudioError):
    """The server cannot start."""


def first(problems: list[Problem]) -> list[Problem]:
    """The problems, or as many as can be told, and how many there are besides."""
    kept, room = [], LONGEST_LIST
    for each in problems:
        room -= sum(map(len, vars(each).values()))
        if room < 0:
            return [*kept, Problem("", f"there are {len(problems) - len(kept)} more problems", remedy="mend these first")]
        kept.append(each)
    return kept


def cut(text: str, limit: int) -> str:
    """A text of at most so many characters: the middle of a longer one is left out.

    >>> cut("there is nothing to see", 11)
    'there … see'
    """
    kept = limit - 3
    return text if len(text) <= limit else f"{text[: kept - kept // 3].rstrip()} … {text[len(text) - kept // 3 :].lstrip()}"


def nearest(name: str, known: Iterable[str]) -> str:
    """A remedy that names the nearest right names, or lists what there is.

    >>> nearest("cac", ["acc", "cacc"])
    "did you mean 'cacc'?"
    """
    names = sorted(known)
    close = difflib.get_close_matches(name, names, n=1, cutoff=0.6)
    if close:
        return f"did you mean {close[0]!r}?"
    shown = ", ".join(names[:8]) + (", …" if len(names) > 8 else "")
    return f"known: {shown}" if names else "there is none"


def short(value: object, limit: int = 60) -> str:
    """A value that fits into a message; of a whole number with more digits than Python writes, the length."""
    try:
        text = repr(value)
    except ValueError:
        text = "a number of thousands of digits"
    return text if len(text) <= limit else text[: limit - 1] + "…"
