"""The story of one idea: the iterations of docs/pages/how/story.md, run again as they stand there.

uv run python -m docs.figures.story      prints the table of the page and draws docs/pages/how/story.svg, half a minute
"""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import yaml

from studio import job
from studio.job import Run
from studio.sample import folder
from studio.validation.figure import drawn

PAGE = Path(__file__).resolve().parent.parent / "pages" / "how"
PARAMETERS = "applications.evasion.parameters"
COLOURS = ("#999999", "#cc79a7", "#e69f00", "#d55e00", "#009e73", "#000000", "#56b4e9", "#0072b2")


class Step(NamedTuple):
    """One iteration: the run that it is a child of, what is changed of the sample, and what is tried."""

    parent: int  # 0 for none
    changes: dict[str, str]
    tried: str


SLOW, SOFT, SHY = {"recognition": "0.2"}, {"lateral": "4"}, {"yielding": "3"}
RARE, LOSS, CHANCE = {"repetition": "0.1"}, {"radio.loss": "0.3"}, {"seed": "7"}
STEPS = (
    Step(0, {"applications": "{}"}, "people drive"),
    Step(1, LOSS | RARE | SHY | SOFT | SLOW, "first parameters"),
    Step(2, LOSS | RARE | SHY | SOFT, "recognises in 0.06 s"),
    Step(3, LOSS | RARE | SHY, "6 m/s² aside"),
    Step(4, LOSS | RARE, "B brakes with 6 m/s²"),
    Step(5, LOSS | RARE | CHANCE, "another chance"),
    Step(6, LOSS | CHANCE, "repeats every 20 ms"),
    Step(7, LOSS | CHANCE | {"room": "30"}, "B spares its follower"),
)
MEASURES = ("collisions", "max_impact_speed", "commit_time", "maneuvers_aborted")


def path_of(name: str) -> str:
    """A change by its whole path."""
    return name if "." in name or name in ("applications", "seed") else f"{PARAMETERS}.{name}"


def command(step: Step) -> str:
    """The command line of an iteration."""
    changes = [f"--set {path_of(name)}={value}" if value != "{}" else f'--set "{name}={value}"' for name, value in step.changes.items()]
    parent = [f"--parent {step.parent}"] if step.parent else []
    return " ".join(["uv run studio run scenarios/celc.yaml", *parent, *changes])


def outcome(step: Step) -> Run:
    """What comes of it."""
    changes: dict[str, Any] = {path_of(name): yaml.safe_load(value) for name, value in step.changes.items()}
    return job.run(job.load(folder() / "celc.yaml", changes))


def shown(value: float | None) -> str:
    """A value for a table."""
    return "–" if value is None else f"{value:.3g}"


def row(number: int, step: Step, found: Run) -> str:
    """A row of the page's table."""
    values = [shown(found.metrics[name].value) for name in MEASURES]
    return f"| {number} | {step.tried} | {' | '.join(values)} | {len(found.unmet)} |"


def draw_ways(axes, outcomes: list[Run]) -> None:
    """Where A's front bumper drives, around the obstacle or into it."""
    for number, (found, colour) in enumerate(zip(outcomes, COLOURS, strict=True), 1):
        time, station = found.record.time, found.record.trace("A.station")
        ahead = station + FRONT - (np.interp(APPEARS, time, station) + FRONT + DISTANCE)
        kept = (ahead > -50.0) & (ahead < 15.0)
        axes.plot(ahead[kept], found.record.trace("A.lateral_offset")[kept], color=colour, linewidth=1.2, label=f"run {number}")
    axes.fill([0.0, 1.0, 1.0, 0.0], [-0.9, -0.9, 0.9, 0.9], color="black")
    axes.set(xlabel="A's front bumper before the obstacle [m]", ylabel="middle of A, to the left [m]", ylim=(-4.5, 1.5))
    axes.set_title(FROM, fontsize="small")


FROM = "50 m from A's front bumper to the obstacle's near edge when it becomes visible; recognition 0.06 s, in run 2 0.2 s"
FRONT, APPEARS, DISTANCE = 2.27, 2.0, 50.0  # [m] of the car, [s], [m] in the sample


def main() -> None:
    """Runs all, prints the table, draws the ways."""
    outcomes = [outcome(step) for step in STEPS]
    for number, (step, found) in enumerate(zip(STEPS, outcomes, strict=True), 1):
        print(f"{row(number, step, found)}      {command(step)}")
    (PAGE / "story.svg").write_text(drawn(lambda axes: draw_ways(axes, outcomes)), encoding="utf-8")


if __name__ == "__main__":
    main()
