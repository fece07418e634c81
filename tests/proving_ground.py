"""An open plane without drivers: cars with constant commands, for closed forms and references."""

import numpy as np

from studio.model.tyre import Tyre
from studio.scenario import catalogue
from studio.world import motion
from studio.world.build import parameters_of
from studio.world.state import (
    ACTIVE,
    C_D,
    C_ROLL,
    COMMAND,
    CONTACT,
    OMEGA,
    RADIUS,
    RING,
    TORQUE_BRAKE,
    TORQUE_DRIVE,
    U_BRAKE,
    U_DRIVE,
    U_STEER,
    V_X,
    VEHICLE,
    WHEEL,
)

TICK = 0.02


class Ground:
    """n equal cars that roll at `speed` [m/s]; arrays as in the world, commands set by hand."""

    def __init__(self, model="bmw_320i", *, n=1, speed=20.0, resistances=True, step=0.005):
        self.n, self.step, self.k = n, step, 0
        self.parameter = np.tile(np.array(parameters_of(model))[:, None], n)
        if not resistances:
            self.parameter[[C_D, C_ROLL]] = 0.0
        tyre = catalogue.find_vehicle(model).tyre
        self.tyres = np.array([catalogue.tyre_coefficients(tyre, Tyre._fields)]).T.copy()
        self.tyre_of = np.zeros(n, dtype=np.int64)
        self.state = np.zeros((len(VEHICLE), n))
        self.state[V_X] = speed
        self.state[ACTIVE] = 1.0
        self.wheels = np.zeros((len(WHEEL), 4 * n))
        self.wheels[OMEGA] = np.tile(self.state[V_X] / self.parameter[RADIUS], 4)
        self.contact = np.zeros((len(CONTACT), 4 * n))
        self.commands = np.zeros((len(COMMAND), RING * n))

    def command(self, *, steering=None, drive=None, brake=None):
        """Constant commands from now on, past ones too: no dead time is left."""
        for row, value in ((U_STEER, steering), (U_DRIVE, drive), (U_BRAKE, brake)):
            if value is not None:
                self.commands[row] = np.tile(np.broadcast_to(value, self.n), RING)
        return self

    def hold(self, *, drive, brake):
        """Actuators that have settled at these torques [Nm]."""
        self.command(drive=drive, brake=brake)
        self.state[TORQUE_DRIVE], self.state[TORQUE_BRAKE] = drive, brake
        return self

    def run(self, seconds, before_tick=lambda ground: None):
        """Advances; `before_tick` may change commands."""
        for _ in range(round(seconds / TICK)):
            before_tick(self)
            motion.integrate(
                self.state, self.parameter, self.tyres, self.tyre_of, self.wheels, self.contact, self.commands,
                self.k, TICK, self.step,
            )  # fmt: skip
            self.k += 1
        return self

    def __getitem__(self, row):
        return self.state[row, 0]


