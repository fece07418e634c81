"""Processes of ours: orders never hold anybody up, and nobody outlives anybody."""

import os
import re
import signal
import subprocess
import sys
import threading
from pathlib import Path

import psutil
import pytest

from studio.process import MOST_ORDERS, Busy, Child, Gone, end_at_once
from tests.patience import PATIENCE, until


def answer(line, *words):
    """Says what it is told, until it is told to end."""
    line.send(("began", *words))
    while (order := line.recv()) != ("end",):
        line.send(("heard", *order))


IDLE = f"import time; time.sleep({PATIENCE})"
ORPHAN = f"""
import subprocess, sys
print(subprocess.Popen([sys.executable, "-c", {IDLE!r}], stdout=subprocess.DEVNULL, start_new_session=True).pid)
"""


def hang(line):
    """Takes no order and never lets go of the interpreter; has started processes which do nothing either: one as usual, one in a
    session of its own, and one whose parent has ended."""
    command = [sys.executable, "-c", IDLE]
    others = [subprocess.Popen(command).pid, subprocess.Popen(command, start_new_session=True).pid]
    others.append(int(subprocess.run([sys.executable, "-c", ORPHAN], stdout=subprocess.PIPE, check=True).stdout))
    line.send(("has", os.getpid(), *others))
    re.match("(a*)*b", 100 * "a")


def stray(line):
    """Ends by a signal, without an end to what it has started in a session of its own."""
    line.send(("has", subprocess.Popen([sys.executable, "-c", IDLE], start_new_session=True).pid))
    os.kill(os.getpid(), signal.SIGKILL)


def tell(line, name):
    """Says by whom its guard was started, and a variable of its environment."""
    line.send((psutil.Process().parent().ppid(), os.environ.get(name)))


def crash(line):
    """Ends without a word."""
    os._exit(7)


def is_gone(pid):
    return not psutil.pid_exists(pid) or psutil.Process(pid).status() == psutil.STATUS_ZOMBIE


def test_orders_arrive_in_order_and_are_answered():
    child = Child.begin(answer, 1, "two")
    try:
        assert child.hear() == ("began", 1, "two")
        for number in range(20):
            child.tell("order", number)
        assert [child.hear() for _ in range(20)] == [("heard", "order", number) for number in range(20)]
        child.tell("end")
        with pytest.raises(Gone) as gone:
            child.hear()
        assert gone.value.code == 0
    finally:
        child.end()
    with pytest.raises(Gone):
        child.tell("order")


def test_a_crash_is_told_with_its_code():
    child = Child.begin(crash)
    with pytest.raises(Gone) as gone:
        child.hear()
    assert gone.value.code == 7 == child.exit_code()
    child.end()
    assert child.exit_code() == 7


@pytest.mark.parametrize("prepared", [False, True])
def test_a_process_that_takes_no_orders_holds_nobody_up(prepared):
    """However many orders, however long: one too many is refused, and the end comes all the same, with what it has started."""
    child = Child.begin(hang, prepared=prepared)
    _, *pids = child.hear()
    long, refused = "x" * 10_000, 0
    for _ in range(10 * MOST_ORDERS):
        try:
            child.tell("step", long)
        except Busy:
            refused += 1
    assert refused >= 8 * MOST_ORDERS
    child.end(0.0)
    assert child.exit_code() == -signal.SIGKILL
    assert all(map(is_gone, pids))


@pytest.mark.parametrize("prepared", [False, True])
def test_a_process_that_dies_leaves_nobody_behind(prepared):
    child = Child.begin(stray, prepared=prepared)
    _, pid = child.hear()
    with pytest.raises(Gone) as gone:
        child.hear()
    assert gone.value.code == -signal.SIGKILL and is_gone(pid)
    child.end()


def test_nothing_is_left_of_a_process_that_has_ended():
    """Neither descriptors nor threads; the first one starts what Python needs for all."""
    Child.begin(crash).end()
    descriptors, threads = psutil.Process().num_fds(), threading.active_count()
    for _ in range(10):
        Child.begin(crash).end()
    assert psutil.Process().num_fds() == descriptors
    until(lambda: threading.active_count() <= threads, "the end of its threads")


def told(**options):
    """What `tell` says, of a variable that is set for it."""
    child = Child.begin(tell, "HOME", **options)
    try:
        return child.hear()
    finally:
        child.end()


def test_who_is_to_be_ended_may_have_ended_by_himself():
    process = subprocess.Popen([sys.executable, "-c", IDLE])
    end_at_once(process.pid)
    assert process.wait(PATIENCE) == -signal.SIGKILL
    end_at_once(process.pid)


def test_prepared_processes_are_split_off_one_that_stays(monkeypatch):
    """With the environment as it is now; where that says something else to who is imported, they are new processes."""
    first, _ = told(prepared=True)
    assert first != os.getpid()
    monkeypatch.setenv("HOME", "elsewhere")
    assert told(prepared=True) == (first, "elsewhere")
    assert told() == (os.getpid(), "elsewhere")
    monkeypatch.setenv("STUDIO_CACHE", "elsewhere")
    assert told(prepared=True) == (os.getpid(), "elsewhere")


MASTER = """
import os, sys, time
from studio.process import Child, prepare
from tests.test_process import hang

if __name__ == "__main__":
    prepare("studio.errors")
    child = Child.begin(hang, prepared={prepared})
    print(child.process.pid, *child.hear()[1:], flush=True)
    time.sleep({patience})
"""


@pytest.mark.parametrize("prepared", [False, True])
def test_nobody_outlives_the_one_who_began_it(tmp_path, prepared):
    """Not even when that one is killed, and nothing but a signal reaches the process; nor does what it has started."""
    (tmp_path / "master.py").write_text(MASTER.format(patience=PATIENCE, prepared=prepared))
    root = str(Path(__file__).parents[1])
    master = subprocess.Popen(
        [sys.executable, str(tmp_path / "master.py")],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": root},
        cwd=tmp_path,
    )
    pids = [int(pid) for pid in master.stdout.readline().split()]
    assert len(pids) == 5 and not any(map(is_gone, pids))
    master.kill()
    master.wait()
    until(lambda: all(map(is_gone, pids)), "the end of its processes")
