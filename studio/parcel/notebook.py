"""A notebook that reads a run through `studio.connect`: what it was made of, its metrics, its traces, beside its parent.

It is a file of Jupyter's format 4.5 (nbformat.readthedocs.io): JSON with cells of text and of Python. Nothing of a run is copied into it
but its number; whoever opens it asks the studio at the address that stands in its first cell.
"""

import json
from collections.abc import Sequence
from typing import Any

from studio.store.runs import Row

MEDIA = "application/x-ipynb+json"
SHOWN = ("speed", "gap", "acceleration")  # of the first vehicles, where they were recorded
MOST = 6  # channels that are drawn at first


def notebook(row: Row, channels: Sequence[str], url: str) -> str:
    """The notebook of a run that a studio at an address has."""
    cells = [text(f"# Run {row.run} of {row.scenario}"), *sources(row, first(channels), url)]
    kernel = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}, "language_info": {"name": "python"}}
    whole = {"cells": [each | {"id": f"cell-{i}"} for i, each in enumerate(cells)], "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(whole, ensure_ascii=False, indent=1) + "\n"


def first(channels: Sequence[str]) -> list[str]:
    """The channels that are drawn at first: of each quantity some vehicles."""
    return [name for quantity in SHOWN for name in channels if name.partition(".")[2] == quantity][:MOST]


def sources(row: Row, drawn: Sequence[str], url: str) -> list[dict[str, Any]]:
    """The cells."""
    made = [
        code("\n".join(opening(row.run, url))),
        text("## What was set, and what came out"),
        code('run.row["parameters"]'),
        code("{name: (each.value, each.unit, each.subject, each.time) for name, each in run.metrics.items() if each.value is not None}"),
    ]
    if drawn:
        made += [text("## Over time"), code(plot(drawn))]
    if row.parent is not None:
        made += [text(f"## Beside its parent, run {row.parent}"), code(f'there.beside({row.parent}, {row.run})["parameters"]')]
    return made


def opening(run: int, url: str) -> list[str]:
    """Python that finds the run."""
    return [
        "import studio",
        "",
        "# with token=... where it serves a network",
        f"there = studio.connect({url!r})",
        f"run = there.find({run})",
        "run",
    ]


def plot(channels: Sequence[str]) -> str:
    """Python that draws channels, those of one quantity in one picture."""
    return "\n".join([
        "import matplotlib.pyplot as plt", "",
        f"channels = {list(channels)!r}",
        "trace = run.trace(*channels)",
        "units = {each[\"name\"]: each[\"unit\"] for each in run.row[\"channels\"]}",
        "quantities = list(dict.fromkeys(name.partition(\".\")[2] for name in channels))",
        "figure, rows = plt.subplots(len(quantities), sharex=True, squeeze=False, layout=\"constrained\")",
        "for axes, quantity in zip(rows[:, 0], quantities):",
        "    for name in [each for each in channels if each.partition(\".\")[2] == quantity]:",
        "        axes.plot(trace[\"time\"], trace[name], label=name.partition(\".\")[0])",
        "        axes.set_ylabel(f\"{quantity} [{units[name]}]\")",
        "    axes.legend()",
        "rows[-1, 0].set_xlabel(\"time [s]\")",
    ])  # fmt: skip


def text(source: str) -> dict[str, Any]:
    """A cell of text."""
    return {"cell_type": "markdown", "metadata": {}, "source": source.splitlines(keepends=True)}


def code(source: str) -> dict[str, Any]:
    """A cell of Python that has not been run."""
    return {"cell_type": "code", "execution_count": None, "metadata": {}, "outputs": [], "source": source.splitlines(keepends=True)}
