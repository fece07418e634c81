"""Courses of a validation as numbers, for who draws them: zones of the recorded runs with the simulations, maneuver by maneuver."""

from typing import Any

import numpy as np

from studio.log.quantity import QUANTITIES
from studio.validation import figure, path
from studio.validation.judge import Comparison, Result
from studio.validation.maneuver import oval
from studio.validation.zone import zone

MOST = 600  # points of a course: more than a chart is wide in dots


def courses(found: Result) -> list[dict[str, Any]]:
    """Every judged signal of every maneuver: abscissa, mean and bounds of the recorded runs, mean of the simulations, averaged input."""
    return [course for each in found.comparisons for course in of(each, found)]


def of(compared: Comparison, found: Result) -> list[dict[str, Any]]:
    """The courses of a maneuver: positions over distance, and else signals over time; of runs that do not repeat each other, each."""
    if compared.kind == "oval":
        return [deviation(compared, found)]
    if not compared.module.REPEATS and len(compared.theirs) > 1:
        return [course for each in figure.alone(compared) for course in of(each, found)]
    shown = [name for name in compared.module.JUDGED if name in compared.theirs[0].signals]
    return [history(compared, name, found) for name in shown]


def history(compared: Comparison, name: str, found: Result) -> dict[str, Any]:
    """A signal over the time after the reference."""
    time, around, mean = compared.zone(name, found.confidence)
    averaged = np.interp(time, *compared.of_average(name), left=np.nan, right=np.nan) if len(compared.theirs) > 1 else None
    named = {"signal": name, "unit": QUANTITIES[name].unit, "over": "time after the reference", "over_unit": "s"}
    return told(compared, named, time, around, mean, averaged)


def deviation(compared: Comparison, found: Result) -> dict[str, Any]:
    """How far to the left of the averaged recorded path, over the travelled distance."""
    lines = [oval.line(each) for each in compared.theirs]
    base = path.averaged(lines)
    around = zone([path.offsets(base, each) for each in lines], found.confidence)
    ours = [path.deviations(base, oval.placed(mine, real)) for mine, real in zip(compared.ours, compared.theirs, strict=True)]
    named = {"signal": "deviation to the left", "unit": "m", "over": "travelled distance", "over_unit": "m"}
    return told(compared, named, base.distance, around, np.mean(ours, axis=0), None)


def told(compared: Comparison, named: dict[str, str], over: np.ndarray, around, mean: np.ndarray, averaged) -> dict[str, Any]:
    """A course as plain data, thinned evenly; where nothing is known it has none."""
    thin = np.unique(np.linspace(0, over.size - 1, min(MOST, over.size)).astype(int))
    columns = {"at": over, "theirs": around.mean, "low": around.low, "high": around.high, "ours": mean, "averaged": averaged}
    values = {key: None if each is None else plain(np.asarray(each)[thin]) for key, each in columns.items()}
    runs = [each.name for each in compared.theirs]
    return {"maneuver": compared.name, "runs": runs} | named | values


def plain(values: np.ndarray) -> list[float | None]:
    """Numbers of six digits; what is none is None."""
    return [float(f"{each:.6g}") if np.isfinite(each) else None for each in values]
