"""The clock of a run: as fast as possible, or paced against real time."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from math import inf

from studio.execution.simulation import Simulation

REPORT_EVERY = 100  # ticks between two reports of progress
LONGEST_DEBT = 0.25  # [s] real time that a slow machine is allowed to owe before the pace gives in
SLOWEST, FASTEST = 0.05, 8.0


def as_fast_as_possible(simulation: Simulation, progress: Callable[[float], None] = lambda share: None) -> None:
    """Runs to the end; `progress` gets the share done, 0 to 1."""
    while not simulation.is_over:
        simulation.advance(REPORT_EVERY)
        progress(min(simulation.world.clock.k / simulation.ticks, 1.0))
    progress(1.0)


@dataclass
class Pace:
    """Real time against simulated time. `factor` is simulated over real seconds, infinite for as fast as possible."""

    factor: float = 1.0
    simulated: float = 0.0
    clock: Callable[[], float] = time.perf_counter  # real time [s]
    real: float = field(init=False)

    def __post_init__(self) -> None:
        self.restart(self.simulated)

    def restart(self, simulated: float) -> None:
        """Counts from now: after a pause, or when the factor has changed."""
        self.real, self.simulated = self.clock(), simulated

    def wait(self, simulated: float) -> float:
        """Seconds of real time until the simulated time is due; zero when it is."""
        if self.factor == inf:
            return 0.0
        due = self.real + (simulated - self.simulated) / self.factor
        early = due - self.clock()
        if early < -LONGEST_DEBT:
            self.restart(simulated)
        return max(early, 0.0)
