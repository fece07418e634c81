"""Quantities: a NamedTuple of numbers, each with its unit, as kinds declare what they give.

class Target(NamedTuple):
    range: Annotated[float, "m", "bumper to bumper"] = 0.0
    history: Annotated[tuple[float, float, float], "m/s²", "of the last ticks"] = (0.0, 0.0, 0.0)

quantities(Target)   →  Quantity("range", "m", 1, 0.0, meaning="bumper to bumper"), Quantity("history", "m/s²", 3, ...)
"""

from typing import Annotated, Any, NamedTuple, get_args, get_origin, get_type_hints


class Quantity(NamedTuple):
    """One field: its name, unit, how many numbers it holds (1 for a plain one), first value, whether it is yes or no, what it means."""

    name: str
    unit: str
    size: int
    default: Any
    is_flag: bool = False
    meaning: str = ""

    @property
    def numbers(self) -> list[float]:
        """The first values as plain numbers."""
        return [float(value) for value in (self.default if self.size > 1 else [self.default])]


def quantities(of: type) -> list[Quantity]:
    """The fields of a NamedTuple; raises TypeError that says which is none: a number with a unit and a first value."""
    hints = get_type_hints(of, include_extras=True)
    return [quantity(name, hints[name], of._field_defaults) for name in of._fields]  # pyrefly: ignore[missing-attribute]


def quantity(name: str, hint: Any, defaults: dict[str, Any]) -> Quantity:
    """One field."""
    if name not in defaults:
        raise TypeError(f"{name} has no first value: write {name}: ... = 0.0")
    kind, *notes = get_args(hint) if get_origin(hint) is Annotated else (hint,)
    unit, meaning = (str(notes[0]) if notes else ""), (str(notes[-1]) if len(notes) > 1 else "")
    if get_origin(kind) is tuple:
        inner, size = get_args(kind), len(get_args(kind))
        if size < 2 or set(inner) != {float} or len(defaults[name]) != size:
            raise TypeError(f"{name} is {kind}; a fixed number of floats is meant, tuple[float, float], with as many first values")
        return Quantity(name, unit, size, defaults[name], meaning=meaning)
    if kind not in (float, int, bool) or not isinstance(defaults[name], (int, float)):
        raise TypeError(f"{name} is {getattr(kind, '__name__', kind)}; float, bool or a tuple of floats is meant, with a first value")
    return Quantity(name, unit, 1, defaults[name], kind is bool, meaning)


def width(of: type) -> int:
    """How many numbers a NamedTuple holds."""
    return sum(each.size for each in quantities(of))


def first_values(of: type) -> list[float]:
    """Its first values, one after another."""
    return [value for each in quantities(of) for value in each.numbers]
