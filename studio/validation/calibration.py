"""Calibration: the parameters with which our vehicle follows the calibration set best, and how well they are known.

Robust least squares (scipy, soft L1) over all recorded signals that the maneuvers judge, instant by instant, each over the noise that
its own log shows. Simulations of all runs with all varied parameters go side by side. What is told of a parameter besides its value:

    spread          standard deviation: of H⁻¹, H = JᵀJ / (s² a) + what was known before; s the robust scale of what is left over, and
                    a how many neighbouring samples are alike (1 + 2 Σ r), so that many samples of one mistake do not count as many
    sensitivity     change of the signals, in their noise, over the whole range of the parameter: RMS
    correlations    of the estimates: two that are bound to each other cannot be told apart by these maneuvers
"""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field, replace
from types import ModuleType
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from studio.errors import Problem, ScenarioError
from studio.log.recording import Recording
from studio.log.smooth import smooth
from studio.scenario import catalogue, edit
from studio.scenario.datasheet import quantities
from studio.validation import known, replay
from studio.validation.project import Calibration, Loaded

STEP = 1e-3  # [1] of the range, for differences
MOST = 60  # evaluations until it should have converged
QUIET = 0.005  # [1] of its range that a signal is uncertain by at least
ALIKE, FELT = 0.95, 0.01  # [1] correlation above which two estimates are one, if their spread is so much of the range
VAGUE = 0.25  # [1] of the range that a spread must stay under
NEAR = 1e-3  # [1] of the range beside a bound
LOST = 1e3  # what a car that was lost counts for, in noise


@dataclass(frozen=True)
class Estimate:
    """A parameter: what the vehicle had, what was found, how uncertain, how much the runs feel it, and what was allowed."""

    path: str
    unit: str
    start: float
    value: float
    spread: float
    sensitivity: float
    low: float
    high: float


@dataclass(frozen=True)
class Calibrated:
    """What a calibration found. `misfit` is the RMS difference over the range of each signal, before and after."""

    estimates: list[Estimate]
    correlations: list[list[float]]
    misfit: dict[str, tuple[float, float]]
    warnings: list[str]
    evaluations: int

    @property
    def changes(self) -> dict[str, float]:
        """What is to be changed in the vehicle."""
        return {each.path: each.value for each in self.estimates}

    def as_json(self) -> dict[str, Any]:
        """Plain data."""
        return asdict(self) | {"changes": self.changes}


@dataclass(frozen=True)
class Series:
    """One recorded signal of one run, with its noise, both in SI."""

    run: int
    signal: str
    values: np.ndarray
    noise: float


@dataclass
class Fit:
    """The problem: runs, what is compared, what is looked for. Parameters are told as shares of their ranges."""

    loaded: Loaded
    asked: Calibration
    runs: list[Recording]
    kinds: list[ModuleType]
    series: list[Series]
    told: Callable[[float], None]
    count: int = 0
    seen: dict[bytes, tuple[np.ndarray, np.ndarray]] = field(default_factory=dict)

    @property
    def paths(self) -> list[str]:
        """The parameters."""
        return list(self.asked.parameters)

    @property
    def low(self) -> np.ndarray:
        """Lowest values."""
        return np.array([each.low for each in self.asked.parameters.values()])

    @property
    def width(self) -> np.ndarray:
        """Ranges."""
        return np.array([each.high - each.low for each in self.asked.parameters.values()])

    def values(self, share: np.ndarray) -> dict[str, float]:
        """Parameters by path."""
        return dict(zip(self.paths, (self.low + share * self.width).tolist(), strict=True))

    def simulations(self, shares: Sequence[np.ndarray]) -> list[list[dict[str, np.ndarray] | None]]:
        """For each set of parameters the signals of every run, None where the car was lost; all of them side by side."""
        models = [catalogue.changed(self.loaded.model, self.values(share)) for share in shares]
        orders = [
            replay.order(model, run, kind, self.loaded.project.road)
            for model in models
            for run, kind in zip(self.runs, self.kinds, strict=True)
        ]
        made = replay.driven(orders)
        self.count += 1
        self.told(min(self.count / MOST, 1.0))
        n = len(self.runs)
        return [
            [
                None if each.broke is not None else dict(replay.simulated(run, each).signals)
                for run, each in zip(self.runs, made[i * n : (i + 1) * n], strict=True)
            ]
            for i in range(len(shares))
        ]

    def residuals(self, shares: Sequence[np.ndarray]) -> np.ndarray:
        """Differences over the noise, [set, sample]; at the end how far each parameter is from what is known of it."""
        rows = [[left(each, made[each.run]) for each in self.series] for made in self.simulations(shares)]
        return np.array([np.concatenate([*row, self.prior(share)]) for row, share in zip(rows, shares, strict=True)])

    def prior(self, share: np.ndarray) -> np.ndarray:
        """How far parameters are from what is known of them beforehand, over its spread."""
        wanted = self.asked.parameters.values()
        return np.array(
            [
                (value - each.prior) / each.spread if each.prior is not None and each.spread else 0.0
                for value, each in zip(self.values(share).values(), wanted, strict=True)
            ]
        )

    def at(self, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Residuals and their change with each parameter, forward or, at the upper bound, backward; it costs as much as one."""
        if share.tobytes() not in self.seen:
            steps = np.where(share + STEP <= 1.0, STEP, -STEP)
            found = self.residuals([share, *(share + np.diag(steps))])
            self.seen = {share.tobytes(): (found[0], ((found[1:] - found[0]) / steps[:, None]).T)}
        return self.seen[share.tobytes()]


def left(each: Series, made: dict[str, np.ndarray] | None) -> np.ndarray:
    """What is left of a signal over its noise."""
    if made is None:
        return np.full(each.values.size, LOST)
    return np.nan_to_num((made[each.signal] - each.values) / each.noise)


def calibrate(loaded: Loaded, step: str, progress: Callable[[float], None] = lambda share: None) -> Calibrated:
    """Finds the parameters of a step; raises ScenarioError when there is nothing to calibrate with, or when it does not converge."""
    fit = problem(loaded, step, progress)
    start = np.clip(had(fit), 0.01, 0.99)
    found = least_squares(
        lambda share: fit.at(share)[0], start, jac=lambda share: fit.at(share)[1], bounds=(0.0, 1.0), loss="soft_l1", f_scale=3.0,
        x_scale="jac", xtol=1e-5, ftol=1e-7, max_nfev=MOST,
    )  # fmt: skip
    if found.status == 0:
        what = f"did not settle within {MOST} evaluations"
        remedy = "calibrate fewer parameters, narrow their ranges, give a prior, or look for a run that does not fit the others"
        raise ScenarioError(
            "The calibration does not converge; nothing was kept.",
            [Problem("calibration.parameters", what, ", ".join(fit.paths), remedy=remedy)],
        )
    return described(fit, np.clip(found.x, 0.0, 1.0))


def problem(loaded: Loaded, step: str, told: Callable[[float], None]) -> Fit:
    """What is to be fitted; raises ScenarioError."""
    asked = loaded.project.calibration[step]
    pairs = pairs_of(loaded, step)
    if not pairs:
        what = Problem(
            f"calibration.{step}", "has no runs to calibrate with", remedy="name runs under `calibration` that validation does not use"
        )
        raise ScenarioError(f"{loaded.path.name} has nothing to calibrate with.", [what])
    runs, kinds = [run for run, _ in pairs], [kind for _, kind in pairs]
    found = [series(i, name, run) for i, (run, kind) in enumerate(pairs) for name in kind.JUDGED]
    return Fit(loaded, asked, runs, kinds, found, told)


def pairs_of(loaded: Loaded, step: str) -> list[tuple[Recording, ModuleType]]:
    """The runs of a step, each with its maneuver."""
    names = loaded.project.calibration[step].maneuvers or list(loaded.calibration)
    return [(run, known.find(loaded.project.maneuvers[name].kind)) for name in names for run in loaded.calibration.get(name, ())]


def runs_of(loaded: Loaded, step: str) -> list[Recording]:
    """The runs of a step."""
    return [run for run, _ in pairs_of(loaded, step)]


def series(i: int, name: str, run: Recording) -> Series:
    """A recorded signal with its noise: what smoothing takes away, robustly, and a little of its range at least."""
    values = run[name]
    spread = np.nanmedian(np.abs(values - smooth(run.time, values))) * 1.4826
    return Series(i, name, values, max(float(spread), QUIET * float(np.nanmax(values) - np.nanmin(values)), 1e-6))


def had(fit: Fit) -> np.ndarray:
    """What the vehicle has before; beyond 0 to 1 where that is not allowed. It begins there, or at the nearest that is."""
    full = fit.loaded.model.values.model_dump()
    return (np.array([edit.get(full, path) for path in fit.paths]) - fit.low) / fit.width


# -- what is told ----------------------------------------------------------------------------------------


def described(fit: Fit, share: np.ndarray) -> Calibrated:
    """The parameters that were found with all that is known of them."""
    start = had(fit)
    samples = sum(each.values.size for each in fit.series)
    whole = fit.at(share)[1]
    J, prior = whole[:samples], whole[samples:]
    before, after = fit.residuals([start, share])[:, :samples]
    information = J.T @ J / (scale(after) ** 2 * alike(fit, after)) + prior.T @ prior
    covariance = np.linalg.pinv(information)
    spread = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    correlations = covariance / np.maximum(np.outer(spread, spread), 1e-30)
    sensitivity = np.sqrt((J**2).mean(axis=0))
    began, value = fit.low + start * fit.width, fit.low + share * fit.width
    estimates = [
        Estimate(path, quantities()[path].unit, *map(float, row))
        for path, *row in zip(fit.paths, began, value, spread * fit.width, sensitivity, fit.low, fit.low + fit.width, strict=True)
    ]
    misfit = {name: (misfits(fit, before, name), misfits(fit, after, name)) for name in dict.fromkeys(each.signal for each in fit.series)}
    return Calibrated(estimates, correlations.tolist(), misfit, warnings(estimates, correlations, information), fit.count)


def scale(residuals: np.ndarray) -> float:
    """Robust scale of residuals: 1.4826 times their median size, that of a normal distribution's standard deviation."""
    return max(1.4826 * float(np.median(np.abs(residuals))), 1e-6)


def alike(fit: Fit, residuals: np.ndarray) -> float:
    """How many samples say the same: 1 + 2 Σ r of the correlations r, until one falls below zero, mean of all series."""
    cuts = np.cumsum([each.values.size for each in fit.series])[:-1]
    return float(np.mean([repeated(each) for each in np.split(residuals, cuts)]))


def repeated(values: np.ndarray) -> float:
    """The same of one series; samples far from all others are drawn in."""
    values = np.clip(values, *np.percentile(values, [1, 99]))
    size = 1 << (2 * values.size - 1).bit_length()
    power = np.abs(np.fft.rfft(values, size)) ** 2
    correlation = np.fft.irfft(power, size)[: values.size] / max(float((values**2).sum()), 1e-30)
    negative = np.flatnonzero(correlation < 0.0)
    return float(max(1.0 + 2.0 * correlation[1 : negative[0] if negative.size else values.size].sum(), 1.0))


def misfits(fit: Fit, residuals: np.ndarray, name: str) -> float:
    """RMS difference over the range of a signal, mean of the runs [1]."""
    cuts = np.cumsum([each.values.size for each in fit.series])[:-1]
    parts = zip(fit.series, np.split(residuals, cuts), strict=True)
    return float(
        np.mean(
            [
                np.sqrt(np.mean(part**2)) * each.noise / np.ptp(each.values[np.isfinite(each.values)])
                for each, part in parts
                if each.signal == name
            ]
        )
    )


def warnings(estimates: Sequence[Estimate], correlations: np.ndarray, information: np.ndarray) -> list[str]:
    """What these runs cannot tell."""
    found = [
        f"{a.path} and {b.path} cannot be told apart here (correlation {correlations[i, j]:+.3f}): calibrate one of them, or give a prior"
        for i, a in enumerate(estimates)
        for j, b in enumerate(estimates[:i])
        if abs(correlations[i, j]) > ALIKE and a.spread > FELT * (a.high - a.low)
    ]
    for i, each in enumerate(estimates):
        width = each.high - each.low
        if not each.low <= each.start <= each.high:
            found.append(
                f"{each.path} of the vehicle is {each.start:.6g} {each.unit}, outside of what is allowed, {each.low:.6g} to "
                f"{each.high:.6g}: what was found may be worse than what it has"
            )
        if information[i, i] < 1e-12 or each.spread > VAGUE * width:
            found.append(f"{each.path} is hardly felt here, its spread is {each.spread:.3g} {each.unit}: leave it out, or add a maneuver")
        elif min(each.value - each.low, each.high - each.value) < NEAR * width:
            found.append(f"{each.path} ended at the bound of its range, {each.value:.6g} {each.unit}: widen it, or doubt the model")
    return found


def applied(loaded: Loaded, found: Calibrated) -> Loaded:
    """The project with the calibrated vehicle."""
    return replace(loaded, model=catalogue.changed(loaded.model, found.changes))
