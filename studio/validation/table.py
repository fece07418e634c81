"""The table of verdicts as texts, every number with its unit; command and report show the same."""

from math import isfinite

from studio.validation.criterion import Verdict

HEAD = ("criterion", "ours", "theirs", "interval", "error", "limit", "verdict", "reason")
NUMERIC = (1, 2, 3, 4, 5)  # columns of numbers


def cells(each: Verdict) -> tuple[str, ...]:
    """A verdict, column by column."""
    return (
        each.criterion,
        quantity(each.ours, each.unit),
        quantity(each.theirs, each.unit),
        interval(each),
        quantity(each.error, each.error_unit, "+"),
        quantity(each.limit, each.error_unit),
        each.verdict,
        each.reason,
    )


def interval(each: Verdict) -> str:
    """From where to where, with one unit."""
    if each.low is None or each.high is None:
        return "–"
    return f"{number(each.low, each.unit)} to {number(each.high, each.unit)}{behind(each.unit)}"


def quantity(value: float | None, unit: str, sign: str = "") -> str:
    """A number with its unit; a pure number is a share, in per cent."""
    if value is None or not isfinite(value):
        return "–"
    return f"{number(value, unit, sign)}{behind(unit)}"


def number(value: float, unit: str, sign: str = "") -> str:
    """Four digits; what they show as zero has no sign."""
    text = f"{(100.0 * value if unit == '1' else value) + 0.0:{sign}.4g}"
    return text.lstrip("+-") if float(text) == 0.0 else text


def behind(unit: str) -> str:
    """The unit as it follows a number."""
    return " %" if unit == "1" else f" {unit}"
