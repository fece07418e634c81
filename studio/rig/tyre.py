"""The tyre bench: forces of a tyre property file for a table of slips and loads, and the usual diagrams.

A table is CSV, plain or gzipped (.csv, .csv.gz), with a head and at least these columns, in any order:

    kappa      longitudinal slip [1]     positive drives: F_x is positive
    alpha_rad  side-slip angle [rad]     positive makes F_y negative
    gamma_rad  camber angle [rad]        positive about the x axis
    Fz_N       load [N]                  never negative

in the axes of the property file (ISO-W: x forward, y left, z up), friction as on the tyre's test track. The result has
all columns of the table, then Fx_N, Fy_N [N] and Mz_Nm [Nm] of combined slip. Given columns of these names stay as
Fx_N_given and so on, to be compared. In a result that is put in again the given ones stay, the computed ones are
computed anew.
"""

from math import pi
from pathlib import Path

import numpy as np

from studio.compiled import compiled
from studio.errors import Problem
from studio.model import tyre
from studio.model.tyre import Tyre
from studio.rig import table
from studio.rig.table import Table
from studio.scenario import tir

OUTPUTS = ("Fx_N", "Fy_N", "Mz_Nm")
GIVEN = "_given"
BELOW_RIGHT = float(np.nextafter(0.5 * pi, 0.0))  # [rad] the largest angle below π/2
ALLOWED = {  # lowest and highest value of each input, and how a message says it
    "kappa": (-1e6, 1e6, "-1e6 to 1e6 [1]"),
    "alpha_rad": (-BELOW_RIGHT, BELOW_RIGHT, "-π/2 < angle < π/2 [rad]"),
    "gamma_rad": (-BELOW_RIGHT, BELOW_RIGHT, "-π/2 < angle < π/2 [rad]"),
    "Fz_N": (0.0, 1e9, "0 to 1e9 [N]"),
}
INPUTS = tuple(ALLOWED)
DIGITS = 9  # of every number in a result

LOADS = (0.5, 1.0, 1.5, 2.0)  # of FNOMIN
LOAD_COLOURS = ("#7fb8dc", "#3787c0", "#08519c", "#041f4a")  # the heavier the darker
KAPPA_SHOWN, ALPHA_SHOWN = 0.5, 20.0  # [1], [deg] to both sides of zero, when the file goes so far
COMBINED_ANGLES = (1.0, 2.0, 4.0, 8.0)  # [deg]
ANGLE_COLOURS = ("#f5a66b", "#dd5f13", "#a63603", "#5a1c00")  # the larger the darker
POINTS = 401


def bench(file: Path, rows: Path, out: Path) -> int:
    """Writes the table `rows` with the forces of the tyre `file` to `out`; the number of rows. Raises ScenarioError."""
    table.check_output(out, file, rows)
    t = Tyre(*tir.coefficients(tir.read(file)))
    slips = table.read(rows, needed=INPUTS)
    results = sweep(t, *table.numbers(slips, ALLOWED))
    table.write(out, with_results(slips, results))
    return len(slips.rows)


def sweep(t: Tyre, kappa, alpha, gamma, F_z) -> np.ndarray:
    """F_x, F_y [N], M_z [Nm], shaped [3, row], for slips kappa [1], angles alpha, gamma [rad] and loads F_z [N]."""
    given = np.broadcast_arrays(kappa, np.tan(alpha), np.sin(gamma), F_z)
    kappa, tangent, sine, F_z = (np.ascontiguousarray(column, dtype=float) for column in given)
    result = np.empty((len(OUTPUTS), kappa.size))
    sweep_rows(t, kappa, tangent, sine, F_z, result)
    return result


@compiled
def sweep_rows(t, kappa, alpha, gamma, F_z, result):
    """Fills the result row by row; alpha and gamma are the tangent and the sine of the angles."""
    for i in range(kappa.size):
        F_x, F_y, M_z = tyre.forces(t, kappa[i], alpha[i], gamma[i], F_z[i], 1.0)
        result[0, i] = F_x
        result[1, i] = F_y
        result[2, i] = M_z


# --- the table -----------------------------------------------------------------------------------------------------------


def with_results(slips: Table, results: np.ndarray) -> list[list[str]]:
    """Head and rows of the result."""
    replaced = [name for name in OUTPUTS if name + GIVEN in slips.head]
    kept = [i for i, name in enumerate(slips.head) if name not in replaced]
    head = [slips.head[i] + GIVEN * (slips.head[i] in OUTPUTS) for i in kept]
    rows = [[row[i] for i in kept] + [f"{value:.{DIGITS}g}" for value in forces] for row, forces in zip(slips.rows, results.T, strict=True)]
    return [[*head, *OUTPUTS], *rows]


# --- diagrams ----------------------------------------------------------------------------------------------------------


def plot(file: Path, png: Path) -> None:
    """Draws the diagrams of the tyre `file` into the picture `png`. Raises ScenarioError."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    if png.suffix != ".png":
        table.refuse(png.name, [Problem(str(png), "is no name for a picture", png.suffix or "no ending", ".png")], "cannot be written")
    table.check_output(png, file)
    properties = tir.read(file)
    figure = Figure(figsize=(11.0, 8.5), layout="constrained")
    FigureCanvasAgg(figure)
    title = " · ".join(part for part in (properties.name, properties.size) if part)
    figure.suptitle(title, fontsize=14, parse_math=False)
    draw(figure.subplots(2, 2), properties)
    try:
        figure.savefig(png, format="png", dpi=150)
    except OSError as error:
        problem = Problem(str(png), f"cannot be written: {error.strerror or error}")
        table.refuse(png.name, [problem], "cannot be written")


def draw(panels, properties: tir.PropertyFile) -> None:
    """The four diagrams: F_x over kappa, F_y and M_z over the side-slip angle, F_y over F_x in combined slip."""
    t, shown = Tyre(*tir.coefficients(properties)), loads(properties)
    kappa = np.linspace(*limits(properties, "KPU", KAPPA_SHOWN), POINTS)
    alpha = np.linspace(*limits(properties, "ALP", np.radians(ALPHA_SHOWN)), POINTS)
    (drive, corner), (align, combined) = panels
    for F_z, colour in zip(shown, LOAD_COLOURS, strict=False):
        style = {"color": colour, "label": f"{F_z:.0f} N"}
        drive.plot(kappa, sweep(t, kappa, 0.0, 0.0, F_z)[0] / 1e3, **style)
        F_y, M_z = sweep(t, 0.0, alpha, 0.0, F_z)[1:]
        corner.plot(np.degrees(alpha), F_y / 1e3, **style)
        align.plot(np.degrees(alpha), M_z, **style)
    dress(drive, "Longitudinal force, no side-slip", r"longitudinal slip $\kappa$ [1]", "$F_x$ [kN]")
    dress(corner, "Lateral force, free rolling", r"side-slip angle $\alpha$ [°]", "$F_y$ [kN]")
    dress(align, "Aligning moment, free rolling", r"side-slip angle $\alpha$ [°]", "$M_z$ [Nm]")
    key(corner, "load $F_z$\n(blue lines)")
    draw_combined(combined, t, kappa, shown[min(1, len(shown) - 1)])


def draw_combined(panel, t: Tyre, kappa: np.ndarray, F_z: float) -> None:
    """F_y over F_x at one load: one line for each side-slip angle, longitudinal slip along it."""
    for degrees, colour in zip(COMBINED_ANGLES, ANGLE_COLOURS, strict=True):
        F_x, F_y, _ = sweep(t, kappa, np.radians(degrees), 0.0, F_z) / 1e3
        panel.plot(F_x, F_y, color=colour, label=f"{degrees:g}°")
    slips = f"{kappa[0]:g} to {kappa[-1]:g}".replace("-", "\N{MINUS SIGN}")
    title = rf"Combined slip, $F_z$ = {F_z:.0f} N, $\kappa$ from {slips}"
    dress(panel, title, "$F_x$ [kN]", "$F_y$ [kN]")
    key(panel, r"side-slip $\alpha$")
    panel.margins(0.05)
    if t.RBX1 == 0.0 and t.RBY1 == 0.0:
        note = "the file has no coefficients of combined slip"
        panel.text(0.5, 0.86, note, ha="center", transform=panel.transAxes)


def dress(panel, title: str, x: str, y: str) -> None:
    """Titles, axes and grid."""
    panel.set(title=title, xlabel=x, ylabel=y)
    panel.axhline(0.0, color="#7f7f7f", linewidth=0.8, zorder=0)
    panel.axvline(0.0, color="#7f7f7f", linewidth=0.8, zorder=0)
    panel.grid(color="#e5e5e5")
    panel.margins(x=0.0)


def key(panel, title: str) -> None:
    """Names of the lines, at the right of a diagram, where no line can run through them."""
    place = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0), "alignment": "left"}
    panel.legend(title=title, fontsize=9, title_fontsize=9, **place)


def loads(properties: tir.PropertyFile) -> list[float]:
    """Loads [N] to show: those within the file's range, or the nominal one."""
    values = properties.values
    low, high = values.get("FZMIN", 0.0), values.get("FZMAX", float("inf"))
    shown = [share * values["FNOMIN"] for share in LOADS if low <= share * values["FNOMIN"] <= high]
    return shown or [values["FNOMIN"]]


def limits(properties: tir.PropertyFile, name: str, shown: float) -> tuple[float, float]:
    """Range to show, within what the file covers."""
    return max(properties.values[name + "MIN"], -shown), min(properties.values[name + "MAX"], shown)
