"""Units as texts write them: whether one is spelled as the studio spells them."""

import re

from studio.errors import nearest

# SI, what follows from it, what is counted, and what radio engineers use.
PLAIN = "m s kg g N Nm J kJ W kW Wh kWh Hz kHz MHz GHz K °C A V Ah Pa kPa bar mol cd rad rpm"
COUNTED = "1 % dB dBm dBi byte bytes bit B kB MB kbit Mbit px"
SYMBOLS = frozenset(f"{PLAIN} {COUNTED}".split())
SPELLED = (
    dict.fromkeys(("deg", "degree", "degrees", "°", "radian", "radians"), "rad")
    | dict.fromkeys(("h", "min", "ms", "us", "µs", "sec", "second", "seconds"), "s")
    | dict.fromkeys(("km", "cm", "mm", "meter", "meters", "metre", "metres"), "m")
    | dict.fromkeys(("mph", "kmh"), "m/s")
)
BETWEEN = re.compile(r"[/·*()\s]+|[²³⁴⁻¹√]+|\^-?\d+")


def unit_slip(unit: str) -> tuple[str, str] | None:
    """What is wrong with a unit, and the remedy; None when nothing is."""
    if not unit.strip():
        return "the unit is empty", 'write "1" for a plain number'
    for symbol in filter(None, BETWEEN.split(unit)):
        if symbol in SPELLED:
            return f"the unit {unit!r} is not one of SI", f"inside, everything is in SI and radians: {SPELLED[symbol]}"
        if symbol not in SYMBOLS:
            return f"the unit {unit!r} is not known", nearest(symbol, SYMBOLS)
    return None
