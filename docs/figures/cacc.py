"""Figures of CACC: gain over frequency and least headway over delay, whole vehicles beside the theory with the same parameters.

uv run python -m docs.figures.cacc           draws docs/pages/explanation/cacc_*.svg, a minute
"""

from pathlib import Path

import numpy as np

from docs.figures.convoy import SPEED, convoy, gain, lines, run, swing
from studio.assess.transfer import FREQUENCIES, actuated, delayed, least_headway, ploeg
from studio.validation.figure import drawn

PAGES = Path(__file__).resolve().parent.parent / "pages" / "explanation"
STANDSTILL, TICKS = 2.5, 0.04  # [m]; [s] two ticks, in which a request is sent and used
SHOWN = np.array([0.03, 0.05, 0.07, 0.09, 0.12, 0.16, 0.22, 0.3])  # [Hz]
CASES = {"0.6 s, link 0 s": (0.6, 0.0), "0.6 s, link 0.15 s": (0.6, 0.15), "0.3 s, link 0.15 s": (0.3, 0.15)}
DELAYS = (0.0, 0.02, 0.05, 0.1, 0.15)  # [s]
CRITICAL = (0.07, 0.085, 0.1)  # [Hz] where the gain is greatest near the least headway
COLOURS = ("#0072b2", "#d55e00", "#009e73")


def two(frequency: float, headway: float, delay: float) -> dict:
    """A leader that swings and a car behind it."""
    gap = STANDSTILL + headway * SPEED
    return convoy("cacc", swing(frequency), gap=gap, parameters={"headway": headway}, radio={"delay": delay})


def lag() -> float:
    """Of drive and brakes [s], measured at the leader."""
    (record,) = run([two(0.1, 1.0, 0.0)])
    ratio = lines(record, "acceleration", 0.1) / lines(record, "requested_acceleration", 0.1)
    return float(-np.angle(ratio[0]) / (2.0 * np.pi * 0.1))


def draw_gain(axes, A) -> None:
    """Lines of theory, points of whole vehicles."""
    records = run([two(f, h, delay) for h, delay in CASES.values() for f in SHOWN])
    gains = np.reshape([abs(gain(record, f)[0]) for record, f in zip(records, [*SHOWN] * len(CASES), strict=True)], (len(CASES), -1))
    for (label, (h, delay)), found, colour in zip(CASES.items(), gains, COLOURS, strict=True):
        axes.plot(FREQUENCIES, abs(ploeg(A, delayed(delay + TICKS), h)), color=colour, linewidth=1.0, label=label)
        axes.plot(SHOWN, found, "o", color=colour, markersize=3.5)
    axes.plot(FREQUENCIES, abs(ploeg(A, 0.0, 1.6)), color="#777777", linewidth=1.0, linestyle="--", label="1.6 s, radar alone")
    axes.axhline(1.0, color="black", linewidth=0.6)
    axes.set(xscale="log", xlim=(0.02, 0.5), ylim=(0.5, 1.2), xlabel="frequency [Hz]", ylabel="gain from car to car [1]")
    axes.set_xticks([0.02, 0.05, 0.1, 0.2, 0.5], ["0.02", "0.05", "0.1", "0.2", "0.5"])
    axes.minorticks_off()


def crossing(headways: np.ndarray, peaks: np.ndarray) -> float:
    """Where the greatest gain falls through 1, by the straight line through its values."""
    slope, level = np.polyfit(headways, peaks - 1.0, 1)
    return float(-level / slope)


def draw_headway(axes, A) -> None:
    """Least headway over delay."""
    wide = np.linspace(0.0, 0.2, 41)
    least = [least_headway(lambda h, theta=theta: abs(ploeg(A, delayed(theta + TICKS), h))) for theta in wide]
    around = np.array([-0.06, -0.04, -0.02, 0.0])
    tried = [(h, theta) for theta in DELAYS for h in np.interp(theta, wide, least) + around]
    records = run([two(f, h, theta) for h, theta in tried for f in CRITICAL])
    gains = [abs(gain(record, f)[0]) for record, f in zip(records, [*CRITICAL] * len(tried), strict=True)]
    peaks = np.reshape(gains, (len(DELAYS), len(around), len(CRITICAL))).max(axis=2)
    found = [crossing(np.interp(theta, wide, least) + around, each) for theta, each in zip(DELAYS, peaks, strict=True)]
    axes.plot(1000.0 * wide, least, color=COLOURS[0], linewidth=1.0, label="theory")
    axes.plot(1000.0 * np.array(DELAYS), found, "o", color=COLOURS[1], markersize=4, label="whole vehicle")
    axes.set(xlabel="delay of the radio [ms]", ylabel="least headway [s]", ylim=(0.0, 1.0))
    for theta, h in zip(DELAYS, found, strict=True):
        print(f"{1000 * theta:3.0f} ms: {h:.3f} s, theory {np.interp(theta, wide, least):.3f} s")


def main() -> None:
    """Draws all."""
    tau = lag()
    print(f"lag of drive and brakes {tau:.3f} s")
    A = actuated(tau, 0.0)
    for name, draw in (("cacc_gain", draw_gain), ("cacc_headway", draw_headway)):
        (PAGES / f"{name}.svg").write_text(drawn(lambda axes, draw=draw: draw(axes, A)), encoding="utf-8")


if __name__ == "__main__":
    main()
