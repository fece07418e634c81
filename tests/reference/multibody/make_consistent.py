"""Makes consistent_*.csv.gz: the sines and lane changes of the reference with its slip angles put right.

    uv run --no-project --with commonroad-vehicle-models==3.0.2 --with numpy python make_consistent.py

The multi-body model of commonroad-vehicle-models takes a wheel's slip angle from the lateral velocity of the body, x[10], though
the wheels have lateral velocities of their own, x[15] and x[20]: a body that rolls does not move its contact patches there. Here
the wheels' own velocities are taken. And the joints that let the body give way sideways are 100 times as stiff, as our model has
none. Without both changes this program reproduces the original files, which it checks first. RK4 at 1 ms, every 10 ms stored.
"""

import csv
import gzip
import math
import re
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
from omegaconf import OmegaConf
from vehiclemodels import vehicle_dynamics_mb
from vehiclemodels.init_mb import init_mb
from vehiclemodels.parameters_vehicle1 import parameters_vehicle1
from vehiclemodels.parameters_vehicle2 import parameters_vehicle2

HERE = Path(__file__).parent
CARS = {"ford_escort": parameters_vehicle1, "bmw_320i": parameters_vehicle2}
SHIFTS = [f"{force}_{kind}{k}" for force in ("p", "r") for kind in ("hx", "vx", "hy", "vy") for k in (1, 3)]
# Where a slip angle takes the body's lateral velocity, and the state that holds the wheels' own.
BODYS_VELOCITY = {r"x\[10\] \+ p\.a\*x\[5\](?= - x\[14\])": "x[15]", r"x\[10\] - p\.b\*x\[5\](?= - x\[19\])": "x[20]"}
STIFFER, DT, EVERY = 100.0, 0.001, 10
HEAD = ["t_s", "x_m", "y_m", "yaw_rate_rps", "ay_mps2", "roll_rad"]


def dynamics(consistent):
    """The right-hand side, as it is or with the wheels' own velocities."""
    source = Path(vehicle_dynamics_mb.__file__).read_text()
    for bodys, wheels in BODYS_VELOCITY.items() if consistent else ():
        source, found = re.subn(bodys, wheels, source)
        assert found == 2
    module = ModuleType("dynamics")
    exec(compile(source, "dynamics", "exec"), module.__dict__)
    return module.vehicle_dynamics_mb


def parameters(car, consistent):
    """Plain numbers; the tyre's shift terms are zero, as in the files."""
    p = CARS[car]()
    for name in vars(p.tire) if not hasattr(p.tire, "keys") else list(p.tire.keys()):
        if name.lower() in SHIFTS:
            setattr(p.tire, name, 0.0)
    p = to_namespace(OmegaConf.to_container(OmegaConf.structured(p)))
    if consistent:
        p.K_ras, p.K_rad = p.K_ras * STIFFER, p.K_rad * math.sqrt(STIFFER)
    return p


def to_namespace(value):
    return SimpleNamespace(**{key: to_namespace(each) for key, each in value.items()}) if isinstance(value, dict) else value


def driven(name, times, steers, speed, consistent):
    """Rows of HEAD."""
    car = name.split("_sym_")[0]
    right_side, p = dynamics(consistent), parameters(car, consistent)

    def slope(x, t):
        x = x.copy()
        x[2] = np.interp(t, times, steers)
        return np.array(right_side(list(x), [0.0, 3.0 * (speed - x[3])], p))

    x, rows = np.array(init_mb([0, 0, 0, speed, 0, 0, 0], p), dtype=float), []
    for k in range(round(times[-1] / DT) + 1):
        t, a = k * DT, slope(x, k * DT)
        if k % EVERY == 0:
            a_y = (p.m_s * a[10] + p.m_uf * a[15] + p.m_ur * a[20]) / p.m + x[5] * x[3]
            rows.append([t, x[0], x[1], x[5], a_y, x[6]])
        b = slope(x + 0.5 * DT * a, t + 0.5 * DT)
        c = slope(x + 0.5 * DT * b, t + 0.5 * DT)
        x = x + DT / 6.0 * (a + 2.0 * b + 2.0 * c + slope(x + DT * c, t + DT))
    return np.array(rows)


def read(path):
    with gzip.open(path, "rt") as file:
        head, *rows = csv.reader(file)
    return dict(zip(head, np.array(rows, dtype=float).T, strict=True))


def main():
    for path in sorted(HERE.glob("*_sym_*.csv.gz")):
        name = path.name.removesuffix(".csv.gz")
        if "_sine_" not in name and "_dlc_" not in name:
            continue
        given = read(path)
        inputs = name, given["t_s"], given["delta_rad"], given["vx_mps"][0]
        for check, column in zip(driven(*inputs, False).T, HEAD, strict=True):
            off = np.abs(check - given[column])[given["t_s"] > 1.0].max()
            assert off < 2e-2 * max(np.abs(given[column]).max(), 0.01), (name, column, off)
        with gzip.open(HERE / f"consistent_{path.name}", "wt", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(HEAD)
            writer.writerows([[f"{value:.7g}" for value in row] for row in driven(*inputs, True)])
        print(name)


if __name__ == "__main__":
    main()
