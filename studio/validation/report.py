"""One page about a validation, to be read and printed: span in words, verdicts, what was calibrated, figures with their zones.

Everything stands in the one file: no script, no font, no picture is fetched from anywhere; a browser prints it as PDF.
"""

from collections.abc import Sequence
from html import escape

from studio.parcel.report import STYLE, listed, section, table, value
from studio.validation import figure, span
from studio.validation import table as verdict
from studio.validation.calibration import Estimate
from studio.validation.criterion import FAIL, OVERRIDDEN, UNJUDGED, Verdict
from studio.validation.judge import Comparison, Result
from studio.validation.project import Loaded
from studio.validation.zone import WORDS

TONE = {"pass": "good", FAIL: "bad", OVERRIDDEN: "dim", UNJUDGED: "dim"}
OTHERS = {FAIL: "failed", OVERRIDDEN: "overridden", UNJUDGED: "cannot be judged"}
METHOD = (
    "The recorded inputs of real maneuvers drove the simulated vehicle open loop: once for every run, and once with the average of them. "
    "A maneuver is valid where the mean of the simulations lies in the interval of the experiments and the simulation of the averaged "
    "input keeps to its limit (M. Massow, I. Radusch, Journal of Advanced Transportation 2018, section 5)."
)


def report(loaded: Loaded, found: Result, estimates: dict[str, Estimate], number: int) -> str:
    """The page, as HTML."""
    title = f"{loaded.project.title}: iteration {number}"
    parts = [
        f"<h1>{escape(title)}</h1>",
        f'<p class="dim">{escape(loaded.model.values.title)}; {escape(WORDS[found.confidence])}</p>',
        section("Verdict", summary(found)),
        section("Validated span", listed(span.told(found.span)) + limits(found)),
        section("What a person judged otherwise", overridden(found.verdicts)),
        section("What was calibrated", calibrated(estimates)),
        *(section(f"{each.module.TITLE}: {each.name}", maneuver(each, found)) for each in found.comparisons),
        section("Method", f"<p>{METHOD}</p>"),
    ]
    head = f'<meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{escape(title)}</title>'
    return f'<!doctype html><html lang="en"><head>{head}<style>{STYLE}</style></head><body>{"".join(parts)}</body></html>\n'


def summary(found: Result) -> str:
    """Whether it is valid, in a sentence."""
    passed = sum(each.verdict == "pass" for each in found.verdicts)
    count = f"{passed} of {len(found.verdicts)} criteria are met"
    others = [f"{n} {word}" for kind, word in OTHERS.items() if (n := sum(each.verdict == kind for each in found.verdicts))]
    word = '<b class="good">valid</b>' if found.is_valid else '<b class="bad">not valid</b>'
    doubt = f" {doubtful(found.doubtful)}" if found.doubtful else ""
    verdict = f"<p>The vehicle is {word} for what these maneuvers ask: {count}{''.join(f', {each}' for each in others)}.{doubt}</p>"
    return verdict + listed(found.hints)


def doubtful(count: int) -> str:
    """What is to be thought of criteria that pass by the width of their interval alone."""
    return f"Of those that are met, {count} by nothing but an interval that is wider than the limit: they prove little."


def limits(found: Result) -> str:
    """The span of every maneuver that met its criteria, and what was left out."""
    rows = [
        (escape(name), *(f"{low:.3g} to {high:.3g}" if low != high else "–" for low, high in each.model_dump().values()))
        for name, each in found.spans.items()
    ]
    head = ["maneuver", *(f"{word} [{span.UNITS[name]}]" for name, word in span.WORDS.items())]
    missing = [each.name for each in found.comparisons if each.name not in found.spans]
    note = f'<p class="dim">Left out, for a criterion failed: {escape(", ".join(missing))}.</p>' if missing else ""
    return table(head, rows) + note


def overridden(verdicts: Sequence[Verdict]) -> str:
    """What failed and counts all the same."""
    rows = [(escape(each.maneuver), escape(each.criterion), escape(each.reason)) for each in verdicts if each.verdict == OVERRIDDEN]
    return table(["maneuver", "criterion that failed", "why it counts as valid"], rows)


def calibrated(estimates: dict[str, Estimate]) -> str:
    """Values that were found, with their uncertainty."""
    rows = [
        (
            escape(each.path),
            value(each.start),
            value(each.value),
            f"± {2 * each.spread:.2g}",
            escape(each.unit),
            f"{each.low:g} to {each.high:g}",
        )
        for each in estimates.values()
    ]
    return table(["parameter", "before", "found", "two standard deviations", "unit", "allowed"], rows, numeric=[1, 2, 3])


def maneuver(compared: Comparison, found: Result) -> str:
    """Verdicts and figures of a maneuver."""
    runs = f"<p>{len(compared.theirs)} runs: {escape(', '.join(each.name for each in compared.theirs))}</p>"
    rows = [row(each) for each in found.verdicts if each.maneuver == compared.name]
    left = f'<p class="dim">Not judged here: {escape("; ".join(found.unjudged[compared.name]))}.</p>'
    pictures = "".join(picture for _, picture in figure.figures(compared, found.confidence))
    return runs + table(verdict.HEAD[:-1], rows, numeric=verdict.NUMERIC) + left + pictures


def row(each: Verdict) -> tuple[str, ...]:
    """A verdict as cells, its reason beside the criterion."""
    criterion, *numbers, word, reason = map(escape, verdict.cells(each))
    why = f': <span class="dim">{reason}</span>' if reason else ""
    return (criterion + why, *numbers, f'<b class="{TONE[each.verdict]}">{word}</b>')
