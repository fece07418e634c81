"""Ghosts: the named cars of other runs that are over, on the clock of the one that is played back."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import hypot
from typing import Any

import numpy as np

from studio.errors import Problem, UnknownError
from studio.execution.record import SAME_TIME
from studio.scene import pose
from studio.scene.fleet import Look
from studio.scene.ghost import COLOURS
from studio.server import answer
from studio.server.frame import looks
from studio.server.replay import Replay

WITHIN = 0.3  # [m] from the same car, a ghost is in it and not seen


@dataclass(frozen=True)
class Ghost:
    """One run: by how much its clock is ahead [s], its colour, and which of its cars are shown: traffic is left out."""

    replay: Replay
    offset: float
    color: str
    columns: np.ndarray

    @property
    def looks(self) -> list[Look]:
        """How its cars look."""
        whole = looks(self.replay.setting)
        return [replace(whole[column], color=self.color) for column in self.columns]

    def poses(self, time: float) -> np.ndarray:
        """Where they were, float32[POSE_ROWS, car], when the clock of the run that is played back says so [s]; beyond their run nowhere."""
        own, times = time + self.offset, self.replay.time
        found = self.replay.frame(own).poses[:, self.columns]
        if not times[0] - SAME_TIME <= own <= times[-1] + SAME_TIME:
            found[pose.VISIBLE] = 0.0
        return found

    def seen(self, played: Replay, time: float) -> np.ndarray:
        """The same poses without those within the same car of the run that is played back, whose colour they would hide."""
        found = self.poses(time)
        for ghost, _, distance in self.pairs(played, found, time):
            found[pose.VISIBLE, ghost] *= distance > WITHIN
        return found

    def pairs(self, played: Replay, poses: np.ndarray, time: float) -> Iterator[tuple[int, int, float]]:
        """Number of a ghost, that of the same car of the run that is played back at a time [s], and how far they are apart [m]."""
        own, number = played.frame(time).poses, {name: i for i, name in enumerate(played.setting.names)}
        for ghost, column in enumerate(self.columns):
            car = number.get(self.replay.setting.names[column])
            if car is not None and own[pose.VISIBLE, car] and poses[pose.VISIBLE, ghost]:
                yield ghost, car, hypot(*(float(poses[each, ghost]) - float(own[each, car]) for each in (pose.X, pose.Y)))

    def links(self, played: Replay, time: float) -> Iterator[answer.LayerLink]:
        """From each car of the run that is played back at a time [s] to the same one of this, as far as both are there."""
        theirs = self.poses(time)
        for ghost, car, distance in self.pairs(played, theirs, time):
            x, y, z = (float(each) for each in theirs[[pose.X, pose.Y, pose.Z], ghost])
            yield answer.LayerLink(car=car, run=self.replay.run, color=self.color, x=x, y=y, z=z, distance=distance)

    def told(self) -> dict[str, Any]:
        """For the page."""
        return {"run": self.replay.run, "color": self.color, "offset": self.offset}


def haunting(played: Replay, others: Sequence[Replay], align: str) -> tuple[Ghost, ...]:
    """Other runs as ghosts of one. Raises UnknownError for one of another map, or without the event that they are aligned by."""
    zero = first(played, align) if others else 0.0
    for each in others:
        if each.setting.network.digest != played.setting.network.digest:
            problem = Problem("ghosts", "drives on another map", str(each.run), "runs of one map", "compare their charts instead")
            raise UnknownError(f"Run {each.run} cannot be shown beside run {played.run}.", [problem])
    named = [len(each.setting.scenario.vehicles) for each in others]
    return tuple(
        Ghost(each, first(each, align) - zero, COLOURS[i % len(COLOURS)], np.arange(count))
        for i, (each, count) in enumerate(zip(others, named, strict=True))
    )


def first(played: Replay, align: str) -> float:
    """When the first event of a kind was [s]; 0 without a kind."""
    if not align:
        return 0.0
    times = [each.time for each in played.happenings if each.kind == align]
    if not times:
        problem = Problem("align", "has not happened", align, f"what happened in run {played.run} and in all others")
        raise UnknownError(f"Run {played.run} has no such event.", [problem])
    return min(times)
