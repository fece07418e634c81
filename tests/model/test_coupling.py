"""Clutch and converter: friction between two discs in closed form, and what no coupling may do."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.model import coupling
from studio.model.coupling import FIRM, STALL
from studio.scenario import catalogue

speeds = st.floats(0, 600)
DT, J_E, J_IN = 0.005, 0.2, 1.5
CONVERTERS = [name for name in catalogue.vehicle_names() if catalogue.find_vehicle(name).values.coupling.kind == "converter"]


NO_CONVERTER = (0.0,) * 6


def engaged(w_e, w_in, T_cap, T_net=0.0):
    """One step of two discs: engine and a gearbox without load; the torque, and both speeds afterwards."""
    D_e, D_in, T_c = coupling.join(w_e, w_in, T_net, 0.0, T_cap, 1.0, J_E, w_in, 1.0 / J_IN, NO_CONVERTER, DT)
    return T_c, w_e + D_e, w_in + D_in


@given(speeds, speeds, st.floats(-300, 300))
def test_a_strong_clutch_makes_both_sides_equally_fast(w_e, w_in, T_net):
    _, after_e, after_in = engaged(w_e, w_in, 1e9, T_net)
    assert after_e == pytest.approx(after_in, abs=1e-6)
    momentum = J_E * w_e + J_IN * w_in + DT * T_net
    assert J_E * after_e + J_IN * after_in == pytest.approx(momentum, rel=1e-9, abs=1e-9)


@given(speeds, speeds, st.floats(0, 500))
def test_a_slipping_clutch_is_coulomb_friction(w_e, w_in, T_cap):
    """It carries its capacity from the faster to the slower side, and destroys energy."""
    T_c, after_e, after_in = engaged(w_e, w_in, T_cap)
    assert abs(T_c) <= T_cap
    assert (after_e - after_in) * (w_e - w_in) >= -1e-6  # it never overtakes
    if abs(after_e - after_in) > 1e-6:
        assert T_c == T_cap * np.sign(w_e - w_in)
    before, after = J_E * w_e**2 + J_IN * w_in**2, J_E * after_e**2 + J_IN * after_in**2
    assert after <= before * (1.0 + 1e-12)


def test_two_discs_meet_in_closed_form():
    """t = dw/(T_cap (1/J_e + 1/J_in)), and then both have the common momentum's speed."""
    w_e, w_in, T_cap, steps = 300.0, 20.0, 90.0, 0
    expected = (w_e - w_in) / (T_cap * (1.0 / J_E + 1.0 / J_IN))
    common = (J_E * w_e + J_IN * w_in) / (J_E + J_IN)
    while w_e - w_in > 1e-9:
        _, w_e, w_in = engaged(w_e, w_in, T_cap)
        steps += 1
    assert steps * DT == pytest.approx(expected, abs=DT)
    assert (w_e, w_in) == pytest.approx((common, common))


def test_an_open_clutch_carries_nothing():
    T_c, w_e, w_in = engaged(300.0, 20.0, 0.0, T_net=50.0)
    assert (T_c, w_e, w_in) == (0.0, pytest.approx(300.0 + DT * 50.0 / J_E), 20.0)


def test_an_automated_clutch_lets_the_engine_rev_and_live():
    """Nothing below 0.85 of the idle speed, all from the launch speed on, straight between them."""
    idle, launch = 80.0, 200.0
    w = [0.8 * idle, STALL * idle, 0.5 * (STALL * idle + launch), launch, 2.0 * launch]
    assert [coupling.capacity(1.0, 300.0, each, idle, launch) for each in w] == pytest.approx([0.0, 0.0, 150.0, 300.0, 300.0])
    assert coupling.capacity(0.25, 300.0, 2.0 * launch, idle, launch) == pytest.approx(75.0)
    assert coupling.capacity(1.0, 300.0, FIRM * idle, idle, idle) == pytest.approx(300.0)  # pedal lifted


def torques(name, ratio, w_e=250.0):
    c = catalogue.find_vehicle(name).values.coupling
    return np.array(coupling.converter(w_e, ratio * w_e, *c.pump, *c.turbine, *c.fluid, c.coupling_ratio)[:2]) / w_e**2


@pytest.mark.parametrize("name", CONVERTERS)
def test_a_converter_in_its_three_points(name):
    """At stall it multiplies the torque, at the coupling ratio it goes over into a fluid coupling, at equal speeds it rests."""
    c = catalogue.find_vehicle(name).values.coupling
    assert torques(name, 0.0) == pytest.approx([c.pump[0], c.turbine[0]])
    assert 1.3 < c.turbine[0] / c.pump[0] < 3.0
    below, above = torques(name, c.coupling_ratio), torques(name, c.coupling_ratio + 1e-9)
    assert above[0] == above[1] and below == pytest.approx(above, rel=2e-3)
    assert abs(torques(name, 1.0)[0]) < 0.01 * c.pump[0]


@pytest.mark.parametrize("name", CONVERTERS)
@pytest.mark.parametrize("ratio", np.linspace(0.0, 1.0, 21))
def test_a_converter_gives_no_more_power_than_it_takes(name, ratio):
    T_p, T_t = torques(name, ratio)
    assert T_t * ratio <= T_p + 1e-5 * abs(torques(name, 0.0)[0])


def test_a_converter_grows_with_the_square_of_the_speed():
    assert torques("bmw_320i", 0.4, 100.0) == pytest.approx(torques("bmw_320i", 0.4, 300.0))


def at(name, w_e, w_t):
    """All six of a converter."""
    c = catalogue.find_vehicle(name).values.coupling
    return coupling.converter(w_e, w_t, *c.pump, *c.turbine, *c.fluid, c.coupling_ratio)


@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.7, 0.95, 1.2])
def test_slopes_are_those_of_the_torques(ratio):
    """By finite differences; what would feed the step with energy is left out: P_e >= 0, Q_t <= 0."""
    w_e, w_t, h = 300.0, ratio * 300.0, 1e-3
    by_e = (np.array(at("suv", w_e + h, w_t)[:2]) - at("suv", w_e - h, w_t)[:2]) / (2 * h)
    by_t = (np.array(at("suv", w_e, w_t + h)[:2]) - at("suv", w_e, max(w_t - h, 0.0))[:2]) / (2 * h if ratio else h)
    _, _, P_e, P_t, Q_e, Q_t = at("suv", w_e, w_t)
    assert (P_e, Q_e) == pytest.approx((max(by_e[0], 0.0), by_e[1]), rel=1e-4, abs=1e-4)
    if ratio:
        assert (P_t, Q_t) == pytest.approx((by_t[0], min(by_t[1], 0.0)), rel=1e-4, abs=1e-4)


def test_a_turbine_turned_backwards_is_taken_as_standing():
    assert at("bmw_320i", 200.0, -50.0)[:2] == at("bmw_320i", 200.0, 0.0)[:2]


@given(st.floats(60, 600), st.floats(0, 700), st.floats(-50, 300), st.floats(0, 400), st.floats(0.01, 20))
def test_a_step_solves_converter_and_clutch_together(w_e, w_t, T_e, T_cap, M):
    """The two linear equations of the docstring hold with the torque that the clutch carries, and so does Coulomb's law."""
    eta, T_loss, A = 0.95, 2.0, w_t - 0.3
    T_p, T_t, P_e, P_t, Q_e, Q_t = torques = at("ford_escort", w_e, w_t)
    D_e, D_t, T_in = coupling.join(w_e, w_t, T_e, T_loss, T_cap, eta, J_E, A, M, torques, DT)
    T_c = T_in - (T_t + Q_e * D_e + Q_t * D_t)
    assert (J_E / DT + P_e) * D_e + P_t * D_t == pytest.approx(T_e - T_p - T_c, rel=1e-6, abs=1e-6)
    assert D_t == pytest.approx(A - w_t + M * DT * (eta * T_in - T_loss), rel=1e-6, abs=1e-6)
    assert abs(T_c) <= T_cap * (1 + 1e-9) + 1e-6
    if abs(T_c) < T_cap - 1e-6:
        assert w_e + D_e == pytest.approx(w_t + D_t, abs=1e-6)


@pytest.mark.parametrize("M", [0.05, 1.0, 40.0])
def test_a_converter_is_stable_however_light_its_load(M):
    """Wheels that spin on ice are light (M [1/(kg m²)]): both speeds meet the coupling point and stay, from either side."""
    for w_t in (0.0, 600.0):
        w_e = 150.0
        for _ in range(20_000):
            D_e, D_t, _ = coupling.join(w_e, w_t, 0.0, 0.0, 0.0, 1.0, J_E, w_t, M, at("suv", w_e, w_t), DT)
            w_e, w_t = w_e + D_e, w_t + D_t
            assert 0.0 <= w_e < 700.0 and 0.0 <= w_t < 700.0
        assert w_t / w_e == pytest.approx(1.0, abs=0.02)
