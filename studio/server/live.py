"""Live runs as the server sees them: a process each, what it has told so far, and who listens.

Lives.start   takes the process that waits ready, gives it its order, starts the next one; or lets the run wait for its turn
LiveRun       orders to one process; its news go to all listeners

A run that waits has its row, its number and its listeners already. Runs begin in the order in which they were asked for.
"""

import asyncio
import logging
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import dataclass, field, replace
from math import inf, isfinite
from pathlib import Path
from typing import Any, get_args

import numpy as np

from studio import job
from studio.errors import Problem, ServerError, StudioError, UnknownError
from studio.job import Loaded
from studio.process import Busy, Child, Gone, prepare
from studio.server import answer, worker
from studio.server.frame import Frame
from studio.server.news import ChannelsNews, EndNews, EventNews, Kind, LayersNews, SamplesNews, StateNews
from studio.server.worker import Order
from studio.store.queue import CANCELLED
from studio.store.runs import LEFT, reopen_runs
from studio.warmup import is_warm

START_PATIENCE = 600.0  # [s] the first start compiles; the page tells how far it is
MOST_LIVE = 8  # processes at a time, unless somebody wants it otherwise
MOST_WAITING = 1000  # runs that wait for their turn
MOST_OVER = 8  # runs that are over, whose news are kept for who comes late
END_PATIENCE = 3.0  # [s] for a process to save and end
STOP_PATIENCE = 5.0  # [s] for a run to react to stop; an application may hang
LOG = logging.getLogger(__name__)
prepare("studio.server.nursery")


def plain(values: np.ndarray) -> list[float | None]:
    """Numbers for JSON: what is not finite becomes null."""
    return [value if isfinite(value) else None for value in values.tolist()]


@dataclass
class LiveRun:
    """One live run."""

    run: int
    scenario: str
    duration: float
    process: Child | None  # none while it waits for its turn
    on_frame: Callable[["LiveRun", Frame], None]
    loaded: Loaded
    db: Path
    kinds: tuple[Path, ...] = ()
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
    layers: LayersNews | None = None
    listeners: set["Listener"] = field(default_factory=set)
    lock: threading.RLock = field(default_factory=threading.RLock)
    position: int = 0  # among those that wait, from 1 on
    obeyed: bool = False
    given_up: bool = False
    is_left: bool = False

    def listen(self, process: Child) -> None:
        """Reads the process's news until it ends; runs in a thread of its own."""
        try:
            while not self.is_over:
                word, *values = process.hear()
                getattr(self, f"on_{word}_news")(*values)
        except Gone as gone:
            status, reason = self.explanation(gone.code)
            with suppress(StudioError, OSError):  # whoever opens the database next takes it in
                if not self.is_left:
                    self.take_in("stopped" if self.given_up else "killed", reason)
            self.on_end_news(status, reason)
        finally:
            process.end()

    def take_in(self, status: str, reason: str) -> None:
        """Has what was recorded taken into the database, in a process of its own, and waits for that."""
        reopen_runs(self.db).leave(self.run, status, reason)
        child = Child.begin(worker.take_in, self.db, self.kinds, prepared=is_warm())
        with suppress(Gone):
            child.hear()
        child.end()

    def abandon(self) -> None:
        """The server ends, and its process with it; if the run goes on still, the next server takes in what was recorded."""
        was_over, self.is_left = self.is_over, True
        if not was_over:
            with suppress(StudioError):  # before its process ends: whoever sees it gone is to find why
                reopen_runs(self.db).leave(self.run, "killed", worker.SERVER_ENDED)
        if self.process is not None:
            self.process.end(0.0)

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

    def on_layers_news(self, seen: dict[str, Any]) -> None:
        """What can be drawn over the scene: only the last of it counts."""
        with self.lock:
            self.layers = LayersNews(**seen)
            self.tell(self.layers)

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
            self.status, self.position, self.end = status, 0, EndNews(run=self.run, status=status, error=error)
            self.tell(self.state())
            self.tell(self.end)

    def state(self) -> StateNews:
        """Where it is, for those who listen."""
        return StateNews(**dict(self.row()), real_time_factor=self.real_time_factor)

    def move(self, position: int) -> None:
        """Its place among those that wait."""
        with self.lock:
            self.position = position
            self.tell(self.state())

    def begin(self, process: Child) -> None:
        """Its turn has come."""
        with self.lock:
            self.status, self.process, self.position = "starting", process, 0
            self.tell(self.state())

    def refused(self, error: StudioError) -> None:
        """Its turn came, and it could not begin, or somebody else has cancelled it."""
        runs = reopen_runs(self.db)
        runs.end(self.run, "failed", str(error))
        row = runs.find(self.run)
        if not self.is_over:
            self.on_end_news("cancelled" if row.status == "cancelled" else "failed", row.error)

    def row(self) -> answer.Live:
        """A row of the list of live runs."""
        return answer.Live(
            run=self.run,
            scenario=self.scenario,
            status=self.status,
            time=round(self.time, 6),
            pace="fast" if self.pace == inf else self.pace,
            duration_s=self.duration,
            position=self.position,
        )

    @property
    def is_over(self) -> bool:
        """Whether it has ended."""
        return self.status in get_args(answer.Over)

    def order(self, *words: Any) -> None:
        """Gives an order; raises ServerError when the run is over, waits for its turn, or has not taken many orders before."""
        process = self.going()
        try:
            process.tell(*words)
        except Busy:
            problem = Problem("order", "cannot be taken", str(words[0]), remedy="stop the run: it does not react")
            raise ServerError(f"Run {self.run} has not taken the orders before.", [problem]) from None
        except Gone:
            raise ServerError(f"The process of run {self.run} has ended.") from None

    def going(self) -> Child:
        """Its process; raises ServerError when the run is over, or has not begun."""
        if self.is_over:
            raise ServerError(f"Run {self.run} is over.", [Problem("run", "is over", self.status, "a run that is going on")])
        if self.process is None:
            problem = Problem("run", "waits for its turn", self.status, "a run that is going on", "wait, or cancel it")
            raise ServerError(f"Run {self.run} has not begun.", [problem])
        return self.process

    def stop(self) -> None:
        """Orders the end; a process that does not react, or takes no orders any more, is ended. Raises ServerError when it is over."""
        process = self.going()
        with suppress(Busy, Gone):
            process.tell("stop")
        patience = threading.Timer(STOP_PATIENCE, self.give_up)
        patience.daemon = True
        patience.start()

    def give_up(self) -> None:
        """Ends a process that still has not stopped; one that has may take its time to save."""
        if not (self.is_over or self.obeyed):
            self.given_up = True
            self.going().kill()

    def join(self, listener: "Listener") -> None:
        """A new listener first gets everything so far."""
        with self.lock:
            listener.put(self.channels)
            listener.put(SamplesNews(time=self.times, channels=self.samples))
            for event in self.events:
                listener.put(event)
            if self.layers:
                listener.put(self.layers)
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
    """All live runs, those that wait for their turn, and the process that waits for the next one."""

    def __init__(self, *, db: Path, first: Path | None, kinds: tuple[Path, ...], most: int = MOST_LIVE,
                 on_frame: Callable[[LiveRun, Frame], None]) -> None:  # fmt: skip
        self.db, self.first, self.kinds, self.most, self.on_frame = db, first, kinds, most, on_frame
        self.kept: tuple[tuple[Path, Path], ...] = ()  # folders, and where versions lie that are used in place of files that do not load
        self.runs: dict[int, LiveRun] = {}
        self.waiting: list[tuple[LiveRun, Order]] = []
        self.spare: Future[Child] | None = None
        self.starting = 0
        self.is_closed = False
        self.lock = threading.RLock()
        self.order = threading.Lock()  # so that runs wait in the order of their numbers

    def make_ready(self) -> None:
        """Has the process for the next run started, unless one waits already, or is about to; does not wait for it."""
        with self.lock:
            if not self.is_closed and (self.spare is None or is_lost(self.spare)):
                lost, self.spare = self.spare, Future()
                threading.Thread(target=self.start_spare, args=(self.spare, lost), name="next run", daemon=True).start()

    def start_spare(self, promised: "Future[Child]", lost: "Future[Child] | None" = None) -> None:
        """Starts a process, in place of one that was lost; the first takes a while, and the server may have ended meanwhile."""
        if lost and lost.exception() is None:
            lost.result().end(0.0)  # it may live still, when only who it was split off from has gone
        try:
            process = Child.begin(worker.main, self.first, self.kinds, self.kept, prepared=is_warm())
        except Exception as error:
            promised.set_exception(error)
            return
        with self.lock:
            promised.set_result(process)
            is_late = self.is_closed
        if is_late:
            process.end(0.0)

    def use(self, kept: tuple[tuple[Path, Path], ...]) -> None:
        """Kinds have changed: the process that waits has the version before, and another takes its place."""
        self.kept = kept
        with self.lock:
            stale, self.spare = self.spare, None
        if stale is not None:
            threading.Thread(target=end_stale, args=(stale,), name="a version before", daemon=True).start()
            self.make_ready()

    def take(self) -> Child:
        """The process that waits. Raises OSError when there is none to be had."""
        self.make_ready()
        with self.lock:
            promised, self.spare = self.spare, None
        if promised is None:
            raise ServerError("The server is about to end.")
        return promised.result()

    # -- the order of runs ---------------------------------------------------------------------------

    def start(self, order: Order, scenario: str, loaded: Loaded) -> LiveRun:
        """Starts a run and returns when its row stands; when there is no place for it, it waits. Raises what the process refuses."""
        if not self.takes_place():
            return self.wait(order, scenario, loaded)
        try:
            process, number, duration = self.begin(order)
            live = LiveRun(number, scenario, duration, process, self.on_frame, loaded, self.db, self.kinds, pace=order.pace)
            self.keep(live)
        finally:
            self.give_place()
        self.listen(live, process)
        return live

    def takes_place(self) -> bool:
        """Takes a place among the runs that go on, if there is one, and nobody waits for it."""
        with self.lock:
            going = sum(not live.is_over and live.process is not None for live in self.runs.values())
            is_free = not self.waiting and self.starting + going < self.most
            self.starting += is_free
            return is_free

    def give_place(self) -> None:
        """Gives it back: the run goes on, or has not begun."""
        with self.lock:
            self.starting -= 1
        self.call_next()

    def listen(self, live: LiveRun, process: Child) -> None:
        """Reads a run's news; when it is over, it is another's turn."""

        def until_its_end() -> None:
            live.listen(process)
            self.call_next()

        threading.Thread(target=until_its_end, name=f"run {live.run}", daemon=True).start()
        threading.Timer(1.0, self.make_ready).start()  # not while the new run draws its first breath

    def wait(self, order: Order, scenario: str, loaded: Loaded) -> LiveRun:
        """A run that waits for its turn, with its row. Raises what is wrong with it, or ServerError when too many wait."""
        if len(self.waiting) >= MOST_WAITING:
            problem = Problem("queue", "is as long as may be", "", f"{MOST_WAITING} runs", "wait, or cancel some")
            raise ServerError("Too many runs wait.", [problem])
        loaded = job.seeded(loaded, order.seed)
        prepared = job.prepare(loaded)
        job.check_recording(prepared, self.db)
        with self.order:
            number = job.begin(loaded, prepared, reopen_runs(self.db), order.parent, status="waiting")
            duration = loaded.scenario.clock.duration
            live = LiveRun(number, scenario, duration, None, self.on_frame, loaded, self.db, self.kinds, "waiting", pace=order.pace)
            self.keep(live)
            self.line_up([*self.waiting, (live, replace(order, run=number))])
        self.call_next()
        return live

    def line_up(self, waiting: list[tuple[LiveRun, Order]]) -> None:
        """These wait now; whoever moves up is told."""
        with self.lock:
            self.waiting = waiting
            for position, (live, _) in enumerate(waiting, start=1):
                live.move(position)

    def call_next(self) -> None:
        """Lets the first of those that wait begin, as long as there are places."""
        with self.lock:
            going = sum(not live.is_over and live.process is not None for live in self.runs.values())
            free = 0 if self.is_closed else max(self.most - self.starting - going, 0)
            turns = self.waiting[:free]
            self.line_up(self.waiting[free:])
            self.starting += len(turns)
        for live, order in turns:
            threading.Thread(target=self.take_turn, args=(live, order), name=f"turn of {live.run}", daemon=True).start()

    def take_turn(self, live: LiveRun, order: Order) -> None:
        """Begins a run that waited; one that is refused now, or was cancelled by somebody else, is over."""
        try:
            process, _, _ = self.begin(order)
            live.begin(process)
            self.listen(live, process)
        except StudioError as error:
            live.refused(error)
        finally:
            self.give_place()

    def stop(self, run: int) -> LiveRun:
        """Ends a run, or takes it out of those that wait. Raises UnknownError, or ServerError when it is over."""
        live = self.find(run)
        if live.status != "waiting" or not self.drop(live, CANCELLED):
            live.stop()
        return live

    def drop(self, live: LiveRun, why: str) -> bool:
        """A run that waits will not begin; whether it still waited."""
        if not reopen_runs(self.db).take_out(live.run, why):
            return False
        live.on_end_news("cancelled", why)
        self.line_up([each for each in self.waiting if each[0] is not live])
        return True

    def keep(self, live: LiveRun) -> None:
        """Takes a run in, and forgets those that have been over for longest: their rows tell all of them."""
        with self.lock:
            over = [number for number, each in self.runs.items() if each.is_over]
            for number in over[: max(0, len(over) - MOST_OVER)]:
                del self.runs[number]
            self.runs[live.run] = live

    # -- processes -----------------------------------------------------------------------------------

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

    def going(self, run: int) -> LiveRun | None:
        """A live run that is not over; None when there is none of this number."""
        with self.lock:
            live = self.runs.get(run)
            return None if live is None or live.is_over else live

    def all(self) -> list[LiveRun]:
        """All of them, newest first."""
        with self.lock:
            return [live for _, live in sorted(self.runs.items(), reverse=True)]

    def close(self) -> None:
        """Stops all runs and ends all processes."""
        with self.lock:
            self.is_closed = True
        for live, _ in list(self.waiting):
            with suppress(StudioError):
                self.drop(live, LEFT)
        for live in self.all():
            with suppress(ServerError):
                live.stop()
        deadline = time.monotonic() + END_PATIENCE
        while any(not live.is_over for live in self.all()) and time.monotonic() < deadline:
            time.sleep(0.02)
        for live in self.all():
            live.abandon()
        if self.spare is not None and self.spare.done() and not self.spare.exception():
            self.spare.result().end(0.0)


def end_stale(promised: "Future[Child]") -> None:
    """Ends a process that nobody waits for any more, when it has begun."""
    if promised.exception() is None:
        promised.result().end(0.0)


def is_lost(promised: "Future[Child]") -> bool:
    """Whether a process that was promised has ended, or could not be started."""
    return promised.done() and (promised.exception() is not None or not promised.result().is_alive())


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
