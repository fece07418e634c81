"""Clutch and converter: friction between two discs in closed form, and what no coupling may do."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.model import coupling
from studio.scenario import catalogue

patient = settings(deadline=None)  # the first call compiles
speeds = st.floats(0, 600)
DT, J_E, J_IN = 0.005, 0.2, 1.5
CONVERTERS = [name for name in catalogue.vehicle_names() if catalogue.find_vehicle(name).values.coupling.kind == "converter"]


def engaged(w_e, w_in, T_cap, T_net=0.0):
    """One step of two discs: engine and a gearbox without load; the torque, and both speeds afterwards."""
    T_c = coupling.clutch(T_cap, w_e, T_net, J_E, w_in, 1.0 / J_IN, DT)
    return T_c, w_e + DT * (T_net - T_c) / J_E, w_in + DT * T_c / J_IN


@patient
@given(speeds, speeds, st.floats(-300, 300))
def test_a_strong_clutch_makes_both_sides_equally_fast(w_e, w_in, T_net):
    T_c, after_e, after_in = engaged(w_e, w_in, 1e9, T_net)
    assert after_e == pytest.approx(after_in, abs=1e-6)
    momentum = J_E * w_e + J_IN * w_in + DT * T_net
    assert J_E * after_e + J_IN * after_in == pytest.approx(momentum, rel=1e-9, abs=1e-9)


@patient
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
    assert coupling.clutch(0.0, 300.0, 50.0, J_E, 20.0, 1.0 / J_IN, DT) == 0.0


def test_a_clutch_lets_go_before_the_engine_stalls():
    idle = 80.0
    carried = [coupling.capacity(1.0, 200.0, share * idle, idle) for share in (0.4, 0.5, 0.7, 0.9, 2.0)]
    assert carried == pytest.approx([0.0, 0.0, 100.0, 200.0, 200.0])
    assert coupling.capacity(0.25, 200.0, 300.0, idle) == pytest.approx(50.0)
    assert coupling.capacity(1.0, 200.0, 0.0, 0.0) == 200.0  # a lock-up, which does not know the idle speed


def torques(name, ratio, w_e=250.0):
    c = catalogue.find_vehicle(name).values.coupling
    return np.array(coupling.converter(w_e, ratio * w_e, *c.pump, *c.turbine, *c.fluid, c.coupling_ratio)) / w_e**2


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
