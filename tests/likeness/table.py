"""The table: our figures beside those that were measured on roads."""

from math import inf

from tests.likeness.published import PUBLISHED, Published


def is_like(value: float, known: Published) -> bool:
    """Whether a figure lies within what was measured."""
    return known.least <= value <= known.most


def markdown(found: dict[str, float]) -> str:
    """All figures, a row each."""
    rows = ["| | here | on roads | within | source |", "|---|---|---|---|---|", *(row(name, value) for name, value in found.items())]
    return "\n".join(rows) + "\n"


def row(name: str, value: float) -> str:
    """One figure."""
    known = PUBLISHED[name]
    unit = "" if known.unit == "1" else f" {known.unit}"
    return f"| {name} | {value:.4g}{unit} | {ranged(known)}{unit} | {'yes' if is_like(value, known) else 'no'} | {known.source} |"


def ranged(known: Published) -> str:
    """A range as text."""
    if known.most == inf:
        return f"above {known.least:g}"
    return f"below {known.most:g}" if known.least == -inf else f"{known.least:g} to {known.most:g}"
