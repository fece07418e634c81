"""Processes of ours: what they are told, what they tell, and how they end.

child = Child.begin(work, *arguments)    runs work(line, *arguments) in a process of its own
child.tell("pause")                      an order; never waits
child.hear()                             the next news; raises Gone when the process has ended without any
child.end()                              kindly first, then by force, with everything that it has started

In the process, `line` is the other end of the pipe: line.send(words), line.recv(), line.poll(seconds). Orders and news are
tuples that begin with a word.

Nobody outlives anybody: a process and what it starts are one group, and the group ends as soon as the process that began it is
gone, however it went. A process that takes no orders costs its own run only: the orders wait in a queue of bounded length, and
one too many is refused.
"""

import multiprocessing
import os
import queue
import signal
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Any

import psutil

MOST_ORDERS = 64  # that wait for a process to take them
END_PATIENCE = 3.0  # [s] for a process to end by itself
LAST_WORDS = 2.0  # [s] for a process to put down that it was left alone
spawn = multiprocessing.get_context("spawn")


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
    def begin(cls, work: Callable[..., None], *arguments: Any) -> "Child":
        """Starts `work(line, *arguments)`, a function that stands in a module. Raises OSError when there is no process to be had."""
        ours, line = spawn.Pipe()
        watched, lifeline = spawn.Pipe(duplex=False)
        try:
            process = spawn.Process(target=live, args=(work, line, watched, arguments), daemon=True)
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
        """Ends it at once, with everything that it has started."""
        with self.ending:
            if not self.is_over and self.process.is_alive():
                kill_group(self.process.pid)

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
            self.process.join()
            self.code, self.is_over = self.process.exitcode, True
            self.process.close()
            self.lifeline.close()
            self.pipe.close()
        with suppress(queue.Empty):
            while True:
                self.orders.get_nowait()
        self.orders.put(None)


def kill_group(pid: int) -> None:
    """Kills a process that `live` began, its group, and what it has started in other groups."""
    with suppress(psutil.NoSuchProcess):
        others = psutil.Process(pid).children(recursive=True)
        if hasattr(os, "killpg"):
            with suppress(ProcessLookupError, PermissionError):
                if os.getpgid(pid) == pid:
                    os.killpg(pid, signal.SIGKILL)
        for each in [psutil.Process(pid), *others]:
            with suppress(psutil.NoSuchProcess):
                each.kill()


# -- in the process ----------------------------------------------------------------------------------


def live(work: Callable[..., None], line: Connection, lifeline: Connection, arguments: tuple[Any, ...]) -> None:
    """What the process does: its work, for as long as somebody holds the other end of the lifeline."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever began it decides when it ends
    if hasattr(os, "setpgrp"):
        os.setpgrp()
    threading.Thread(target=perish, args=(lifeline,), name="lifeline", daemon=True).start()
    work(line, *arguments)


def perish(lifeline: Connection) -> None:
    """Waits for the end of the lifeline, on which nothing ever comes, and soon ends the process and its group with it."""
    with suppress(EOFError, OSError):
        lifeline.recv()
    time.sleep(LAST_WORDS)
    if hasattr(os, "killpg"):
        os.killpg(os.getpgrp(), signal.SIGKILL)
    os._exit(1)
