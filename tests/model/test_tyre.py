"""The tyre against another program's forces, and against what its own coefficients say."""

import csv
import gzip
from math import radians, sin, tan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.model import tyre
from studio.model.tyre import Tyre
from studio.scenario import catalogue

FOLDER = "tests/reference"


@pytest.fixture(scope="module")
def measured_tyre(root):
    given_coefficients = catalogue.read_tyre(root / FOLDER / "MagicFormula52_Parameters.tir")
    return Tyre(*[given_coefficients[name] for name in Tyre._fields])


@pytest.fixture(scope="module")
def passenger_tyre():
    return Tyre(*catalogue.tyre_coefficients("passenger_car", Tyre._fields))


def test_forces_of_another_program(measured_tyre, root):
    """All 495 rows, pure and combined slip with camber: within 0.1 % or 1 N."""
    with gzip.open(root / FOLDER / "mfeval_MagicFormula52_opentire.csv.gz", "rt") as rows:
        table = list(csv.DictReader(rows))
    assert len(table) == 495
    for row in table:
        kappa, alpha, gamma, F_z = (float(row[name]) for name in ("kappa", "alpha_rad", "gamma_rad", "Fz_N"))
        F_x, F_y = tyre.forces(measured_tyre, kappa, tan(alpha), sin(gamma), F_z, 1.0)
        assert pytest.approx(float(row["Fx_N"]), rel=1e-3, abs=1.0) == F_x
        assert pytest.approx(float(row["Fy_N"]), rel=1e-3, abs=1.0) == F_y


def test_slopes_at_the_origin(passenger_tyre):
    """BCD is the slope: the stiffness functions are the derivatives of the forces."""
    t, F_z, h = passenger_tyre, 3000.0, 1e-5
    slope_x = (tyre.longitudinal_pure(t, h, 0.0, F_z, 1.0) - tyre.longitudinal_pure(t, -h, 0.0, F_z, 1.0)) / (2 * h)
    slope_y = (tyre.lateral_pure(t, h, 0.0, F_z, 1.0) - tyre.lateral_pure(t, -h, 0.0, F_z, 1.0)) / (2 * h)
    assert slope_x == pytest.approx(tyre.slip_stiffness(t, F_z), rel=1e-4)
    assert slope_y == pytest.approx(tyre.cornering_stiffness(t, 0.0, F_z), rel=1e-4)


def test_peak_is_friction_times_load(passenger_tyre):
    """At the nominal load the peak of F_x is PDX1 F_z, and twice the road friction doubles it."""
    t = passenger_tyre
    slips = np.linspace(0.0, 0.5, 2001)
    peak = max(tyre.longitudinal_pure(t, kappa, 0.0, t.FNOMIN, 1.0) for kappa in slips)
    assert peak == pytest.approx(t.PDX1 * t.FNOMIN, rel=1e-4)
    slippery = max(tyre.longitudinal_pure(t, kappa, 0.0, t.FNOMIN, 0.5) for kappa in slips)
    assert slippery == pytest.approx(0.5 * peak, rel=1e-4)


@given(kappa=st.floats(-1, 1), alpha=st.floats(-0.5, 0.5), F_z=st.floats(0, 9000))
def test_a_symmetric_tyre_is_symmetric(kappa, alpha, F_z):
    """Without shifts, mirrored slip gives mirrored forces; no load, no force."""
    t = Tyre(*catalogue.tyre_coefficients("passenger_car", Tyre._fields))
    F_x, F_y = tyre.forces(t, kappa, alpha, 0.0, F_z, 1.0)
    mirrored_x, mirrored_y = tyre.forces(t, kappa, -alpha, 0.0, F_z, 1.0)
    assert mirrored_x == pytest.approx(F_x, rel=1e-9, abs=1e-6)
    # RVY4 to RVY6 turn a little of the longitudinal slip into side force: F_y itself is not odd in alpha alone
    assert abs(mirrored_y + F_y) <= 2.1 * abs(tyre.braking_side_force(t, kappa, alpha, 0.0, F_z, 1.0)) + 1e-6
    assert tyre.forces(t, kappa, alpha, 0.0, 0.0, 1.0) == (0.0, 0.0)


@given(kappa=st.floats(-1, 1), degrees=st.floats(-40, 40), F_z=st.floats(100, 9000))
def test_combined_slip_never_exceeds_pure_slip(kappa, degrees, F_z):
    """The weights take away, they do not add."""
    t = Tyre(*catalogue.tyre_coefficients("passenger_car", Tyre._fields))
    alpha = tan(radians(degrees))
    F_x, _ = tyre.forces(t, kappa, alpha, 0.0, F_z, 1.0)
    assert abs(F_x) <= abs(tyre.longitudinal_pure(t, kappa, 0.0, F_z, 1.0)) * (1 + 1e-9)
