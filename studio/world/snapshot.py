"""Snapshots: all that moves in a world is one buffer, so that keeping a moment is one copy, and going back to it another.

gather(world)                everything that moves becomes a view into `world.arena`
snapshot(world)    →  Snapshot
restore(world, snapshot)     the world goes on from there with the same bits
"""

import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, is_dataclass
from typing import Any, NamedTuple, get_type_hints

import numpy as np

from studio.errors import Problem, SnapshotError
from studio.rows import MOVES
from studio.source import source_digest
from studio.world import script
from studio.world.board.air import EARLY
from studio.world.setting import Setting
from studio.world.world import World

ALIGNMENT = 64  # [bytes] every part begins where a line of the cache does


class Part(NamedTuple):
    """An array that moves: whose field it is, the field, and the path to it."""

    owner: Any
    field: str
    path: str

    @property
    def array(self) -> np.ndarray:
        """The array as it is now."""
        return getattr(self.owner, self.field)


class Identity(NamedTuple):
    """What a snapshot belongs to, as digests: of the sources, of what the world was built from, of its parts and their shapes."""

    version: str
    scenario: str
    layout: str


@dataclass(frozen=True)
class Snapshot:
    """A world at one moment: where it belongs, ticks that have passed, the bytes of everything that moves, and its collisions."""

    identity: Identity
    k: int
    content: bytes
    hits: np.ndarray  # as many as there is room for now


REFUSED = {
    "version": ("is of another version of the simulator", "run the scenario again with this version"),
    "scenario": ("is of other scenarios", "build the world from the scenarios that it was taken of, in their order"),
    "layout": ("is of a world of another shape", "build the world as it was when it was taken"),
}


def snapshot(world: World) -> Snapshot:
    """The present moment."""
    return Snapshot(identity(world), world.clock.k, world.arena.tobytes(), world.events.hits.copy())


def restore(world: World, kept: Snapshot) -> None:
    """Goes back, or ahead, to a moment of the same world; raises SnapshotError."""
    check(world, kept)
    world.arena[:] = np.frombuffer(kept.content, np.uint8)
    world.events.hits = kept.hits.copy()
    world.ready.clear()
    world.clock.k = kept.k
    script.follow(world)
    for post in world.units.posts:
        post.log.forget(world.clock.time - EARLY)
    for each in world.open_inboxes:
        each.lay_anew(world.clock.time)


def check(world: World, kept: Snapshot) -> None:
    """Refuses a snapshot that does not fit."""
    problems = [
        Problem(f"snapshot.{name}", REFUSED[name][0], theirs[:16], ours[:16], REFUSED[name][1])
        for name, theirs, ours in zip(Identity._fields, kept.identity, identity(world), strict=True)
        if theirs != ours
    ]
    if not problems and len(kept.content) != world.arena.size:
        size, allowed = f"{len(kept.content)} bytes", f"{world.arena.size} bytes"
        problems = [Problem("snapshot.content", "is not complete", size, allowed, "take it anew")]
    if problems:
        raise SnapshotError("The snapshot does not fit this world.", problems)


def identity(world: World) -> Identity:
    """What snapshots of this world belong to."""
    layout = hashlib.sha256()
    for part in moving(world):
        layout.update(f"{part.path} {part.array.dtype} {part.array.shape}\n".encode())
    return Identity(source_digest(), world.origin, layout.hexdigest())


def origin_of(settings: Sequence[Setting], world: World) -> str:
    """Digest of what a world was built from: scenarios with their seeds, maps, vehicles, and the files of kinds."""
    digest = hashlib.sha256()
    for each in settings:
        digest.update(f"{each.network.digest} {each.scenario.model_dump_json()}\n".encode())
    for fixed in (world.vehicles.parameter, world.vehicles.gears, world.vehicles.tyres):
        digest.update(fixed.tobytes())
    of_script = [each.kind for each in (*world.script.asked, *world.script.maneuvers)]
    of_radio = [kind for post in world.units.posts for kind in (post.kind, post.radio)]
    for kind in [*(seats.kind for seats in world.seats), *(hosted.application for hosted in world.hosted), *of_script, *of_radio]:
        digest.update(kind.digest.encode())
    return digest.hexdigest()


# -- one buffer ----------------------------------------------------------------------------------------


def moving(owner: Any, path: str = "world") -> Iterator[Part]:
    """The fields of a dataclass, and of those in it, that are declared as Moving."""
    for name, hint in get_type_hints(type(owner), include_extras=True).items():
        value, here = getattr(owner, name), f"{path}.{name}"
        if MOVES in getattr(hint, "__metadata__", ()):
            yield Part(owner, name, here)
        for i, each in enumerate(value if isinstance(value, list) else [value]):
            if is_dataclass(each):
                yield from moving(each, f"{here}[{i}]" if isinstance(value, list) else here)


def gather(world: World) -> None:
    """Puts everything that moves into one buffer, and views into it in place of the arrays."""
    parts = list(moving(world))
    sizes = [-(-part.array.nbytes // ALIGNMENT) * ALIGNMENT for part in parts]
    world.arena = aligned(sum(sizes))
    start = 0
    for part, size in zip(parts, sizes, strict=True):
        array = part.array
        view = world.arena[start : start + array.nbytes].view(array.dtype).reshape(array.shape)
        view[...] = array
        setattr(part.owner, part.field, view)
        start += size


def aligned(size: int) -> np.ndarray:
    """uint8[size] of zeros that begins on a line of the cache."""
    room = np.zeros(size + ALIGNMENT, np.uint8)
    start = -room.ctypes.data % ALIGNMENT
    return room[start : start + size]
