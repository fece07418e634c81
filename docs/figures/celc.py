"""Figures of CELC: least distances over speed, whole vehicles beside the formula, the bound of the tyres, and braking alone.

uv run python -m docs.figures.celc           draws docs/pages/explanation/celc_*.svg, half a minute
uv run python -m docs.figures.celc --long    prints ways and least distances over 15 speeds and 6 latencies, three minutes
"""

import sys
from pathlib import Path

import numpy as np
from scipy.optimize import minimize_scalar

from docs.figures.convoy import run
from docs.figures.situation import formula, least, situation, way_aside
from studio.conventions import GRAVITY
from studio.model.evasion import left_over, stopping_distance
from studio.validation.figure import drawn

PAGES = Path(__file__).resolve().parent.parent / "pages" / "explanation"
SPEEDS, LATENCIES = np.array([40.0, 55.0, 70.0, 90.0, 110.0]), (0.01, 0.1, 0.2)  # [km/h], [s]
LONG_SPEEDS, LONG_LATENCIES = np.arange(40.0, 111.0, 5.0), (0.01, 0.02, 0.05, 0.1, 0.15, 0.2)
ALWAYS = {"always": True, "patience": 0.6}
GRIP = 0.85 * GRAVITY  # [m/s²]
COLOURS = ("#0072b2", "#009e73", "#d55e00")
FROM = "distance: A's front bumper to the obstacle's near edge when it becomes visible; recognition takes 0 s"


def case(kmh: float, latency: float) -> dict:
    """What `situation` wants, but for the distance."""
    return {"speed": kmh / 3.6, "latency": latency, "parameters": ALWAYS}


def bound(v: float) -> float:
    """Way [m] to come 2 m aside at v [m/s], braking with what a tyre of 0.85 has left: no evasion can need less."""

    def needed(a_y):
        t = np.sqrt(4.0 / a_y)
        return v * t - 0.5 * left_over(GRIP, a_y) * t * t

    return float(minimize_scalar(needed, bounds=(3.0, GRIP), method="bounded").fun)


def ways(speeds: np.ndarray, latencies: tuple[float, ...]) -> np.ndarray:
    """Way [m] until A is as far aside as the formula wants, float[latency, speed]."""
    tried = [case(v, latency) for latency in latencies for v in speeds]
    records = run([situation(**each, distance=1.3 * formula(each["speed"], each["latency"])) for each in tried])
    return np.reshape([way_aside(record) for record in records], (len(latencies), -1))


def draw_distance(axes) -> None:
    """Lines of the formula, points of whole vehicles."""
    wide = np.linspace(35.0, 115.0, 81)
    for latency, found, colour in zip(LATENCIES, ways(SPEEDS, LATENCIES), COLOURS, strict=True):
        axes.plot(wide, [formula(v / 3.6, latency) for v in wide], color=colour, linewidth=1.0, label=f"together, {1000 * latency:.0f} ms")
        axes.plot(SPEEDS, found, "o", color=colour, markersize=3.5)
    axes.plot(wide, [stopping_distance(v / 3.6, GRIP, 0.2, 0.2) for v in wide], color="black", linewidth=1.0, label="braking alone")
    axes.plot(wide, [bound(v / 3.6) for v in wide], color="#777777", linewidth=1.0, linestyle="--", label="bound of the tyres")
    axes.set(xlabel="speed [km/h]", ylabel="distance [m]", ylim=(0.0, 75.0))
    axes.set_title(FROM, fontsize="small")


def print_long() -> None:
    """Every way and every least distance as a multiple of the formula's."""
    found = ways(LONG_SPEEDS, LONG_LATENCIES)
    for latency, row in zip(LONG_LATENCIES, found, strict=True):
        tried = [case(v, latency) for v in LONG_SPEEDS]
        theory = np.array([formula(each["speed"], latency) for each in tried])
        without = least(tried, low=0.5, high=1.3) / theory
        for v, way, free in zip(LONG_SPEEDS, row / theory, without, strict=True):
            print(f"{v:3.0f} km/h  {1000 * latency:3.0f} ms  way {way:.3f}  without contact {free:.3f} of the formula's distance")


def main() -> None:
    """Draws, or prints."""
    if "--long" in sys.argv:
        print_long()
        return
    (PAGES / "celc_distance.svg").write_text(drawn(draw_distance), encoding="utf-8")


if __name__ == "__main__":
    main()
