"""What kinds give: their named numbers with units, as they are recorded, sent or shown.

given(kind)   →  [Quantity("range", "m", 1, 0.0), ...]
"""

from math import nan

from studio.application import port
from studio.kind.quantity import Quantity, quantities
from studio.kind.registry import Kind


def given(kind: Kind) -> list[Quantity]:
    """The numbers of a reading, of a payload, of what an application logs; of a metric or a channel the one that it is."""
    if hasattr(kind.module, "UNIT"):
        return [Quantity(kind.name, kind.module.UNIT, 1, nan, meaning=kind.title)]
    return [each for part in parts(kind) for each in quantities(part)]


def parts(kind: Kind) -> list[type]:
    """The NamedTuples of numbers that a kind gives."""
    if kind.sort == "application":
        return [each.type for each in port.done(kind.module) if each.what == port.LOG]
    return [getattr(kind.module, name) for name in ("Reading", "Payload") if hasattr(kind.module, name)]
