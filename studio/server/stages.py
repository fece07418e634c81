"""The stages: every page that shows a scene has one to itself for as long as its scene is connected, so that none disturbs another.

A page asks for a stage and is given a free one, the first first; a page that is loaded again wishes for the one that it had. A stage that
is free keeps its scene for who comes next.
"""

import threading
import time
from collections import Counter
from collections.abc import Generator
from contextlib import contextmanager

from studio.errors import ConflictError, Problem
from studio.server.answer import FIRST_STAGE, MOST_STAGES
from studio.server.frame import Frame
from studio.server.live import LiveRun
from studio.server.stage import Stage

PROMISED = 20.0  # [s] in which a page connects to the stage that it was given
LEAVING = 1.5  # [s] in which a page that is loaded again has left its stage


class Stages:
    """Stages by their numbers, each made when it is first wanted. Every method may be called from any thread."""

    def __init__(self) -> None:
        self._made: dict[int, Stage] = {}
        self._making = threading.Lock()
        self._joined: Counter[int] = Counter()
        self._promised: dict[int, float] = {}
        self._changed = threading.Condition()

    def __getitem__(self, number: int) -> Stage:
        """A stage; its scene takes a moment when it is new."""
        with self._making:
            if number not in self._made:
                self._made[number] = Stage()
            return self._made[number]

    def allot(self, wanted: int | None = None) -> int:
        """The number of a stage that nobody has, the wanted one if it is free within a moment; raises ConflictError when none is."""
        with self._changed:
            if wanted is not None:
                self._changed.wait_for(lambda: self._is_free(wanted), timeout=LEAVING)
            numbers = range(FIRST_STAGE, MOST_STAGES + 1)
            found = next((each for each in (wanted, *numbers) if each is not None and self._is_free(each)), None)
            if found is None:
                allowed, remedy = f"{MOST_STAGES} pages at once", "close another tab of the studio"
                problem = Problem("stage", "is not free", "", allowed, remedy)
                raise ConflictError("Too many pages of this studio show a scene.", [problem])
            self._promised[found] = time.monotonic() + PROMISED
            return found

    def _is_free(self, number: int) -> bool:
        return not self._joined[number] and self._promised.get(number, 0.0) < time.monotonic()

    @contextmanager
    def joined(self, number: int) -> Generator[None]:
        """While a scene is connected to a stage."""
        self._count(number, 1)
        try:
            yield
        finally:
            self._count(number, -1)

    def _count(self, number: int, by: int) -> None:
        with self._changed:
            self._joined[number] += by
            self._promised.pop(number, None)
            self._changed.notify_all()

    def on_frame(self, live: LiveRun, frame: Frame) -> None:
        """A frame of some live run; drawn wherever that is shown."""
        for stage in list(self._made.values()):
            stage.on_frame(live, frame)

    def close(self) -> None:
        """All scenes end; may take some seconds."""
        with self._making:
            for stage in self._made.values():
                stage.scene.stop()
