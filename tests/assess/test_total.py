"""Sums that do not hang on the order of what is summed, and records in the order of names."""

import numpy as np
import pytest

from studio.assess.measure import measure_all
from studio.assess.total import mean, total
from tests.assess.drive import CAR, record


def test_a_sum_is_exact():
    values = np.array([1e16, 1.0, -1e16, np.nan, 1e-3])
    assert total(values) == total(values[::-1]) == 1.001 and mean(values) == 1.001 / 4 and np.isnan(mean(np.array([np.nan])))


def test_metrics_do_not_hang_on_the_order_of_vehicles():
    """Every metric of a record of eleven cars that drive by chance, and of the same in the other order, to the last bit."""
    draw, time = np.random.default_rng(1), np.arange(0.0, 20.0, 0.02)
    names = [f"car_{i:02}" for i in range(11)]
    channels = {
        "speed": draw.uniform(5.0, 40.0, (11, time.size)), "acceleration": draw.normal(size=(11, time.size)),
        "drive_torque": draw.normal(100.0, 500.0, (11, time.size)), "gap": draw.uniform(1.0, 100.0, (11, time.size)),
        "x": np.cumsum(draw.uniform(0.1, 0.8, (11, time.size)), axis=1), "y": np.repeat(4.0 * np.arange(11.0)[:, None], time.size, axis=1),
        "adhesion_rear_left": draw.uniform(0.0, 1.0, (11, time.size)),
    }  # fmt: skip
    bodies = dict.fromkeys(names, CAR)
    one = measure_all(record(time, names, bodies, **channels))
    turned = {name: values[::-1] for name, values in channels.items()}
    assert measure_all(record(time, names[::-1], bodies, **turned)) == one
    assert one["mean_speed"].value == pytest.approx(22.5, abs=0.5) and one["energy"].value > 0.0
