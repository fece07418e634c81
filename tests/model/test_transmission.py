"""Gearbox and differentials: one implicit step against the same equations solved as a linear system."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.model import transmission

DT = 0.005


@given(st.floats(-200, 400), st.floats(1, 15), st.floats(0, 0.5), st.floats(0, 1), st.tuples(*[st.floats(5, 200)] * 4))
def test_a_step_solves_the_equations_of_wheels_and_gearbox(T, i, J_g, front, omega):
    """Unknowns w_1..4, w_in and T_out: I_j (w_j' - w_j)/dt = s_j T_out, w_in = i sum s_j w_j, Eq. 8 with dw_in/dt."""
    s, inertia = np.array([front, front, 1 - front, 1 - front]) / 2, np.array([2.0, 3.0, 2.5, 4.0])
    A = np.zeros((6, 6))
    A[:4, :4], A[:4, 5] = np.diag(inertia / DT), -s
    A[4, :4], A[4, 4] = i * s, -1.0
    A[5, 4], A[5, 5] = i * J_g / DT, 1.0
    w_in = i * (s @ omega)
    solution = np.linalg.solve(A, np.concatenate([inertia / DT * np.array(omega), [0.0, (T + J_g * w_in / DT) * i]]))
    B = i * i * (s * s / inertia).sum()
    after = transmission.input_free(w_in, B, w_in, T, J_g, DT)  # nothing but the drive acts on these wheels
    T_out = transmission.output_torque(T, J_g, (after - w_in) / DT, i)
    assert after == pytest.approx(solution[4], rel=1e-9, abs=1e-9)
    assert T_out == pytest.approx(solution[5], rel=1e-7, abs=1e-6)


def test_mobility_is_the_answer_to_a_torque():
    A, B, J_g = 100.0, 0.8, 0.3
    driven, free = (transmission.input_free(A, B, 90.0, T, J_g, DT) for T in (50.0, 0.0))
    assert transmission.input_mobility(B, J_g) == pytest.approx((driven - free) / (50.0 * DT))
    assert transmission.input_mobility(B, 0.0) == B


def test_less_arrives_than_is_sent_in_both_directions():
    for T in (100.0, -100.0):
        sent, arrived = T, transmission.efficiency(T, 0.05) * T
        assert arrived < sent  # driving, the wheels get less; braking, the engine's drag costs the wheels more
        assert abs(arrived - sent) == pytest.approx(5.0)


def test_the_constant_loss_opposes_rotation():
    assert transmission.constant_loss(100.0, 3.0) == 3.0 and transmission.constant_loss(-100.0, 3.0) == -3.0
    assert transmission.constant_loss(0.0, 3.0) == 0.0


def test_a_ratio_multiplies_torque():
    assert transmission.output_torque(100.0, 0.4, 0.0, 12.0) == 1200.0
    assert transmission.output_torque(100.0, 0.4, 50.0, -12.0) == -(100.0 - 20.0) * 12.0
