"""String stability: whether a disturbance grows from car to car.

In the time domain: per-hop gain in the L2 sense, ||a_i|| / ||a_{i-1}|| of the accelerations (J. Ploeg et al., IEEE Trans. Control Systems
Technology 22 (2014) 786): above 1 the next car works harder than the one ahead of it.

In the frequency domain: |A_i(f)| / |A_{i-1}(f)| of the Fourier transforms of the accelerations, at the frequencies at which the car ahead
was excited. A run begins and ends somewhere, which smears what lies between the lines of the transform: the records are weighed with
a Hann window. A sine that was driven for many periods gives its gain at its frequency; a step or a brake gives the whole curve.
"""

import itertools
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from studio.execution.record import Chain, Record

QUIET = 0.05  # [m/s²] root mean square below which there is no disturbance to pass on
EXCITED = 0.1  # [1] of the strongest line, below which a frequency is not excited
SLOWEST, FASTEST = 0.01, 1.0  # [Hz] between which gains are looked for: below, a run is too short; above, nobody drives


class Hop(NamedTuple):
    """From a car to the one behind it: their names, and the gain [1]."""

    ahead: str
    behind: str
    gain: float


class Spectrum(NamedTuple):
    """Gain over frequency: frequencies [Hz] and gains [1], at the frequencies that were excited."""

    frequency: np.ndarray
    gain: np.ndarray


class Peak(NamedTuple):
    """The greatest gain over frequency, where it is [Hz], and from whom to whom."""

    gain: float
    frequency: float
    ahead: str
    behind: str


def strength(record: Record, vehicle: str) -> float:
    """Root mean square of the acceleration [m/s²]."""
    values = record.trace(f"{vehicle}.acceleration")
    return float(np.sqrt(np.nanmean(values**2))) if np.isfinite(values).any() else 0.0


def hops(record: Record, chain: Chain) -> list[Hop]:
    """Every hop of a chain that had something to pass on."""
    levels = [(vehicle, strength(record, vehicle)) for vehicle in chain.vehicles if vehicle in record.vehicles]
    return [Hop(front, rear, level / ahead) for (front, ahead), (rear, level) in itertools.pairwise(levels) if ahead > QUIET]


def spectrum(ahead: np.ndarray, behind: np.ndarray, time: np.ndarray) -> Spectrum:
    """Gain over frequency from one acceleration to another [m/s²], float64[n] each, while both took part."""
    there = np.isfinite(ahead) & np.isfinite(behind)
    n = int(there.sum())
    if n < 4 or np.sqrt(np.mean(ahead[there] ** 2)) <= QUIET:
        return Spectrum(np.zeros(0), np.zeros(0))
    frequency = np.fft.rfftfreq(n, time[1] - time[0])
    front, rear = (np.abs(np.fft.rfft(np.hanning(n) * each[there])) for each in (ahead, behind))
    usable = (frequency >= SLOWEST) & (frequency <= FASTEST)
    usable &= front > EXCITED * front[usable].max(initial=0.0)
    return Spectrum(frequency[usable], rear[usable] / front[usable])


def peak(record: Record, front: str, rear: str) -> Peak | None:
    """The greatest gain over frequency from one vehicle to another; None when there was no disturbance."""
    found = spectrum(record.trace(f"{front}.acceleration"), record.trace(f"{rear}.acceleration"), record.time)
    if not found.gain.size:
        return None
    place = int(found.gain.argmax())
    return Peak(float(found.gain[place]), float(found.frequency[place]), front, rear)


def hop_peaks(record: Record) -> Iterator[Peak]:
    """Of every hop of every chain."""
    for chain in record.chains:
        yield from (each for pair in itertools.pairwise(recorded(record, chain)) if (each := peak(record, *pair)))


def platoon_peaks(record: Record) -> Iterator[Peak]:
    """From the first to the last of every chain."""
    for chain in record.chains:
        members = recorded(record, chain)
        if len(members) > 1 and (found := peak(record, members[0], members[-1])):
            yield found


def recorded(record: Record, chain: Chain) -> list[str]:
    """The vehicles of a chain that were recorded."""
    return [each for each in chain.vehicles if each in record.vehicles]
