"""The tyre against another program's forces, against closed forms, and against what its own coefficients say."""

import csv
import gzip
from math import atan, cos, pi, radians, sin, tan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.model import tyre
from studio.model.tyre import Tyre
from studio.rig.tyre import sweep
from studio.scenario import tir
from tests.conftest import ROOT

FOLDER = ROOT / "tests" / "reference"
PAIRS = {
    "mfeval_MagicFormula52": "MagicFormula52_Parameters",
    "chrono_uazbus": "UAZBUS_Pac02Tire",
    "chrono_vw_microbus_185_80R14": "mf_185_80R14",
    "chrono_sedan_245_40R18": "Sedan_Pac02Tire",
}
SCALING = [name for name in Tyre._fields if name.startswith("L")]


slips = st.floats(-1, 1)
angles = st.floats(-0.6, 0.6)
cambers = st.floats(-0.1, 0.1)
loads = st.floats(100, 9000)


def tyre_of(path) -> Tyre:
    return Tyre(*tir.coefficients(tir.read(path)))


MEASURED = tyre_of(FOLDER / "MagicFormula52_Parameters.tir")
PASSENGER = tyre_of(ROOT / "studio" / "scenario" / "tyres" / "passenger_car.tir")
TYRES = [tyre_of(FOLDER / f"{name}.tir") for name in PAIRS.values()]
# A tyre without conicity and ply-steer: everything that tells left from right is 0, camber is not.
EVEN = MEASURED._replace(
    **dict.fromkeys(["PEY3", "PHY1", "PHY2", "PVY1", "PVY2", "RHX1", "RBY3", "RVY1", "RVY2"], 0.0),
    **dict.fromkeys(["QBZ4", "QDZ3", "QDZ6", "QDZ7", "QEZ4", "QHZ1", "QHZ2", "SSZ1"], 0.0),
)


def braking_side_force(t, kappa, alpha, gamma, F_z, mu):
    """S_Vy,kappa [N] (4.E66, 4.E67): side force that longitudinal slip itself makes."""
    df_z = tyre.load_change(t, F_z)
    mu_y = tyre.lateral_factors(t, gamma, df_z, mu).mu
    return F_z * tyre.braking_side_per_load(t, kappa, alpha, gamma, df_z, mu_y)


@pytest.fixture(scope="module", params=PAIRS, ids=PAIRS)
def reference(request):
    """A tyre with LFZO = 1, and 495 rows of forces that another program computed for it."""
    with gzip.open(FOLDER / f"{request.param}_opentire.csv.gz", "rt") as rows:
        table = list(csv.DictReader(rows))
    columns = {name: np.array([float(row[name]) for row in table]) for name in table[0]}
    return tyre_of(FOLDER / f"{PAIRS[request.param]}.tir")._replace(LFZO=1.0), columns


# --- another program ---------------------------------------------------------------------------------------------------


def test_forces_of_another_program(reference):
    """All rows, pure and combined slip with camber: within the rounding of the file, M_z within 0.1 Nm.

    M_z differs because the other program takes the cosine of tan(alpha) in place of the cosine of alpha.
    """
    t, rows = reference
    assert rows["kappa"].size == 495
    F_x, F_y, M_z = sweep(t, rows["kappa"], rows["alpha_rad"], rows["gamma_rad"], rows["Fz_N"])
    assert np.max(np.abs(F_x - rows["Fx_N"])) < 1e-3
    assert np.max(np.abs(F_y - rows["Fy_N"])) < 1e-3
    assert np.max(np.abs(M_z - rows["Mz_Nm"])) < 0.1


def test_pure_slip_of_another_program(reference):
    t, rows = reference
    inputs = zip(rows["kappa"], np.tan(rows["alpha_rad"]), np.sin(rows["gamma_rad"]), rows["Fz_N"], strict=True)
    for i, (kappa, alpha, gamma, F_z) in enumerate(inputs):
        if i % 5 == 0:
            assert tyre.longitudinal_pure(t, kappa, gamma, F_z, 1.0) == pytest.approx(rows["Fx0_N"][i], abs=1e-3)
            assert tyre.lateral_pure(t, alpha, gamma, F_z, 1.0) == pytest.approx(rows["Fy0_N"][i], abs=1e-3)


# --- slopes, peaks, shapes ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("t", TYRES, ids=list(PAIRS))
@given(gamma=cambers, F_z=loads)
def test_slopes_at_the_origin(t, gamma, F_z):
    """BCD is the slope: the stiffness functions are the derivatives of the forces where the shifted slip is 0."""
    h, df_z = 1e-6, tyre.load_change(t, F_z)
    x, y = tyre.longitudinal_factors(t, gamma, df_z, 1.0), tyre.lateral_factors(t, gamma, df_z, 1.0)
    rise_x = [tyre.longitudinal_pure(t, slip - x.S_H, gamma, F_z, 1.0) for slip in (-h, h)]
    rise_y = [tyre.lateral_pure(t, slip - y.S_H, gamma, F_z, 1.0) for slip in (-h, h)]
    assert (rise_x[1] - rise_x[0]) / (2 * h) == pytest.approx(tyre.slip_stiffness(t, F_z), rel=1e-4)
    assert (rise_y[1] - rise_y[0]) / (2 * h) == pytest.approx(tyre.cornering_stiffness(t, gamma, F_z), rel=1e-4)


def test_stiffness_is_greatest_at_its_load():
    """K_y peaks at PKY2 times the nominal load, with PKY1 times the nominal load (4.E25)."""
    F_z0 = MEASURED.FNOMIN * MEASURED.LFZO
    at = MEASURED.PKY2 * F_z0
    assert tyre.cornering_stiffness(MEASURED, 0.0, at) == pytest.approx(MEASURED.PKY1 * F_z0, rel=1e-12)
    assert abs(tyre.cornering_stiffness(MEASURED, 0.0, 0.9 * at)) < abs(MEASURED.PKY1 * F_z0)
    assert abs(tyre.cornering_stiffness(MEASURED, 0.0, 1.1 * at)) < abs(MEASURED.PKY1 * F_z0)


def test_peak_is_friction_times_load():
    """At the nominal load the peak of F_x is PDX1 F_z, and half the road friction halves it."""
    t = PASSENGER
    grid = np.linspace(0.0, 0.5, 2001)
    peak = max(tyre.longitudinal_pure(t, kappa, 0.0, t.FNOMIN, 1.0) for kappa in grid)
    assert peak == pytest.approx(t.PDX1 * t.FNOMIN, rel=1e-4)
    slippery = max(tyre.longitudinal_pure(t, kappa, 0.0, t.FNOMIN, 0.5) for kappa in grid)
    assert slippery == pytest.approx(0.5 * peak, rel=1e-4)


def test_shape_factors_set_the_sliding_force():
    """Far beyond the peak the force is D sin(C pi/2) (4.E9): with LCX and LCY it follows their C."""
    t = PASSENGER._replace(LCX=0.9, LCY=1.2)
    F_x = tyre.longitudinal_pure(t, 1e9, 0.0, t.FNOMIN, 1.0)
    F_y = tyre.lateral_pure(t, -1e9, 0.0, t.FNOMIN, 1.0)
    assert F_x == pytest.approx(t.PDX1 * t.FNOMIN * sin(0.9 * t.PCX1 * pi / 2), rel=1e-6)
    assert F_y == pytest.approx(t.PDY1 * t.FNOMIN * sin(1.2 * t.PCY1 * pi / 2), rel=1e-6)


def test_curvature_factors_bend_the_curve():
    """Without curvature (LEX = LEY = 0) a force is D sin(C atan(B x)) with B = K/(C D)."""
    t, slip, F_z = PASSENGER._replace(LEX=0.0, LEY=0.0), 0.07, 3000.0
    D_x, D_y = t.PDX1 * F_z, t.PDY1 * F_z
    B_x, B_y = (
        tyre.slip_stiffness(t, F_z) / (t.PCX1 * D_x),
        tyre.cornering_stiffness(t, 0.0, F_z) / (t.PCY1 * D_y),
    )
    F_x, F_y = tyre.longitudinal_pure(t, slip, 0.0, F_z, 1.0), tyre.lateral_pure(t, slip, 0.0, F_z, 1.0)
    assert F_x == pytest.approx(D_x * sin(t.PCX1 * atan(B_x * slip)), rel=1e-8)
    assert F_y == pytest.approx(D_y * sin(t.PCY1 * atan(B_y * slip)), rel=1e-8)


def test_curvature_is_at_most_one():
    """Beyond 1 the curve would turn back: a larger E counts as 1 (4.E14, 4.E24, 4.E56, 4.E64)."""
    large, one = (MEASURED._replace(REX1=e, REX2=0.0, REY1=e, REY2=0.0) for e in (5.0, 1.0))
    assert tyre.longitudinal_curvature(MEASURED._replace(PEX1=50.0), 0.0, 0.1) == 1.0
    assert tyre.lateral_curvature(MEASURED._replace(PEY1=50.0), 0.0, 0.0, 0.1) == 1.0
    assert tyre.longitudinal_weight(large, 0.1, 0.2, 4000.0) == tyre.longitudinal_weight(one, 0.1, 0.2, 4000.0)
    assert tyre.lateral_weight(large, 0.1, 0.2, 4000.0) == tyre.lateral_weight(one, 0.1, 0.2, 4000.0)


# --- scaling factors ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SCALING)
def test_every_scaling_factor_scales(name):
    scaled = MEASURED._replace(**{name: 0.8})
    assert sweep(scaled, 0.05, 0.06, 0.03, 8000.0) != pytest.approx(sweep(MEASURED, 0.05, 0.06, 0.03, 8000.0), rel=1e-4)


@given(factor=st.floats(0.5, 2.0), kappa=slips, alpha=angles, gamma=cambers, F_z=loads)
def test_nominal_load(factor, kappa, alpha, gamma, F_z):
    """LFZO FNOMIN is the nominal load: a tyre with LFZO behaves as one with another FNOMIN (4.E1)."""
    scaled, other = MEASURED._replace(LFZO=factor), MEASURED._replace(FNOMIN=factor * MEASURED.FNOMIN)
    F_z0 = factor * MEASURED.FNOMIN
    assert tyre.load_change(scaled, F_z) == pytest.approx((F_z - F_z0) / F_z0, abs=1e-12)
    expected = tyre.forces(other, kappa, alpha, gamma, F_z, 1.0)
    assert tyre.forces(scaled, kappa, alpha, gamma, F_z, 1.0) == pytest.approx(expected, rel=1e-9, abs=1e-6)


@given(mu=st.floats(0.1, 1.2), kappa=slips, alpha=angles, gamma=cambers, F_z=loads)
def test_road_friction_is_a_scaling_factor(mu, kappa, alpha, gamma, F_z):
    """A slippery road is a tyre with smaller LMUX and LMUY."""
    scaled = tyre.forces(MEASURED._replace(LMUX=mu, LMUY=mu), kappa, alpha, gamma, F_z, 1.0)
    assert tyre.forces(MEASURED, kappa, alpha, gamma, F_z, mu) == pytest.approx(scaled, rel=1e-9, abs=1e-9)


def test_stiffness_factors():
    t = MEASURED._replace(LKX=2.0, LKY=3.0)
    assert tyre.slip_stiffness(t, 5000.0) == pytest.approx(2.0 * tyre.slip_stiffness(MEASURED, 5000.0), rel=1e-12)
    assert tyre.cornering_stiffness(t, 0.02, 5000.0) == pytest.approx(3.0 * tyre.cornering_stiffness(MEASURED, 0.02, 5000.0), rel=1e-12)


def test_camber_factors():
    """Without LGAX, LGAY camber does not reach the force in pure slip; LGAZ = 0 takes it out of the trail."""
    t = MEASURED._replace(LGAX=0.0, LGAY=0.0, LGAZ=0.0)
    assert tyre.longitudinal_pure(t, 0.1, 0.05, 5000.0, 1.0) == tyre.longitudinal_pure(t, 0.1, 0.0, 5000.0, 1.0)
    assert tyre.lateral_pure(t, 0.1, 0.05, 5000.0, 1.0) == tyre.lateral_pure(t, 0.1, 0.0, 5000.0, 1.0)
    assert tyre.trail(t, 0.1, 0.05, 0.0, 1.0, 0.0) == tyre.trail(t, 0.1, 0.0, 0.0, 1.0, 0.0)


def test_camber_that_no_factor_scales():
    """RVY3 and SSZ3 belong to the camber itself (4.E67, 4.E76)."""
    level = MEASURED._replace(PDY3=0.0)
    scaled = level._replace(LGAY=0.5, LGAZ=0.5)
    given_force = braking_side_force(level, 0.1, 0.05, 0.05, 5000.0, 1.0)
    assert braking_side_force(scaled, 0.1, 0.05, 0.05, 5000.0, 1.0) == given_force
    assert tyre.moment_arm(scaled, 0.05, 0.1, 1000.0) == tyre.moment_arm(level, 0.05, 0.1, 1000.0)


def test_shift_factors():
    """Without shifts an upright tyre that rolls freely makes no force."""
    t = MEASURED._replace(LHX=0.0, LVX=0.0, LHY=0.0, LVY=0.0, LVYKA=0.0)
    assert tyre.forces(t, 0.0, 0.0, 0.0, 5000.0, 1.0)[:2] == (0.0, 0.0)


def test_combined_factors():
    """Without LXAL, LYKA, LVYKA combined slip is pure slip."""
    t, kappa, alpha, gamma, F_z = MEASURED._replace(LXAL=0.0, LYKA=0.0, LVYKA=0.0), 0.1, 0.08, 0.03, 6000.0
    F_x, F_y, _ = tyre.forces(t, kappa, alpha, gamma, F_z, 1.0)
    assert F_x == pytest.approx(tyre.longitudinal_pure(t, kappa, gamma, F_z, 1.0), rel=1e-12)
    assert F_y == pytest.approx(tyre.lateral_pure(t, alpha, gamma, F_z, 1.0), rel=1e-12)


def test_parts_of_the_aligning_moment():
    """M_z is the sum of trail, residual moment and moment arm, each with its factor (4.E71)."""
    t, kappa, alpha, F_z = TYRES[2], 0.05, 0.03, 4000.0

    def moment(**factors):
        return tyre.forces(t._replace(**factors), kappa, alpha, 0.0, F_z, 1.0)[2]

    none = {"LTR": 0.0, "LRES": 0.0, "LS": 0.0}
    parts = [moment(**{**none, name: 1.0}) for name in none]
    assert moment(**none) == 0.0
    assert all(abs(part) > 1.0 for part in parts)
    assert sum(parts) == pytest.approx(moment(), rel=1e-9)


# --- groups that a file may lack ---------------------------------------------------------------------------------------


def without(t, *prefixes):
    return t._replace(**{name: 0.0 for name in Tyre._fields if name.startswith(prefixes)})


@given(kappa=slips, alpha=angles, gamma=cambers, F_z=loads)
def test_zeros_switch_groups_off(kappa, alpha, gamma, F_z):
    bare = without(MEASURED, "R", "Q", "SSZ")
    F_x, F_y, M_z = tyre.forces(bare, kappa, alpha, gamma, F_z, 1.0)
    assert F_x == pytest.approx(tyre.longitudinal_pure(MEASURED, kappa, gamma, F_z, 1.0), rel=1e-12)
    assert F_y == pytest.approx(tyre.lateral_pure(MEASURED, alpha, gamma, F_z, 1.0), rel=1e-12)
    assert M_z == 0.0


# --- invariants --------------------------------------------------------------------------------------------------------


@given(kappa=slips, alpha=angles, gamma=cambers, F_z=st.floats(0, 9000), mu=st.floats(0.1, 1.2))
def test_a_mirrored_tyre(kappa, alpha, gamma, F_z, mu):
    """What does not tell left from right gives mirrored forces for mirrored slip and camber."""
    F_x, F_y, M_z = tyre.forces(EVEN, kappa, alpha, gamma, F_z, mu)
    mirrored_x, mirrored_y, mirrored_z = tyre.forces(EVEN, kappa, -alpha, -gamma, F_z, mu)
    assert mirrored_x == pytest.approx(F_x, rel=1e-9, abs=1e-6)
    assert -mirrored_y == pytest.approx(F_y, rel=1e-9, abs=1e-6)
    assert -mirrored_z == pytest.approx(M_z, rel=1e-9, abs=1e-6)


@given(kappa=slips, alpha=angles, gamma=cambers)
def test_no_load_no_force(kappa, alpha, gamma):
    """Exactly none at no load; near it in proportion to the load."""
    assert tyre.forces(MEASURED, kappa, alpha, gamma, 0.0, 1.0) == (0.0, 0.0, 0.0)
    light = np.array(tyre.forces(MEASURED, kappa, alpha, gamma, 1e-6, 1.0))
    lighter = np.array(tyre.forces(MEASURED, kappa, alpha, gamma, 1e-9, 1.0))
    assert light == pytest.approx(1e3 * lighter, rel=1e-3, abs=1e-14)


@given(kappa=slips, alpha=angles, gamma=cambers, F_z=loads)
def test_no_friction_no_force(kappa, alpha, gamma, F_z):
    assert tyre.forces(MEASURED, kappa, alpha, gamma, F_z, 0.0) == (0.0, 0.0, 0.0)


@given(kappa=slips, degrees=st.floats(-40, 40), F_z=loads)
def test_combined_slip_never_exceeds_pure_slip(kappa, degrees, F_z):
    """The weights take away, they do not add."""
    alpha = tan(radians(degrees))
    F_x = tyre.forces(PASSENGER, kappa, alpha, 0.0, F_z, 1.0)[0]
    assert abs(F_x) <= abs(tyre.longitudinal_pure(PASSENGER, kappa, 0.0, F_z, 1.0)) * (1 + 1e-9)


@pytest.mark.parametrize("t", TYRES, ids=list(PAIRS))
def test_far_outside_the_measured_range(t):
    """Locked, spinning and sideways wheels: finite, and no force beyond a few times the load."""
    for kappa in (-1e6, -1.0, 0.0, 1.0, 1e6):
        for alpha in (-1e9, -10.0, 0.0, 10.0, 1e9):
            F_x, F_y, M_z = tyre.forces(t, kappa, alpha, 0.0, 5000.0, 1.0)
            assert abs(F_x) < 3 * 5000.0 and abs(F_y) < 3 * 5000.0 and abs(M_z) < 0.5 * 5000.0


# --- the aligning moment -----------------------------------------------------------------------------------------------


def test_the_trail_turns_a_wheel_back():
    """At small side-slip F_y acts behind the wheel's centre: M_z opposes the side-slip angle."""
    for t in TYRES:
        F_y, M_z = tyre.forces(t, 0.0, tan(radians(3.0)), 0.0, t.FNOMIN, 1.0)[1:]
        assert F_y < 0.0 < M_z
        F_y, M_z = tyre.forces(t, 0.0, -tan(radians(3.0)), 0.0, t.FNOMIN, 1.0)[1:]
        assert F_y > 0.0 > M_z


def test_trail_at_its_peak():
    """Where the shifted slip is zero the trail is D_t = (F_z/F_z0) R_0 (QDZ1 + QDZ2 df_z) LTR (4.E42)."""
    t, df_z = MEASURED, 0.2
    alpha = -(t.QHZ1 + t.QHZ2 * df_z)
    expected = 1.2 * t.UNLOADED_RADIUS * (t.QDZ1 + t.QDZ2 * df_z)
    assert tyre.trail(t, alpha, 0.0, df_z, 1.0, 0.0) == pytest.approx(expected, rel=1e-12)


@given(x=st.floats(-0.3, 0.3))
def test_tangent_squared(x):
    assert tyre.tangent_squared(x) == pytest.approx(tan(x) ** 2, rel=3e-4, abs=1e-300)


@given(shifted=st.floats(-0.3, 0.3), slip=st.floats(-5, 5))
def test_equivalent_slip(shifted, slip):
    """The formula of MF-Tyre 5.2; with one kind of slip alone it is that slip's own angle."""
    expected = atan((tan(shifted) ** 2 + slip**2) ** 0.5)
    assert tyre.equivalent_slip(shifted, slip) == pytest.approx(expected, rel=2e-4, abs=1e-12)
    assert tyre.equivalent_slip(0.0, slip) == pytest.approx(atan(abs(slip)), rel=1e-9, abs=1e-12)
    assert tyre.equivalent_slip(shifted, 0.0) == pytest.approx(abs(shifted), rel=2e-4, abs=1e-12)


SCALED = MEASURED._replace(LKY=1.2, LMUY=0.7, LGAZ=0.8, LTR=0.9, LRES=1.1, QBZ10=0.6, QEZ3=0.4)


@given(
    alpha=st.floats(-0.25, 0.25),
    gamma=cambers,
    df_z=st.floats(-0.9, 1.5),
    mu=st.floats(0.3, 1.2),
    slip=st.floats(-1, 1),
)
def test_trail(alpha, gamma, df_z, mu, slip):
    """t/cos(alpha) (4.E33 to 4.E44) written out with the mathematics library."""
    t, gamma_z = SCALED, SCALED.LGAZ * gamma
    alpha_t = alpha + t.QHZ1 + t.QHZ2 * df_z + (t.QHZ3 + t.QHZ4 * df_z) * gamma_z
    B = (t.QBZ1 + t.QBZ2 * df_z + t.QBZ3 * df_z**2) * (1 + t.QBZ4 * gamma_z + t.QBZ5 * abs(gamma_z)) * t.LKY / (t.LMUY * mu)
    D = (1 + df_z) * (t.QDZ1 + t.QDZ2 * df_z) * (1 + t.QDZ3 * gamma_z + t.QDZ4 * gamma_z**2) * t.UNLOADED_RADIUS * t.LTR
    E = t.QEZ1 + t.QEZ2 * df_z + t.QEZ3 * df_z**2
    E = min(E * (1 + (t.QEZ4 + t.QEZ5 * gamma_z) * 2 / pi * atan(B * t.QCZ1 * alpha_t)), 1.0)
    z = B * tyre.equivalent_slip(alpha_t, slip)
    expected = D * cos(t.QCZ1 * atan(z - E * (z - atan(z))))
    assert tyre.trail(t, alpha, gamma, df_z, t.LKY / (t.LMUY * mu), slip) == pytest.approx(expected, rel=1e-8, abs=1e-10)


@given(
    alpha=st.floats(-0.25, 0.25),
    gamma=cambers,
    df_z=st.floats(-0.9, 1.5),
    mu=st.floats(0.3, 1.2),
    slip=st.floats(-1, 1),
)
def test_residual_moment(alpha, gamma, df_z, mu, slip):
    """M_zr/(F_z cos(alpha)) (4.E36 to 4.E47) written out with the mathematics library."""
    t, gamma_z = SCALED, SCALED.LGAZ * gamma
    y = tyre.lateral_factors(t, gamma, df_z, mu)
    softening = t.LKY / (t.LMUY * mu)
    B = t.QBZ9 * softening + t.QBZ10 * y.B * y.C
    D = ((t.QDZ6 + t.QDZ7 * df_z) * t.LRES + (t.QDZ8 + t.QDZ9 * df_z) * gamma_z) * t.UNLOADED_RADIUS * t.LMUY * mu
    expected = D * cos(atan(B * tyre.equivalent_slip(alpha + y.S_H + y.S_V / y.K, slip)))
    found = tyre.residual_per_load(t, y, alpha, gamma, df_z, mu, softening, 1.0 / y.K, slip)
    assert found == pytest.approx(expected, rel=1e-8, abs=1e-12)


@given(kappa=slips, alpha=angles, gamma=cambers, F_z=loads, mu=st.floats(0.3, 1.2))
def test_aligning_moment(kappa, alpha, gamma, F_z, mu):
    """M_z = (M_zr - t F'_y) cos(alpha) + s F_x (4.E71, 4.E72), put together from its parts."""
    t, df_z = SCALED, tyre.load_change(SCALED, F_z)
    y = tyre.lateral_factors(t, gamma, df_z, mu)
    slip = kappa * tyre.slip_stiffness(t, F_z) / tyre.cornering_stiffness(t, gamma, F_z)
    softening = t.LKY / (t.LMUY * mu)
    F_x, F_y, M_z = tyre.forces(t, kappa, alpha, gamma, F_z, mu)
    residual = F_z * tyre.residual_per_load(t, y, alpha, gamma, df_z, mu, softening, 1.0 / y.K, slip)
    F_y_weighted = F_y - braking_side_force(t, kappa, alpha, gamma, F_z, mu)
    turning = residual - tyre.trail(t, alpha, gamma, df_z, softening, slip) * F_y_weighted
    expected = turning * cos(atan(alpha)) + tyre.moment_arm(t, gamma, df_z, F_y) * F_x
    assert M_z == pytest.approx(expected, rel=1e-6, abs=1e-6)


def test_moment_arm():
    """s = R_0 (SSZ1 + SSZ2 F_y/F_z0 + (SSZ3 + SSZ4 df_z) gamma) LS (4.E76)."""
    t = MEASURED._replace(LFZO=0.8, LS=0.5)
    s = tyre.moment_arm(t, 0.03, 0.2, 2000.0)
    share = t.SSZ1 + t.SSZ2 * 2000.0 / (0.8 * t.FNOMIN) + (t.SSZ3 + t.SSZ4 * 0.2) * 0.03
    assert s == pytest.approx(0.5 * t.UNLOADED_RADIUS * share, rel=1e-12)


def test_weights_at_no_slip_are_one():
    for t in TYRES:
        assert tyre.longitudinal_weight(t, 0.2, 0.0, 4000.0) == pytest.approx(1.0, rel=1e-12)
        assert tyre.lateral_weight(t, 0.0, 0.2, 4000.0) == pytest.approx(1.0, rel=1e-12)


def test_braking_side_force():
    """S_Vy,kappa (4.E66, 4.E67) written out."""
    t, kappa, alpha, gamma, F_z = MEASURED, 0.05, 0.04, 0.02, 7000.0
    df_z = F_z / t.FNOMIN - 1.0
    mu_y = (t.PDY1 + t.PDY2 * df_z) * (1.0 - t.PDY3 * gamma**2)
    D = mu_y * F_z * (t.RVY1 + t.RVY2 * df_z + t.RVY3 * gamma) * cos(atan(t.RVY4 * alpha))
    expected = D * sin(t.RVY5 * atan(t.RVY6 * kappa))
    assert braking_side_force(t, kappa, alpha, gamma, F_z, 1.0) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("t", TYRES, ids=list(PAIRS))
@pytest.mark.parametrize("mu", [0.3, 1.0])
def test_a_tyre_slides_beyond_its_peak(t, mu):
    """Up to the slip of the greatest force it does not, and beyond it does, along and across."""
    slips = np.linspace(0.0, 3.0, 3001)
    for force, place in ((tyre.longitudinal_pure, lambda slip: (-slip, 0.0)), (tyre.lateral_pure, lambda slip: (0.0, slip))):
        forces = np.abs([force(t, -slip if force is tyre.longitudinal_pure else slip, 0.0, 4000.0, mu) for slip in slips])
        peak = int(forces.argmax())
        before, after = slips[max(peak - 3, 0)], slips[min(peak + 3, 3000)]
        assert not tyre.slides(t, *place(before), 4000.0, mu)
        assert tyre.slides(t, *place(after), 4000.0, mu) == (peak < 2998)
    assert not tyre.slides(t, -1.0, 0.0, 0.0, mu)
