"""Who has swerved round something has it no longer ahead: its gap, its time to collision and all that is made of them say so."""

import numpy as np
import pytest

from studio import job


@pytest.fixture(scope="module")
def record(root):
    """The sample in which A goes round a box, from the start to its end."""
    return job.run(job.load(root / "scenarios" / "celc.yaml")).record


def test_the_box_is_ahead_until_the_body_is_clear_of_it(record):
    """As far as both bodies overlap sideways, and not a sample longer; the box is 1.8 m wide and in the middle of the way."""
    row = record.vehicles.index("A")
    gap, offset, width = record.channel("gap")[row], record.channel("lateral_offset")[row], record.bodies["A"].width
    box = np.array([record.ahead(row, k) == "cargo" for k in range(record.time.size)]) & np.isfinite(gap)
    assert box.any()
    turned = 0.5 * record.bodies["A"].length  # by no more than a right angle
    assert (np.abs(offset[box]) < 0.9 + 0.5 * width + turned).all()
    clear = np.abs(offset) > 0.9 + 0.5 * width + 0.3 * turned  # turned by 17° at most while it drives that fast
    past = clear & (record.time < 4.0)
    assert past.any() and not (box & past).any()
