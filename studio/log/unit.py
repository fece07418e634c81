"""Units of recorded signals: how many of ours one is, and whether a value can be right.

Ours are SI and radians; a temperature or a count has no place here. Factors are exact by definition (SI brochure, 9th edition;
the international mile of 1959), the standard gravity is 9.80665 m/s² (CGPM 1901).
"""

from math import pi

from studio.errors import Problem, ScenarioError, nearest

MILE, GRAVITY, TURN = 1609.344, 9.80665, 2.0 * pi
FACTORS = {  # our unit: what is read as well, with its factor to ours
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0},
    "m": {"m": 1.0, "km": 1e3, "cm": 1e-2, "mm": 1e-3, "mi": MILE},
    "m/s": {"m/s": 1.0, "km/h": 1 / 3.6, "kph": 1 / 3.6, "kmh": 1 / 3.6, "mph": MILE / 3600.0, "kn": 1852.0 / 3600.0},
    "m/s²": {"m/s²": 1.0, "m/s^2": 1.0, "m/s2": 1.0, "m/s/s": 1.0, "g": GRAVITY},
    "rad": {"rad": 1.0, "deg": pi / 180, "°": pi / 180, "grad": pi / 200},
    "rad/s": {"rad/s": 1.0, "deg/s": pi / 180, "°/s": pi / 180, "rpm": TURN / 60, "1/min": TURN / 60, "rev/min": TURN / 60},
    "Nm": {"Nm": 1.0, "N m": 1.0, "N·m": 1.0, "kNm": 1e3},
    "Pa": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "bar": 1e5},
    "1": {"1": 1.0, "": 1.0, "-": 1.0, "%": 1e-2},
}


def factor(unit: str, ours: str, where: str) -> float:
    """How many of our unit one of `unit` is; raises ScenarioError that names the units which are read for it."""
    known, readable = FACTORS[ours], plain(ours)
    if unit.strip().lower() not in readable:
        kind = next((our for our, units in FACTORS.items() if unit.strip().lower() in {each.lower() for each in units}), None)
        what = "is not a unit of this quantity" if kind else "is not a unit that is read"
        problem = Problem(where, what, unit or "none", ", ".join(known), nearest(unit, known) if unit else "say its unit in the mapping")
        raise ScenarioError("A signal has a unit that does not fit.", [problem])
    return readable[unit.strip().lower()]


def plain(ours: str) -> dict[str, float]:
    """What is read for a unit of ours, in small letters, with its factor."""
    return {each.lower(): value for each, value in FACTORS[ours].items()}
