"""One page about a run, to be read and printed: what was decided, what came out, against its parent, over time, and of what it is made.

Everything stands in the one file: no script, no font, no picture is fetched from anywhere.
"""

import io
from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

import numpy as np

from studio.parcel import plan
from studio.store.comparison import compare
from studio.store.runs import Row, Runs
from studio.store.verdict import Verdict, remark_of, verdicts

CHARTS = ("speed", "gap", "acceleration", "time_gap")  # where they were recorded
SIZE = (7.2, 2.3)  # [in] of a chart
INNER = (2.0, 98.0)  # percentiles that an axis shows at least, so that one needle does not flatten all else
ROOM = 0.15  # of what they span, on each side
STYLE = """
body { font: 14px/1.45 system-ui, sans-serif; max-width: 52rem; margin: 2rem auto; padding: 0 1rem; color: #1a1a1a; background: #fff; }
h1 { font-size: 1.4rem; margin-bottom: 0; } h2 { font-size: 1.05rem; margin: 1.6rem 0 .4rem; }
table { border-collapse: collapse; width: 100%; } th, td { text-align: left; padding: .15rem .6rem .15rem 0; vertical-align: top; }
tr { border-bottom: 1px solid #ddd; break-inside: avoid; } .n { text-align: right; white-space: nowrap; }
.n { font-variant-numeric: tabular-nums; }
.dim { color: #5a5a5a; } .good { color: #0b6e4f; } .bad { color: #b3261e; } svg { width: 100%; height: auto; break-inside: avoid; }
pre { white-space: pre-wrap; overflow-wrap: anywhere; } @media print { body { margin: 0; max-width: none; } }
"""


def report(runs: Runs, run: int) -> str:
    """The page, as HTML. Raises UnknownError when there is no such run."""
    row, said = runs.find(run), remark_of(runs, run)
    against = compare(runs, row.parent, run) if row.parent is not None else None
    name = f"Run {run}" + (f": {row.name}" if row.name else "")
    parts = [
        f"<h1>{escape(name)}</h1>",
        f'<p class="dim">{escape(row.scenario)}, {escape(row.status)}, begun {escape(row.created[:19])} UTC</p>',
        section("Verdict", decided(verdicts(runs, run))),
        section("Note", f"<pre>{escape(said.note)}</pre>" if said.note else ""),
        section("Goals that were not met", listed(row.unmet)),
        section("What went wrong", f"<pre>{escape(row.error)}</pre>" if row.error else ""),
        section(f"What differs from run {row.parent}", parameters(against)),
        section("Metrics", metrics(row, against)),
        *plans(runs, row),
        section("Over time", charts(runs, row)),
        section("What happened", events(runs, run)),
        section("Of what it is made", made_of(row)),
    ]
    head = f'<meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{escape(name)}</title>'
    return f'<!doctype html><html lang="en"><head>{head}<style>{STYLE}</style></head><body>{"".join(parts)}</body></html>\n'


def section(title: str, content: str) -> str:
    """A part of the page; nothing without content."""
    return f"<h2>{escape(title)}</h2>{content}" if content else ""


def listed(lines: Sequence[str]) -> str:
    """Lines with points."""
    return f"<ul>{''.join(f'<li>{escape(each)}</li>' for each in lines)}</ul>" if lines else ""


def table(head: Sequence[str], rows: Iterable[Sequence[str]], numeric: Sequence[int] = ()) -> str:
    """A table of texts that are HTML already; nothing without rows. Columns of numbers stand on the right."""
    marks = [' class="n"' if i in numeric else "" for i in range(len(head))]
    body = "".join(f"<tr>{''.join(f'<td{mark}>{cell}</td>' for mark, cell in zip(marks, row, strict=True))}</tr>" for row in rows)
    titles = "".join(f"<th{mark}>{escape(each)}</th>" for mark, each in zip(marks, head, strict=True))
    return f"<table><thead><tr>{titles}</tr></thead><tbody>{body}</tbody></table>" if body else ""


# -- what was decided, and what came out ----------------------------------------------------------------


def decided(given: Sequence[Verdict]) -> str:
    """The verdict that counts, then those before it."""
    if not given:
        return '<p class="dim">Open: nobody has decided about this run.</p>'
    tone = {"candidate": "good", "discarded": "bad"}
    rows = [
        (
            f'<b class="{tone.get(each.verdict, "dim")}">{escape(each.verdict)}</b>',
            escape(each.reason),
            escape(f"{each.who}, {each.when[:16]}"),
        )
        for each in reversed(given)
    ]
    return table(["verdict", "reason", "who and when (UTC)"], rows)


def parameters(against: dict[str, Any] | None) -> str:
    """What was set otherwise than in the parent."""
    rows = [
        (escape(each["path"]), value(each["a"]), value(each["b"]), escape(each["unit"])) for each in (against or {}).get("parameters", ())
    ]
    return table(["parameter", "there", "here", "unit"], rows)


def metrics(row: Row, against: dict[str, Any] | None) -> str:
    """Every metric with its unit, whom it is about, and against the parent's."""
    before = {each["name"]: each for each in (against or {}).get("metrics", ())}
    found = [
        (
            escape(name),
            value(each.value),
            escape(each.unit),
            escape(each.about),
            each.goal or "",
            change(before.get(name)),
        )
        for name, each in row.metrics.items()
    ]
    return table(["metric", "value", "unit", "whom and when", "better", "against parent"], found, numeric=[1])


def change(metric: dict[str, Any] | None) -> str:
    """How a metric compares: what it was, and which run is better."""
    if metric is None or metric["a"] is None or metric["b"] is None:
        return ""
    tone = {"a": "bad", "b": "good"}.get(metric["better"] or "", "dim")
    word = {"a": "worse", "b": "better", "same": "same"}.get(metric["better"] or "", "")
    difference = metric["b"] - metric["a"]
    return f'<span class="{tone}">{f"{value(difference, signed=True)} {word}" if difference else "same"}</span>'


def value(number: Any, *, signed: bool = False) -> str:
    """A number with four digits; what is none as it is."""
    if isinstance(number, bool) or not isinstance(number, int | float):
        return "–" if number is None else escape(str(number))
    text = f"{number + 0.0:{'+' if signed else ''}.4g}"
    return text.replace("-0", "0", 1) if float(text) == 0 else text


# -- from above -----------------------------------------------------------------------------------------


def plans(runs: Runs, row: Row) -> list[str]:
    """The map of the paths, and a film strip; nothing where it was not recorded who was where."""
    found = plan.drive(runs, row)
    if found is None:
        return []
    moments = f'<p class="dim">{escape(plan.captions(found))}. Lines show where each was in the {plan.TRAIL:g} s before.</p>'
    where = '<p class="dim">Where the vehicles drove; each began at its dot.</p>'
    return [section("From above", where + svg(plan.plan(found))), section("Film strip", moments + svg(plan.strip(found)))]


# -- over time ------------------------------------------------------------------------------------------


def charts(runs: Runs, row: Row) -> str:
    """Pictures of the channels of all named vehicles, one above the other, with the events."""
    known = {each["name"]: each for each in runs.channels(row.run)}
    named = list(runs.document(row)["vehicles"])
    when = [each.time for each in runs.events(row.run)]
    found = []
    for quantity in CHARTS:
        names = [f"{vehicle}.{quantity}" for vehicle in named if f"{vehicle}.{quantity}" in known]
        if names:
            about = known[names[0]]
            found.append(picture(runs.trace(row.run, names), names, f"{about['label']} [{about['unit']}]", when))
    return "".join(found)


def picture(columns: dict[str, np.ndarray], names: Sequence[str], label: str, when: Sequence[float]) -> str:
    """One chart as SVG."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=SIZE, layout="constrained")
    axes = figure.add_subplot()
    for name in names:
        axes.plot(columns["time"], columns[name], linewidth=1.0, label=name.partition(".")[0])
    for time in when:
        axes.axvline(time, color="0.75", linewidth=0.5, zorder=0)
    axes.set(xlabel="time [s]", ylabel=label, ylim=limits(np.concatenate([columns[name] for name in names])))
    axes.legend(fontsize="x-small", loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    axes.grid(alpha=0.3)
    return svg(figure)


def svg(figure) -> str:
    """A figure as it stands in the page."""
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    out = io.StringIO()
    FigureCanvasSVG(figure).print_svg(out, metadata={"Date": None})
    text = out.getvalue()
    return text[text.index("<svg") :]


def limits(values: np.ndarray) -> tuple[float, float] | None:
    """What an axis shows: nearly all values with some room; all where they are near each other. None where there is none."""
    finite = values[np.isfinite(values)]
    if not finite.size:
        return None
    low, high = np.percentile(finite, INNER)
    room = ROOM * max(high - low, 1e-3 * max(abs(low), abs(high), 1.0))
    return max(float(finite.min()), float(low - 4 * room)) - room, min(float(finite.max()), float(high + 4 * room)) + room


# -- what happened, and of what it is made ----------------------------------------------------------------


def events(runs: Runs, run: int) -> str:
    """What happened, in its order."""
    return table(
        ["time [s]", "whom", "what"],
        [(value(each.time), escape(each.vehicle or ""), escape(each.text)) for each in runs.events(run)],
        numeric=[0],
    )


def made_of(row: Row) -> str:
    """What it takes to repeat it."""
    told = {
        "seed": row.seed,
        "parent": row.parent,
        "simulated [s]": row.sim_time_s,
        "state at the end": row.state_hash,
        "scenario": row.scenario_hash,
        "studio": row.code_version,
        "host": row.host,
        **row.versions,
        **{f"git, {each['folder']}": each["commit"] + (" and changes" if each["patch"] else "") for each in row.revisions},
    }
    set_ = [(escape(path), value(each)) for path, each in row.parameters.items()]
    return table(["", ""], [(escape(name), value(each)) for name, each in told.items()]) + section(
        "Parameters that were set", table(["path", "value"], set_)
    )
