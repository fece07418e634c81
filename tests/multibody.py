"""Another program's cars: the runs of the multi-body model, our cars on the same inputs, and what is compared.

tests/reference/multibody/*.csv.gz are described in tests/reference/README.md. Their axes are SAE-like, so a positive steer
angle turns right there and left here: magnitudes are compared, and the left wheels with the right ones. A run's inputs are its
road wheel angle; and the acceleration u that its speed control asks for, u = 3 (v0 - v_x), or that is prescribed (`long`), as
wheel torque m R u: driving through the differential, braking through the brakes' shares. No air drag, no rolling resistance.

Two things that differ on purpose show in fast maneuvers, and both can be computed:

roll    Their slip angles are taken from the body's lateral velocity, though the wheels have their own, and their body gives way
        sideways. `consistent_*.csv.gz` are their runs with the wheels' velocities and stiff joints (make_consistent.py).
patch   Our contact patches take up slip over 0.1 m (model/wheel.py), theirs at once: the linear single track with and without.

So a row that misses its tolerance is compared a second time, with what theirs would be with both.
"""

import csv
import gzip
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.signal import StateSpace, lsim

from studio.model.wheel import SIGMA
from studio.vehicle.parameter import MASS, RADIUS
from studio.vehicle.state import A_X, A_Y, DELTA, F_Z, ROLL, V_X, YAW_RATE, X, Y
from tests.closed_form import single_track
from tests.conftest import ROOT
from tests.proving_ground import Ground

FOLDER = ROOT / "tests" / "reference" / "multibody"
CARS = ("bmw_320i", "ford_escort")
MANEUVERS = ("step", "sine", "dlc", "long")
STEERED = 1.0  # [s] when a maneuver begins
THEIRS = {"x": "x_m", "y": "y_m", "r": "yaw_rate_rps", "a_x": "ax_mps2", "a_y": "ay_mps2", "roll": "roll_rad"}
OURS = {"x": X, "y": Y, "r": YAW_RATE, "a_x": A_X, "a_y": A_Y, "roll": ROLL}
LOADS = ("Fz_LF", "Fz_RF", "Fz_LR", "Fz_RR")


@dataclass(frozen=True)
class Run:
    """One run: its car and maneuver, inputs over time, and the columns of the answer."""

    name: str
    car: str
    maneuver: str
    inputs: dict[str, np.ndarray]
    columns: dict[str, np.ndarray]

    @property
    def speed(self) -> float:
        """At the start [m/s]."""
        return float(self.inputs["vx_mps"][0])

    @property
    def end(self) -> float:
        """Its length [s]."""
        return float(self.inputs["t_s"][-1])

    @property
    def title(self) -> str:
        """Without the car's name."""
        return self.name.removeprefix(f"{self.car}_sym_")


def read(path) -> Run:
    """One file."""
    with gzip.open(path, "rt") as file:
        head, *rows = csv.reader(file)
    given = dict(zip(head, np.array(rows, dtype=float).T, strict=True))
    name = path.name.removesuffix(".csv.gz").removeprefix("consistent_")
    car, kind = name.split("_sym_")
    answer = {"t": given["t_s"], **{ours: given[theirs] for ours, theirs in THEIRS.items() if theirs in given}}
    answer["loads"] = np.array([given[key] for key in LOADS if key in given])
    return Run(name, car, kind.split("_")[0], given, answer)


@cache
def runs() -> tuple[Run, ...]:
    """All runs of both cars."""
    return tuple(read(path) for car in CARS for path in sorted(FOLDER.glob(f"{car}_sym_*.csv.gz")))


def consistent(run: Run) -> Run:
    """Their answer with the wheels' own lateral velocities and stiff joints; of a sine or a lane change."""
    made = read(FOLDER / f"consistent_{run.name}.csv.gz")
    return Run(run.name, run.car, run.maneuver, run.inputs, made.columns)


def asked(run: Run, time: float, v_x: float) -> float:
    """Acceleration [m/s²] that is asked for: prescribed, or by the speed control."""
    if run.maneuver != "long":
        return 3.0 * (run.speed - v_x)
    return float(run.inputs["u_acc_mps2"][np.searchsorted(run.inputs["t_s"], time + 1e-9, side="right") - 1])


@cache
def driven(step: float, seconds: float = 17.0) -> dict[str, Run]:
    """Our cars on the inputs of all runs at once, which they hold after a run's end: the answers at every step."""
    all_of_them = runs()
    cars, speeds = [run.car for run in all_of_them], [run.speed for run in all_of_them]
    ground = Ground(cars, speed=speeds, resistances=False, step=step, tick=step)
    times = step * np.arange(round(seconds / step))
    steers = np.array([np.interp(times, run.inputs["t_s"], run.inputs["delta_rad"]) for run in all_of_them]).T

    def feed(each):
        u = np.array([asked(run, each.time, v_x) for run, v_x in zip(all_of_them, each.state[V_X], strict=True)])
        torque = u * each.parameter[MASS] * each.parameter[RADIUS]
        each.state[DELTA] = steers[each.k]
        each.command(steering=steers[each.k], applied_drive=np.maximum(torque, 0.0), applied_brake=np.maximum(-torque, 0.0))

    rows = list(OURS.values())
    seen = ground.history(seconds, lambda each: np.concatenate([each.state[rows], each.wheels[F_Z].reshape(4, -1)]), feed)
    answers = {}
    for v, run in enumerate(all_of_them):
        columns = {"t": times + step, **{name: seen[:, k, v] for k, name in enumerate(OURS)}}
        columns["loads"] = seen[:, len(rows) :, v].T[[1, 0, 3, 2]]  # their left is our right
        answers[run.name] = Run(run.name, run.car, run.maneuver, run.inputs, columns)
    return answers


# --- what is compared ------------------------------------------------------------------------------------------------------


def window(run: Run, begin: float, end: float) -> np.ndarray:
    """Which samples lie in (begin, end]."""
    return (run.columns["t"] > begin + 1e-9) & (run.columns["t"] <= end + 1e-9)


def settled(run: Run, name: str) -> float:
    """Mean of the last second, as a magnitude."""
    return abs(float(run.columns[name][window(run, run.end - 1.0, run.end)].mean()))


def settled_loads(run: Run) -> np.ndarray:
    """Mean loads of the last second."""
    return run.columns["loads"][:, window(run, run.end - 1.0, run.end)].mean(axis=1)


def crossing(run: Run, name: str, level: float) -> float:
    """When a magnitude first rises through a level [s]."""
    t, x = run.columns["t"], np.abs(run.columns[name])
    i = int(np.argmax((x >= level) & (t > STEERED)))
    return float(t[i - 1] + (level - x[i - 1]) / (x[i] - x[i - 1]) * (t[i] - t[i - 1]))


def rise(run: Run, name: str) -> float:
    """Time [s] from 10 % to 90 % of the settled value."""
    return crossing(run, name, 0.9 * settled(run, name)) - crossing(run, name, 0.1 * settled(run, name))


def response(run: Run, name: str) -> complex:
    """Answer over steer angle of a sine, from its last whole periods."""
    frequency = float(run.title.split("_")[1][1:])
    periods = max(int((run.end - STEERED - 1.0) * frequency), 1)
    inside = window(run, run.end - periods / frequency, run.end)
    t = run.columns["t"][inside]
    turn = np.exp(-2j * np.pi * frequency * t)
    steer = np.interp(t, run.inputs["t_s"], run.inputs["delta_rad"])
    return complex((run.columns[name][inside] * turn).sum() / (steer * turn).sum())


def lag(run: Run, name: str) -> float:
    """By which the answer follows the steer angle [s]."""
    frequency = float(run.title.split("_")[1][1:])
    return -float(np.angle(response(run, name) * np.sign(response(run, name).real))) / (2.0 * np.pi * frequency)


def peak(run: Run, name: str) -> float:
    """Greatest magnitude from the maneuver's beginning on."""
    return float(np.abs(run.columns[name][window(run, STEERED, run.end)]).max())


# --- what the contact patch does -----------------------------------------------------------------------------------------

NO_PATCH = 1e-4  # [m]


def linear(run: Run, sigma: float) -> Run:
    """The linear single track's answer to a run's steer angle, its patches taking up slip over sigma [m]."""
    A, b = single_track(Ground(run.car), run.speed, sigma=sigma)
    times = np.arange(0.0, run.end + 0.0005, 0.001)
    out = np.array([[0.0, 1.0, 0.0, 0.0], A[0] + [0.0, run.speed, 0.0, 0.0]])  # r, and a_y = dv_y/dt + v r
    steer = np.interp(times, run.inputs["t_s"], run.inputs["delta_rad"])
    _, answer, _ = lsim(StateSpace(A, b[:, None], out, np.zeros((2, 1))), steer, times)
    return Run(run.name, run.car, run.maneuver, run.inputs, {"t": times, "r": answer[:, 0], "a_y": answer[:, 1]})


@cache
def linear_pair(name: str) -> tuple[Run, Run]:
    """With our patch, and without."""
    run = next(each for each in runs() if each.name == name)
    return linear(run, SIGMA), linear(run, NO_PATCH)


# --- the table -----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Row:
    """One comparison; differences are in `unit`: "%" of theirs, or an absolute unit. allowed None: no tolerance is stated.

    expected: what theirs would be with what is known to differ, if that can be computed; `margin`: the tolerance of that, when
    it is another one.
    """

    run: str
    quantity: str
    ours: float
    theirs: float
    unit: str
    allowed: float | None
    note: str = ""
    expected: float | None = None
    margin: float | None = None

    def off(self, other: float) -> float:
        """Ours against another value."""
        return 100.0 * (self.ours / other - 1.0) if self.unit == "%" else (self.ours - other) * SCALES[self.unit]

    @property
    def difference(self) -> float:
        """Ours against theirs."""
        return self.off(self.theirs)

    @property
    def verdict(self) -> str:
        """`ok`; `why`: within the tolerance of what is expected; `NO`; `-`: no tolerance is stated."""
        if self.allowed is None:
            return "-"
        if abs(self.difference) <= self.allowed:
            return "ok"
        margin = self.allowed if self.margin is None else self.margin
        return "why" if self.expected is not None and abs(self.off(self.expected)) <= margin else "NO"


SCALES = {"ms": 1000.0, "m": 1.0, "m/s²": 1.0}
SLOW, FAST = 3.0, 5.0  # [m/s²] the reference's tolerances: 2 % below, 4 % up to, none beyond
BEYOND = "beyond 5 m/s², where no tolerance is stated"
ROLL_NOTE = "the tolerance of the load split: the roll-centre model differs"
NEAR_ROLL = 7.0  # [%] at 1 to 2 Hz, where a_y is small: 10 % of roll inertia or 3 % of height make 4 %
POSITION_NOTE = "the way of a whole maneuver; no tolerance is stated"
PATCH_NOTE = "our patches take up slip over 0.1 m"
FAST_NOTE = "their slip angles leave out the roll rate; our patches take up slip over 0.1 m"


def allowed_at(a_y: float) -> tuple[float | None, str]:
    """Percent for yaw rate and lateral acceleration at a lateral acceleration, and a note."""
    return (2.0, "") if a_y < SLOW else (4.0, "") if a_y <= FAST else (None, BEYOND)


def compared(ours: Run, theirs: Run) -> list[Row]:
    """All rows of one run; a note says why where it is needed."""
    kinds = {"step": compared_step, "sine": compared_sine, "dlc": compared_dlc, "long": compared_long}
    return [Row(theirs.name, *row) for row in kinds[theirs.maneuver](ours, theirs)]


def compared_step(ours: Run, theirs: Run):
    allowed, note = allowed_at(settled(theirs, "a_y"))
    yield "yaw rate", settled(ours, "r"), settled(theirs, "r"), "%", allowed, note
    yield "lateral acceleration", settled(ours, "a_y"), settled(theirs, "a_y"), "%", allowed, note
    yield "roll", settled(ours, "roll"), settled(theirs, "roll"), "%", 10.0, ROLL_NOTE
    patched, plain = linear_pair(theirs.name)
    expected = rise(theirs, "r") + rise(patched, "r") - rise(plain, "r")
    yield "rise of yaw rate", rise(ours, "r"), rise(theirs, "r"), "ms", 30.0, PATCH_NOTE, expected
    yield from compared_loads(ours, theirs)
    for axle, left, right in (("front", 0, 1), ("rear", 2, 3)):
        split = [settled_loads(run)[left] - settled_loads(run)[right] for run in (ours, theirs)]
        yield f"load split {axle}", abs(split[0]), abs(split[1]), "%", 10.0


def compared_loads(ours: Run, theirs: Run):
    for axle, wheels in (("front", [0, 1]), ("rear", [2, 3])):
        yield f"axle load {axle}", settled_loads(ours)[wheels].sum(), settled_loads(theirs)[wheels].sum(), "%", 2.0


def compared_sine(ours: Run, theirs: Run):
    allowed, _ = allowed_at(peak(theirs, "a_y"))
    patched, plain = linear_pair(theirs.name)
    right = consistent(theirs)
    for name, quantity in (("r", "yaw rate"), ("a_y", "lateral acceleration")):
        gain = abs(response(right, name)) * abs(response(patched, name)) / abs(response(plain, name))
        margin = NEAR_ROLL if name == "a_y" else None
        note = FAST_NOTE if name == "r" else f"{FAST_NOTE}; near the roll mode, {NEAR_ROLL:g} %"
        yield f"gain of {quantity}", abs(response(ours, name)), abs(response(theirs, name)), "%", allowed, note, gain, margin
        late = lag(right, name) + lag(patched, name) - lag(plain, name)
        yield f"lag of {quantity}", lag(ours, name), lag(theirs, name), "ms", 20.0, FAST_NOTE, late


def compared_dlc(ours: Run, theirs: Run):
    allowed, _ = allowed_at(peak(theirs, "a_y"))
    patched, plain = linear_pair(theirs.name)
    right = consistent(theirs)
    for name, quantity in (("r", "yaw rate"), ("a_y", "lateral acceleration")):
        expected = peak(right, name) * peak(patched, name) / peak(plain, name)
        yield f"peak of {quantity}", peak(ours, name), peak(theirs, name), "%", allowed, FAST_NOTE, expected
    aside = [float(np.abs(run.columns["y"][window(run, 0.0, run.end)]).max()) for run in (ours, theirs)]
    yield "greatest offset", *aside, "m", None, POSITION_NOTE


def compared_long(ours: Run, theirs: Run):
    coasts = settled(theirs, "a_x") < 0.01
    yield "acceleration", settled(ours, "a_x"), settled(theirs, "a_x"), "m/s²" if coasts else "%", 1e-3 if coasts else 0.5
    yield from compared_loads(ours, theirs)
    way = [float(np.interp(run.end, run.columns["t"], run.columns["x"])) for run in (ours, theirs)]
    yield "way", *way, "m", None, POSITION_NOTE


@cache
def table(step: float = 0.005) -> tuple[Row, ...]:
    """All rows of all runs."""
    answers = driven(step)
    return tuple(row for run in runs() for row in compared(answers[run.name], run))


# --- in words ------------------------------------------------------------------------------------------------------------

LEGEND = [
    "ok: within the tolerance. why: outside, but within it of what theirs would be (`expected`) with the cause in the note.",
    "NO: outside and not explained. -: no tolerance is stated.",
]


HEAD = f"{'difference':>16} {'tolerance':>10}  {'':3}  {'to expected':>11}"


def told(row: Row) -> str:
    """Difference, tolerance, verdict, difference to what is expected, and the note where one is needed."""
    bound = "-" if row.allowed is None else f"{row.allowed:g} {row.unit}"
    expected = "" if row.verdict != "why" else f"{row.off(row.expected):+.3f} {row.unit}"
    note = row.note if row.verdict != "ok" else ""
    return f"{row.difference:+10.3f} {row.unit:5} {bound:>10}  {row.verdict:3}  {expected:>11}  {note}"


def full_table() -> str:
    """Every row."""
    head = f"{'run':36} {'quantity':29} {'ours':>10} {'theirs':>10} {HEAD}  note"
    lines = [f"{row.run:36} {row.quantity:29} {row.ours:10.5g} {row.theirs:10.5g} {told(row)}".rstrip() for row in table()]
    return "\n".join([*LEGEND, head, *lines, "", *halving_table(), ""])


def groups() -> list[list[Row]]:
    """Rows of one quantity, car, tolerance and verdict."""
    found: dict[tuple, list[Row]] = {}
    for row in table():
        car = next(car for car in CARS if row.run.startswith(car))
        found.setdefault((row.quantity, car, row.allowed or 0.0, row.verdict), []).append(row)
    return [found[key] for key in sorted(found)]


def short_table() -> list[str]:
    """The greatest difference of each group."""
    lines = [f"{'greatest difference of':29} {'in':36} {'of':>3} {HEAD}  note"]
    for rows in groups():
        worst = max(rows, key=lambda row: abs(row.difference))
        lines.append(f"{worst.quantity:29} {worst.run:36} {len(rows):3} {told(worst)}".rstrip())
    return [*LEGEND, *lines]


# --- halving the step ------------------------------------------------------------------------------------------------------


HALVED_AFTER = 10.0  # [s]


def place(run: Run) -> np.ndarray:
    """Where a car is after HALVED_AFTER."""
    return np.array([np.interp(HALVED_AFTER, run.columns["t"], run.columns[axis]) for axis in ("x", "y")])


@cache
def halving() -> dict[tuple[str, str], float]:
    """Greatest distance [m] after 10 s between runs at 5 ms and at 2.5 ms, by car and maneuver."""
    coarse, fine, distances = driven(0.005), driven(0.0025), {}
    for run in runs():
        distance = float(np.hypot(*(place(coarse[run.name]) - place(fine[run.name]))))
        distances[run.car, run.maneuver] = max(distance, distances.get((run.car, run.maneuver), 0.0))
    return distances


def halving_table() -> list[str]:
    """The distances, car by car."""
    rows = [[f"{halving()[car, maneuver]:10.4f} m" for car in CARS] for maneuver in MANEUVERS]
    return [
        f"Distance after {HALVED_AFTER:g} s between steps of 5 ms and of 2.5 ms",
        f"{'maneuver':10} " + " ".join(f"{car:>12}" for car in CARS),
        *(f"{maneuver:10} " + " ".join(row) for maneuver, row in zip(MANEUVERS, rows, strict=True)),
    ]
