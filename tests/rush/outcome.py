"""What came of much traffic: the measures of everybody, and which of them are not as they have to be."""

from collections.abc import Callable
from typing import NamedTuple

from studio.assess.measure import measure_all
from studio.execution.simulation import simulation
from tests.rush.place import prepared

OFTEN = 500  # ticks at a time
RARE = 2e-3  # [1] violations over conflicts
MEASURES = (
    "collisions", "passed_at_red", "left_road", "conflicts", "right_of_way_violations", "longest_wait", "longest_deadlock", "arrivals",
    "never_entered",
)  # fmt: skip
ALLOWED: dict[str, Callable[[dict[str, float]], bool]] = {
    "collisions": lambda m: m["collisions"] == 0,
    "passed_at_red": lambda m: m["passed_at_red"] == 0,
    "left_road": lambda m: m["left_road"] == 0,
    "right_of_way_violations": lambda m: m["right_of_way_violations"] <= RARE * m["conflicts"],
    "longest_wait": lambda m: m["longest_wait"] <= 600,  # [s]
    "longest_deadlock": lambda m: m["longest_deadlock"] <= 120,  # [s]
}


class Outcome(NamedTuple):
    """Of one place with one seed."""

    place: str
    seed: int
    measures: dict[str, float]
    error: str | None

    @property
    def wrong(self) -> list[str]:
        """What is not as it has to be."""
        return [*([self.error] if self.error else []), *(name for name, is_allowed in ALLOWED.items() if not is_allowed(self.measures))]

    def cells(self) -> list[str]:
        """As text."""
        return [self.place, f"{self.seed}", *(f"{self.measures[name]:g}" for name in MEASURES), ", ".join(self.wrong)]


def outcome(place: str, cars: int, seconds: float, seed: int) -> Outcome:
    """Lets so many cars drive there for so long."""
    running = simulation(prepared(place, cars, seconds, seed))
    while not running.is_over:
        running.advance(OFTEN)
    found = measure_all(running.record(), None, print)
    return Outcome(place, seed, {name: float(found[name].value or 0.0) for name in MEASURES}, running.cases[0].error)


def markdown(outcomes: list[Outcome], about: str) -> str:
    """The table."""
    head = ["place", "seed", *(name.replace("_", " ") for name in MEASURES), "not as it has to be"]
    rows = [head, ["---"] * len(head), *(each.cells() for each in outcomes)]
    return "\n".join([*(f"| {' | '.join(cells)} |" for cells in rows), "", about]) + "\n"
