"""The table: a row for each kind of input or fault, with what came of it."""

import time
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

MOST_KEPT = 20  # of what is wrong, in a row; all are counted
HEAD = ("part", "kind", "tried", "seed", "what came", "worst [s]", "wrong", "late")


@dataclass
class Row:
    """One kind of input or fault: how often it was tried, what came, and what was wrong about that."""

    part: str
    kind: str
    seed: int
    tried: int = 0
    came: Counter[str] = field(default_factory=Counter)
    worst: float = 0.0
    wrong: list[str] = field(default_factory=list)
    wrongs: int = 0
    late: list[str] = field(default_factory=list)

    def add(self, came: str, seconds: float, wrong: str = "") -> None:
        """One try."""
        self.tried += 1
        self.came[came] += 1
        self.worst = max(self.worst, seconds)
        if wrong:
            self.blame(wrong)

    def blame(self, wrong: str) -> None:
        """Something is wrong, with the last try or with all of them."""
        self.wrongs += 1
        self.wrong += [wrong] if len(self.wrong) < MOST_KEPT else []

    @contextmanager
    def trying(self, came: str) -> Iterator[None]:
        """One try that takes this block; what it asserts in vain, or raises, is wrong."""
        began = time.perf_counter()
        try:
            yield
        except Exception as error:
            self.add("wrong", time.perf_counter() - began, f"{came}: {type(error).__name__}: {error}")
        else:
            self.add(came, time.perf_counter() - began)

    def cells(self) -> list[str]:
        """As text."""
        came = ", ".join(f"{count} {name}" for name, count in self.came.most_common())
        return [self.part, self.kind, f"{self.tried}", f"{self.seed}", came, f"{self.worst:.2f}", f"{self.wrongs}", f"{len(self.late)}"]


def markdown(rows: Iterable[Row], about: str) -> str:
    """The table, its totals, and what is wrong."""
    rows = list(rows)
    lines = [f"| {' | '.join(cells)} |" for cells in (HEAD, ["---"] * len(HEAD), *(row.cells() for row in rows))]
    tries, wrongs, late = (sum(each) for each in zip(*((row.tried, row.wrongs, len(row.late)) for row in rows), strict=True))
    total = f"{len(rows)} kinds, {tries} tries, {wrongs} wrong, {late} late. {about}"
    wrong = [f"- {row.part}, {row.kind}: {each}" for row in rows for each in (*row.wrong, *row.late)]
    return "\n".join([*lines, "", total, *(["", *wrong] if wrong else [])]) + "\n"
