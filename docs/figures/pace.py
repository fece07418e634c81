"""Figures of PACE: ten cars on the drawn deck, and how long they take by two ways of giving away spaces.

uv run python -m docs.figures.pace           draws docs/pages/explanation/pace_*.svg, a few minutes
uv run python -m docs.figures.pace --long    a hundred cars come and leave, five at a time, over twenty seeds and two allocations: a table
"""

import json
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from studio import job
from studio.assess.parking import clearance, errors, parking_times, stays
from studio.execution.loop import as_fast_as_possible
from studio.execution.record import Record
from studio.execution.simulation import simulation
from studio.garage import plan
from studio.road.drawn.deck import deck as draw_deck
from studio.validation.figure import drawn

PAGES = Path(__file__).resolve().parent.parent / "pages" / "explanation"
COLOURS = ("#d55e00", "#0072b2", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000", "#777777", "#882255", "#44aa99")
CAMERAS = {"kind": "deck_cameras", "delay": 0.18, "delay_variation": 0.04, "period": 0.07, "drop_out": 0.1}
SEEDS, TOGETHER = 20, 5


def deck(
    cars: int, *, duration: float, stay: float = 60.0, seed: int = 1, garage: dict[str, Any] | None = None,
    cameras: dict[str, Any] | None = None, parking: dict[str, Any] | None = None, apart: float = 8.0, script: dict[str, Any] | None = None,
    loss: float = 0.0, shape: plan.Plan = plan.SIXTY,
) -> dict[str, Any]:  # fmt: skip
    """A scenario: a queue of cars `apart` [m] from the street into the deck, which are called back `stay` [s] after they have parked."""
    names = [f"car_{i}" for i in range(1, cars + 1)]
    built = {
        "groups": shape.groups,
        "together": shape.together,
        "space_length": shape.length,
        "space_width": shape.width,
        "aisle": shape.aisle,
    }
    one = {"route": "in_and_out", "model": "electric_compact", "speed": 0.0, "sensors": {}, "gps": {"drift": 0.3, "noise": 0.1}}
    return {
        "version": 3, "title": "Deck", "seed": seed, "clock": {"duration": duration},
        "map": {"file": "parking_deck.osm", "radius": 140, "parking_aisles": True},
        "routes": {"in_and_out": {"roads": ["1", "4", "5", "9", "3"]}},
        "vehicles": {name: one | {"position": {"along": 115.0 - apart * i}} for i, name in enumerate(names)},
        "stations": {"garage": {"position": {"x": 0, "y": 0}, "sensors": {"cameras": CAMERAS | (cameras or {})}}},
        "applications": {
            "house": {"application": "garage", "units": ["garage"], "parameters": {"stay": stay} | built | (garage or {})},
            "parking": {"application": "parking", "units": names, "listens_to": ["garage"] * cars, "parameters": parking or {}},
        },
        "script": script or {},
        "radio": {"kind": "ad_hoc", "buildings": False, "loss": loss},
        "recording": {"period": 0.1},
    }  # fmt: skip


def run(documents: list[dict[str, Any]], shape: plan.Plan = plan.SIXTY) -> list[Record]:
    """The records of scenarios that are run side by side, on a deck of a shape."""
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        draw_deck(shape).write(place / "parking_deck.osm")
        prepared = []
        for i, document in enumerate(documents):
            (place / f"{i}.yaml").write_text(json.dumps(document, default=float), encoding="utf-8")
            prepared.append(job.prepare(job.load(place / f"{i}.yaml")))
        running = simulation(*prepared)
        as_fast_as_possible(running)
    for case in running.cases:
        assert case.status == "done", case.error
    return [running.record(i) for i in range(len(documents))]


def gone(record: Record) -> int:
    """How many cars have their driver back."""
    return sum(bool(np.any(stay.phase == 4.0)) for stay in stays(record))


def touched(record: Record) -> int:
    """How many contacts there were."""
    return sum(each.kind == "collision" for each in record.happenings)


def outline(axes, shape, **style) -> None:
    """A polygon, or several."""
    for each in getattr(shape, "geoms", [shape]):
        if isinstance(each, shapely.Polygon):
            axes.fill(*np.array(each.exterior.coords).T, **style)


def draw_ways(axes, record: Record) -> None:
    """The deck, and the ways of its cars."""
    outline(axes, plan.structure(plan.SIXTY).intersection(shapely.box(-40, -16.2, 34, 16.2)), color="#999999")
    for it in plan.spaces(plan.SIXTY):
        axes.fill(
            [it.x - 1.25, it.x + 1.25, it.x + 1.25, it.x - 1.25], np.repeat([it.y - 2.5, it.y + 2.5], 2), fill=False, edgecolor="#dddddd"
        )
    for stay, colour in zip(stays(record), COLOURS, strict=False):
        for phase, style in ((1.0, "-"), (3.0, ":")):
            on = stay.phase == phase
            axes.plot(stay.x[on], stay.y[on], style, color=colour, linewidth=0.9, label=stay.vehicle if style == "-" else None)
    axes.set(xlabel="east [m]", ylabel="north [m]", aspect="equal", xlim=(-46, 35), ylim=(-17, 17))


def draw_times(axes, records: dict[str, Record]) -> None:
    """When each car stands in its space."""
    for (name, record), colour in zip(records.items(), COLOURS, strict=False):
        at = sorted(each.time for each in parking_times(record))
        axes.step([0.0, *at], np.arange(len(at) + 1), where="post", color=colour, label=name)
    axes.set(xlabel="time [s]", ylabel="cars that are parked")


def interval(values: np.ndarray) -> str:
    """Mean with its 95 % interval (Student's t)."""
    from scipy.stats import t

    half = t.ppf(0.975, values.size - 1) * values.std(ddof=1) / np.sqrt(values.size)
    return f"{values.mean():.1f} ± {half:.1f}"


def print_long() -> None:
    """Twenty seeds, two allocations; the difference seed by seed."""
    means = {}
    for how in ("optimal", "first_come"):
        rows = []
        for seed in range(1, SEEDS + 1):
            (record,) = run([deck(TOGETHER, duration=260.0, stay=60.0, seed=seed, garage={"allocation": how})])
            near = clearance(record)
            error = float(np.sqrt(np.mean(np.concatenate([errors(record, stay) for stay in stays(record)]) ** 2)))
            times = [each.value for each in parking_times(record)]
            rows.append((len(times), gone(record), touched(record), float(np.mean(times)), getattr(near, "value", np.nan), error))
            print(how, seed, *(f"{each:.3g}" for each in rows[-1]), flush=True)
        table = np.array(rows)
        means[how] = table[:, 3]
        print(
            f"{how}: parked {table[:, 0].sum():.0f}, gone {table[:, 1].sum():.0f}, contacts {table[:, 2].sum():.0f}, mean time to park "
            f"{interval(table[:, 3])} s, least clearance {np.nanmin(table[:, 4]):.3f} m, localisation {table[:, 5].mean():.3f} m"
        )
    print(f"saved against first come, first served: {interval(means['first_come'] - means['optimal'])} s a car")


def main() -> None:
    """Draws, or prints."""
    if "--long" in sys.argv:
        print_long()
        return
    both = {how: {"allocation": how} for how in ("optimal", "first_come")}
    records = {how: run([deck(10, duration=340.0, stay=150.0, garage=garage)])[0] for how, garage in both.items()}
    (PAGES / "pace_ways.svg").write_text(drawn(lambda axes: draw_ways(axes, records["optimal"])), encoding="utf-8")
    named = {"in waves": records["optimal"], "first come, first served": records["first_come"]}
    (PAGES / "pace_times.svg").write_text(drawn(lambda axes: draw_times(axes, named)), encoding="utf-8")
    for how, record in records.items():
        found = [each.value for each in parking_times(record)]
        print(how, len(found), np.mean(found), np.max(found), clearance(record), touched(record), gone(record))


if __name__ == "__main__":
    main()
