"""Snapshots: a world goes on from one with all its bits, in mid-run and from the start, alone and side by side with others.

The worlds are gone through field by field, whatever is declared: an array that were forgotten would differ.
"""

import pickle
from dataclasses import fields, is_dataclass, replace

import numpy as np
import pytest

from studio import job
from studio.errors import SnapshotError
from studio.world.build import build
from studio.world.passes.neighbour import Neighbours
from studio.world.passes.queue import Queues
from studio.world.snapshot import moving, restore, snapshot
from studio.world.tick import tick
from tests.changing import SLOW, scenario
from tests.conftest import ROOT

SAMPLES = sorted((ROOT / "scenarios").glob("*.yaml"))
ROADS, SCRIPT = ("points", "pieces", "forced"), ("waiting", "acting")
FOLLOWS = {*(f"world.roads.{name}" for name in ROADS), *(f"world.script.{name}" for name in SCRIPT)}  # made anew
SORTED = {f"world.{name}.{each.name}" for name, kind in (("neighbours", Neighbours), ("queues", Queues)) for each in fields(kind)}
SCRATCH = {
    "world.roads.near",
    "world.vehicles.tile",
    "world.script.held",
    "world.script.mail",
    "world.script.values",
    "world.units.sight",
    *(f"world.units.posts[{i}].{name}" for i in range(3) for name in ("came", "came_count")),  # from the post to the inboxes
    *(f"world.open_inboxes[{i}].post.{name}" for i in range(3) for name in ("came", "came_count")),
    *(f"world.open_inboxes[{i}].when" for i in range(3)),  # behind those who are heard nobody looks; up to there it is made anew
    *(f"world.open_inboxes[{i}].ready" for i in range(3)),  # a function, with its arrays given once it has been called
    *SORTED,
}
KNOWN = {"world.roads.shadow.sky"}  # looked up once and kept: open sky


def leaves(owner, path="world"):
    """Everything that a world holds, down to arrays, numbers and texts, with its path."""
    # What a port is wired to stands with the units; a log is a record, and `taken` and `looks` count for one what has ever come.
    if path in KNOWN or path.endswith((".owner", ".log", ".taken", ".looks")):
        return
    if isinstance(owner, np.ndarray):
        yield path, (owner.dtype, owner.shape, owner.tobytes())
    elif is_dataclass(owner):
        for each in fields(owner):
            yield from leaves(getattr(owner, each.name), f"{path}.{each.name}")
    elif hasattr(owner, "_fields"):
        for name in owner._fields:
            yield from leaves(getattr(owner, name), f"{path}.{name}")
    elif isinstance(owner, (list, tuple)):
        for i, each in enumerate(owner):
            yield from leaves(each, f"{path}[{i}]")
    elif isinstance(owner, (int, float, str, type(None))):
        yield path, repr(owner)


def differences(one: dict, other: dict) -> set[str]:
    """Paths at which two worlds differ."""
    return {path for path in one.keys() | other.keys() if one.get(path) != other.get(path)}


def run(world, ticks):
    for _ in range(ticks):
        tick(world)
    return dict(leaves(world))


def variants(sample, count):
    """A sample with different seeds."""
    return [job.prepare(job.seeded(job.load(sample), seed)) for seed in range(1, count + 1)]


def changing(sample):
    """The cars' lane is closed and opened again; a limit begins at a place behind it, ice for a while; the leader brakes."""
    lane = {"kind": "close_lane", "road": "340498991", "lane": 1, "start": 460, "end": 520, "taper": 40}
    ice = {"kind": "friction", "route": "east_to_west", "start": 300, "end": 700, "friction": 0.5, "width": 20}
    script = {
        "works": {"when": {"kind": "time", "at": 2}, "until": {"kind": "time", "at": 6}, "do": lane},
        "slow": {"when": {"kind": "passed", "vehicle": "leader", "along": 560}, "do": SLOW},
        "ice": {"when": {"kind": "time", "at": 1}, "until": {"kind": "time", "at": 5}, "do": ice},
        "brake": {
            "when": {"kind": "time", "at": 1.3},
            "do": {"kind": "brake", "vehicle": "leader", "deceleration": 3, "duration": 1, "to_speed": 5},
        },
    }
    return scenario(sample, script, alone=False, lane=1)


def goes_on(settings, before, ticks):
    """Whether the same world, and one that is built anew, end as the original does; the original at the end."""
    world = build(settings)
    run(world, before)
    kept, present = snapshot(world), dict(leaves(world))
    expected, digest = run(world, ticks), world.digest()
    restore(world, kept)
    assert differences(dict(leaves(world)), present) <= SCRATCH
    assert differences(run(world, ticks), expected) == set()
    anew = build(settings)
    restore(anew, pickle.loads(pickle.dumps(kept)))
    assert differences(run(anew, ticks), expected) <= SCRATCH
    assert world.digest() == anew.digest() == digest
    return expected


@pytest.mark.parametrize("count", [1, 3])
@pytest.mark.parametrize("sample", SAMPLES, ids=lambda path: path.stem)
def test_a_world_goes_on_from_a_snapshot(sample, count):
    goes_on(variants(sample, count), 150, 100)


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda path: path.stem)
def test_a_world_goes_back_to_its_start(sample):
    goes_on(variants(sample, 1), 0, 60)


@pytest.mark.parametrize("before", [0, 75, 200, 275])
def test_what_changes_on_the_road_is_in_it(sample, before):
    """Snapshots before, while and after works, ice and a limit act; cars that went around drive where they drove."""
    goes_on([changing(sample)], before, 150)


@pytest.mark.parametrize("settings", ["changing", *SAMPLES], ids=lambda each: getattr(each, "stem", each))
def test_whatever_changes_is_declared(settings, sample):
    world = build([changing(sample)] if settings == "changing" else variants(settings, 1))
    start = dict(leaves(world))
    changed = differences(start, run(world, 350))
    assert "world.vehicles.state" in changed
    assert changed <= declared(world)


def declared(world) -> set[str]:
    """What may change: what is declared as moving, follows from it, or is nobody's concern."""
    return (
        {part.path for part in moving(world)}
        | FOLLOWS
        | SCRATCH
        | {"world.clock.k", "world.arena", "world.events.hits"}
        | open_to_all(world)
    )


def open_to_all(world) -> set[str]:
    """Where those whom an inbox hears stand, which hears everybody: made anew of what the post has."""
    places = {f"world.open_inboxes[{i}].{name}" for i in range(len(world.open_inboxes)) for name in ("heard", "slots")}
    shared = [each for inbox in world.open_inboxes for each in (inbox.heard, inbox.slots)]
    for h, host in enumerate(world.hosted):
        for w, wiring in enumerate(host.wiring):
            found = enumerate(wiring.columns)
            places |= {f"world.hosted[{h}].wiring[{w}].columns[{c}]" for c, column in found if any(column is each for each in shared)}
    return places


def test_a_collision_is_declared(sample_setting):
    """Two cars that stand in each other."""
    world = build([sample_setting])
    start = dict(leaves(world))
    world.vehicles.state[:, 1] = world.vehicles.state[:, 0]
    changed = differences(start, run(world, 1))
    assert {"world.events.hits", "world.events.found"} < changed <= declared(world)


def test_everything_that_is_declared_comes_back(sample_setting):
    world = build([sample_setting])
    kept, present = snapshot(world), dict(leaves(world))
    for part in moving(world):
        part.array[...] = 7
    world.clock.k = 7
    restore(world, kept)
    assert differences(dict(leaves(world)), present) == set()


def test_what_is_declared_lies_in_one_buffer(sample_setting):
    world = build([sample_setting])
    parts = list(moving(world))
    assert len(parts) > 25 and len({part.path for part in parts}) == len(parts)
    assert all(part.array.size == 0 or np.shares_memory(part.array, world.arena) for part in parts)
    assert sum(part.array.nbytes for part in parts) <= world.arena.size == len(snapshot(world).content)


# -- what is refused -----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def world(sample_setting):
    return build([sample_setting])


def problems(world, kept):
    """What is told, after nothing has been touched."""
    before = dict(leaves(world))
    with pytest.raises(SnapshotError, match="does not fit this world") as caught:
        restore(world, kept)
    assert differences(dict(leaves(world)), before) == set()
    assert all(each.what and each.value and each.allowed and each.remedy for each in caught.value.problems)
    return [each.where for each in caught.value.problems]


def test_another_seed_is_another_world(world, sample):
    kept = snapshot(build([job.prepare(job.seeded(job.load(sample, {"clock.duration": 10}), 2))]))
    assert problems(world, kept) == ["snapshot.scenario"]


def test_a_batch_is_another_world(world, sample_setting):
    assert problems(world, snapshot(build([sample_setting] * 2))) == ["snapshot.scenario", "snapshot.layout"]


def test_another_version_is_refused(world):
    kept = snapshot(world)
    assert problems(world, replace(kept, identity=kept.identity._replace(version="0" * 16))) == ["snapshot.version"]


def test_a_part_of_a_snapshot_is_refused(world):
    kept = snapshot(world)
    assert problems(world, replace(kept, content=kept.content[:-64])) == ["snapshot.content"]
