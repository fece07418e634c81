"""Live runs as the server sees them: a process each, what it has told so far, and who listens.

Lives.start   takes the process that waits ready, gives it its order, starts the next one
LiveRun       orders to one process; its news go to all listeners
"""

import asyncio
import logging
import threading
import time
from collections.abc import Callable, Generator
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, field
from math import inf, isfinite
from pathlib import Path
from typing import Any

import numpy as np

from studio.errors import Problem, ServerError, UnknownError
from studio.job import Loaded
from studio.process import Busy, Child, Gone
from studio.server import answer, worker
from studio.server.frame import Frame
from studio.server.news import ChannelsNews, EndNews, EventNews, Kind, SamplesNews, StateNews
from studio.server.worker import Order
from studio.store.runs import reopen_runs

START_PATIENCE = 600.0  # [s] the first start compiles; the page tells how far it is
MOST_LIVE = 8  # processes at a time
MOST_OVER = 8  # runs that are over, whose news are kept for who comes late
END_PATIENCE = 3.0  # [s] for a process to save and end
STOP_PATIENCE = 5.0  # [s] for a run to react to stop; an application may hang
LOG = logging.getLogger(__name__)


def plain(values: np.ndarray) -> list[float | None]:
    """Numbers for JSON: what is not finite becomes null."""
    return [value if isfinite(value) else None for value in values.tolist()]


@dataclass
class LiveRun:
    """One live run."""

    run: int
    scenario: str
    duration: float
    process: Child
    on_frame: Callable[["LiveRun", Frame], None]
    loaded: Loaded
    db: Path
    status: answer.LiveStatus = "starting"
    time: float = 0.0
    pace: float = 1.0
    real_time_factor: float = 0.0
    end: EndNews | None = None
    channels: ChannelsNews = field(default_factory=lambda: ChannelsNews(channels=[]))
    times: list[float] = field(default_factory=list)
    samples: dict[str, list[float | None]] = field(default_factory=dict)
    events: list[EventNews] = field(default_factory=list)
    frame: Frame | None = None
    listeners: set["Listener"] = field(default_factory=set)
    lock: threading.RLock = field(default_factory=threading.RLock)
    obeyed: bool = False
    given_up: bool = False

    def listen(self) -> None:
        """Reads the process's news until it ends; runs in a thread of its own."""
        try:
            while not self.is_over:
                word, *values = self.process.hear()
                getattr(self, f"on_{word}_news")(*values)
        except Gone as gone:
            status, reason = self.explanation(gone.code)
            if self.given_up:  # a row of a process that died by itself is found by whoever reads it next
                with closing(reopen_runs(self.db)) as runs:
                    runs.end(self.run, status, reason)
            self.on_end_news(status, reason)
        finally:
            self.process.end()

    def explanation(self, code: int | None) -> tuple[answer.Over, str]:
        """Status and reason of a run whose process has gone without a word."""
        if self.given_up:
            return "stopped", f"It did not react to stop within {STOP_PATIENCE:g} s; its process was ended."
        return "failed", f"The process of this run ended with code {code}."

    def on_frame_news(self, when: float, frame: Frame) -> None:
        """A picture for the scene. What goes wrong with drawing must not end a run."""
        self.frame = frame
        try:
            self.on_frame(self, frame)
        except Exception:
            LOG.exception("a frame of run %d could not be drawn", self.run)

    def on_channels_news(self, channels: list[tuple[str, str, str]]) -> None:
        """What the live charts may show."""
        with self.lock:
            self.channels = ChannelsNews(channels=[answer.Channel(name=name, unit=unit, label=label) for name, unit, label in channels])
            self.tell(self.channels)

    def on_samples_news(self, times: np.ndarray, values: dict[str, np.ndarray]) -> None:
        """New points of the live charts."""
        news = {name: plain(each) for name, each in values.items()}
        with self.lock:
            self.times += times.tolist()
            for name, each in news.items():
                self.samples.setdefault(name, []).extend(each)
            self.tell(SamplesNews(time=times.tolist(), channels=news))

    def on_event_news(self, happened: dict[str, Any]) -> None:
        """Something happened."""
        event = EventNews(**happened)
        with self.lock:
            self.events.append(event)
            self.tell(event)

    def on_state_news(self, status: answer.LiveStatus, when: float, pace: float, real_time_factor: float) -> None:
        """Where the run is."""
        with self.lock:
            over = self.obeyed = status not in ("running", "paused")
            self.status = self.status if over else status  # it is over when it has been saved
            self.time, self.pace, self.real_time_factor = when, pace, real_time_factor
            self.tell(self.state())

    def on_end_news(self, status: answer.Over, error: str | None) -> None:
        """The run is over and saved."""
        with self.lock:
            self.status, self.end = status, EndNews(run=self.run, status=status, error=error)
            self.tell(self.state())
            self.tell(self.end)

    def state(self) -> StateNews:
        """Where it is, for those who listen."""
        return StateNews(**dict(self.row()), real_time_factor=self.real_time_factor)

    def row(self) -> answer.Live:
        """A row of the list of live runs."""
        return answer.Live(
            run=self.run,
            scenario=self.scenario,
            status=self.status,
            time=round(self.time, 6),
            pace="fast" if self.pace == inf else self.pace,
            duration_s=self.duration,
        )

    @property
    def is_over(self) -> bool:
        """Whether it has ended."""
        return self.status in ("done", "stopped", "failed")

    def order(self, *words: Any) -> None:
        """Gives an order; raises ServerError when the run is over, or has not taken many orders before."""
        self.check_going()
        try:
            self.process.tell(*words)
        except Busy:
            problem = Problem("order", "cannot be taken", str(words[0]), remedy="stop the run: it does not react")
            raise ServerError(f"Run {self.run} has not taken the orders before.", [problem]) from None
        except Gone:
            raise ServerError(f"The process of run {self.run} has ended.") from None

    def check_going(self) -> None:
        """Raises ServerError when the run is over."""
        if self.is_over:
            raise ServerError(f"Run {self.run} is over.", [Problem("run", "is over", self.status, "a run that is going on")])

    def stop(self) -> None:
        """Orders the end; a process that does not react, or takes no orders any more, is ended. Raises ServerError when it is over."""
        self.check_going()
        with suppress(Busy, Gone):
            self.process.tell("stop")
        patience = threading.Timer(STOP_PATIENCE, self.give_up)
        patience.daemon = True
        patience.start()

    def give_up(self) -> None:
        """Ends a process that still has not stopped; one that has may take its time to save."""
        if not (self.is_over or self.obeyed):
            self.given_up = True
            self.process.kill()

    def join(self, listener: "Listener") -> None:
        """A new listener first gets everything so far."""
        with self.lock:
            listener.put(self.channels)
            listener.put(SamplesNews(time=self.times, channels=self.samples))
            for event in self.events:
                listener.put(event)
            listener.put(self.state())
            if self.end:
                listener.put(self.end)
            self.listeners.add(listener)

    def leave(self, listener: "Listener") -> None:
        """No more news for this one."""
        with self.lock:
            self.listeners.discard(listener)

    def tell(self, message: Kind) -> None:
        """A message to all listeners."""
        for listener in self.listeners:
            listener.put(message)


class Listener:
    """A queue of messages in the server's event loop. One that sleeps too long is cut off: its last message is None."""

    CAPACITY = 2000

    def __init__(self) -> None:
        self.loop = asyncio.get_running_loop()
        self.queue: asyncio.Queue[Kind | None] = asyncio.Queue()
        self.is_cut = False

    def put(self, message: Kind) -> None:
        """From any thread."""
        if self.is_cut or self.loop.is_closed():
            return
        self.is_cut = self.queue.qsize() >= self.CAPACITY
        self.loop.call_soon_threadsafe(self.queue.put_nowait, None if self.is_cut else message)


class Lives:
    """All live runs, and the process that waits for the next one."""

    def __init__(self, *, db: Path, first: Path | None, kinds: tuple[Path, ...],
                 on_frame: Callable[[LiveRun, Frame], None]) -> None:  # fmt: skip
        self.db, self.first, self.kinds, self.on_frame = db, first, kinds, on_frame
        self.runs: dict[int, LiveRun] = {}
        self.spare: Child | None = None
        self.starting = 0
        self.lock = threading.Lock()

    def make_ready(self) -> None:
        """Starts the process for the next run, unless it waits already."""
        with self.lock:
            if self.spare is None or not self.spare.is_alive():
                self.spare = Child.begin(worker.main, self.first, self.kinds)

    def take(self) -> Child:
        """The process that waits."""
        self.make_ready()
        with self.lock:
            process, self.spare = self.spare, None
        assert process, "made ready above"
        return process

    def start(self, order: Order, scenario: str, loaded: Loaded) -> LiveRun:
        """Starts a run; returns when its row stands. Raises what the process refuses, or ServerError."""
        with self.place():
            process, number, duration = self.begin(order)
            live = LiveRun(number, scenario, duration, process, self.on_frame, loaded, self.db, pace=order.pace)
            self.keep(live)
        threading.Thread(target=live.listen, name=f"run {number}", daemon=True).start()
        threading.Timer(1.0, self.make_ready).start()  # not while the new run draws its first breath
        return live

    def keep(self, live: LiveRun) -> None:
        """Takes a run in, and forgets those that have been over for longest: their rows tell all of them."""
        with self.lock:
            over = [number for number, each in self.runs.items() if each.is_over]
            for number in over[: max(0, len(over) - MOST_OVER)]:
                del self.runs[number]
            self.runs[live.run] = live

    @contextmanager
    def place(self) -> Generator[None]:
        """A place among the live runs, held while one starts; raises ServerError when there is none."""
        with self.lock:
            if self.starting + sum(not live.is_over for live in self.runs.values()) >= MOST_LIVE:
                raise ServerError(
                    "Too many runs are going on.",
                    [Problem("live runs", "are as many as may be", "", f"{MOST_LIVE} at a time", "stop one")],
                )
            self.starting += 1
        try:
            yield
        finally:
            with self.lock:
                self.starting -= 1

    def begin(self, order: Order) -> tuple[Child, int, float]:
        """A process that has begun with the order; when the one that waited has died, another."""
        process = self.take()
        try:
            return process, *begun(process, order)
        except OSError:
            process.end()
        process = self.take()
        try:
            return process, *begun(process, order)
        except OSError:
            process.end()
            raise ServerError(f"The process of the run did not start (code {process.exit_code()}).") from None

    def find(self, run: int) -> LiveRun:
        """A live run; raises UnknownError."""
        with self.lock:
            if run not in self.runs:
                known = ", ".join(map(str, sorted(self.runs))) or "there is none"
                raise UnknownError(f"Run {run} is not a live run of this server.", [Problem("run", "is not live", str(run), known)])
            return self.runs[run]

    def all(self) -> list[LiveRun]:
        """All of them, newest first."""
        with self.lock:
            return [live for _, live in sorted(self.runs.items(), reverse=True)]

    def close(self) -> None:
        """Stops all runs and ends all processes."""
        for live in self.all():
            with suppress(ServerError):
                live.stop()
        deadline = time.monotonic() + END_PATIENCE
        while any(not live.is_over for live in self.all()) and time.monotonic() < deadline:
            time.sleep(0.02)
        with self.lock:
            for process in (*(live.process for live in self.runs.values()), *([self.spare] if self.spare else [])):
                process.end(0.0)


def begun(process: Child, order: Order) -> tuple[int, float]:
    """Gives the order and waits for the answer: the run's number and duration. Raises OSError, or a refusal."""
    process.tell("start", order)
    while process.hears_within(START_PATIENCE):
        word, *values = process.hear()
        if word == "refused":
            process.end()
            raise values[0]
        if word == "begun":
            return values[0], values[1]
    raise TimeoutError
