"""Transfer functions of platoons against the figures that are published."""

import numpy as np
import pytest

from studio.assess.transfer import FREQUENCIES, actuated, delayed, laplace, least_headway, ploeg


def least(A, D):
    """Of Ploeg's law."""
    return least_headway(lambda h: abs(ploeg(A, D, h)))


@pytest.mark.parametrize(("theta", "headway"), [(0.02, 0.252), (0.05, 0.400), (0.10, 0.568), (0.15, 0.699), (0.30, 1.002)])
def test_least_headway_of_cacc(theta, headway):
    """tau = 0.1 s, phi = 0.2 s; 0.25 s at 0.02 s is in J. Ploeg et al., IEEE Trans. ITS 16 (2015) 488."""
    assert least(actuated(0.1, 0.2), delayed(theta)) == pytest.approx(headway, abs=0.01)


@pytest.mark.parametrize(("tau", "phi"), [(0.1, 0.2), (0.5, 0.0), (0.07, 0.0)])
def test_least_headway_without_feed_forward(tau, phi):
    """sqrt(2/k_p), whatever the drive; 3.16 s is in the same paper."""
    assert least(actuated(tau, phi), 0.0) == pytest.approx(np.sqrt(2.0 / 0.2), abs=0.01)


@pytest.mark.parametrize(("tau", "phi", "headway"), [(0.1, 0.2, 1.00), (0.5, 0.0, 1.37)])
def test_least_headway_with_the_measured_acceleration(tau, phi, headway):
    assert least(actuated(tau, phi), actuated(tau, phi)) == pytest.approx(headway, abs=0.02)


@pytest.mark.parametrize(("tau", "phi"), [(0.1, 0.2), (0.5, 0.0)])
def test_an_ideal_link_makes_a_lag(tau, phi):
    """1/(h s + 1), whatever the drive."""
    np.testing.assert_allclose(ploeg(actuated(tau, phi), 1.0, 0.6), 1.0 / (0.6 * laplace(FREQUENCIES) + 1.0), rtol=1e-9)
