"""The bits of a world hang on nothing but its scenario and seed: not on the batch, the threads, or the order of a file."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import pytest

from studio import job
from studio.scenario import file
from studio.scenario.setup import complete
from studio.world.build import build
from studio.world.setting import setting
from studio.world.tick import tick
from tests.conftest import ROOT

SAMPLES = sorted((ROOT / "scenarios").glob("*.yaml"))


def prepared(sample, *, reverse=False):
    """A sample, its vehicles in the order of the file or the other way round."""
    document = file.read(sample)
    if reverse:
        document["vehicles"] = dict(reversed(document["vehicles"].items()))
    return setting(complete(document, sample.name), sample.parent, sample.name)


def seeded(setting, seed):
    """The same cars at the same places; what is measured and heard by chance differs."""
    return replace(setting, scenario=setting.scenario.model_copy(update={"seed": seed}))


def run(world, ticks):
    for _ in range(ticks):
        tick(world)
    return world


def test_a_batch_of_64(sample):
    """Every world of the batch is as it is alone, and by chance none is as another."""
    each = prepared(sample)
    together = run(build([seeded(each, seed) for seed in range(64)]), 150)
    digests = [together.digest(w) for w in range(64)]
    assert len(set(digests)) == 64
    for w in (0, 1, 31, 63):
        assert run(build([seeded(each, w)]), 150).digest(0) == digests[w]


def test_two_threads(sample):
    """Worlds that run at the same time end as they do one after the other."""
    each = prepared(sample)
    halves = [[seeded(each, seed) for seed in seeds] for seeds in ((1, 2), (3, 4))]
    with ThreadPoolExecutor(2) as pool:
        at_once = list(pool.map(run, map(build, halves), [200, 200]))
    assert [world.digest() for world in at_once] == [run(build(half), 200).digest() for half in halves]


def wheels_of(world, v):
    """All rows of the four wheels of a vehicle."""
    return world.vehicles.wheels.reshape(-1, 4, world.size)[:, :, v]


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda path: path.stem)
def test_the_order_of_the_file_does_not_matter(sample):
    """Vehicles written the other way round drive, measure and hear the same, to the last bit."""
    one, other = (run(build([prepared(sample, reverse=reverse)]), 250) for reverse in (False, True))
    assert one.names != other.names and set(one.names[0]) == set(other.names[0])
    for name in one.names[0]:
        a, b = one.column(name), other.column(name)
        assert one.vehicles.state[:, a].tobytes() == other.vehicles.state[:, b].tobytes(), name
        assert wheels_of(one, a).tobytes() == wheels_of(other, b).tobytes(), name
        assert one.units.satellite[:, a].tobytes() == other.units.satellite[:, b].tobytes(), name


def test_traffic_leaves_the_chances_of_the_others_alone(sample):
    """What is measured and heard by chance hangs on these numbers; every vehicle of a world has one of its own."""
    few, many = (build([job.prepare(job.load(sample, {"traffic.count": count}))]) for count in (3, 7))
    names = [name for name in few.names[0] if not name.startswith("traffic")]
    assert [few.worlds.entity[few.column(name)] for name in names] == [many.worlds.entity[many.column(name)] for name in names]
    assert sorted(many.worlds.entity) == list(range(many.size))
