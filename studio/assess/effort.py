"""Effort: what the drive took.

Energy at the wheels: E = ∫ max(T v/R, 0) dt with the drive torque T of all wheels, the speed v and the wheels' radius R: what the drive
puts in. What brakes and drag take out again is not given back; what an engine needs for it is another matter.
"""

import numpy as np

from studio.execution.record import Record


def energy(torque: np.ndarray, speed: np.ndarray, radius: np.ndarray, time: np.ndarray) -> np.ndarray:
    """E [J] per vehicle, of T [Nm] and v [m/s] float64[vehicle, n], R [m] float64[vehicle]; by trapezoids, while they take part."""
    power = np.maximum(torque * speed / radius[:, None], 0.0)
    steps = 0.5 * (power[:, 1:] + power[:, :-1]) * np.diff(time)
    return np.where(np.isfinite(steps), steps, 0.0).sum(axis=1)


def energy_of(record: Record) -> np.ndarray:
    """E [J] of every recorded vehicle."""
    radius = np.array([record.bodies[name].radius for name in record.vehicles])
    return energy(record.channel("drive_torque"), record.channel("speed"), radius, record.time)


def lasting(holds: np.ndarray, time: np.ndarray) -> np.ndarray:
    """For how long [s] something holds, per row, bool[vehicle, n]: every sample stands for the time to the next one."""
    return (holds[..., :-1] * np.diff(time)).sum(axis=-1)
