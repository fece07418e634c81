"""A stretch of a run that is stored: what its measures would be if nothing but that had been driven."""

from dataclasses import replace

from studio.assess.census import NOT_KEPT
from studio.assess.intact import intact
from studio.assess.measure import measure_all
from studio.assess.metric import Measured
from studio.errors import Problem, UnknownError
from studio.store.runs import Runs

COUNTED = "is counted while a run goes on, and not kept for a part of it"


def stretch(runs: Runs, run: int, begin: float, end: float) -> tuple[float, float, dict[str, Measured]]:
    """First and last time of the samples between two times [s], and the measures of these. Raises UnknownError where there are none."""
    whole = runs.record(run)
    part = intact(whole).between(begin, end)  # a collision before it counts, too
    if part.time.size < 2:
        first, last = (float(whole.time[i]) for i in (0, -1)) if whole.time.size else (0.0, 0.0)
        problem = Problem(
            "begin, end", "hold no two samples", f"{begin:g} to {end:g} s", f"within {first:g} to {last:g} s, begin before end"
        )
        raise UnknownError(f"Nothing of run {run} was recorded between these times.", [problem])
    # the windows of the scenario's own measures are about the whole run: here every metric is as usual
    found = {name: told(each) for name, each in measure_all(part).items()}
    return float(part.time[0]), float(part.time[-1]), found


def told(found: Measured) -> Measured:
    """A measure that says why it has no value here."""
    return replace(found, about=COUNTED) if found.about == NOT_KEPT.why else found
