"""What runs were set to: the value of every parameter that one of them has set, as each of them had it.

Who compares runs by a parameter wants its value of all of them, of those too that left it as their scenario has it. The documents of runs
are many and long, so SQLite takes the few values out of them itself: of 10 000 runs in a fraction of a second.
"""

import json
from collections.abc import Sequence
from typing import Any

from studio.scenario.edit import leaves
from studio.store.runs import Row, Runs

MOST = 90  # paths in one call: SQLite's functions take a hundred arguments
SEED = "seed"  # stands in the row and not in the document, which runs of all seeds share


def settings(runs: Runs, rows: Sequence[Row]) -> dict[int, dict[str, Any]]:
    """By run: values by path; a path that a run's scenario does not have is left out there."""
    own = {row.run: dict(laid_out(row.parameters)) for row in rows}
    paths = sorted({path for each in own.values() for path in each})
    hashes = sorted({row.scenario_hash for row in rows})
    found: dict[str, dict[str, Any]] = {each: {} for each in hashes}
    wanted = [path for path in paths if path != SEED and '"' not in path]
    for first in range(0, len(wanted), MOST):
        for scenario, values in extracted(runs, hashes, wanted[first : first + MOST]):
            found[scenario] |= values
    seeds = {row.run: {SEED: row.seed} if SEED in paths else {} for row in rows}
    return {row.run: found[row.scenario_hash] | seeds[row.run] | own[row.run] for row in rows}


def laid_out(parameters: dict[str, Any]) -> list[tuple[str, Any]]:
    """Single values of what was set; a program may have set whole objects."""
    return [leaf for path, value in parameters.items() for leaf in leaves(value, f"{path}.")]


def extracted(runs: Runs, hashes: Sequence[str], paths: Sequence[str]) -> list[tuple[str, dict[str, Any]]]:
    """Values at some paths of the documents of some scenarios; neither what is not there nor whole objects."""
    marks, places = ", ".join("?" * len(hashes)), ", ".join("?" * len(paths))
    # with one path SQLite would give a bare value, which is 1 for true: the version is asked for to have a list always
    taken = f"select hash, json_extract(document, '$.version', {places}) as kept from scenarios"
    found = runs.rows(f"{taken} where hash in ({marks}) and json_valid(document)", [*map(place, paths), *hashes])
    return [(row["hash"], present(paths, json.loads(row["kept"])[1:])) for row in found]


def present(paths: Sequence[str], values: Sequence[Any]) -> dict[str, Any]:
    """Those that are there."""
    return {path: value for path, value in zip(paths, values, strict=True) if value is not None and not isinstance(value, dict)}


def place(path: str) -> str:
    """A dotted path as SQLite has it: names begin with a letter, so a number is a place in a list."""
    return "$" + "".join(f"[{part}]" if part.isdecimal() else f'."{part}"' for part in path.split("."))
