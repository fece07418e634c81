"""Processes of ours: what they are told, what they tell, and how they end.

child = Child.begin(work, *arguments)    runs work(line, *arguments) in a process of its own
child.tell("pause")                      an order; never waits
child.hear()                             the next news; raises Gone when the process has ended without any
child.end()                              kindly first, then by force, with everything that it has started

In the process, `line` is the other end of the pipe: line.send(words), line.recv(), line.poll(seconds). Orders and news are
tuples that begin with a word.

Nobody outlives anybody. What `begin` starts is a guard, which does nothing but watch over the process that works, its child: no code
of a user's runs in it, so nothing can hold it up. When the one who began it is gone, however that went, or when it is told to, it ends
the worker; when the worker has ended, it ends whatever that has started, in groups and sessions of their own too, and ends like it.

A process that takes no orders costs its own run only: the orders wait in a queue of bounded length, and one too many is refused.

To import all of the studio takes a new process seconds. One that is `prepared` is split off a process that has done so, once, and does
nothing else; where the system cannot do that, or the environment is another than then, it is a new process as well.
"""

import ctypes
import multiprocessing
import os
import queue
import signal
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from multiprocessing.connection import Connection
from multiprocessing.reduction import ForkingPickler
from typing import Any, NoReturn

import psutil

MOST_ORDERS = 64  # that wait for a process to take them
END_PATIENCE = 3.0  # [s] for a process to end by itself
LAST_WORDS = 2.0  # [s] for a process to put down that it was left alone
NOW = "now"  # said over the lifeline: no last words
PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36  # of Linux, prctl(2)
READ_EARLY = ("STUDIO_", "XDG_", "NUMBA_", "PYTHON")  # beginnings of what of the environment is read by who is imported
spawn = multiprocessing.get_context("spawn")
split: Any = multiprocessing.get_context("forkserver") if sys.platform == "linux" else None


class Gone(OSError):
    """The process has ended; `code` is what it ended with, negative for a signal."""

    def __init__(self, code: int | None) -> None:
        super().__init__(f"the process has ended with code {code}")
        self.code = code


class Busy(OSError):
    """The process has not taken the orders before."""


class Child:
    """A process that was started here, and our ends of its pipes."""

    def __init__(self, process: Any, pipe: Connection, lifeline: Connection) -> None:
        self.process, self.pipe, self.lifeline = process, pipe, lifeline
        self.orders: queue.Queue[tuple[Any, ...] | None] = queue.Queue(MOST_ORDERS)
        self.ending = threading.Lock()
        self.code: int | None = None
        self.is_over = False
        threading.Thread(target=self.deliver, name=f"orders of {process.pid}", daemon=True).start()

    @classmethod
    def begin(cls, work: Callable[..., None], *arguments: Any, prepared: bool = False) -> "Child":
        """Starts `work(line, *arguments)`, a function that stands in a module. Raises OSError when there is no process to be had.

        The first that is `prepared` waits until there is something that it can be split off.
        """
        ours, line = spawn.Pipe()
        watched, lifeline = spawn.Pipe(duplex=False)
        try:
            task = bytes(ForkingPickler.dumps((work, arguments)))
            process = (split if prepared and can_split() else spawn).Process(
                target=live, args=(line, watched, task, dict(os.environ)), daemon=True
            )
            process.start()
        except BaseException:
            ours.close()
            lifeline.close()
            raise
        finally:
            line.close()
            watched.close()
        return cls(process, ours, lifeline)

    # -- orders and news -----------------------------------------------------------------------------

    def tell(self, *words: Any) -> None:
        """Gives an order and does not wait. Raises Gone, or Busy when too many have not been taken."""
        if self.is_over or not self.process.is_alive():
            raise Gone(self.exit_code())
        try:
            self.orders.put_nowait(words)
        except queue.Full:
            raise Busy from None

    def deliver(self) -> None:
        """Hands the orders over, one after another; in a thread of its own, for a full pipe holds up whoever writes into it."""
        with suppress(OSError):
            while (words := self.orders.get()) is not None:
                self.pipe.send(words)

    def hear(self) -> tuple[Any, ...]:
        """Waits for the next news; raises Gone when there will be none."""
        try:
            return self.pipe.recv()
        except (EOFError, OSError):
            self.process.join(END_PATIENCE)
            raise Gone(self.exit_code()) from None

    def hears_within(self, seconds: float) -> bool:
        """Whether there are news within so many seconds, or there will be none."""
        try:
            return self.pipe.poll(seconds)
        except (EOFError, OSError):
            return True

    # -- the end -------------------------------------------------------------------------------------

    def is_alive(self) -> bool:
        """Whether it still goes on."""
        return not self.is_over and self.process.is_alive()

    def exit_code(self) -> int | None:
        """What it ended with; None while it goes on."""
        return self.code if self.is_over else self.process.exitcode

    def kill(self) -> None:
        """Ends it at once, with everything that it has started; does not wait for that."""
        with self.ending, suppress(OSError):
            if not self.is_over:
                self.lifeline.send(NOW)

    def end(self, patience: float = END_PATIENCE) -> None:
        """Waits a little for its end, then kills it; afterwards nothing of it is left here, no descriptor and no thread."""
        with suppress(queue.Full):
            self.orders.put_nowait(None)
        if not self.is_over:
            self.process.join(patience)
        self.kill()
        with self.ending:
            if self.is_over:
                return
            self.process.join(END_PATIENCE + LAST_WORDS)
            self.process.kill()  # a guard that never came so far as to watch
            self.process.join()
            self.code, self.is_over = self.process.exitcode, True
            self.process.close()
            self.lifeline.close()
            self.pipe.close()
        with suppress(queue.Empty):
            while True:
                self.orders.get_nowait()
        self.orders.put(None)


# -- what processes are split off --------------------------------------------------------------------


def prepare(module: str) -> None:
    """Says what a process has imported that others are split off; counts until the first is."""
    if split:
        split.set_forkserver_preload([module])


def can_split() -> bool:
    """Whether processes can be split off one that has read the environment as it is now."""
    return bool(split) and environment_then() == environment_now()


@cache
def environment_then() -> dict[str, str]:
    """The environment that was read when the first was split off."""
    return environment_now()


def environment_now() -> dict[str, str]:
    """What of the environment is read by who is imported."""
    return {name: value for name, value in os.environ.items() if name.startswith(READ_EARLY)}


# -- the guard ---------------------------------------------------------------------------------------


def live(line: Connection, lifeline: Connection, task: bytes, environment: dict[str, str]) -> None:
    """What the process does: its work, for as long as somebody holds the other end of the lifeline.

    The work is unpacked, with all the imports that this takes, in the process that does it.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever began it decides when it ends
    if os.environ != environment:
        os.environ.clear()
        os.environ.update(environment)
    if hasattr(os, "fork"):
        split_off(line, lifeline)
    else:
        threading.Thread(target=cut_off, args=(lifeline, lambda: os._exit(1)), daemon=True).start()
    work, arguments = ForkingPickler.loads(task)
    work(line, *arguments)


def split_off(line: Connection, lifeline: Connection) -> None:
    """Splits the worker off, in which this returns, and watches over it."""
    os.setpgrp()
    control(PR_SET_CHILD_SUBREAPER, 1)  # orphans of the worker come to this process
    guard = os.getpid()
    if worker := os.fork():
        line.close()
        watch(worker, lifeline)
    os.setpgrp()
    control(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != guard:
        os._exit(1)  # gone before it could be noticed
    lifeline.close()


def control(option: int, value: int) -> None:
    """Sets what only Linux knows about a process."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(option, value, 0, 0, 0)


def watch(worker: int, lifeline: Connection) -> NoReturn:
    """Until the worker has ended; then ends what is left of it, and ends like it."""
    threading.Thread(target=cut_off, args=(lifeline, lambda: end_at_once(worker)), daemon=True).start()
    ended, status = 0, 0
    while ended != worker:
        ended, status = os.wait()
    end_others(worker)
    end_like(os.waitstatus_to_exitcode(status))


def end_at_once(worker: int) -> None:
    """Ends a process that may have ended already."""
    with suppress(ProcessLookupError):
        os.kill(worker, signal.SIGKILL)


def cut_off(lifeline: Connection, end: Callable[[], None]) -> None:
    """Waits for the end of the lifeline, and for the last words of who depends on it, or for the word that it be now."""
    try:
        lifeline.recv()
    except (EOFError, OSError):
        time.sleep(LAST_WORDS)
    end()


def end_others(worker: int) -> None:
    """Ends all that the worker has started and that still goes on: its group, and what has come to the guard."""
    until = time.monotonic() + LAST_WORDS
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(worker, signal.SIGKILL)
    while (others := psutil.Process().children(recursive=True)) and time.monotonic() < until:
        for each in others:
            with suppress(psutil.Error):
                each.kill()
        with suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        time.sleep(0.01)


def end_like(code: int) -> NoReturn:
    """Ends this process with the code of another, or by the signal that ended that one, without a second dump of memory."""
    if code < 0:
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if code not in (-signal.SIGKILL, -signal.SIGSTOP):
            signal.signal(-code, signal.SIG_DFL)
        os.kill(os.getpid(), -code)
    os._exit(code)
