"""An open plane without drivers: cars with constant commands, for closed forms and references."""

import numpy as np

from studio.scenario import catalogue
from studio.vehicle import fleet
from studio.vehicle.command import (
    RING,
    U_APPLIED,
    U_APPLIED_BRAKE,
    U_BRAKE,
    U_DRIVE,
    U_ENGINE,
    U_GEAR,
    U_PEDAL,
    U_STEER,
    U_STEER_TORQUE,
)  # fmt: skip
from studio.vehicle.contact import MU, SLOPE_X
from studio.vehicle.fleet import Start
from studio.vehicle.parameter import C_D, C_ROLL, IDLE, J_WF, J_WR, MASS, RADIUS
from studio.vehicle.state import GEAR, J_GEAR, NEXT_GEAR, NEXT_RATIO, OMEGA_E, RATIO, V_X

TICK = 0.02
MODELS = catalogue.vehicle_names()
FIGURES: list[str] = []  # what tests measured, for the end of the test run's output
ROWS = {
    "steering": U_STEER, "steering_torque": U_STEER_TORQUE, "drive": U_DRIVE, "brake": U_BRAKE, "pedal": U_PEDAL,
    "engine": U_ENGINE, "gear": U_GEAR, "applied_drive": U_APPLIED, "applied_brake": U_APPLIED_BRAKE,
}  # fmt: skip


class Ground:
    """Cars that roll east; in neutral, unless `powertrain`. Nothing is commanded at first.

    models: one name or a list, one each; n: so many of each. speed [m/s], slope (rise of the road ahead [1]) and friction [1]:
    one number or one for each car. resistances=False: no air drag, no rolling resistance. changes: of the models, by path. light: with the
    light dynamics.
    """

    def __init__(
        self, models="bmw_320i", *, n=1, speed=20.0, resistances=True, powertrain=False, slope=0.0, friction=1.0, step=0.005,
        tick=TICK, changes=None, light=False,
    ):  # fmt: skip
        names = [models] if isinstance(models, str) else list(models)
        found = {name: catalogue.find_vehicle(name, dict(changes or {})) for name in dict.fromkeys(names)}
        self.names = [name for name in names for _ in range(n)]
        self.models = [found[name] for name in self.names]
        self.n, self.step, self.tick, self.k = len(self.names), step, tick, 0
        ground = fleet.level_ground(self.n)
        ground[MU], ground[SLOPE_X] = np.tile(self.each(friction), 4), np.tile(self.each(slope), 4)
        starts = [Start(model, 0.0, 0.0, 0.0, v, light) for model, v in zip(self.models, self.each(speed), strict=True)]
        self.fleet = fleet.fleet(starts, ground=ground)
        if not resistances:
            self.parameter[[C_D, C_ROLL]] = 0.0
        if not powertrain:
            self.state[[GEAR, NEXT_GEAR, RATIO, NEXT_RATIO, J_GEAR]] = 0.0
            self.state[OMEGA_E] = self.parameter[IDLE]
            self.command(gear=0.0)

    state = property(lambda self: self.fleet.state)
    wheels = property(lambda self: self.fleet.wheels)
    parameter = property(lambda self: self.fleet.parameter)
    p = property(lambda self: self.fleet.parameter[:, 0])

    def each(self, value) -> np.ndarray:
        """One value for each car."""
        return np.broadcast_to(np.asarray(value, dtype=float), self.n)

    def command(self, **values):
        """Constant commands from now on, past ones too: no dead time is left. Names as in ROWS."""
        for name, value in values.items():
            self.fleet.commands[ROWS[name]] = np.tile(self.each(value), RING)
        return self

    def engage(self, gear):
        """Every car in a gear, which it keeps."""
        for v in range(self.n):
            fleet.engage(self.fleet, v, gear)
        return self.command(gear=float(gear))

    def put(self, row, corner, value):
        """Changes the ground under one wheel of every car."""
        self.fleet.ground[row, corner * self.n : (corner + 1) * self.n] = value
        return self

    def road(self, row, corner):
        """The ground under one wheel of the first car."""
        return self.fleet.ground[row, corner * self.n]

    def run(self, seconds, before_tick=lambda ground: None):
        """Advances; `before_tick` may change commands."""
        for _ in range(round(seconds / self.tick)):
            before_tick(self)
            fleet.advance(self.fleet, self.k, self.tick, self.step)
            self.k += 1
        return self

    def history(self, seconds, of, before_tick=lambda ground: None) -> np.ndarray:
        """Advances; what `of(ground)` is after every tick."""
        return np.array([of(self.run(self.tick, before_tick)) for _ in range(round(seconds / self.tick))])

    @property
    def time(self):
        """Seconds since the start."""
        return self.k * self.tick

    def wheel(self, row, v=0):
        """A row of the four wheels of one car."""
        return self.wheels[row].reshape(4, self.n)[:, v]

    def __getitem__(self, row):
        return self.state[row, 0]


def heavier(p) -> np.ndarray:
    """Mass [kg] that an acceleration works on: m + sum J/R², all wheels rolling."""
    return p[MASS] + 2.0 * (p[J_WF] + p[J_WR]) / p[RADIUS] ** 2


def hold_speed(v):
    """Speed control of the reference runs, u = 3 (v0 - v_x) [m/s²], as torque at the wheels: drive or brake."""

    def before_tick(ground):
        torque = 3.0 * (v - ground.state[V_X]) * ground.parameter[MASS] * ground.parameter[RADIUS]
        ground.command(applied_drive=np.maximum(torque, 0.0), applied_brake=np.maximum(-torque, 0.0))

    return before_tick
