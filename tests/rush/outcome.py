"""What came of much traffic: the measures of everybody, which of them are not as they have to be, and who it was, when."""

import time
from collections.abc import Callable
from math import inf
from typing import NamedTuple

from studio.assess.measure import measure_all
from studio.execution.counted import Counted
from studio.execution.simulation import simulation
from tests.rush.place import prepared

OFTEN = 500  # ticks at a time
RARE = 2e-3  # [1] violations over conflicts
LONG_WAIT, LONG_RING = 600.0, 120.0  # [s]
MEASURES = (
    "collisions", "passed_at_red", "left_road", "conflicts", "right_of_way_violations", "longest_wait", "longest_deadlock", "arrivals",
    "never_entered",
)  # fmt: skip
ALLOWED: dict[str, Callable[[dict[str, float]], bool]] = {
    "collisions": lambda m: m["collisions"] == 0,
    "passed_at_red": lambda m: m["passed_at_red"] == 0,
    "left_road": lambda m: m["left_road"] == 0,
    "right_of_way_violations": lambda m: m["right_of_way_violations"] <= RARE * m["conflicts"],
    "longest_wait": lambda m: m["longest_wait"] <= LONG_WAIT,
    "longest_deadlock": lambda m: m["longest_deadlock"] <= LONG_RING,
}
LEAST = {"violation": -inf, "at red": -inf, "off": -inf, "waited": LONG_WAIT, "ring": LONG_RING}  # what is told one by one, from there on


class Outcome(NamedTuple):
    """Of one place with one seed."""

    place: str
    seed: int
    cars: int
    minutes: float  # simulated
    commit: str  # of the code
    processor: float  # [s] that it took
    measures: dict[str, float]
    told: list[str]  # one by one, what should not have been
    error: str | None

    @property
    def wrong(self) -> list[str]:
        """What is not as it has to be."""
        return [*([self.error] if self.error else []), *(name for name, is_allowed in ALLOWED.items() if not is_allowed(self.measures))]

    def cells(self) -> list[str]:
        """As text."""
        about = [f"{self.processor / 60:.1f}", self.commit, ", ".join(self.wrong)]
        return [self.place, f"{self.seed}", *(f"{self.measures[name]:g}" for name in MEASURES), *about]


def outcome(place: str, cars: int, minutes: float, seed: int, commit: str = "") -> Outcome:
    """Lets so many cars drive there for so long."""
    began = time.process_time()
    running = simulation(prepared(place, cars, 60.0 * minutes, seed))
    while not running.is_over:
        running.advance(OFTEN)
    record = running.record()
    found = measure_all(record, None, print)
    measures = {name: float(found[name].value or 0.0) for name in MEASURES}
    told = [as_text(each) for each in record.counted or () if each.kind in LEAST and not each.value < LEAST[each.kind]]
    hit = [f"collision: {found['collisions'].about}"] if measures["collisions"] else []
    return Outcome(place, seed, cars, minutes, commit, time.process_time() - began, measures, hit + told, running.cases[0].error)


def as_text(each: Counted) -> str:
    """One thing that was counted."""
    return f"{each.kind}: {' before '.join(filter(None, (each.who, each.other)))} at {each.time:.2f} s, {each.value:.3g}"


def markdown(outcomes: list[Outcome], about: str) -> str:
    """The table, and below it what is not as it has to be, one by one."""
    head = ["place", "seed", *(name.replace("_", " ") for name in MEASURES), "minutes of processor", "code", "not as it has to be"]
    rows = [head, ["---"] * len(head), *(each.cells() for each in outcomes)]
    told = [f"- {each.place}, seed {each.seed}: {text}" for each in outcomes for text in each.told]
    return "\n".join([*(f"| {' | '.join(cells)} |" for cells in rows), "", about, *(["", *told] if told else [])]) + "\n"
