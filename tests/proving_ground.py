"""An open plane without drivers: equal cars with constant commands, for closed forms and references."""

import numpy as np

from studio.scenario import catalogue
from studio.world import fleet
from studio.world.fleet import Start
from studio.world.state import (
    C_D, C_ROLL, GEAR, J_GEAR, NEXT_GEAR, NEXT_RATIO, RATIO, RING, SLOPE_X, U_APPLIED, U_APPLIED_BRAKE, U_BRAKE, U_DRIVE, U_ENGINE, U_GEAR, U_PEDAL, U_STEER,
)  # fmt: skip

TICK = 0.02
ROWS = {
    "steering": U_STEER, "drive": U_DRIVE, "brake": U_BRAKE, "pedal": U_PEDAL, "engine": U_ENGINE, "gear": U_GEAR,
    "applied_drive": U_APPLIED, "applied_brake": U_APPLIED_BRAKE,
}  # fmt: skip


class Ground:
    """n equal cars that roll east at `speed` [m/s]; in neutral, unless `powertrain`.

    resistances=False: no air drag, no rolling resistance. slope: rise of the road ahead [1]. friction [1].
    """

    def __init__(
        self, model="bmw_320i", *, n=1, speed=20.0, resistances=True, powertrain=False, slope=0.0, friction=1.0, step=0.005, changes=None
    ):  # fmt: skip
        self.n, self.step, self.k = n, step, 0
        self.model = catalogue.find_vehicle(model, changes or {})
        ground = fleet.level_ground(n, friction=friction)
        ground[SLOPE_X] = slope
        self.fleet = fleet.fleet([Start(self.model, 0.0, 0.0, 0.0, speed)] * n, ground=ground)
        if not resistances:
            self.parameter[[C_D, C_ROLL]] = 0.0
        if not powertrain:
            self.state[[GEAR, NEXT_GEAR, RATIO, NEXT_RATIO, J_GEAR]] = 0.0
            self.command(gear=0.0)

    state = property(lambda self: self.fleet.state)
    wheels = property(lambda self: self.fleet.wheels)
    parameter = property(lambda self: self.fleet.parameter)
    p = property(lambda self: self.fleet.parameter[:, 0])

    def command(self, **values):
        """Constant commands from now on, past ones too: no dead time is left. Names as in ROWS."""
        for name, value in values.items():
            self.fleet.commands[ROWS[name]] = np.tile(np.broadcast_to(value, self.n), RING)
        return self

    def run(self, seconds, before_tick=lambda ground: None):
        """Advances; `before_tick` may change commands."""
        for _ in range(round(seconds / TICK)):
            before_tick(self)
            fleet.advance(self.fleet, self.k, TICK, self.step)
            self.k += 1
        return self

    def wheel(self, row, v=0):
        """A row of the four wheels of one car."""
        return self.wheels[row].reshape(4, self.n)[:, v]

    def __getitem__(self, row):
        return self.state[row, 0]
