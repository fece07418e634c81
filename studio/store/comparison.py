"""The comparison of saved runs as plain data, for the command line and REST: of two, or of several with the first of them.

compare(runs, a, b)       what differs between two, and what every metric says
beside(runs, numbers)     the same of up to eight, run by run, with their environment and the source of what they used
"""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from difflib import unified_diff
from typing import Any

from studio.assess import compare as assess
from studio.assess.goal import goals_of, unmet
from studio.errors import Problem, UnknownError, short
from studio.kind import registry
from studio.scenario.edit import flatten
from studio.scenario.schema import Scenario, unit_at
from studio.store.runs import Row, Runs

DIGITS = 19  # that a number has which SQLite can count to
MOST = 8  # runs beside each other: more than that nobody tells apart
BESIDE = {"a": "worse", "b": "better", "same": "same", None: None}  # how the other one is, seen from the first


def compare(runs: Runs, a: int, b: int) -> dict[str, Any]:
    """Both rows, the parameters that differ with their units, every metric; raises UnknownError."""
    left, right = runs.find(a), runs.find(b)
    documents = [runs.document(left), runs.document(right)]
    differing = assess.parameters(*documents)
    early = [each for each in (left, right) if not each.is_whole]
    return {
        "a": left.as_json(),
        "b": right.as_json(),
        "alike": assess.ALIKE,
        "unranked": unranked(early),
        "parameters": [asdict(each) | {"unit": unit(each.path, documents)} for each in differing],
        "metrics": [asdict(each) for each in assess.metrics(left.metrics, right.metrics, is_ranked=not early)],
    }


def unranked(early: Sequence[Row]) -> str:
    """Why no metric is better in one of the runs: what did not come to its end was measured over less; empty when both did."""
    told = [f"run {each.run} is {each.status}" + ("" if each.sim_time_s is None else f" at {each.sim_time_s:g} s") for each in early]
    return f"Nothing is ranked: {' and '.join(dict.fromkeys(told))}, so it was measured over less than a whole run." if told else ""


def unit(path: str, documents: list[dict[str, Any]]) -> str:
    """Unit of a parameter; those of applications are told by the applications that the runs used."""
    parts = path.split(".")
    if parts[0] == "applications" and len(parts) == 4 and parts[2] == "parameters":
        used = [document["applications"].get(parts[1], {}).get("application") for document in documents]
        known = registry.known("application")
        models = [known[name].module.Parameters for name in used if name in known]
        return next((found for model in models if (found := unit_at(model, parts[3]))), "")
    return unit_at(Scenario, path)


# -- several ---------------------------------------------------------------------------------------------


def beside(runs: Runs, numbers: Sequence[int], *, everything: bool = False) -> dict[str, Any]:
    """Up to eight runs, each compared with the first: `values` stand in their order, None where a run has none.

    Parameters and environment are those that differ, or `everything`; sources are the differences to those of the first, as unified
    diffs. Raises UnknownError for a run that is not there, for none at all, for one twice, and for too many.
    """
    check_numbers(numbers)
    rows = [runs.find(number) for number in numbers]
    documents = [runs.document(row) for row in rows]
    return {
        "runs": [row.as_json() for row in rows],
        "alike": assess.ALIKE,
        "unranked": [unranked([each for each in (rows[0], row) if not each.is_whole]) for row in rows],
        "goals": [goals(row, document) for row, document in zip(rows, documents, strict=True)],
        "parameters": [
            {"path": path, "values": values, "unit": unit(path, documents)}
            for path, values in lined_up([flatten(each) for each in documents], everything)
        ],
        "metrics": list(metrics(rows)),
        "environment": [{"name": name, "values": values} for name, values in lined_up([environment(row) for row in rows], everything)],
        "sources": list(sources(runs, rows)),
    }


def goals(row: Row, document: dict[str, Any]) -> dict[str, Any] | None:
    """How many of its scenario's goals a run met, and what is told of the others; None of one that was not measured to its end."""
    wanted = goals_of(document)
    missed = unmet(wanted, row.metrics)
    return {"met": len(wanted) - len(missed), "of": len(wanted), "missed": missed} if row.is_whole else None


def numbers(text: str) -> list[int]:
    """Numbers of runs with commas between them; raises UnknownError for anything else."""
    found = [each.strip() for each in text.split(",")]
    if wrong := [each for each in found if not (each.isascii() and each.isdigit() and len(each) < DIGITS)]:
        problem = Problem("runs", "is no number of a run", short(wrong[0]), f"1 to {MOST} numbers of runs with commas, such as 1,2,5")
        raise UnknownError("These runs cannot stand beside each other.", [problem])
    return [int(each) for each in found]


def check_numbers(numbers: Sequence[int]) -> None:
    """Raises UnknownError for runs that cannot stand beside each other."""
    if not 1 <= len(numbers) <= MOST or len(set(numbers)) < len(numbers):
        problem = Problem("runs", "cannot be compared", ", ".join(map(str, numbers)), f"1 to {MOST} numbers of runs, each once")
        raise UnknownError("These runs cannot stand beside each other.", [problem])


def lined_up(each: Sequence[dict[str, Any]], everything: bool) -> Iterator[tuple[str, list[Any]]]:
    """The values of all by name, in the order in which the names come up; only those that differ, or everything."""
    for name in dict.fromkeys(name for values in each for name in values):
        values = [some.get(name) for some in each]
        if everything or any(value != values[0] for value in values):
            yield name, values


def metrics(rows: Sequence[Row]) -> Iterator[dict[str, Any]]:
    """Every metric that a run has, and how each of the others is in it."""
    for name in dict.fromkeys(name for row in rows for name in row.metrics):
        known = next(row.metrics[name] for row in rows if name in row.metrics)
        first = rows[0]
        pairs = [assess.metric(name, first.metrics.get(name), row.metrics.get(name), first.is_whole and row.is_whole)
                 if name in first.metrics or name in row.metrics else None for row in rows]  # fmt: skip
        yield {
            "name": name,
            "unit": known.unit,
            "goal": known.goal,
            "values": [row.metrics[name].value if name in row.metrics else None for row in rows],
            "relative": [pair.relative if pair else None for pair in pairs],
            "stands": [BESIDE[pair.better] if pair else None for pair in pairs],
        }


def environment(row: Row) -> dict[str, Any]:
    """Where and with what a run was made, by name."""
    changed = {f"revision of {each['folder']}": told(each) for each in row.revisions}
    return {"studio": row.code_version, "host": row.host, **row.versions, **changed}


def told(revision: dict[str, Any]) -> str:
    """A revision in words: its commit, and the digest of what stood there uncommitted."""
    return revision["commit"] + (f" and changes {revision['patch'][:12]}" if revision["patch"] else "")


def sources(runs: Runs, rows: Sequence[Row]) -> Iterator[dict[str, Any]]:
    """What others have used in another form than the first run: kind, file, whose, and the difference; or that only one has it."""
    first = runs.sources(rows[0])
    for row in rows[1:]:
        other = runs.sources(row)
        for name in dict.fromkeys([*first, *other]):
            if rows[0].kinds.get(name) == row.kinds.get(name):
                continue
            about = {"kind": name, "run": row.run, "only": None}
            if name in first and name in other:
                yield from ({**about, "file": file, "diff": text} for file, text in differing(first[name], other[name]))
            else:
                yield {**about, "only": rows[0].run if name in first else row.run, "file": "", "diff": ""}


def differing(old: dict[str, str], new: dict[str, str]) -> Iterator[tuple[str, str]]:
    """The files of a kind that differ, and how: a unified diff without its head."""
    for file in dict.fromkeys([*old, *new]):
        before, after = (each.get(file, "").splitlines() for each in (old, new))
        if lines := list(unified_diff(before, after, lineterm="", n=2))[2:]:
            yield file, "\n".join(lines)
