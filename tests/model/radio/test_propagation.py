"""Signal strengths: distances, the ground, buildings, in closed form and against published figures."""

import numpy as np
import pytest

from studio.model.radio.propagation import attenuation, felt_distance, free_space, slopes, two_ray, wavelength

LAMBDA = wavelength(5.89e9)
CLOSEST = free_space(1.0, LAMBDA)


@pytest.mark.parametrize(("distance", "loss"), [(1.0, 47.85), (100.0, 87.85), (500.0, 101.83)])
def test_free_space(distance, loss):
    assert free_space(distance, LAMBDA) == pytest.approx(loss, abs=0.01)


@pytest.mark.parametrize(("distance", "loss"), [(100.0, 84.15), (200.0, 90.84), (500.0, 98.47), (1000.0, 109.40)])
def test_two_rays(distance, loss):
    """Antennas at 1.895 m, permittivity 1.02, within 0.05 dB."""
    assert two_ray(distance, LAMBDA, 1.895, 1.895, 1.02) == pytest.approx(loss, abs=0.05)


def test_far_away_two_rays_fall_with_the_fourth_power():
    """Over a perfect mirror: L = 40 lg(d) - 20 lg(h_t h_r) beyond the crossover (Rappaport, section 4.6)."""
    far = two_ray(20_000.0, LAMBDA, 1.5, 2.0, 1e9)
    assert far == pytest.approx(40.0 * np.log10(20_000.0) - 20.0 * np.log10(1.5 * 2.0), abs=0.05)


def test_one_slope_of_two_is_free_space():
    for distance in (1.0, 50.0, 700.0):
        assert slopes(distance, CLOSEST, 2.0, 2.0, 2.0, 100.0, 500.0) == pytest.approx(free_space(distance, LAMBDA), abs=1e-9)


def test_slopes_change_at_their_breaks():
    """Each stretch by itself, decade by decade: 1.9, 3.8 and 3 times 10 dB."""
    loss = [slopes(d, CLOSEST, 1.9, 3.8, 3.0, 100.0, 1000.0) for d in (10.0, 100.0, 1000.0, 10_000.0)]
    assert np.diff(loss) == pytest.approx([19.0, 38.0, 30.0], abs=1e-9)
    assert loss[0] == pytest.approx(47.85 + 19.0, abs=0.01)


def test_no_antenna_is_nearer_than_a_metre():
    assert free_space(0.0, LAMBDA) == slopes(0.0, CLOSEST, 2.0, 3.0, 4.0, 10.0, 20.0) == free_space(1.0, LAMBDA)
    assert np.isfinite(two_ray(0.0, LAMBDA, 1.5, 1.5, 1.02))


def test_a_building_of_twenty_metres():
    """Two walls and 20 m inside: 26 dB, at n = 2 as much as twenty times the distance."""
    assert attenuation(2.0, 20.0) == pytest.approx(26.0, abs=1e-12)
    assert felt_distance(100.0, 26.0, 2.0) == pytest.approx(100.0 * 10.0**1.3)
    near, far = (slopes(d, CLOSEST, 2.0, 2.0, 2.0, 100.0, 500.0) for d in (100.0, felt_distance(100.0, 26.0, 2.0)))
    assert far - near == pytest.approx(26.0, abs=1e-9)


def test_the_wavelength():
    assert wavelength(5.89e9) == pytest.approx(0.0509, abs=5e-5)
