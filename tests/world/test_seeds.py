"""A seed for each stream of chance: what it varies changes, and nothing else."""

import numpy as np
import pytest

from studio import job
from studio.world.build import build
from studio.world.table.unit import H_CAME, HEARD
from studio.world.tick import tick

LOSSY = {"radio.loss": 0.3, "traffic.count": 6}


def traces(sample, **changes):
    """What the streams bring in one second: traffic at the start, readings of sensors, satellites' errors, messages as they came."""
    world = build([job.prepare(job.load(sample, {**LOSSY, **changes}))])
    start, found = world.vehicles.state.copy(), {"sensors": [], "satellites": [], "radio": []}
    for _ in range(50):
        tick(world)
        found["sensors"].append(np.concatenate([each.out.ravel() for each in world.units.mounted]))
        found["satellites"].append(world.units.satellite.copy())
        found["radio"].append(np.concatenate([post.inbox[H_CAME : len(HEARD)].ravel() for post in world.units.posts]))
    return {"traffic": start, **{name: np.array(each) for name, each in found.items()}}


def same(one, other):
    """Which streams are equal to the last bit."""
    return {name for name in one if one[name].shape == other[name].shape and np.array_equal(one[name], other[name], equal_nan=True)}


@pytest.fixture(scope="module")
def usual(sample):
    return traces(sample)


def test_the_scenarios_own_seed_spelled_out_changes_nothing(sample, usual):
    own = {f"seeds.{name}": job.load(sample).scenario.seed for name in usual}
    assert same(usual, traces(sample, **own)) == set(usual)


@pytest.mark.parametrize("stream", ["radio", "satellites", "sensors"])
def test_one_stream_is_varied_and_the_rest_stays(sample, usual, stream):
    """Cars that hear or see otherwise drive otherwise; what chance alone decides stays."""
    found = same(usual, traces(sample, **{f"seeds.{stream}": 4711}))
    assert stream not in found and {"traffic", "satellites"} - {stream} <= found


def test_other_traffic(sample, usual):
    assert "traffic" not in same(usual, traces(sample, **{"seeds.traffic": 4711}))


def test_batched_with_others_every_world_has_its_own(sample):
    """Side by side with another radio seed: the same bits as alone."""
    settings = [job.prepare(job.load(sample, LOSSY | {"seeds.radio": seed})) for seed in (5, 6)]
    together, alone = build(settings), [build([each]) for each in settings]
    for world in (together, *alone):
        for _ in range(50):
            tick(world)
    assert [together.digest(0), together.digest(1)] == [each.digest(0) for each in alone]
