"""The same step on a GPU: one block of threads for a tile, one thread for a vehicle, the same functions as on the CPU.

    Device(fleet)                       a copy of a fleet on the GPU
    device.integrate(k, tick, dt)       motion of one tick, or of several with the same commands
    device.fetch(fleet)                 state and wheels back into the fleet
    ptx()                               the machine code, also where no GPU is

Gearboxes, drivers, applications and light vehicles stay on the CPU. Needs the extra `cuda` of the package.
"""

import warnings
from collections.abc import Generator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import numba.cuda
import numpy as np
from numba import float64, int64
from numba.core.errors import NumbaPerformanceWarning
from numba.cuda import dispatcher

from studio.conventions import DEFAULT_STEP
from studio.vehicle.command import COMMAND, RING
from studio.vehicle.contact import CONTACT
from studio.vehicle.corner import corners_step, tyre_step
from studio.vehicle.fleet import Fleet
from studio.vehicle.motion import body_step, derive, intake_step, steps_of
from studio.vehicle.tile import LANES, tyre_at

cuda: Any = numba.cuda  # its types are those of placeholders, and not of what the compiler puts there
CAPABILITY = (8, 0)  # of the code that `ptx` makes: Ampere and later
TILE, TABLE = float64[:, :, ::1], float64[:, ::1]
SIGNATURE = (int64[:, ::1], int64[:, ::1], TABLE, TABLE, int64, float64, float64, int64, int64, *[TILE] * 6)


def kernel(columns, tyres_of, tyres, commands, k, tick, dt, steps, ticks, state, wheels, ground, contact, parameter, command):
    """One vehicle: `ticks` ticks of `steps` steps, all with the commands in force at tick k.

    columns int64[tile, lane], tyres_of int64[2, tile]; tiles float64[tile, row, lane] or [tile, row, corner · LANES + lane].
    """
    b, v = cuda.blockIdx.x, cuda.threadIdx.x
    if columns[b, v] < 0:
        return
    front, rear = tyre_at(tyres, tyres_of[0, b]), tyre_at(tyres, tyres_of[1, b])
    for _ in range(ticks):
        for i in range(steps):
            intake_step(v, columns[b, v], commands.shape[1] // RING, parameter[b], commands, k, i * dt, tick, command[b])
            corners_step(v, state[b], wheels[b], ground[b], contact[b], parameter[b], dt)
            tyre_step(front, 1.0, v, wheels[b], ground[b], contact[b])
            tyre_step(front, -1.0, LANES + v, wheels[b], ground[b], contact[b])
            tyre_step(rear, 1.0, 2 * LANES + v, wheels[b], ground[b], contact[b])
            tyre_step(rear, -1.0, 3 * LANES + v, wheels[b], ground[b], contact[b])
            body_step(v, state[b], wheels[b], contact[b], parameter[b], command[b], dt)
        derive(v, state[b])


@contextmanager
def a_device(capability: tuple[int, int]) -> Generator[None]:
    """Stands in for the look-up of the present GPU, which device functions make while they are compiled."""
    found = dispatcher.get_current_device
    dispatcher.get_current_device = lambda: SimpleNamespace(compute_capability=capability)
    try:
        yield
    finally:
        dispatcher.get_current_device = found


def ptx() -> str:
    """Machine code of the kernel for a GPU of CAPABILITY; needs none."""
    with a_device(CAPABILITY):
        return cuda.compile_ptx(kernel, SIGNATURE, cc=CAPABILITY)[0]


def is_available() -> bool:
    """Whether there is a GPU."""
    return cuda.is_available()


def name() -> str:
    """Name of the GPU."""
    found = cuda.get_current_device().name
    return found.decode() if isinstance(found, bytes) else str(found)


class Device:
    """A fleet on the GPU."""

    def __init__(self, fleet: Fleet):
        """Copies everything; tiles that are not full hold vehicles that do not exist (column -1)."""
        self.count = fleet.blocks.shape[1]
        self.columns = np.full((self.count, LANES), -1)
        for b, (first, count) in enumerate(fleet.blocks[:2].T):
            self.columns[b, :count] = fleet.order[first : first + count]
        parts = {"state": (fleet.state, 1), "wheels": (fleet.wheels, 4), "ground": (fleet.ground, 4), "parameter": (fleet.parameter, 1)}
        self.parts = {name: cuda.to_device(self.tiled(part, groups)) for name, (part, groups) in parts.items()}
        self.contact = cuda.device_array((self.count, len(CONTACT), 4 * LANES))
        self.command = cuda.device_array((self.count, len(COMMAND), LANES))
        self.fixed = [cuda.to_device(part) for part in (self.columns, fleet.blocks[2:].copy(), fleet.tyres)]
        self.commands = cuda.to_device(fleet.commands)
        self.kernel = cuda.jit(fastmath=False)(kernel)

    def tiled(self, part: np.ndarray, groups: int) -> np.ndarray:
        """[tile, row, group · LANES + lane] of an array [row, group · n + column]; column -1 repeats the last one."""
        rows = part.reshape(part.shape[0], groups, -1)[:, :, self.columns]
        return np.ascontiguousarray(np.moveaxis(rows, 2, 0).reshape(self.count, part.shape[0], groups * LANES))

    def integrate(self, k: int, tick: float, dt: float = DEFAULT_STEP, *, ticks: int = 1) -> None:
        """Motion of `ticks` ticks with the commands in force at tick k; returns before the GPU is ready."""
        p = self.parts
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", NumbaPerformanceWarning)
            self.kernel[self.count, LANES](
                *self.fixed, self.commands, k, tick, dt, steps_of(tick, dt), ticks, p["state"], p["wheels"], p["ground"],
                self.contact, p["parameter"], self.command,
            )  # fmt: skip

    def synchronize(self) -> None:
        """Waits for the GPU."""
        cuda.synchronize()

    def fetch(self, fleet: Fleet) -> None:
        """State and wheels as they are on the GPU."""
        exists = self.columns >= 0
        for part, name, groups in ((fleet.state, "state", 1), (fleet.wheels, "wheels", 4)):
            tiles = self.parts[name].copy_to_host().reshape(self.count, part.shape[0], groups, LANES)
            part.reshape(part.shape[0], groups, -1)[:, :, self.columns[exists]] = np.moveaxis(tiles, 0, 2)[:, :, exists]
